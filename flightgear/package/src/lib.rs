//! FlightGear's XV-15: its model, paint, animations, sounds and the numbers of its display, made from
//! the aircraft file.
//!
//! Pure functions: the same aircraft gives the same files, byte for byte. The example `xv15_package`
//! writes them to `flightgear/Aircraft/XV-15`, and a test says whether those in the tree are fresh.
//! What is not a matter of the aircraft's geometry (the Nasal scripts, which sound when) is written by
//! hand beside them.

pub mod ac3d;
pub mod animations;
pub mod display;
pub mod mesh;
pub mod paint;
pub mod shape;
pub mod sounds;

use engine::aircraft::Params as Aircraft;

/// Where the package is in the tree.
pub const FOLDER: &str = "flightgear/Aircraft/XV-15";

/// A file of the package.
pub struct File {
    /// Below [`FOLDER`].
    pub path: String,
    /// What is in it.
    pub bytes: Vec<u8>,
}

fn file(path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> File {
    File { path: path.into(), bytes: bytes.into() }
}

/// Every file that is made.
pub fn files(aircraft: &Aircraft) -> Vec<File> {
    let mut files = vec![
        file("xv15-set.xml", display::set(aircraft)),
        file("Nasal/numbers.nas", display::numbers(aircraft)),
        file("Models/xv15.ac", model(aircraft)),
        file("Models/xv15.xml", animations::xml(aircraft)),
        file("Models/ghost.xml", animations::ghost(aircraft)),
        file(format!("Models/{}", paint::LIVERY), paint::livery(aircraft)),
        file(format!("Models/{}", paint::DISC), paint::disc()),
        file(format!("Models/{}", paint::HALO), paint::halo()),
        file(format!("Models/{}", paint::DUST), paint::dust()),
        file(format!("Models/{}", paint::SCREEN), paint::screen()),
    ];
    files.extend(sounds::files().map(|(name, bytes)| file(format!("Sounds/{name}"), bytes)));
    files
}

/// The model; its origin is the point whose place is sent to FlightGear: the centre of gravity as a
/// helicopter.
fn model(aircraft: &Aircraft) -> String {
    use shape::{cockpit, fuselage, gear, lights, nacelle, rotor, tail, wing};
    let mut parts = fuselage::parts(aircraft);
    // What can be seen through is drawn last.
    let glass = parts.remove(1);
    parts.extend(wing::parts(aircraft));
    parts.extend(tail::parts(aircraft));
    parts.extend(gear::parts(aircraft));
    parts.extend(nacelle::parts(aircraft));
    parts.extend(cockpit::parts(aircraft));
    parts.extend(lights::parts(aircraft));
    parts.push(glass);
    parts.extend(rotor::parts(aircraft));
    let cg = aircraft.weight_balance.cg_m;
    ac3d::write(&parts, [cg.x, cg.y, cg.z])
}
