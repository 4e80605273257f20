#!/usr/bin/env bash
# The real FlightGear over its scenery of Hilo: a flight begins on FlightGear's runway and rolls on it, another lands
# on it, and the wheels are on the ground that FlightGear draws; the flight replays exactly without FlightGear.
# Usage: tests/flightgear_scenery.sh [TILTROTOR]
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/flightgear/real.sh
the_tiltrotor "${1:-}"
start_screen 320x240
small_flightgear
env "${mesa[@]}" python3 tests/flightgear/scenery.py "$tiltrotor" "$work" "${options[@]}"
