#!/usr/bin/env bash
# Instructions of a tick of a hover, counted by callgrind: free of the noise that times have on a machine
# that others use, too. Fails above the ceiling: what was measured when it was last moved, and 1 %.
# Whoever makes the step cheaper lowers it; whoever makes it dearer says in the commit what for.
# Usage: tests/instructions.sh
set -euo pipefail
cd "$(dirname "$0")/.."

# Counted with the Rust of this workspace's rust-version on x86-64.
ceiling=57600

if ! command -v valgrind >/dev/null; then
    echo "skipped  instructions a tick: no valgrind (Debian package valgrind)"
    exit 0
fi
if [ "$(uname -m)" != x86_64 ]; then
    echo "skipped  instructions a tick: the ceiling is that of x86-64, this is $(uname -m)"
    exit 0
fi

cargo build --quiet --release --package aircraft --example hover --target-dir target/headless
counted() { # TICKS
    valgrind --tool=callgrind --callgrind-out-file=/dev/null \
        target/headless/release/examples/hover "$1" 2>&1 | sed -n 's/.*Collected : //p'
}
# What comes before the first tick is in both.
ticks=1000
few=$(counted $ticks)
many=$(counted $((2 * ticks)))
each=$(((many - few) / ticks))
if [ "$each" -le 0 ] || [ "$each" -gt "$ceiling" ]; then
    echo "FAILED   $each instructions a tick of a hover, at most $ceiling"
    exit 1
fi
echo "passed   $each instructions a tick of a hover, at most $ceiling"
