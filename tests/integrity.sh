#!/usr/bin/env bash
# What takes too long for every test run: every bit of a real log, a hundred kills, many rounds of
# fuzzing, and whether memory grows with the length of a flight.
# Usage: tests/integrity.sh [bits] [kills] [fuzz] [memory]   (all of them without one)
set -euo pipefail
cd "$(dirname "$0")/.."
headless=(--release --no-default-features --target-dir target/headless)
cargo build --quiet "${headless[@]}"
tiltrotor=target/headless/release/tiltrotor
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

bits() {
    "$tiltrotor" fly --pilot hover --fast --duration 0.02 --no-flightgear --out "$work/bits.mcap" >/dev/null
    cargo test --quiet "${headless[@]}" -p logs --test every_bit
    echo "every bit of a real log of five ticks, $(stat -c %s "$work/bits.mcap") bytes"
    TILTROTOR_EVERY_BIT_LOG=$work/bits.mcap cargo test --quiet "${headless[@]}" -p logs \
        --test every_bit -- --nocapture every_flipped_bit_of_a_closed_log
}

kills() {
    TILTROTOR_KILLS=100 cargo test --quiet "${headless[@]}" --test kill -- --nocapture \
        a_killed_flight a_full_disk
}

fuzz() {
    TILTROTOR_FUZZ_ROUNDS=${TILTROTOR_FUZZ_ROUNDS:-20000} \
        TILTROTOR_FUZZ_SEED=${TILTROTOR_FUZZ_SEED:-$(date +%s)} \
        cargo test --quiet "${headless[@]}" --test fuzz
}

peak_kib() { # command...: the most memory it had, KiB
    python3 -c '
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)' "$@"
}

memory() {
    local grown_max=4096 what one ten
    for what in record verify; do
        if [ $what = record ]; then
            # Real time has more and smaller chunks; their index is kept until landing.
            one=$(peak_kib "$tiltrotor" fly --pilot hover --fast --duration 60 --no-flightgear \
                --out "$work/one.mcap")
            ten=$(peak_kib "$tiltrotor" fly --pilot hover --fast --duration 600 --no-flightgear \
                --out "$work/ten.mcap")
        else
            one=$(peak_kib "$tiltrotor" verify "$work/one.mcap")
            ten=$(peak_kib "$tiltrotor" verify "$work/ten.mcap")
        fi
        echo "$what: at most $one KiB for 1 min of flight, $ten KiB for 10 min"
        if [ $((ten - one)) -gt $grown_max ]; then
            echo "$what: memory grows with the flight, by more than $grown_max KiB" >&2
            return 1
        fi
    done
}

for part in "${@:-bits kills fuzz memory}"; do
    for name in $part; do
        echo "== $name"
        "$name"
    done
done
