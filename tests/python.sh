#!/usr/bin/env bash
# The Python package: built, installed, and held against the command: digests, verdicts, matrices, every number of a log;
# types, Ctrl-C, processes, examples of docs/python.md.
# Usage: tests/python.sh [TILTROTOR] [PYTEST ARGUMENTS]   (a headless release build without one; PyPI once)
# Ends with 77 where there is no Python with venv and pip, or no network to get what it needs.
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

tiltrotor=${1:-}
[ $# = 0 ] || shift
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi

venv=target/venv-python
make_venv_of "$venv" python/requirements.txt

begun=$SECONDS
# Its own target folder: profiles and features are another workspace's.
CARGO_TARGET_DIR=$PWD/target/python "$venv/bin/maturin" build --quiet --release --locked \
    --manifest-path python/Cargo.toml --interpreter "$venv/bin/python" --out target/python/wheels
wheel=$(ls -t target/python/wheels/tiltrotor-*.whl | head -1)
"$venv/bin/pip" install --quiet --force-reinstall --no-deps "$wheel"
echo "wheel built and installed in $((SECONDS - begun)) s: $(du -h "$wheel" | cut -f1) $(basename "$wheel")"

begun=$SECONDS
TILTROTOR=$(realpath "$tiltrotor") "$venv/bin/python" -m pytest --quiet -p no:cacheprovider --rootdir python \
    python/tests "$@"
echo "python: tested in $((SECONDS - begun)) s"
