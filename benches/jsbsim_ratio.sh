#!/usr/bin/env bash
# What a tick of ours costs beside a frame of JSBSim's ah1s, a helicopter with one rotor, on the same CPU
# in alternation: the ratio is what can be compared between machines.
# Usage: benches/jsbsim_ratio.sh [ROUNDS]   (needs python3 with venv, and PyPI once)
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

venv=target/venv-jsbsim
if [ ! -x "$venv/bin/python" ] || ! "$venv/bin/python" -c "import jsbsim"; then
    make_venv "$venv" jsbsim==1.3.3
fi
cargo build --quiet --release --package aircraft --example hover --target-dir target/headless
exec "$venv/bin/python" benches/jsbsim_ratio.py target/headless/release/examples/hover "${1:-25}"
