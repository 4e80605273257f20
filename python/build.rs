//! Tells the package what it was built from.

fn main() {
    provenance::tell(&["python/Cargo.lock", "python/Cargo.toml", "python/build.rs", "python/src"]);
}
