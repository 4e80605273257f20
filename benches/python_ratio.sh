#!/usr/bin/env bash
# What a tick from Python costs beside the same tick in Rust, and beside a frame of JSBSim's wheel, on the same
# processor in alternation: the ratios are what can be compared between machines.
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
exec "$venv/bin/python" benches/python_ratio.py target/headless/release/examples/stepped "${1:-25}"
