#!/usr/bin/env bash
# The real FlightGear follows a flight, and then its replay: place, height and attitude as it shows them,
# read back over its own HTTP server. Headless: needs the packages flightgear, xvfb and curl.
# Usage: tests/flightgear_live.sh [TILTROTOR] [SCREENSHOT.png]
set -euo pipefail
cd "$(dirname "$0")/.."

fgfs=$(command -v fgfs || echo /usr/games/fgfs)
for program in "$fgfs" Xvfb curl python3; do
    command -v "$program" >/dev/null || { echo "skipped: $program is not installed"; exit 77; }
done
tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
screenshot=${2:-}

# FlightGear's home keeps its navigation cache, which takes long to build, between runs.
home=$PWD/target/flightgear-home
work=$(mktemp -d)
mkdir -p "$home" "$work/scenery/Terrain" "$work/xdg"
processes=()
finish() {
    status=$?
    # FlightGear hangs when asked to quit; it ends at once when told to.
    for process in "${processes[@]}"; do kill "$process" 2>/dev/null || true; done
    wait 2>/dev/null || true
    [ "$status" = 0 ] || tail -20 "$work/fgfs.log"
    rm -rf "$work"
    exit "$status"
}
trap finish EXIT

exec 3>"$work/display"
Xvfb -displayfd 3 -screen 0 640x480x24 -nolisten tcp +extension GLX -noreset 2>/dev/null &
processes+=($!)
for _ in $(seq 50); do [ -s "$work/display" ] && break; sleep 0.1; done
export DISPLAY=":$(cat "$work/display")" LIBGL_ALWAYS_SOFTWARE=1 DBUS_FATAL_WARNINGS=0
export FG_HOME=$home XDG_RUNTIME_DIR=$work/xdg

free_port() { python3 -c "import socket; s = socket.socket(socket.AF_INET, socket.$1); s.bind(('127.0.0.1', 0)); print(s.getsockname()[1])"; }
udp=$(free_port SOCK_DGRAM)
http=$(free_port SOCK_STREAM)
"$fgfs" --aircraft=ufo --airport=PHTO --fdm=null --fg-scenery="$work/scenery" \
    --native-fdm="socket,in,60,127.0.0.1,$udp,udp" --httpd="127.0.0.1:$http" --geometry=320x240 \
    --disable-terrasync --disable-sound --disable-splash-screen --disable-real-weather-fetch \
    --disable-ai-traffic --disable-ai-models --disable-random-objects --disable-random-vegetation \
    --disable-random-buildings --disable-clouds --disable-clouds3d --disable-save-on-exit \
    --disable-fgcom --disable-hud --start-date-gmt=2020:06:21:21:00:00 \
    --prop:int:/sim/rendering/shaders/quality-level=0 >"$work/fgfs.log" 2>&1 &
flightgear=$!
processes+=("$flightgear")

property() { # PATH
    curl --silent --max-time 60 "http://127.0.0.1:$http/json$1" |
        python3 -c 'import json, sys; print(json.load(sys.stdin)["value"])' 2>/dev/null || true
}
echo "waiting for FlightGear; minutes, the first time"
for _ in $(seq 240); do
    kill -0 "$flightgear" 2>/dev/null || { echo "FlightGear died"; exit 1; }
    ready=$(property /sim/signals/fdm-initialized)
    [ "$ready" = True ] || [ "$ready" = true ] && break
    sleep 1
done

follows() { # WHAT: the aircraft has risen to its hover over the runway, heading as the scenario says
    local height latitude longitude heading
    height=$(property /position/altitude-ft)
    latitude=$(property /position/latitude-deg)
    longitude=$(property /position/longitude-deg)
    heading=$(property /orientation/heading-deg)
    echo "$1: FlightGear shows $latitude°, $longitude°, $height ft, heading $heading°"
    python3 - "$height" "$latitude" "$longitude" "$heading" "$work/where.json" <<'P'
import json, math, sys
height_ft, latitude, longitude, heading = map(float, sys.argv[1:5])
where = json.load(open(sys.argv[5]))
# Drawn a moment after it was read: a metre of height, a few metres of place.
assert abs(height_ft * 0.3048 - where["height_m"]) < 1.5, where
metres = math.radians(1) * 6371e3
assert abs(latitude - where["latitude_deg"]) * metres < 3, where
assert abs(longitude - where["longitude_deg"]) * metres * math.cos(math.radians(latitude)) < 3, where
assert abs((heading - where["heading_deg"] + 180) % 360 - 180) < 2, where
P
}

"$tiltrotor" fly --pilot hover --duration 20 --flightgear "127.0.0.1:$udp" --out "$work/flight.mcap" \
    >"$work/flight.txt" || { cat "$work/flight.txt"; exit 1; }
# What the flight ended with, from its own log.
"$tiltrotor" log cat "$work/flight.mcap" --topic /outputs | tail -n 1 | python3 -c '
import json, math, sys
last = json.loads(sys.stdin.readline())
print(json.dumps({
    "height_m": last["place.height_m"],
    "latitude_deg": math.degrees(last["place.latitude_rad"]),
    "longitude_deg": math.degrees(last["place.longitude_rad"]),
    "heading_deg": math.degrees(last["euler.heading_rad"]),
}))' >"$work/where.json"
# The last packet stays on the screen; a slow machine needs a frame or two to get there.
sleep 5
follows "in flight"

# Somewhere else first, so that what is shown next comes from the replay.
python3 - "$udp" <<'P'
import socket, struct, sys
packet = bytearray(408)
struct.pack_into(">I", packet, 0, 24)
struct.pack_into(">ddd", packet, 8, 0.1, 0.2, 3000.0)
socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(packet, ("127.0.0.1", int(sys.argv[1])))
P
sleep 3
"$tiltrotor" replay "$work/flight.mcap" --speed 4 --flightgear "127.0.0.1:$udp"
sleep 5
follows "in replay"
if [ -n "$screenshot" ]; then
    curl --silent --max-time 120 --output "$screenshot" "http://127.0.0.1:$http/screenshot?type=png"
    echo "screenshot in $screenshot"
fi
echo "FlightGear followed the flight and its replay"
