#!/usr/bin/env bash
# Other systems: the program compiles for Windows and macOS, and the Windows binary, run by Wine, verifies every
# golden flight exact and flies to the same bits.
#
#   tests/cross.sh check     compiles for both, runs nothing
#   tests/cross.sh           builds the Windows binary and runs it, too
#
# What it needs, `./setup --cross` installs; ends with 77 where it is not there. macOS: only the Rust code is checked, because its C headers are
# Apple's; nobody has run the program there.
set -euo pipefail
cd "$(dirname "$0")/.."
windows=x86_64-pc-windows-gnu
macos=aarch64-apple-darwin

for target in $windows $macos; do
    if ! rustup target list --installed 2>/dev/null | grep --quiet --line-regexp "$target"; then
        echo "SKIPPED: no Rust target $target here: ./setup --cross adds it"
        exit 77
    fi
done
command -v x86_64-w64-mingw32-gcc >/dev/null ||
    { echo "SKIPPED: no mingw here: ./setup --cross installs it"; exit 77; }

echo "cargo check for $macos (Rust only) and $windows"
export CC_aarch64_apple_darwin=$PWD/tests/cross/no_c_compiler
export AR_aarch64_apple_darwin=$PWD/tests/cross/no_c_compiler
cargo check --workspace --no-default-features --features sticks --target $macos --target $windows
[ "${1-}" = check ] && exit 0

wine=$(command -v wine64 || command -v wine) ||
    { echo "SKIPPED: no Wine here: ./setup --cross installs it"; exit 77; }
cargo build --release --no-default-features --target $windows
release=target/$windows/release
# Older Wines lack it; Windows has its own.
x86_64-w64-mingw32-gcc -shared -Os -o $release/bcryptprimitives.dll tests/cross/bcryptprimitives.c -ladvapi32
cargo build --release --no-default-features

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export WINEPREFIX=$scratch/wine WINEDEBUG=-all
exe() { "$wine" $release/tiltrotor.exe "$@" | tr -d '\r'; }

exe --version
echo "golden flights, reflown by the Windows binary"
exe verify tests/golden | tee "$scratch/verified"
golden=$(ls tests/golden/*.mcap | wc -l)
grep --quiet "^$golden logs: $golden exact;" "$scratch/verified"

echo "one flight each, flown by both binaries: the same digest, and each verifies the other's"
flight=(--pilot hover --fast --duration 10 --force)
exe fly "${flight[@]}" --out "$scratch/windows.mcap"
target/release/tiltrotor fly "${flight[@]}" --out "$scratch/linux.mcap"
target/release/tiltrotor verify "$scratch/windows.mcap" | tee "$scratch/there"
exe verify "$scratch/linux.mcap" | tee "$scratch/back"
digest() { sed -n 's/.*: exact: .*digest \([0-9a-f]*\)$/\1/p' "$1"; }
[ -n "$(digest "$scratch/there")" ] && [ "$(digest "$scratch/there")" = "$(digest "$scratch/back")" ]
echo "the same bits on Windows"
