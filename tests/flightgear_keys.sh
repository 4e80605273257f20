#!/usr/bin/env bash
# The keys of FlightGear's window in the real program: `fly --flightgear-controls` with the nacelles, flaps, gear,
# parking brake, SCAS, rotor speed and marker on keys that are really pressed. Each of them reaches the flight as a
# recorded input, and the flight replays exactly.
# Usage: tests/flightgear_keys.sh [TILTROTOR]
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/flightgear/real.sh
the_tiltrotor "${1:-}"
command -v xdotool >/dev/null || apt-get install -y --no-install-recommends xdotool >/dev/null 2>&1 ||
    skip "no xdotool (Debian package xdotool)"
start_screen 320x240
small_flightgear
log=$work/keys.mcap
env "${mesa[@]}" "$tiltrotor" fly --flightgear-controls --no-panel --start hover-50ft --duration 600 --ground flat \
    --flightgear "127.0.0.1:$(free_port SOCK_DGRAM)" --launch-flightgear --terrasync off --hold 0 --out "$log" \
    "${options[@]/#/--fgfs-arg=}" >"$work/said" 2>&1 &
flight=$!
processes+=("$flight")
# It is recorded from take-off on, and that is when FlightGear is ready.
deadline=$((SECONDS + 300))
until [ -s "$log" ] || compgen -G "$work/.keys*" >/dev/null; do
    kill -0 "$flight" 2>/dev/null || { cat "$work/said"; exit 1; }
    [ "$SECONDS" -lt "$deadline" ] || { cat "$work/said"; echo "no flight began"; exit 1; }
    sleep 0.5
done
sleep 3
window=$(xdotool search --onlyvisible --name . | head -1)
xdotool windowfocus "$window" mousemove --window "$window" 160 120
press() { # KEY SECONDS
    xdotool keydown "$1"
    sleep "$2"
    xdotool keyup "$1"
    # At least one more frame is drawn before the next one.
    sleep 1.5
}
press k 2.5
press j 2
press bracketleft 1
press bracketright 1
for key in g B s r m; do press "$key" 1; done
kill -INT "$flight"
wait "$flight" || { cat "$work/said"; exit 1; }
"$tiltrotor" log cat "$log" --channel outputs --every 25 2>/dev/null | python3 -c '
import json, sys

seen = {}
for line in sys.stdin:
    message = json.loads(line)
    for name, value in message.items():
        if name.startswith("cockpit."):
            values = seen.setdefault(name.removeprefix("cockpit."), [])
            if not values or values[-1] != value:
                values.append(value)
wanted = {
    "nacelle_aft_norm": lambda v: 1 in v and -1 in v and v[-1] == 0,
    "flap_detent": lambda v: v == [2, 1, 2],
    "gear_down": lambda v: v == [1, 0],
    "parking_brake": lambda v: len(v) == 2,
    "scas_on": lambda v: v == [1, 0],
    "rpm_select": lambda v: len(v) == 2,
    "markers": lambda v: v == [0, 1],
}
missing = [f"{name}: {seen.get(name)}" for name, good in wanted.items() if not good(seen.get(name, []))]
for name in wanted:
    print(f"{name}: {seen.get(name)}")
sys.exit(f"not as the keys say: {missing}" if missing else 0)
'
"$tiltrotor" verify "$log"
echo "passed   nine keys of FlightGear reach the flight, which replays exactly"
