#!/usr/bin/env bash
# The source distribution of the Python package: made by `python -m build`, its wheel built from nothing else, installed alone, and
# a flight recorded by it verified by the command.
# Usage: tests/sdist.sh [TILTROTOR]   (a headless release build without one; PyPI once)
# Ends with 77 where there is no Python with venv and pip, or no network to get what it needs.
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
venv=$scratch/venv
make_venv "$venv" build==1.3.0 "$(grep '^maturin==' python/requirements.txt)" "$(grep '^numpy==' python/requirements.txt)"

begun=$SECONDS
# Packages of others are built already; ours are at another place now, and built there.
CARGO_TARGET_DIR=$PWD/target/python PATH=$venv/bin:$PATH \
    "$venv/bin/python" -m build --no-isolation --outdir "$scratch/dist" python >"$scratch/said" 2>&1 ||
    { tail -n 30 "$scratch/said" >&2; exit 1; }
(cd "$scratch/dist" && du -h -- *)
"$venv/bin/pip" install --quiet --disable-pip-version-check --no-deps "$scratch"/dist/tiltrotor-*.whl
echo "source distribution and its wheel built in $((SECONDS - begun)) s"

commit=$(git rev-parse --short=12 HEAD)
(cd "$scratch" && "$venv/bin/python" - "$commit" <<'PYTHON')
import sys

import tiltrotor

assert f"(commit {sys.argv[1]}" in tiltrotor.BUILD, tiltrotor.BUILD
with tiltrotor.Flight(start="hover-50ft") as flight:
    flight.record("flight.mcap")
    flight.set(stick_aft=0.1)
    flight.step(500)
assert tiltrotor.verify("flight.mcap")
assert tiltrotor.facts("flight.mcap")["commit"] == sys.argv[1]
print(tiltrotor.BUILD)
PYTHON
"$tiltrotor" verify "$scratch/flight.mcap"
