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

# The same hands on pedals that are geared otherwise.
fly=(fly --pilot convert --fast --no-flightgear --duration 90)
"$tiltrotor" "${fly[@]}" --out "$work/calm.mcap" || [ $? = 4 ]
"$tiltrotor" whatif "$work/calm.mcap" --set fcc.travel.pedal_in=2 --out "$work/pedals.mcap"
"$tiltrotor" plot "$work/calm.mcap" --against "$work/pedals.mcap" --out "$work" --figure euler
cp "$work/calm-pedals-euler.svg" docs/pictures/review_against.svg

printf '[[event]]\nat_s = 1.0\naxis = { stick_right = 1.0 }\n' >"$work/roll.toml"
"$tiltrotor" fly --script "$work/roll.toml" --from-trim --speed-kt 100 --altitude-ft 400 --duration 8 --fast \
    --no-flightgear --out "$work/crash.mcap"
"$tiltrotor" plot "$work/crash.mcap" --out "$work" --figure profile
cp "$work/crash-profile.svg" docs/pictures/review_crash.svg

viewing=${2:-target/release/tiltrotor}
if ! "$viewing" view "$work/demo.mcap" --save "$work/pilot.rrd" --force >/dev/null; then
    echo "no pictures of the viewer: $viewing is not built with the default features" >&2
    exit 0
fi
for layout in engineer rotor latency; do
    "$viewing" view "$work/demo.mcap" --layout "$layout" --save "$work/$layout.rrd"
done
"$viewing" view "$work/calm.mcap" --against "$work/pedals.mcap" --save "$work/compare.rrd"
"$viewing" view "$work/crash.mcap" --save "$work/crash.rrd"
pictures=(pilot engineer rotor latency compare crash)
# A log that diverges, as tests/view.rs leaves it: the aircraft in it is not the one that was flown.
diverged=(target/tmp/view-diverged/parted/*.rrd)
if [ -s "${diverged[0]}" ]; then
    cp "${diverged[0]}" "$work/diverged.rrd"
    pictures+=(diverged)
else
    echo "no picture of a diverged log: run tests/view.rs first" >&2
fi
for name in "${pictures[@]}"; do
    tests/rerun_screenshot.sh "$work/$name.rrd" "$work/$name.png" 30
    target/rerun-0.36.3/bin/python - "$work/$name.png" "docs/pictures/view_$name.jpg" <<'PYTHON'
import sys
from PIL import Image

Image.open(sys.argv[1]).convert("RGB").save(sys.argv[2], quality=82, optimize=True)
PYTHON
done
