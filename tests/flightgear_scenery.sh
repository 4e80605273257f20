#!/usr/bin/env bash
# The real FlightGear over its scenery of Hilo: a flight begins on FlightGear's runway and rolls on it, another lands
# on it, and the wheels are on the ground that FlightGear draws; the flight replays exactly without FlightGear.
# Usage: tests/flightgear_scenery.sh [TILTROTOR]
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/flightgear/real.sh
the_tiltrotor "${1:-}"
start_screen 320x240
export XDG_CACHE_HOME=$work/cache FG_HOME=$fg_home XDG_RUNTIME_DIR=$work/xdg
export LIBGL_ALWAYS_SOFTWARE=1 ALSOFT_DRIVERS=null
options=(--geometry=320x240 --disable-sound --disable-splash-screen --disable-random-objects
    --disable-random-vegetation --disable-random-buildings --disable-clouds --disable-clouds3d
    --disable-ai-models --prop:int:/sim/rendering/shaders/quality-level=0)
env "${mesa[@]}" python3 tests/flightgear/scenery.py "$tiltrotor" "$work" "${options[@]}"
