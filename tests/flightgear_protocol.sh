#!/usr/bin/env bash
# The real FlightGear, headless, over empty scenery: our packets as it shows them, every property of every frame
# beside the log; starved, and frozen over the end of the flight; our packets read by somebody else's decoder.
# A minute or two; installs FlightGear where it can and says `skipped:` with its reason and 77 where it cannot.
# Usage: tests/flightgear_protocol.sh [TILTROTOR]
set -euo pipefail
cd "$(dirname "$0")/.."
. tests/flightgear/real.sh
the_tiltrotor "${1:-}"
start_screen 320x240
export XDG_CACHE_HOME=$work/cache FG_HOME=$fg_home XDG_RUNTIME_DIR=$work/xdg
export LIBGL_ALWAYS_SOFTWARE=1 ALSOFT_DRIVERS=null
options=(--geometry=320x240 --fg-scenery="$work/empty" --disable-sound --disable-splash-screen
    --disable-random-objects --disable-random-vegetation --disable-random-buildings --disable-clouds
    --disable-clouds3d --disable-ai-models --prop:int:/sim/rendering/shaders/quality-level=0)
env "${mesa[@]}" python3 tests/flightgear/protocol.py "$tiltrotor" "$work" "${options[@]}"

# Somebody else's decoder, from PyPI.
if python3 -m venv "$work/venv" 2>/dev/null && "$work/venv/bin/pip" install --quiet flightgear-python==2.1.0 2>"$work/pip"; then
    "$work/venv/bin/python" tests/flightgear/other_decoder.py "$tiltrotor" "$work/flight.mcap"
else
    echo "skipped: flightgear-python: $(tail -n 1 "$work/pip" 2>/dev/null || echo 'no venv')"
fi
