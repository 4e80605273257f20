//! Tells the library what it was built from.

fn main() {
    provenance::tell(&["fmi/Cargo.lock", "fmi/Cargo.toml", "fmi/build.rs", "fmi/src"]);
}
