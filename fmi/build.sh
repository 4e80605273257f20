#!/usr/bin/env bash
# Builds the library and packs it: target/fmi/XV15-fmi2.fmu and target/fmi/XV15-fmi3.fmu.
#
#   fmi/build.sh              for this system
#   fmi/build.sh --windows    and for 64-bit Windows, where Rust's target and mingw are there (./setup --cross)
#
# Two archives, because one has one modelDescription.xml at its root, and that has one version; the library in both is the
# same file.
set -euo pipefail
cd "$(dirname "$0")/.."
windows=x86_64-pc-windows-gnu
target=$PWD/target/fmi
machine=$(uname -m)

build=(cargo build --release --locked --manifest-path fmi/Cargo.toml --target-dir "$target")
"${build[@]}"
libraries=("$target/release/libtiltrotor_fmi.so=linux64=$machine-linux=XV15.so")
[ "$machine" = x86_64 ] || libraries=("$target/release/libtiltrotor_fmi.so=$machine-linux=$machine-linux=XV15.so")

if [ "${1-}" = --windows ]; then
    if ! rustup target list --installed 2>/dev/null | grep --quiet --line-regexp $windows ||
        ! command -v x86_64-w64-mingw32-gcc >/dev/null; then
        echo "fmi/build.sh: no Rust target $windows or no mingw here: ./setup --cross adds them" >&2
        exit 77
    fi
    "${build[@]}" --lib --target $windows
    libraries+=("$target/$windows/release/tiltrotor_fmi.dll=win64=x86_64-windows=XV15.dll")
fi

# pack VERSION: the folder names of the binaries are the version's own.
pack() {
    local version=$1 folder=$target/fmu-$1 fmu=$target/XV15-fmi$1.fmu entry library of2 of3 name place
    rm -rf "$folder" "$fmu"
    mkdir -p "$folder/documentation/licenses"
    "$target/release/describe" "$version" >"$folder/modelDescription.xml"
    for entry in "${libraries[@]}"; do
        IFS='=' read -r library of2 of3 name <<<"$entry"
        place=$of2
        [ "$version" = 2 ] || place=$of3
        mkdir -p "$folder/binaries/$place"
        cp "$library" "$folder/binaries/$place/$name"
    done
    cp LICENSE-APACHE LICENSE-MIT "$folder/documentation/licenses/"
    if command -v zip >/dev/null; then
        (cd "$folder" && zip --quiet -X -r "$fmu" modelDescription.xml binaries documentation)
    else
        (cd "$folder" && python3 -m zipfile -c "$fmu" modelDescription.xml binaries documentation)
    fi
    rm -rf "$folder"
    echo "${fmu#"$PWD/"}: $(du -h "$fmu" | cut -f1)"
}
pack 2
pack 3
