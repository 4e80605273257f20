#!/bin/sh
# Opens a flight in the rerun viewer without a screen and takes its picture.
#
#   tests/rerun_screenshot.sh FLIGHT.rrd OUT.png
#
# Needs no GPU and no X. Fails unless the picture shows something: an empty window has few colours.
# The viewer comes from PyPI into target/, Vulkan's software driver from apt when it is missing.
set -eu

VERSION=0.36.3
SECONDS_MAX=180
COLOURS_MIN=500

[ $# -eq 2 ] || { echo "usage: $0 FLIGHT.rrd OUT.png" >&2; exit 2; }
flight=$1
picture=$2
[ -s "$flight" ] || { echo "$0: no recording at $flight" >&2; exit 2; }
repository=$(cd "$(dirname "$0")/.." && pwd)
venv=${CARGO_TARGET_DIR:-$repository/target}/rerun-$VERSION

if [ ! -x "$venv/bin/rerun" ]; then
    rm -rf "$venv"
    python3 -m venv "$venv"
    "$venv/bin/pip" install --quiet --disable-pip-version-check "rerun-sdk==$VERSION"
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
trap 'rm -f "$log"' EXIT
if ! RERUN_ANALYTICS=0 timeout "$SECONDS_MAX" "$venv/bin/rerun" --headless \
    --window-size 1400x900 --screenshot-to "$picture" "$flight" >"$log" 2>&1; then
    cat "$log" >&2
    echo "$0: the viewer failed or took longer than $SECONDS_MAX s" >&2
    exit 1
fi
[ -s "$picture" ] || { cat "$log" >&2; echo "$0: the viewer took no picture" >&2; exit 1; }

# Pillow comes with rerun-sdk.
"$venv/bin/python" - "$picture" "$COLOURS_MIN" <<'PYTHON'
import sys
from PIL import Image

name, least = sys.argv[1], int(sys.argv[2])
picture = Image.open(name).convert("RGB")
colours = len(set(picture.getdata()))
print(f"{name}: {picture.width} x {picture.height} pixels, {colours} colours")
if colours < least:
    sys.exit(f"{name}: only {colours} colours, at least {least} expected: is the window empty?")
PYTHON
