#!/usr/bin/env bash
# What a tick from Python costs beside the same tick in Rust, and beside a frame of JSBSim's wheel, on the same
# processor in alternation: the ratios are what can be compared between machines. Then in instructions.
# Usage: benches/python_ratio.sh [ROUNDS]   (after tests/python.sh; PyPI once)
set -euo pipefail
cd "$(dirname "$0")/.."

venv=target/venv-python
if ! "$venv/bin/python" -c "import tiltrotor" 2>/dev/null; then
    echo "tests/python.sh builds and installs the package: run it first" >&2
    exit 2
fi
if ! "$venv/bin/python" -c "import jsbsim" 2>/dev/null; then
    "$venv/bin/pip" install --quiet jsbsim==1.3.3 || echo "no JSBSim: pip cannot install it"
fi
cargo build --quiet --release --no-default-features --package recorder --example stepped --target-dir target/headless
stepped=target/headless/release/examples/stepped
status=0
"$venv/bin/python" benches/python_ratio.py "$stepped" "${1:-25}" || status=$?

# The same in instructions, which no other program's noise can change; what comes before the first tick is in both counts.
if command -v valgrind >/dev/null; then
    export PYTHONHASHSEED=0 OPENBLAS_NUM_THREADS=1
    counted() { # PROGRAM...
        valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 | sed -n 's/.*Collected : //p'
    }
    ticks_of() { # PROGRAM...: instructions of each of 8,000 ticks
        echo $((($(counted "$@" 9000) - $(counted "$@" 1000)) / 8000))
    }
    rust=$(ticks_of "$stepped")
    python=$(ticks_of "$venv/bin/python" -c '
import sys, tiltrotor
flight = tiltrotor.Flight(start="hover-50ft")
for _ in range(int(sys.argv[1])):
    flight.step()')
    awk -v rust="$rust" -v python="$python" \
        'BEGIN { printf "instructions a tick: Rust %d, Python %d, ratio %.3f\n", rust, python, python / rust }'
fi
exit "$status"
