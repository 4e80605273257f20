//! Where FlightGear is on this machine, and what it has.

use std::env;
use std::fs;
use std::net::UdpSocket;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

/// The oldest series with what is needed: protocols from our own folder.
const VERSION_MIN: (u32, u32) = (2020, 3);

/// Where the program may be when it is not in the search path.
const PROGRAMS: &[&str] = &[
    "/usr/games/fgfs",
    "/usr/local/games/fgfs",
    "/usr/local/bin/fgfs",
    "/opt/flightgear/bin/fgfs",
    "/Applications/FlightGear.app/Contents/MacOS/fgfs",
    "C:\\Program Files\\FlightGear 2020.3\\bin\\fgfs.exe",
    "C:\\Program Files\\FlightGear 2024.1\\bin\\fgfs.exe",
    "C:\\Program Files\\FlightGear\\bin\\fgfs.exe",
];

/// Where its base package may be.
const ROOTS: &[&str] = &[
    "/usr/share/games/flightgear",
    "/usr/share/flightgear",
    "/usr/local/share/flightgear",
    "/Applications/FlightGear.app/Contents/Resources/data",
    "C:\\Program Files\\FlightGear 2020.3\\data",
    "C:\\Program Files\\FlightGear 2024.1\\data",
    "C:\\Program Files\\FlightGear\\data",
];

/// A FlightGear on this machine.
#[derive(Clone, Debug)]
pub struct Found {
    /// `fgfs`.
    pub program: PathBuf,
    /// Its base package, where it is known.
    pub root: Option<PathBuf>,
}

impl Found {
    /// Looks for it, at that place or in the usual ones.
    ///
    /// # Errors
    /// When there is none, or one that is too old.
    pub fn look(given: Option<&Path>) -> Result<Self> {
        let program = match given {
            Some(path) if path.is_file() => path.to_path_buf(),
            Some(path) => bail!("no program at {}", path.display()),
            None => match program() {
                Some(path) => path,
                None => bail!(
                    "FlightGear is not installed, or not where it is looked for: install FlightGear \
                     2020.3 (./setup --flightgear does), or say where it is with --fgfs FILE"
                ),
            },
        };
        let roots = env::var_os("FG_ROOT").map(PathBuf::from).into_iter();
        let root = roots
            .chain(ROOTS.iter().map(PathBuf::from))
            .find(|root| root.join("version").is_file());
        if let Some(root) = &root {
            check_version(root)?;
        }
        Ok(Self { program, root })
    }

    /// Whether scenery of a place is installed.
    pub fn has_scenery(&self, latitude_deg: f64, longitude_deg: f64) -> bool {
        let tile = tile(latitude_deg, longitude_deg);
        let mut folders: Vec<PathBuf> = self.root.iter().map(|root| root.join("Scenery")).collect();
        if let Some(given) = env::var_os("FG_SCENERY") {
            folders.extend(env::split_paths(&given));
        }
        if let Some(home) = env::var_os("FG_HOME").map(PathBuf::from).or_else(home) {
            folders.push(home.join("TerraSync"));
        }
        folders.iter().any(|folder| folder.join("Terrain").join(&tile).is_dir())
    }
}

/// Where FlightGear keeps what is the user's.
fn home() -> Option<PathBuf> {
    env::var_os("HOME").map(|home| PathBuf::from(home).join(".fgfs"))
}

/// In the search path, or in the usual places.
fn program() -> Option<PathBuf> {
    let name = if cfg!(windows) { "fgfs.exe" } else { "fgfs" };
    let path = env::var_os("PATH").unwrap_or_default();
    let in_path: Vec<PathBuf> = env::split_paths(&path).map(|folder| folder.join(name)).collect();
    in_path.into_iter().chain(PROGRAMS.iter().map(PathBuf::from)).find(|path| path.is_file())
}

fn check_version(root: &Path) -> Result<()> {
    let text = fs::read_to_string(root.join("version")).unwrap_or_default();
    let mut numbers = text.trim().split('.').map(|number| number.parse::<u32>().unwrap_or(0));
    let version = (numbers.next().unwrap_or(0), numbers.next().unwrap_or(0));
    if version < VERSION_MIN {
        bail!(
            "FlightGear {} is too old: {}.{} or newer is needed",
            text.trim(),
            VERSION_MIN.0,
            VERSION_MIN.1
        );
    }
    Ok(())
}

/// The folder of a degree of scenery: `w160n10/w156n19`.
fn tile(latitude_deg: f64, longitude_deg: f64) -> PathBuf {
    let name = |latitude: f64, longitude: f64| {
        let ew = if longitude < 0.0 { 'w' } else { 'e' };
        let ns = if latitude < 0.0 { 's' } else { 'n' };
        format!("{ew}{:03.0}{ns}{:02.0}", longitude.abs(), latitude.abs())
    };
    let tens = |deg: f64| (deg / 10.0).floor() * 10.0;
    let (latitude, longitude) = (latitude_deg.floor(), longitude_deg.floor());
    PathBuf::from(name(tens(latitude), tens(longitude))).join(name(latitude, longitude))
}

/// Where what is unpacked for FlightGear is kept.
pub fn cache() -> PathBuf {
    let given = env::var_os("XDG_CACHE_HOME").or_else(|| env::var_os("LOCALAPPDATA"));
    let home = || env::var_os("HOME").map(|home| PathBuf::from(home).join(".cache"));
    given.map(PathBuf::from).or_else(home).unwrap_or_else(env::temp_dir).join("tiltrotor")
}

/// Whether there is a way out of this machine. Nothing is sent.
pub fn has_network() -> bool {
    let way = UdpSocket::bind("0.0.0.0:0").and_then(|socket| socket.connect("192.0.2.1:9"));
    way.is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenery_lies_where_flightgear_looks_for_it() {
        for (latitude_deg, longitude_deg, folder) in [
            (19.72, -155.03, "w160n10/w156n19"),
            (64.1, -21.9, "w030n60/w022n64"),
            (-33.9, 151.2, "e150s40/e151s34"),
            (45.0, 7.65, "e000n40/e007n45"),
            (0.5, -0.5, "w010n00/w001n00"),
        ] {
            assert_eq!(tile(latitude_deg, longitude_deg), PathBuf::from(folder));
        }
    }

    #[test]
    fn an_old_flightgear_is_refused_by_its_version() {
        let root = env::temp_dir().join(format!("tiltrotor-fgroot-{}", std::process::id()));
        fs::create_dir_all(&root).expect("a folder");
        for (version, good) in
            [("2020.3.16\n", true), ("2024.1.1\n", true), ("2019.1.2\n", false), ("", false)]
        {
            fs::write(root.join("version"), version).expect("written");
            assert_eq!(check_version(&root).is_ok(), good, "{version}");
        }
        fs::remove_dir_all(root).expect("removed");
    }
}
