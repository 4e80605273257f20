#!/usr/bin/env bash
# What the primary flight display costs in the real FlightGear: CPU time of a frame with it and without, by
# turns, in the pilot's view and with the display over the view from behind, while a flight is replayed.
# Usage: tests/flightgear_display_cost.sh [TILTROTOR] [WIDTHxHEIGHT]
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/flightgear/real.sh
the_tiltrotor "${1:-}"
size=${2:-1280x720}

"$tiltrotor" demo --fast --no-flightgear --out "$work/demo.mcap" >"$work/demo.log" 2>&1 ||
    { status=$?; tail -5 "$work/demo.log"; exit "$status"; }
mkdir -p "$work/data/Protocol"
cp tests/flightgear/frames.xml "$work/data/Protocol/"
frames=$(free_port SOCK_DGRAM)
start_screen "$size"
start_flightgear "$size" --data="$work/data" --generic="socket,out,1000,127.0.0.1,$frames,udp,frames"
wait_until_ready
echo "FlightGear is ready after $SECONDS s; $size, $(nproc) cores, $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1)"
failed=0
for view in Pilot "Chase View"; do
    "$tiltrotor" replay "$work/demo.mcap" --from 48 --flightgear "127.0.0.1:$fdm" >"$work/replay.log" 2>&1 &
    replay=$!
    processes+=("$replay")
    for number in $(seq 0 13); do
        set_property /sim/current-view/view-number "$number"
        [ "$(property /sim/current-view/name)" != "$view" ] || break
    done
    echo "$view:"
    python3 tests/flightgear/cost.py "$flightgear" "$http" "$frames" --pairs "${PAIRS:-9}" || failed=1
    stop "$replay"
done
no_complaints
exit "$failed"
