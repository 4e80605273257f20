#!/usr/bin/env bash
# Several flights, of this version and of older ones, exported in one go: every number as Parquet and CSV
# beside other people's reader of the log, bit for bit, and the queries of docs/queries.md by DuckDB.
# Usage: tests/export.sh [TILTROTOR]   (a headless release build with Parquet without one)
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --features parquet --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi

venv=target/venv-export
if [ ! -x "$venv/bin/python" ] || ! "$venv/bin/python" -c "import duckdb, lz4, mcap, polars, pyarrow"; then
    make_venv "$venv" duckdb==2.0.0 mcap==1.6.0 lz4==4.4.5 polars==2.1.0 pyarrow==26.0.1
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$tiltrotor" demo --fast --no-flightgear --out "$work/demo.mcap" >"$work/said"
for kt in 80 100; do
    "$tiltrotor" fly --from-trim --nacelle 75 --speed-kt "$kt" --altitude-ft 3000 --fast --no-flightgear \
        --script tests/export.toml --out "$work/conversion-$kt.mcap" >"$work/said"
done
# A folder more, and another flight of the same name in it.
mkdir "$work/elsewhere"
"$tiltrotor" fly --pilot hover --duration 5 --fast --no-flightgear --out "$work/elsewhere/demo.mcap" >"$work/said"

"$venv/bin/python" tests/export.py "$tiltrotor" "$work" \
    "$work"/*.mcap "$work"/elsewhere/*.mcap tests/corpus/*.mcap
