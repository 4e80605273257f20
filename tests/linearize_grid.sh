#!/usr/bin/env bash
# Small motions about steady flight over nacelle incidence and speed, SCAS off and on: every eigenvalue
# beside those that numpy finds of the same matrix.
# Usage: tests/linearize_grid.sh [TILTROTOR]   (a headless release build without one)
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi

# The environment of tests/cdr.sh.
venv=target/venv-cdr
if [ ! -x "$venv/bin/python" ] || ! "$venv/bin/python" -c "import mcap_ros2, numpy"; then
    make_venv "$venv" mcap==1.6.0 mcap-ros2-support==0.6.0 numpy==2.4.6
fi

"$venv/bin/python" tests/linearize_grid.py "$tiltrotor"
