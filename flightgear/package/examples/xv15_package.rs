//! Writes FlightGear's XV-15; run as a test it says whether the files in the tree are fresh.
//!
//! With an aircraft file and a folder it writes that aircraft's files there, in place of the XV-15's.

use std::fs;
use std::path::{Path, PathBuf};

use flightgear_package::{FOLDER, File};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(FOLDER)
}

fn made() -> Vec<File> {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
    flightgear_package::files(&aircraft)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let (files, folder) = match &arguments[..] {
        [] => (made(), folder()),
        [file, folder] => {
            let text = fs::read_to_string(file).map_err(|why| format!("{file}: {why}"))?;
            let aircraft = aircraft::aircraft(file, &text)?;
            (flightgear_package::files(&aircraft), PathBuf::from(folder))
        }
        _ => return Err("expected nothing, or an aircraft file and a folder".into()),
    };
    for file in files {
        let path = folder.join(&file.path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(&path, &file.bytes)?;
        println!("{:>8} bytes  {}", file.bytes.len(), path.display());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_files_in_the_tree_are_those_that_are_made() {
        for file in made() {
            let path = folder().join(&file.path);
            let there = fs::read(&path).unwrap_or_default();
            let fresh = there == file.bytes;
            assert!(
                fresh,
                "{}: run `cargo run -p flightgear-package --example xv15_package`",
                file.path
            );
        }
    }

    /// What is between two texts, everywhere.
    fn between<'a>(text: &'a str, before: &'a str, after: char) -> impl Iterator<Item = &'a str> {
        text.split(before).skip(1).filter_map(move |rest| rest.split(after).next())
    }

    fn tree(path: &str) -> String {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path);
        fs::read_to_string(&path).unwrap_or_else(|why| panic!("{}: {why}", path.display()))
    }

    /// A node with its first index, as FlightGear has it: `rotor/rpm` is `rotor[0]/rpm`.
    fn indexed(node: &str) -> String {
        let parts = node.split('/').map(|part| part.strip_suffix("[0]").unwrap_or(part));
        parts.collect::<Vec<_>>().join("/")
    }

    #[test]
    fn whatever_moves_or_is_shown_is_sent() {
        let protocol = tree("flightgear/data/Protocol/tiltrotor.xml");
        let sent: Vec<_> = between(&protocol, "<node>/tiltrotor/", '<').map(indexed).collect();
        let display = tree(&format!("{FOLDER}/Nasal/pfd.nas"));
        let sounds = tree(&format!("{FOLDER}/Sounds/xv15-sound.xml"));
        let model = tree(&format!("{FOLDER}/Models/xv15.xml"));
        let moved = between(&model, "<property>tiltrotor/", '<').chain(between(
            &sounds,
            "<property>tiltrotor/",
            '<',
        ));
        let shown = between(&display, "node(\"", '"').chain(between(&display, "works(\"", '"'));
        let mut seen = 0;
        for node in moved.chain(shown) {
            seen += 1;
            assert!(sent.contains(&indexed(node)), "tiltrotor/{node} is not sent");
        }
        assert!(seen > 100, "{seen} properties");

        let protocol = tree("flightgear/data/Protocol/tiltrotor-ghost.xml");
        let sent: Vec<_> = between(&protocol, "<node>/ghost/", '<').map(indexed).collect();
        let ghost = tree(&format!("{FOLDER}/Models/ghost.xml"));
        let moved: Vec<_> = between(&ghost, "<property>/ghost/", '<').map(indexed).collect();
        assert!(moved.len() > 50, "{} properties", moved.len());
        for node in moved {
            assert!(sent.contains(&node), "ghost/{node} is not sent");
        }
        assert_eq!(between(&ghost, "<property>tiltrotor/", '<').next(), None, "the first one's");
    }

    #[test]
    fn no_comment_of_xml_holds_what_would_end_it() {
        for file in [
            "xv15-set.xml",
            "Models/xv15.xml",
            "Models/ghost.xml",
            "Sounds/xv15-sound.xml",
            "Display/pfd.svg",
        ] {
            let text = tree(&format!("{FOLDER}/{file}"));
            for comment in text.split("<!--").skip(1) {
                let inside = comment.split("-->").next().unwrap_or("");
                assert!(!inside.contains("--"), "{file}: <!--{inside}-->");
            }
        }
    }

    fn text<'a>(files: &'a [File], path: &str) -> &'a str {
        let file = files.iter().find(|file| file.path == path).expect(path);
        std::str::from_utf8(&file.bytes).expect("text")
    }

    /// The parts of the model: for each the least and the greatest place along the axes of its file, m.
    fn parts(files: &[File]) -> Vec<(&str, [[f64; 2]; 3])> {
        let objects = text(files, "Models/xv15.ac").split("OBJECT poly\nname \"").skip(1);
        let extent = |object| {
            let (name, rest) = str::split_once(object, '"').expect("a name");
            let (_, vertices) = rest.split_once("numvert ").expect("vertices");
            let count =
                vertices.lines().next().and_then(|count| count.parse().ok()).expect("a count");
            let mut extent = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
            for vertex in vertices.lines().skip(1).take(count) {
                for (ends, number) in extent.iter_mut().zip(vertex.split(' ')) {
                    let at = number.parse().expect("a number");
                    *ends = [engine::math::min(ends[0], at), engine::math::max(ends[1], at)];
                }
            }
            (name, extent)
        };
        objects.map(extent).collect()
    }

    /// The generic tilt-rotor is the XV-15 at 0.8 of its size, and so is every part that its file does not have.
    #[test]
    fn another_aircraft_has_a_model_of_its_own() {
        let toml = tree("aircraft/generic.toml");
        let generic = aircraft::aircraft("generic.toml", &toml).expect("an aircraft");
        let (generic, xv15) = (flightgear_package::files(&generic), made());
        let (small, large) = (parts(&generic), parts(&xv15));
        assert!(small.len() == large.len() && small.len() > 70, "{} parts", small.len());
        for ((name, small), (_, large)) in small.into_iter().zip(large) {
            for (small, large) in small.into_iter().flatten().zip(large.into_iter().flatten()) {
                assert!((small - 0.8 * large).abs() < 0.02, "{name}: {small} m, {large} m");
            }
        }
        let entry = text(&generic, "xv15-set.xml");
        assert!(entry.contains("<splash-title>Generic tilt-rotor<"), "{entry}");
        let livery = |files: &[File]| {
            files
                .iter()
                .find(|file| file.path == "Models/livery.png")
                .expect("a livery")
                .bytes
                .clone()
        };
        assert!(livery(&generic) != livery(&xv15), "its own name");
    }

    #[test]
    fn the_package_is_small() {
        let bytes: usize = made().iter().map(|file| file.bytes.len()).sum();
        assert!(bytes < 3_000_000, "{bytes} bytes");
    }
}
