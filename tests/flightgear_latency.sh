#!/usr/bin/env bash
# Transport delay to the eye: from a step of the stick to the changed pixel in the real FlightGear's window, as a
# helicopter and as an aeroplane, beside the 150 ms of CS-FSTD(A). Headless, drawn by the CPU: what the
# machine and its rate of frames are is said with the result.
# Usage: tests/flightgear_latency.sh [TILTROTOR] [WIDTHxHEIGHT]
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/flightgear/real.sh
the_tiltrotor "${1:-}"
size=${2:-320x240}

start_screen "$size" -fbdir "$work"
start_flightgear "$size" --fg-scenery="$work/empty"
wait_until_ready
echo "FlightGear is ready after $SECONDS s"
# The stick of the right seat, large, and nothing of the outside.
set_property /sim/current-view/field-of-view 30
set_property /sim/current-view/pitch-offset-deg -58
set_property /sim/tiltrotor/overlay 0
set_property /sim/tiltrotor/display "${DISPLAY_ON:-1}"
sleep 2
rate=$(property /sim/frame-rate)
echo "$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1), $(nproc) cores, load $(cut -d' ' -f1 /proc/loadavg);" \
    "$size drawn by the CPU, $rate frames a second"
python3 tests/flightgear/delay.py "$tiltrotor" "$work/Xvfb_screen0" "$fdm" "$work"
no_complaints
echo "frames a second at the end: $(property /sim/frame-rate); $SECONDS s in all"
