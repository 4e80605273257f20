#!/usr/bin/env bash
# The demonstration flight in the real FlightGear, in the scenery of Hilo: pictures in hover, in the middle of
# the conversion, as an aeroplane and while landing, from outside and from the cockpit. Headless.
# Checks that they show what they should: that the display is lit, and that no two are the same.
# Usage: tests/flightgear_pictures.sh [TILTROTOR] [FOLDER for the pictures]
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/flightgear/real.sh
the_tiltrotor "${1:-}"
folder=${2:-$work/pictures}
mkdir -p "$folder"

"$tiltrotor" demo --fast --no-flightgear --out "$work/demo.mcap" >"$work/demo.log" 2>&1 ||
    { status=$?; tail -5 "$work/demo.log"; exit "$status"; }

start_screen 1280x720
start_flightgear 1280x720
echo "waiting for FlightGear; minutes, the first time"
wait_until_ready
echo "FlightGear $(property /sim/version/flightgear) is ready after $SECONDS s"

view_number() { # NAME
    for number in 0 1 2 3 4 5 6 7 8 9 10 11 12 13; do
        set_property /sim/current-view/view-number "$number"
        [ "$(property /sim/current-view/name)" != "$1" ] || return 0
    done
    echo "FlightGear has no view called $1"
    exit 1
}

take() { # NAME: after two frames more, so that what was asked for is there
    local before now seen=0 deadline=$((SECONDS + 60))
    before=$(property /sim/time/elapsed-sec)
    while [ "$seen" -lt 4 ] && [ "$SECONDS" -lt "$deadline" ]; do
        now=$(property /sim/time/elapsed-sec)
        if [ "$now" != "$before" ]; then seen=$((seen + 1)); before=$now; fi
    done
    curl --silent --max-time 60 "http://127.0.0.1:$http/screenshot?type=png" -o "$work/$1.png"
    convert "$work/$1.png" -resize 960x540 -quality 80 "$folder/$1.jpg"
    echo "$folder/$1.jpg: $(stat -c %s "$folder/$1.jpg") bytes"
}

moment() { # NAME SECONDS HEADING PITCH: the moment from outside, from that side, and from the cockpit
    "$tiltrotor" replay "$work/demo.mcap" --at "$2" --hold forever --flightgear "127.0.0.1:$fdm" \
        >"$work/replay.log" 2>&1 &
    local replay=$!
    processes+=("$replay")
    view_number "Helicopter View"
    set_property /sim/tiltrotor/overlay 0
    set_property /sim/current-view/field-of-view 42
    set_property /sim/current-view/z-offset-m -22
    set_property /sim/current-view/heading-offset-deg "$3"
    set_property /sim/current-view/pitch-offset-deg "$4"
    take "$1"
    view_number Pilot
    take "$1_cockpit"
    stop "$replay"
}

# When is what, by the log: from nacelle angle and height, not from a clock.
"$tiltrotor" log cat "$work/demo.mcap" --channel outputs --every 25 2>"$work/cat.log" |
    python3 tests/flightgear/moments.py >"$work/moments" || { tail -3 "$work/cat.log"; exit 1; }
when() { sed -n "s/^$1 //p" "$work/moments"; }
moment hover "$(when hover)" 150 8
moment conversion "$(when conversion)" 125 4
moment aeroplane "$(when aeroplane)" 215 6
moment landing "$(when landing)" 40 5

# A second aircraft: the same flight, half a second behind. It is loaded when it first appears.
"$tiltrotor" replay "$work/demo.mcap" --ghost "$work/demo.mcap" --ghost-ahead -0.5 --at "$(when aeroplane)" --hold forever \
    --flightgear "127.0.0.1:$fdm" >"$work/replay.log" 2>&1 &
processes+=($!)
view_number "Helicopter View"
set_property /sim/current-view/z-offset-m -60
set_property /sim/current-view/heading-offset-deg 200
for _ in $(seq 60); do
    [ "$(property /models/model/path)" != "Aircraft/XV-15/Models/ghost.xml" ] || break
    sleep 1
done
sleep 5
take ghost

no_complaints
python3 tests/flightgear/look.py "$work" hover conversion aeroplane landing
echo "all pictures show what they should; $SECONDS s"
