#!/usr/bin/env bash
# What docs/clusters.md shows, as it stands there: shards, Dask over the wheel, a sweep of what-ifs, DuckDB over the tables.
# Usage: tests/clusters.sh [TILTROTOR]   (built with Parquet; a release build without one. After tests/python.sh; PyPI once)
# Ends with 77 where the package is not installed or pip cannot get Dask and DuckDB.
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --features parquet --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
venv=target/venv-python
if ! "$venv/bin/python" -c "import tiltrotor" 2>/dev/null; then
    echo "skipped: tests/python.sh builds and installs the package first"
    exit 77
fi
if ! "$venv/bin/python" -c "import distributed, duckdb" 2>/dev/null; then
    make_venv "$venv" distributed==2026.8.0 duckdb==2.0.1
fi

tiltrotor=$(realpath "$tiltrotor") python=$PWD/$venv/bin/python page=$PWD/docs/clusters.md golden=$PWD/tests/golden
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shown NAME: the fenced block behind <!-- NAME -->.
shown() { awk -v mark="<!-- $1 -->" '$0 == mark {found = 1} found && /^```/ {inside = !inside; if (!inside) exit; next} inside' "$page"; }
for name in dask sweep duckdb; do
    shown "$name" >"$work/$name"
    [ -s "$work/$name" ] || { echo "docs/clusters.md shows no $name" >&2; exit 1; }
done
cd "$work"
mkdir flights
cp "$golden"/*.mcap flights
"$python" - <<'PYTHON'
import tiltrotor

with tiltrotor.Flight(start="hover-50ft") as flight:
    flight.record("flights/hover.mcap")
    flight.step(750)
PYTHON

# Shards are all logs, each once; what Dask says of them is what the command says.
for shard in 1/3 2/3 3/3; do
    "$tiltrotor" verify --shard "$shard" --format json flights >"verdicts-${shard%/*}.json" || true
done
"$python" dask >said
"$python" - <<'PYTHON'
import json

by_command = {}
for shard in "123":
    for log in json.load(open(f"verdicts-{shard}.json"))["logs"]:
        assert log["log"] not in by_command, log["log"]
        by_command[log["log"]] = (log["outcome"], log.get("digest"))
by_dask = {}
for line in open("said"):
    log, outcome, digest = line.split()
    by_dask[log] = (outcome, None if digest == "None" else digest)
from pathlib import Path

assert by_dask == by_command and len(by_dask) == len(list(Path("flights").glob("*.mcap"))), (by_dask, by_command)
print(f"{len(by_dask)} verdicts by Dask's workers and by shards are the same")
PYTHON

"$python" sweep
"$tiltrotor" verify variants
"$tiltrotor" log export variants/*.mcap --parquet tables >exported || { cat exported >&2; exit 1; }
"$python" - <<'PYTHON'
import duckdb
import tiltrotor

rows = duckdb.sql(open("duckdb").read()).fetchall()
print(*rows, sep="\n")
assert len(rows) == 8
factors = [load_factor for _, load_factor, _ in rows]
assert max(factors) > min(factors), "a gust changes nothing?"
for file, load_factor, _ in rows:
    name = file.rsplit("/", 1)[-1]
    assert tiltrotor.read(f"variants/{name}", "outputs")["load_factor"].max() == load_factor, file
PYTHON
# Compacted logs become tables, too: the golden flights are.
"$tiltrotor" log export "$golden"/*.mcap --parquet golden >exported || { cat exported >&2; exit 1; }
"$python" - "$golden"/*.mcap <<'PYTHON'
import sys

import duckdb

flights = duckdb.sql("FROM read_parquet('golden/flights/*/*.parquet', union_by_name = true)").fetchall()
assert len(flights) == len(sys.argv) - 1, flights
PYTHON
echo "docs/clusters.md is as it says"
