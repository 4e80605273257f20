#!/usr/bin/env bash
# The second simulator: JSBSim flies an XV-15 written for it by the published tables, and is compared with ours
# (docs/second_simulator.md). Exit 1 when something promised is not kept.
# Usage: tests/second_simulator.sh [TILTROTOR] [PICTURES]   (a headless release build without one; its figures are
# written into the folder PICTURES; PyPI once, else skipped with 77)
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

venv=target/venv-second
if ! "$venv/bin/python" -c "import jsbsim, matplotlib, numpy" 2>/dev/null; then
    make_venv "$venv" jsbsim==1.3.3 matplotlib==3.11.2 numpy==2.4.6
fi

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
exec "$venv/bin/python" tests/second_simulator/compare.py "$tiltrotor" "${@:2}"
