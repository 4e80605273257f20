#!/usr/bin/env bash
# Other people's readers read every channel of a flight log, and find our numbers.
# Usage: tests/cdr.sh [TILTROTOR]   (a headless release build without one)
set -euo pipefail
cd "$(dirname "$0")/.."

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi

venv=target/venv-cdr
if [ ! -x "$venv/bin/python" ]; then
    python3 -m venv "$venv"
    "$venv/bin/pip" install --quiet mcap==1.6.0 mcap-ros2-support==0.6.0
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$tiltrotor" demo --fast --no-flightgear --out "$work/flight.mcap"
"$venv/bin/python" tests/cdr.py "$work/flight.mcap" "$tiltrotor"
