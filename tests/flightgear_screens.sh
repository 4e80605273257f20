#!/usr/bin/env bash
# Three screens: three of the real FlightGear, one flight that sends to all of them, as
# docs/flightgear_views.md has it. All follow the flight to the same place, each looks its own way.
# Usage: tests/flightgear_screens.sh [TILTROTOR] [FOLDER for the pictures]
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/flightgear/real.sh
the_tiltrotor "${1:-}"
folder=${2:-$work}
mkdir -p "$folder"

"$tiltrotor" demo --fast --no-flightgear --out "$work/demo.mcap" >"$work/demo.log" 2>&1 ||
    { status=$?; tail -5 "$work/demo.log"; exit "$status"; }
start_screen 960x240
names=(left ahead right)
headings=(60 0 -60)
ports=() webs=() programs=()
for screen in 0 1 2; do
    start_flightgear 320x240 --fov=60 --prop:double:/sim/tiltrotor/screen-heading-deg="${headings[screen]}" \
        --prop:int:/sim/tiltrotor/overlay=0 --max-fps=10
    ports+=("$fdm") webs+=("$http") programs+=("$flightgear")
    # The first one builds the navigation cache that the others only read.
    wait_until_ready 300
    echo "${names[screen]}: ready after $SECONDS s"
done
send=()
for port in "${ports[@]}"; do send+=(--flightgear "127.0.0.1:$port"); done
"$tiltrotor" replay "$work/demo.mcap" --from 60 --until 66 --hold forever "${send[@]}" >"$work/replay.log" 2>&1 &
processes+=($!)
sleep 25
for screen in 0 1 2; do
    http=${webs[screen]}
    echo "${names[screen]} $(property /tiltrotor/tick) $(property /position/latitude-deg) $(property /position/longitude-deg)" \
        "$(property /sim/current-view/heading-offset-deg) $(property /sim/current-view/pitch-offset-deg)" \
        "$(property /sim/current-view/field-of-view)"
    curl --silent --max-time 60 "http://127.0.0.1:$http/screenshot?type=png" -o "$work/${names[screen]}.png"
done | tee "$work/screens"
convert "$work/left.png" "$work/ahead.png" "$work/right.png" +append "$folder/three_screens.jpg"
python3 - "$work/screens" <<'P'
import sys
rows = [line.split() for line in open(sys.argv[1])]
assert [row[0] for row in rows] == ["left", "ahead", "right"], rows
# The replay ends after 66 s; the last picture is held.
assert {float(row[1]) for row in rows} == {66 * 250.0}, "ticks"
for i in (2, 3):
    places = [float(row[i]) for row in rows]
    assert max(places) - min(places) < 1e-6, f"places {places}"
assert [float(row[4]) % 360 for row in rows] == [60.0, 0.0, 300.0], "headings"
assert all(abs(float(row[5])) < 0.01 and abs(float(row[6]) - 60) < 0.1 for row in rows), "level, 60 deg wide"
P
echo "three screens show the same moment, 60 deg apart; $SECONDS s"
