//! Lists the files of FlightGear's side, so that the program carries them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo tells"));
    let mut files = Vec::new();
    for folder in ["Aircraft", "data"] {
        println!("cargo::rerun-if-changed={folder}");
        find(&root.join(folder), &mut files);
    }
    files.sort();
    // FNV-1a over names and contents: a name for the whole.
    let mut content: u64 = 0xcbf2_9ce4_8422_2325;
    let mut list = String::from(
        "/// Every file, by its place in the package.\nconst FILES: &[(&str, &[u8])] = &[\n",
    );
    for path in &files {
        let place = path.strip_prefix(&root).expect("within").to_string_lossy().replace('\\', "/");
        let bytes = fs::read(path).expect("a file of the package");
        for byte in place.bytes().chain(bytes) {
            content = (content ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        let _ = writeln!(list, "    ({place:?}, include_bytes!({:?})),", path.to_string_lossy());
    }
    let _ = write!(
        list,
        "];\n/// Changes with the files.\nconst CONTENT: &str = \"{content:016x}\";\n"
    );
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo tells"));
    fs::write(out.join("files.rs"), list).expect("written");
}

fn find(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            println!("cargo::rerun-if-changed={}", path.display());
            find(&path, files);
        } else {
            files.push(path);
        }
    }
}
