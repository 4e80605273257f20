#!/usr/bin/env bash
# The FMU in somebody else's simulation tool, FMPy: both versions validated and flown for ten seconds to the bits of the
# native flight; logs that verify exact; states set back; what has to be refused, in words.
# Usage: tests/fmu.sh [TILTROTOR]   (a headless release build without one; PyPI once)
# Ends with 77 where there is no Python with venv and pip, or no network to get what it needs.
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi

venv=target/venv-fmu
wanted=$(sha256sum fmi/requirements.txt)
if [ "$(cat "$venv/installed" 2>/dev/null)" != "$wanted" ]; then
    make_venv "$venv" --requirement fmi/requirements.txt
    echo "$wanted" >"$venv/installed"
fi

begun=$SECONDS
fmi/build.sh
cargo build --quiet --release --locked --manifest-path fmi/Cargo.toml --target-dir target/fmi --example native
echo "FMU built in $((SECONDS - begun)) s"

begun=$SECONDS
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
target/fmi/release/examples/native hover-50ft >"$scratch/native"
"$venv/bin/python" tests/fmu.py "$(realpath "$tiltrotor")" target/fmi "$scratch"
echo "fmu: tested in $((SECONDS - begun)) s"
