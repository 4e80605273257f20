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
make_venv_of "$venv" fmi/requirements.txt

begun=$SECONDS
fmi/build.sh target/fmu
cargo build --quiet --release --locked --manifest-path fmi/Cargo.toml --target-dir target/python --example native
cargo test --quiet --release --locked --manifest-path fmi/Cargo.toml --target-dir target/python --lib
echo "FMU built in $((SECONDS - begun)) s"

begun=$SECONDS
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Command and FMU are of one version.
number=$("$tiltrotor" --version | cut -d ' ' -f 2)
grep --quiet "<fmiModelDescription .* version=\"$number (commit " target/fmu/modelDescription-fmi2.xml

# Packed: the same bytes every time, and a zip archive to others' eyes, too.
for version in 2 3; do
    "$tiltrotor" fmu --from target/fmu --fmi $version --out "$scratch/XV15-fmi$version.fmu"
    python3 -m zipfile --test "$scratch/XV15-fmi$version.fmu" >"$scratch/said"
    "$tiltrotor" fmu --from target/fmu --fmi $version --out "$scratch/again.fmu" --force >/dev/null
    cmp "$scratch/XV15-fmi$version.fmu" "$scratch/again.fmu"
done
# refused WORDS COMMAND: ends with 2 and says that.
refused() {
    local words=$1 status=0
    shift
    "$@" >"$scratch/said" 2>&1 || status=$?
    if [ $status != 2 ] || ! grep --quiet --fixed-strings "$words" "$scratch/said"; then
        echo "expected to be refused with: $words; exit $status: $(cat "$scratch/said")" >&2
        exit 1
    fi
}
refused "the FMU's library is not there" "$tiltrotor" fmu --from "$scratch/nowhere" --out "$scratch/none.fmu"
refused "exists" "$tiltrotor" fmu --from target/fmu --out "$scratch/again.fmu"
cp -r target/fmu "$scratch/mixed"
sed -i 's/ version="0/ version="9/' "$scratch/mixed/modelDescription-fmi3.xml"
refused "of another build" "$tiltrotor" fmu --fmi 3 --from "$scratch/mixed" --out "$scratch/none.fmu"
rm -r "$scratch"/mixed/*-linux
refused "no library in it" "$tiltrotor" fmu --fmi 3 --from "$scratch/mixed" --out "$scratch/none.fmu"
[ ! -e "$scratch/none.fmu" ]

target/python/release/examples/native hover-50ft >"$scratch/native"
"$venv/bin/python" tests/fmu.py "$(realpath "$tiltrotor")" "$scratch" "$scratch"
echo "fmu: tested in $((SECONDS - begun)) s"
