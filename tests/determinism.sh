#!/usr/bin/env bash
# One flight, reflown to the same bits by every build and on every kind of CPU at hand: debug, release,
# release for this very CPU with link-time optimisation, a C library that may not use AVX2 and FMA,
# and, where qemu is installed, a CPU that has neither, and 64-bit Arm. And steady flights with what
# `linearize` finds about them, to the same bytes.
# Usage: tests/determinism.sh          the debug build is the tests' own; for this very CPU the flight model
#                                      alone is built, and steps from 72,000 random states to the known bits
#        tests/determinism.sh whole    the program for this very CPU, and one with nothing optimised: minutes more
#        TILTROTOR_AARCH64=build tests/determinism.sh   with one for 64-bit Arm, which takes minutes: needs
#        qemu-user, gcc-aarch64-linux-gnu, libc6-dev-arm64-cross, rustup target add aarch64-unknown-linux-gnu
#        TILTROTOR_AARCH64=FILE                         with one that is there
set -euo pipefail
cd "$(dirname "$0")/.."
# With the tables, so that tests/export.sh finds its program built.
headless=(--no-default-features --features parquet)
whole=${1-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

build() { # NAME, cargo's options...
    local name=$1
    shift
    cargo build --quiet "${headless[@]}" --target-dir "target/$name" "$@"
}

for_this_cpu=(env RUSTFLAGS="-C target-cpu=native" CARGO_PROFILE_RELEASE_LTO=fat)
echo "building: release, debug${whole:+, release for this CPU with link-time optimisation}"
build headless --release
release=target/headless/release/tiltrotor
if [ "$whole" = whole ]; then
    build headless --config profile.dev.package.engine.opt-level=0 \
        --config profile.dev.package.logs.opt-level=0 \
        --config profile.dev.package.flightgear-package.opt-level=0
    debug=target/headless/debug/tiltrotor
    CARGO_TARGET_DIR=target/native "${for_this_cpu[@]}" cargo build --quiet "${headless[@]}" --release
    native=target/native/release/tiltrotor
else
    cargo test --quiet --workspace --no-run 2>"$work/build.txt" || {
        cat "$work/build.txt"
        exit 1
    }
    debug=target/debug/tiltrotor
fi

"$release" demo --fast --no-flightgear --out "$work/flight.mcap" >"$work/demo.txt" || {
    cat "$work/demo.txt"
    exit 1
}

passed=0
skipped=0
# Trims, modes, responses and every number of the matrices: all that is computed with matrices of any size.
linear() { # FOLDER, command...
    local to=$1 conditions=("--nacelle 90 --speed-kt 30" "--nacelle 60 --speed-kt 80 --turn-degps 3"
        "--nacelle 0 --speed-kt 180") i
    shift
    mkdir -p "$to"
    for i in "${!conditions[@]}"; do
        read -ra flight <<<"${conditions[$i]} --scas"
        "$@" linearize "${flight[@]}" --fast --response --matrices --csv "$to/$i.csv" >"$to/$i.txt"
        "$@" trim "${flight[@]}" --csv "$to/$i-trim.csv" >"$to/$i-trim.txt"
    done
}
linear "$work/linear" "$release"

exact() { # WHAT, command...
    local what=$1
    shift
    rm -rf "$work/linear-here"
    linear "$work/linear-here" "$@"
    if ! diff -r "$work/linear" "$work/linear-here" >"$work/out.txt"; then
        printf 'DIVERGED %s: trim and linearize\n' "$what"
        head -20 "$work/out.txt"
        exit 1
    fi
    if "$@" verify "$work/flight.mcap" >"$work/out.txt" 2>&1; then
        printf 'exact    %s\n' "$what"
        passed=$((passed + 1))
    else
        printf 'DIVERGED %s\n' "$what"
        cat "$work/out.txt"
        exit 1
    fi
}
skip() {
    printf 'skipped  %s\n' "$1"
    skipped=$((skipped + 1))
}

exact "release" "$release"
exact "debug" "$debug"
if [ "$whole" = whole ]; then
    exact "release for this CPU, link-time optimised" "$native"
else
    "${for_this_cpu[@]}" cargo test --quiet --release --package engine --test random_states \
        --target-dir target/native >"$work/out.txt" 2>&1 || {
        printf 'DIVERGED the flight model for this CPU, link-time optimised\n'
        cat "$work/out.txt"
        exit 1
    }
    printf 'exact    the flight model for this CPU, link-time optimised: steps from random states\n'
    passed=$((passed + 1))
fi
tunables=glibc.cpu.hwcaps=-AVX2,-FMA
exact "release, C library without AVX2 and FMA" env "GLIBC_TUNABLES=$tunables" "$release"
exact "debug, C library without AVX2 and FMA" env "GLIBC_TUNABLES=$tunables" "$debug"
if command -v qemu-x86_64 >/dev/null; then
    exact "release, on a Nehalem (qemu)" qemu-x86_64 -cpu Nehalem "$release"
else
    skip "a Nehalem: no qemu-x86_64 (Debian package qemu-user)"
fi
arm=${TILTROTOR_AARCH64:-}
if [ "$arm" = build ]; then
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc \
        CC_aarch64_unknown_linux_gnu=aarch64-linux-gnu-gcc \
        build arm --release --target aarch64-unknown-linux-gnu
    arm=target/arm/aarch64-unknown-linux-gnu/release/tiltrotor
fi
if [ -n "$arm" ] && command -v qemu-aarch64 >/dev/null; then
    exact "64-bit Arm (qemu)" qemu-aarch64 -L /usr/aarch64-linux-gnu "$arm"
else
    skip "64-bit Arm: not asked for (TILTROTOR_AARCH64), or no qemu-aarch64"
fi

# The other way round: what the debug build flies, the native one reflies.
"$debug" fly --pilot hover --fast --duration 5 --no-flightgear --force --out "$work/flight.mcap" >/dev/null
if [ "$whole" = whole ]; then
    exact "flown by debug, reflown for this CPU" "$native"
else
    exact "flown by debug, reflown by release" "$release"
fi
echo "$passed exact, 0 diverged, $skipped skipped"
