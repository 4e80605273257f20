//! Tells the program what it was built from.

fn main() {
    provenance::tell(&["Cargo.lock", "build.rs", "src"]);
}
