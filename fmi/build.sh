#!/usr/bin/env bash
# Builds the FMU's library and writes its descriptions into a folder, of which `tiltrotor fmu` packs an FMU.
#
#   fmi/build.sh [FOLDER]              for this system; target/fmu without a folder
#   fmi/build.sh --windows [FOLDER]    and for 64-bit Windows, where Rust's target and mingw are there (./setup --cross)
#
# `fmu` beside the program is where `tiltrotor fmu` looks by itself. In the folder: modelDescription-fmi2.xml,
# modelDescription-fmi3.xml, and the library below the name of each system.
set -euo pipefail
cd "$(dirname "$0")/.."
windows=x86_64-pc-windows-gnu
# The Python package has the same dependencies in the same profile: what one has built the other finds there.
target=$PWD/target/python
machine=$(uname -m)

with_windows=
if [ "${1-}" = --windows ]; then
    with_windows=yes
    shift
    if ! rustup target list --installed 2>/dev/null | grep --quiet --line-regexp $windows ||
        ! command -v x86_64-w64-mingw32-gcc >/dev/null; then
        echo "fmi/build.sh: no Rust target $windows or no mingw here: ./setup --cross adds them" >&2
        exit 77
    fi
fi
folder=${1:-target/fmu}

build=(cargo build --release --locked --manifest-path fmi/Cargo.toml --target-dir "$target")
"${build[@]}"
# What is of an older build does not stay beside what is new.
rm -rf "$folder"/{modelDescription-fmi{2,3}.xml,{x86_64,aarch64}-linux,x86_64-windows}
put() { mkdir -p "$folder/$2" && cp "$1" "$folder/$2/$3"; }
put "$target/release/libtiltrotor_fmi.so" "$machine-linux" XV15.so
if [ -n "$with_windows" ]; then
    "${build[@]}" --lib --target $windows
    put "$target/$windows/release/tiltrotor_fmi.dll" x86_64-windows XV15.dll
fi
for version in 2 3; do
    "$target/release/describe" $version >"$folder/modelDescription-fmi$version.xml"
done
echo "$folder: the parts of the FMU; \`tiltrotor fmu --from $folder --out XV15.fmu\` packs them"
