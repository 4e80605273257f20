//! FlightGear's side of it: the aircraft and the protocol files, as they are in the tree, so that an
//! installed program has them with it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

include!(concat!(env!("OUT_DIR"), "/files.rs"));

/// Where FlightGear looks for the aircraft and for the protocols.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Package {
    /// `--fg-aircraft`.
    pub aircraft: PathBuf,
    /// `--data`.
    pub data: PathBuf,
}

impl Package {
    /// The package in a folder that has it, such as the repository's `flightgear`.
    pub fn in_folder(folder: &Path) -> Self {
        Self { aircraft: folder.join("Aircraft"), data: folder.join("data") }
    }

    /// Writes the package under a folder, for good: a name of its own for every content, so that what is
    /// there already is the same.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn unpack(folder: &Path) -> io::Result<Self> {
        let place = folder.join(format!("flightgear-{CONTENT}"));
        for (name, bytes) in FILES {
            let path = place.join(name);
            if fs::metadata(&path).is_ok_and(|there| there.len() == bytes.len() as u64) {
                continue;
            }
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent)?;
            }
            // Whole or not at all: another one may be starting FlightGear just now.
            let part = path.with_extension(format!("part-{}", std::process::id()));
            fs::write(&part, bytes)?;
            fs::rename(&part, &path)?;
        }
        Ok(Self::in_folder(&place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_unpacked_is_what_is_in_the_tree() {
        let folder = std::env::temp_dir().join(format!("tiltrotor-package-{}", std::process::id()));
        let package = Package::unpack(&folder).expect("unpacked");
        for name in ["XV-15/xv15-set.xml", "XV-15/Nasal/ground.nas", "XV-15/Models/xv15.ac"] {
            let tree = Path::new(env!("CARGO_MANIFEST_DIR")).join("Aircraft").join(name);
            assert_eq!(fs::read(package.aircraft.join(name)).ok(), fs::read(tree).ok(), "{name}");
        }
        assert!(package.data.join("Protocol/tiltrotor.xml").is_file());
        // A second time nothing is to be done, and the place is the same.
        assert_eq!(Package::unpack(&folder).expect("there already"), package);
        fs::remove_dir_all(folder).expect("removed");
    }

    #[test]
    fn the_ground_is_looked_up_under_the_wheels_of_the_aircraft_file() {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
        let nasal = fs::read_to_string(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/Aircraft/XV-15/Nasal/ground.nas"
        ))
        .expect("the script");
        let (gear, from) = (&aircraft.landing_gear, aircraft.weight_balance.cg_m);
        let nose = gear.nose.tyre_m.from_cg(from);
        let right = gear.main.tyre_m.from_cg(from);
        let expected = format!(
            "var wheels = [[{:.4}, 0.0], [{:.4}, {:.4}], [{:.4}, {:.4}]];",
            nose.x, right.x, -right.y, right.x, right.y
        );
        assert!(nasal.contains(&expected), "ground.nas: {expected}");
    }
}
