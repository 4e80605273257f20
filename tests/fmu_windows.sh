#!/usr/bin/env bash
# The FMU's Windows library, loaded by Wine: ten seconds with the bits of the Linux library, and a log that verifies exact.
# Usage: tests/fmu_windows.sh [TILTROTOR]   (a headless release build without one)
# What it needs, `./setup --cross` installs; ends with 77 where it is not there.
set -euo pipefail
cd "$(dirname "$0")/.."

wine=$(command -v wine64 || command -v wine) ||
    { echo "SKIPPED: no Wine here: ./setup --cross installs it"; exit 77; }
tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export WINEPREFIX=$scratch/wine WINEDEBUG=-all
fmi/build.sh --windows target/fmu
"$tiltrotor" fmu --from target/fmu --out "$scratch/XV15.fmu" | tee "$scratch/said"
grep --quiet x86_64-windows "$scratch/said"
python3 -m zipfile --extract "$scratch/XV15.fmu" "$scratch/unpacked"
[ -f "$scratch/unpacked/binaries/win64/XV15.dll" ]

description=$scratch/unpacked/modelDescription.xml
token=$(sed -n 's/.* guid="\([^"]*\)".*/\1/p' "$description")
reference() { sed -n "s/.*<ScalarVariable name=\"$1\" valueReference=\"\([0-9]*\)\".*/\1/p" "$description"; }
outputs=$(grep -o 'valueReference="[0-9]*"[^>]* causality="output"' "$description" | grep -o 'valueReference="[0-9]*"' | grep -o '[0-9]*')
first=$(head -1 <<<"$outputs") last=$(tail -1 <<<"$outputs") count=$(wc -l <<<"$outputs")
[ $((last - first + 1)) = "$count" ] && [ "$count" -gt 200 ]
flown=("$(reference start)" "$(reference log_file)" "$(reference stick_aft)" "$first" "$count")

cc -O1 -o "$scratch/caller" tests/cross/fmu_caller.c -ldl
x86_64-w64-mingw32-gcc -O1 -o "$scratch/caller.exe" tests/cross/fmu_caller.c
# Older Wines lack it; Windows has its own.
x86_64-w64-mingw32-gcc -shared -Os -o "$scratch/bcryptprimitives.dll" tests/cross/bcryptprimitives.c -ladvapi32
cd "$scratch"
./caller "$PWD/unpacked/binaries/linux64/XV15.so" "$token" linux.mcap "${flown[@]}" >linux.bits
"$wine" caller.exe 'unpacked\binaries\win64\XV15.dll' "$token" windows.mcap "${flown[@]}" | tr -d '\r' >windows.bits
[ "$(wc -l <linux.bits)" = $((2500 * count + 1)) ]
cmp linux.bits windows.bits
cd - >/dev/null
"$tiltrotor" verify "$scratch/linux.mcap" "$scratch/windows.mcap"
echo "the same bits by the Windows library: $count outputs at 2500 points"
