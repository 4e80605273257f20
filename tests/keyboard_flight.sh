#!/bin/sh
# A flight by keyboard alone, in a terminal of tmux: take-off, hover, landing. The script is the pilot: it
# reads height and climb off the panel and presses keys. The log is verified; the picture of the panel in
# the hover is put where `PICTURE` says.
#
#   PICTURE=docs/panel.txt tests/keyboard_flight.sh
#
# TILTROTOR names the program; without it, a release build is made. Needs tmux.
set -eu
cd "$(dirname "$0")/.."
command -v tmux >/dev/null || { echo "skipped: needs tmux"; exit 77; }
if [ -z "${TILTROTOR:-}" ]; then
    cargo build --quiet --release --no-default-features --target-dir target/headless
fi
program=$(realpath "${TILTROTOR:-target/headless/release/tiltrotor}")
folder=$(mktemp -d)
tmux="tmux -L tiltrotor-$$"
trap '$tmux kill-server 2>/dev/null || true; rm -rf "$folder"' EXIT

$tmux new-session -d -s flight -x 100 -y 32 \
    "cd $folder && $program fly --keyboard --no-flightgear --out flight.mcap >said; echo \$? >status; \
    stty -a >terminal"

key() { $tmux send-keys -t flight "$@"; }
picture() { $tmux capture-pane -p -t flight; }
shows() { $tmux capture-pane -p -t "$1" | grep -qE "$2"; }
# Waits for a condition, twenty seconds at most.
await() {
    session=$1 tries=0
    shift
    until "$@"; do
        tries=$((tries + 1))
        [ $tries -lt 100 ] || { echo "waited in vain for: $*"; $tmux capture-pane -p -t "$session" || true; exit 1; }
        sleep 0.2
    done
}
# Height, climb, forward speed, pitch and roll as the panel shows them.
read_panel() {
    shown=$(picture)
    roll=$(printf '%s\n' "$shown" | sed -n 's/.*roll *+*\(-\{0,1\}[0-9]*\)° pitch.*/\1/p')
    pitch=$(printf '%s\n' "$shown" | sed -n 's/.*pitch *+*\(-\{0,1\}[0-9]*\)°.*/\1/p')
    height=$(printf '%s\n' "$shown" | sed -n 's/^ height *\(-\{0,1\}[0-9]*\) ft.*/\1/p')
    forward=$(printf '%s\n' "$shown" | sed -n 's/^ drift kt *fwd +*\(-\{0,1\}[0-9]*\) .*/\1/p')
    climb=$(printf '%s\n' "$shown" | sed -n 's/^ climb *\(-\{0,1\}[0-9]*\) ft.*/\1/p')
}
# One look, and at most a press for each control: the climb is to be $1 ft/min, the aircraft level.
steer() {
    read_panel
    # A degree is the pitch of a hover: more slows it down.
    level=$((1 + forward / 2))
    [ $level -le 4 ] || level=4
    [ $level -ge -4 ] || level=-4
    if [ "$pitch" -gt $((level + 1)) ]; then key Up; elif [ "$pitch" -lt $((level - 1)) ]; then key Down; fi
    if [ "$roll" -gt 2 ]; then key Left; elif [ "$roll" -lt -2 ]; then key Right; fi
    if [ "$climb" -lt $(($1 - 40)) ]; then key +; fi
    if [ "$climb" -gt $(($1 + 40)) ]; then key -; fi
    sleep 0.4
}

await flight shows flight ' height '

key k # the parking brake, off
for _ in $(seq 9); do key w; sleep 0.05; done # where the stick is in a hover
for _ in $(seq 32); do key PageUp; sleep 0.05; done
on_ground=7
looks=0
while read_panel; [ "$height" -lt 20 ]; do
    looks=$((looks + 1))
    [ $looks -lt 400 ] || { echo "it does not lift off:"; picture; exit 1; }
    if [ "$height" -le $((on_ground + 1)) ]; then key +; sleep 0.15; else steer 150; fi
done
key m # in the air
for _ in $(seq "${HOVER_LOOKS:-80}"); do
    read_panel
    want=$(((40 - height) * 6))
    [ $want -le 150 ] || want=150
    [ $want -ge -150 ] || want=-150
    steer $want
done
picture >"$folder/picture"
[ "$height" -ge 25 ] && [ "$height" -le 55 ] || { echo "no hover at 40 ft:"; picture; exit 1; }
looks=0
while read_panel; [ "$height" -gt $((on_ground + 1)) ]; do
    looks=$((looks + 1))
    [ $looks -lt 400 ] || { echo "it does not come down:"; picture; exit 1; }
    steer -130
done
for _ in $(seq 50); do key PageDown; sleep 0.03; done
key k # the parking brake, set
sleep 3
key Q
await flight [ -s "$folder/status" ]
cat "$folder/said"
# The terminal is as it was.
sleep 1
grep -qE '[^-]icanon' "$folder/terminal" && grep -qE '[^-]echo ' "$folder/terminal" ||
    { echo "the terminal was not given back:"; cat "$folder/terminal"; exit 1; }
[ "$(cat "$folder/status")" = 0 ]
grep -q '^debrief    touchdown' "$folder/said"
if grep -qE "HARD|hull" "$folder/said"; then echo "that was no landing"; exit 1; fi
"$program" verify "$folder/flight.mcap"
"$program" log summary "$folder/flight.mcap"
# A signal lands the flight, and gives the terminal back as well.
$tmux new-session -d -s signal -x 100 -y 32 "cd $folder && \
    sh -c 'echo \$\$ >process; exec $program fly --keyboard --no-flightgear --out signal.mcap >said2'; \
    echo \$? >status2; stty -a >terminal2; sleep 5"
await signal shows signal ' height '
sleep 2
kill -TERM "$(cat "$folder/process")"
await signal [ -s "$folder/terminal2" ]
[ "$(cat "$folder/status2")" = 0 ]
grep -q 'end        ended by a signal: SIGTERM' "$folder/said2"
grep -qE '[^-]icanon' "$folder/terminal2" && grep -qE '[^-]echo ' "$folder/terminal2"
"$program" verify "$folder/signal.mcap"

# A replay has keys: it stands still, goes a tick at a time, back to the beginning, and ends when told.
$tmux new-session -d -s replay -x 100 -y 32 "cd $folder && \
    $program replay flight.mcap --no-flightgear >said3; echo \$? >status3; stty -a >terminal3; sleep 5"
at() { $tmux capture-pane -p -t replay | sed -n 's/^ *\([0-9.]*\) s  .*/\1/p' | tail -1; }
await replay shows replay ' times real time'
$tmux send-keys -t replay Space
await replay shows replay ' s  paused'
stood=$(at)
$tmux send-keys -t replay Right Right Left
await replay shows replay "$(awk -v s="$stood" 'BEGIN { printf "%.3f", s + 0.004 }') s  paused"
$tmux send-keys -t replay Home
await replay shows replay '0\.004 s  paused'
$tmux send-keys -t replay Q
await replay [ -s "$folder/terminal3" ]
[ "$(cat "$folder/status3")" = 0 ]
grep -q '^not reflown: ' "$folder/said3"
grep -qE '[^-]icanon' "$folder/terminal3" && grep -qE '[^-]echo ' "$folder/terminal3"
if [ -n "${PICTURE:-}" ]; then cp "$folder/picture" "$PICTURE"; fi
if [ -n "${LOG:-}" ]; then cp "$folder/flight.mcap" "$LOG"; fi
echo "flown by keyboard: took off, hovered, landed; verified exact; replayed by keys"
