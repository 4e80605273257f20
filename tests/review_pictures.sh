#!/usr/bin/env bash
# The pictures of docs/review.md, made anew: figures of the demonstration flight, of two flights, and of a crash.
# Usage: tests/review_pictures.sh [TILTROTOR]
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
