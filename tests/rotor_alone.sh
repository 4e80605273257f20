#!/usr/bin/env bash
# The rotor of hover and of two cruises beside dynbem, other people's blade-element theory: power within 6 %.
# Usage: tests/rotor_alone.sh [TILTROTOR]   (a headless release build without one; PyPI once, else skipped with 77)
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

venv=target/venv-rotor
if ! "$venv/bin/python" -c "import dynbem, numpy" 2>/dev/null; then
    make_venv "$venv" dynbem==0.8.0 numpy==2.4.6
fi

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
exec "$venv/bin/python" tests/rotor_alone.py "$tiltrotor"
