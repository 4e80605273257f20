#!/bin/sh
# The pilot models, in release: every test of theirs with all its winds, seeds and strange aircraft;
# then the demonstration by the command in ten kinds of weather, each flight verified.
#
#   tests/pilots.sh
set -eu
cd "$(dirname "$0")/.."
cargo test --release -p recorder --no-default-features --test pilots
cargo build --release --no-default-features
tiltrotor=${CARGO_TARGET_DIR:-target}/release/tiltrotor
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for weather in "0 0 0.0 0" "10 270 0.0 0" "10 90 0.0 0" "10 0 0.0 0" "10 180 0.0 0" \
    "0 0 1.0 1" "10 270 1.0 2" "10 90 1.0 3" "10 0 1.0 4" "10 180 1.0 5"; do
    set -- $weather
    sed -e "s/wind_kt = 0.0/wind_kt = $1.0/" -e "s/wind_from_deg = 0.0/wind_from_deg = $2.0/" \
        -e "s/\[world\]/[world]\nturbulence_mps = $3\nturbulence_seed = $4/" \
        aircraft/scenario/default.toml >"$work/scenario.toml"
    "$tiltrotor" demo --fast --force --no-flightgear --scenario "$work/scenario.toml" \
        --out "$work/flight.mcap" >"$work/said"
    echo "wind $1 kt from $2 deg, turbulence $3 m/s: $(grep exact "$work/said")"
    "$tiltrotor" log info "$work/flight.mcap" | grep -q touchdown
done
