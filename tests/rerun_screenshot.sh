#!/usr/bin/env bash
# Opens a flight in the rerun viewer without a screen and takes its picture.
#
#   tests/rerun_screenshot.sh FLIGHT.rrd OUT.png [SECONDS]
#
# Needs no GPU and no X. Fails unless the picture shows something: an empty window has few colours.
# Without SECONDS the picture is taken a second after the start, at twice the resolution, under the
# viewer's first notices and with a long flight half loaded. With SECONDS (10 or more are good) the
# viewer plays that long, faster or slower than real time as it pleases, and shows everything.
# The viewer comes from PyPI into target/, Vulkan's software driver from apt when it is missing.
set -eu

VERSION=0.36.3
SECONDS_MAX=180
COLOURS_MIN=2500

[ $# -eq 2 ] || [ $# -eq 3 ] || { echo "usage: $0 FLIGHT.rrd OUT.png [SECONDS]" >&2; exit 2; }
flight=$1
picture=$2
play=${3:-}
[ -s "$flight" ] || { echo "$0: no recording at $flight" >&2; exit 2; }
repository=$(cd "$(dirname "$0")/.." && pwd)
venv=${CARGO_TARGET_DIR:-$repository/target}/rerun-$VERSION

if [ ! -x "$venv/bin/rerun" ]; then
    source "$repository/tests/venv.sh"
    make_venv "$venv" "rerun-sdk==$VERSION"
fi

if ! ls /usr/share/vulkan/icd.d/lvp_icd*.json >/dev/null 2>&1; then
    if [ "$(id -u)" -ne 0 ]; then
        echo "$0: needs mesa-vulkan-drivers: sudo apt-get install mesa-vulkan-drivers" >&2
        exit 2
    fi
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive \
        apt-get install -qq --no-install-recommends mesa-vulkan-drivers >/dev/null
fi

rm -f "$picture"
log=$(mktemp)
viewer=
trap '[ -z "$viewer" ] || kill "$viewer" 2>/dev/null || true; rm -f "$log"' EXIT
# Only listens to this machine, where another viewer may have the usual port.
port=$("$venv/bin/python" -c '
import socket
with socket.socket() as s:
    s.bind(("127.0.0.1", 0))
    print(s.getsockname()[1])')
export RERUN_ANALYTICS=0
set -- timeout "$SECONDS_MAX" "$venv/bin/rerun" --headless --bind 127.0.0.1 --port "$port" \
    --window-size 1400x900

if [ -z "$play" ]; then
    "$@" --screenshot-to "$picture" "$flight" >"$log" 2>&1 || {
        cat "$log" >&2
        echo "$0: the viewer failed or took longer than $SECONDS_MAX s" >&2
        exit 1
    }
else
    "$@" "$flight" >"$log" 2>&1 &
    viewer=$!
    sleep "$play"
    timeout 60 "$venv/bin/python" tests/viewer_picture.py "$port" "$picture"
fi
[ -s "$picture" ] || { cat "$log" >&2; echo "$0: the viewer took no picture" >&2; exit 1; }

# Pillow comes with rerun-sdk.
"$venv/bin/python" - "$picture" "$COLOURS_MIN" <<'PYTHON'
import sys
from PIL import Image

name, least = sys.argv[1], int(sys.argv[2])
picture = Image.open(name).convert("RGB")
colours = len(picture.getcolors(picture.width * picture.height))
print(f"{name}: {picture.width} x {picture.height} pixels, {colours} colours")
if colours < least:
    sys.exit(f"{name}: only {colours} colours, at least {least} expected: is the window empty?")
PYTHON
