#!/usr/bin/env bash
# The pictures of docs/review.md, made anew: figures of the demonstration flight, of two flights, and of a crash;
# and with a program that has the viewer's features, what the viewer shows of them in every layout.
# Usage: tests/review_pictures.sh [TILTROTOR [TILTROTOR_WITH_VIEWER]]
set -euo pipefail
cd "$(dirname "$0")/.."

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$tiltrotor" demo --fast --no-flightgear --out "$work/demo.mcap"
"$tiltrotor" plot "$work/demo.mcap" --out "$work" --force --figure trajectory euler corridor
for name in trajectory euler corridor; do
    cp "$work/demo-$name.svg" "docs/pictures/review_$name.svg"
done

# The same hands, with a weaker hold of the pitch attitude.
fly=(fly --pilot convert --fast --no-flightgear --duration 90)
"$tiltrotor" "${fly[@]}" --out "$work/calm.mcap" || [ $? = 4 ]
"$tiltrotor" whatif "$work/calm.mcap" --set fcc.scas.pitch.attitude_gain_in_per_rad=0.9 --out "$work/weaker.mcap"
"$tiltrotor" plot "$work/calm.mcap" --against "$work/weaker.mcap" --out "$work" --figure euler
cp "$work/calm-weaker-euler.svg" docs/pictures/review_against.svg

printf '[[event]]\nat_s = 1.0\naxis = { stick_right = 1.0 }\n' >"$work/roll.toml"
"$tiltrotor" fly --script "$work/roll.toml" --from-trim --speed-kt 100 --altitude-ft 400 --duration 8 --fast \
    --no-flightgear --out "$work/crash.mcap"
"$tiltrotor" plot "$work/crash.mcap" --out "$work" --figure profile
cp "$work/crash-profile.svg" docs/pictures/review_crash.svg

viewing=${2:-target/release/tiltrotor}
# The viewer itself: the script that starts it would be ended in its place.
viewer=$(find target/rerun-0.36.3/lib -path '*rerun_cli/rerun' -type f 2>/dev/null | head -1)
if [ -z "$viewer" ] || ! "$viewing" view "$work/demo.mcap" --save "$work/demo.rrd" --force >/dev/null; then
    echo "no pictures of the viewer: $viewing is not built with the default features, or" \
        "tests/rerun_screenshot.sh has not brought the viewer yet" >&2
    exit 0
fi
# As `view --viewer` starts it, without a window; it says where it listens and which process it is.
cat >"$work/viewer" <<SCRIPT
#!/bin/sh
[ "\$1" = --version ] && exec "$PWD/$viewer" --version
echo "\$\$ \$4" >"$work/listens"
export RERUN_ANALYTICS=0
exec "$PWD/$viewer" --headless --window-size 1400x900 "\$@"
SCRIPT
chmod +x "$work/viewer"

as_jpeg() {
    target/rerun-0.36.3/bin/python - "$1" "docs/pictures/view_$2.jpg" <<'PYTHON'
import os, sys
from PIL import Image

picture = Image.open(sys.argv[1]).convert("RGB").resize((1400, 900))
for quality in (84, 80, 76, 72, 68, 64):
    picture.save(sys.argv[2], quality=quality, optimize=True)
    if os.path.getsize(sys.argv[2]) < 200_000:
        break
PYTHON
}

# picture NAME LOG ARGUMENTS: what `view` shows of it.
picture() {
    local name=$1 process port
    shift
    "$viewing" view "$@" --viewer "$work/viewer" --force
    read -r process port <"$work/listens"
    # What was loaded is drawn by then.
    sleep "${SETTLES:-60}"
    timeout 120 target/rerun-0.36.3/bin/python tests/viewer_picture.py "$port" "$work/$name.png"
    kill "$process"
    as_jpeg "$work/$name.png" "$name"
}
picture pilot "$work/demo.mcap" --at 50
picture engineer "$work/demo.mcap" --layout engineer --at 110
picture rotor "$work/demo.mcap" --layout rotor --at 30
# How it kept time is of a flight that waited for the clock.
"$viewing" fly --pilot takeoff --no-flightgear --no-panel --duration 60 --out "$work/timed.mcap"
picture latency "$work/timed.mcap" --layout latency
picture compare "$work/calm.mcap" --against "$work/weaker.mcap" --at 23
picture crash "$work/crash.mcap" --at 6.6
# While it is flown: what is seen of the stream after a while, at its end.
port=$(python3 -c 'import socket
s = socket.socket()
s.bind(("127.0.0.1", 0))
print(s.getsockname()[1])')
RERUN_ANALYTICS=0 "$viewer" --headless --window-size 1400x900 --bind 127.0.0.1 --port "$port" >/dev/null 2>&1 &
process=$!
sleep 5
"$viewing" fly --pilot takeoff --no-flightgear --no-panel --duration 60 --rerun "127.0.0.1:$port" \
    --out "$work/live.mcap" &
flying=$!
sleep 50
timeout 120 target/rerun-0.36.3/bin/python tests/viewer_picture.py "$port" "$work/live.png"
wait "$flying"
kill "$process"
as_jpeg "$work/live.png" live
# A log that diverges, as tests/command/view.rs leaves it: the aircraft in it is not the one that was flown.
diverged=(target/tmp/view-diverged/parted/*.rrd)
if [ -s "${diverged[0]}" ]; then
    tests/rerun_screenshot.sh "${diverged[0]}" "$work/diverged.png" 30
    as_jpeg "$work/diverged.png" diverged
else
    echo "no picture of a diverged log: run tests/command/view.rs first" >&2
fi
