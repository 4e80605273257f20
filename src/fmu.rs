//! `tiltrotor fmu`: the XV-15 as a Functional Mock-up Unit, packed from the library beside the program.
//!
//! The library is a program of its own (`fmi/`), because a C interface needs what is forbidden here. `fmi/build.sh` puts
//! it and its descriptions into a folder; here they become the one file that simulation tools load.

mod archive;

use std::env;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, bail};
use logs::output;
use logs::text::size;

use crate::plot;
use crate::status::Status;
use archive::Archive;

/// What is packed, and where to.
#[derive(clap::Args)]
pub struct Args {
    /// The file to be written: XV15.fmu
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Version of the interface: 2 is FMI 2.0, which most tools read; 3 is FMI 3.0
    #[arg(long, value_name = "VERSION", default_value = "2")]
    fmi: Fmi,
    /// The folder that `fmi/build.sh` made (`fmu` beside the program without)
    #[arg(long, value_name = "FOLDER")]
    from: Option<PathBuf>,
    /// Replace a file that is there
    #[arg(long)]
    force: bool,
}

/// A version of the interface.
#[derive(clap::ValueEnum, Clone, Copy, PartialEq, Eq)]
enum Fmi {
    /// FMI 2.0
    #[value(name = "2")]
    Two,
    /// FMI 3.0
    #[value(name = "3")]
    Three,
}

/// A system for which there may be a library.
struct Platform {
    /// Its folder, as FMI 3.0 calls it.
    name: &'static str,
    /// As FMI 2.0 does.
    name_in_2: &'static str,
    /// The library, under the model's name.
    file: &'static str,
}

const PLATFORMS: [Platform; 3] = [
    Platform { name: "x86_64-linux", name_in_2: "linux64", file: "XV15.so" },
    Platform { name: "aarch64-linux", name_in_2: "aarch64-linux", file: "XV15.so" },
    Platform { name: "x86_64-windows", name_in_2: "win64", file: "XV15.dll" },
];

const LICENCES: [(&str, &str); 2] = [
    ("LICENSE-APACHE", include_str!("../LICENSE-APACHE")),
    ("LICENSE-MIT", include_str!("../LICENSE-MIT")),
];

/// Packs it.
pub fn run(args: &Args) -> Result<Status> {
    let folder = match &args.from {
        Some(folder) => folder.clone(),
        None => beside_the_program()?,
    };
    output::refuse(&args.out, args.force, &[])?;
    let (number, words) = match args.fmi {
        Fmi::Two => (2, "FMI 2.0"),
        Fmi::Three => (3, "FMI 3.0"),
    };
    let path = folder.join(format!("modelDescription-fmi{number}.xml"));
    let description = fs::read_to_string(&path).with_context(|| {
        format!(
            "cannot read {}: the FMU's library is not there; in the sources `fmi/build.sh FOLDER` builds it, and \
             --from FOLDER says where it is",
            path.display()
        )
    })?;
    let build = build_of(&description)
        .ok_or_else(|| anyhow!("{}: no model description of ours", path.display()))?;
    let mut archive = Archive::default();
    archive.add("modelDescription.xml", description.as_bytes())?;
    let mut packed = Vec::new();
    for Platform { name, name_in_2, file } in &PLATFORMS {
        let path = folder.join(name).join(file);
        if !path.exists() {
            continue;
        }
        let library = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
        // A tool would load it, and be refused by it.
        if !library.windows(build.len()).any(|bytes| bytes == build.as_bytes()) {
            bail!(
                "{}: of another build than its description ({build}): `fmi/build.sh FOLDER` makes both anew",
                path.display()
            );
        }
        let place = if args.fmi == Fmi::Two { name_in_2 } else { name };
        archive.add(&format!("binaries/{place}/{file}"), &library)?;
        packed.push(*name);
    }
    if packed.is_empty() {
        let known: Vec<_> = PLATFORMS.iter().map(|p| format!("{}/{}", p.name, p.file)).collect();
        bail!("{}: no library in it; looked for {}", folder.display(), known.join(", "));
    }
    for (name, text) in LICENCES {
        archive.add(&format!("documentation/licenses/{name}"), text.as_bytes())?;
    }
    let bytes = archive.finish()?;
    plot::write(&args.out, &bytes, args.force, &[])?;
    let (systems, bytes) = (packed.join(", "), size(bytes.len() as u64));
    say!("{}: {words}, {systems}, {bytes}, version {build}", args.out.display());
    let own = env!("TILTROTOR_VERSION");
    if build != own {
        complain!("tiltrotor: that is not the version of this command, {own}");
    }
    Ok(Status::Done)
}

/// Where the library is unless it is said.
fn beside_the_program() -> Result<PathBuf> {
    let program = env::current_exe().context("cannot tell where this program is: --from FOLDER")?;
    Ok(program.parent().unwrap_or(Path::new("")).join("fmu"))
}

/// The version of the program that wrote a description.
fn build_of(description: &str) -> Option<&str> {
    let (_, model) = description.split_once("<fmiModelDescription ")?;
    let (_, version) = model.split_once(" version=\"")?;
    Some(version.split_once('"')?.0).filter(|version| !version.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_build_is_the_models_and_not_that_of_the_markup() {
        let text = "<?xml version=\"1.0\"?>\n<fmiModelDescription fmiVersion=\"2.0\" version=\"0.1.0 (x)\" guid=\"\">";
        assert_eq!(build_of(text), Some("0.1.0 (x)"));
        assert_eq!(build_of("<?xml version=\"1.0\"?>"), None);
        assert_eq!(build_of("<fmiModelDescription version=\"\">"), None);
    }
}
