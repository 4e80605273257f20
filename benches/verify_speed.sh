#!/usr/bin/env bash
# How fast a log is verified: times of real time by CPU time on one thread, and by the wall clock on one and on
# all processors, the best of five, alternating; and, where valgrind is, instructions a tick, which no other
# program's noise can change. The whole log and the same compacted.
# Usage: benches/verify_speed.sh [TILTROTOR]   (a headless release build without one)
set -euo pipefail
cd "$(dirname "$0")/.."
tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --quiet --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fly() { "$tiltrotor" fly --pilot demo --fast --no-flightgear --duration "$1" --out "$work/$2.mcap" >"$work/said"; }
fly 200 whole
"$tiltrotor" log compact "$work/whole.mcap" --out "$work/compacted.mcap" >"$work/said"

python3 - "$tiltrotor" "$work" <<'PYTHON'
import os, resource, subprocess, sys, time

program, work = sys.argv[1:]
FLOWN_S, RUNS = 200.0, 5
CORES = os.cpu_count()


def once(log, jobs):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begun = time.monotonic()
    command = [program, "verify", "--jobs", str(jobs), f"{work}/{log}.mcap"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    wall = time.monotonic() - begun
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


best = {}
for _ in range(RUNS):
    for log in ("whole", "compacted"):
        for jobs in sorted({1, CORES}):
            times = once(log, jobs)
            known = best.get((log, jobs), times)
            best[log, jobs] = tuple(min(pair) for pair in zip(known, times))
for (log, jobs), (wall, cpu) in best.items():
    print(
        f"{log:10} {jobs} threads: {FLOWN_S / wall:6.0f} x real time by the clock, "
        f"{FLOWN_S / cpu:6.0f} x by CPU time, {cpu / FLOWN_S * 4000:.2f} us of CPU a tick"
    )
PYTHON

command -v valgrind >/dev/null || exit 0
fly 4 few
fly 8 many
counted() { # LOG
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$tiltrotor" verify --jobs 1 "$work/$1.mcap" \
        2>&1 >"$work/said" | sed -n 's/.*Collected : //p'
}
for log in few many; do "$tiltrotor" log compact "$work/$log.mcap" --out "$work/$log-compact.mcap" >"$work/said"; done
echo "whole      $((($(counted many) - $(counted few)) / 1000)) instructions a tick"
echo "compacted  $((($(counted many-compact) - $(counted few-compact)) / 1000)) instructions a tick"
