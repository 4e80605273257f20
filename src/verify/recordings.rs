//! What diverged, as recordings for the viewer.

#[cfg(feature = "rerun")]
mod with_rerun {
    use std::fs;
    use std::path::{Component, Path, PathBuf};

    use anyhow::{Context, Result};
    use logs::output::Output;
    use replay::view::{Comparison, Other};

    use super::super::run::{Run, Verified};
    use crate::status::Status;

    /// Makes the folder: better before the logs are reflown than after.
    pub fn prepare(folder: &Path) -> Result<()> {
        fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))
    }

    /// Draws every log that diverged. Names go to standard error, where no report is.
    pub fn save(run: &Run, folder: &Path) -> Result<()> {
        let parted = |log: &&Verified| {
            log.verdict.as_ref().is_ok_and(|verdict| verdict.divergence.is_some())
        };
        for verified in run.logs.iter().filter(parted) {
            let saved = folder.join(name(&verified.log));
            let output = Output::beside(&saved, true, &[&verified.log])?;
            let title = verified.log.file_stem().unwrap_or_default().display().to_string();
            let how = Comparison::of_reflight(&title);
            let status = |_: &[_]| Status::Differs.number();
            replay::view::draw_against(&verified.log, Other::Reflown, &output, &how, status)
                .with_context(|| verified.log.display().to_string())?;
            output.finish()?;
            complain!("{}: recorded, reflown and the difference", saved.display());
        }
        Ok(())
    }

    /// A name that no other log of the run has: its path in one word.
    fn name(log: &Path) -> PathBuf {
        let parts: Vec<_> = log
            .components()
            .filter_map(|part| match part {
                Component::Normal(part) => Some(part.to_string_lossy()),
                Component::ParentDir => Some("up".into()),
                _ => None,
            })
            .collect();
        Path::new(&parts.join("-")).with_extension("rrd")
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn logs_of_one_name_in_two_folders_get_two_names() {
            assert_eq!(name(Path::new("a/x.mcap")), Path::new("a-x.rrd"));
            assert_eq!(name(Path::new("/b/x.mcap")), Path::new("b-x.rrd"));
            assert_eq!(name(Path::new("x.mcap")), Path::new("x.rrd"));
        }
    }
}

#[cfg(feature = "rerun")]
pub use with_rerun::{prepare, save};

/// Says what is missing.
#[cfg(not(feature = "rerun"))]
pub fn prepare(_: &std::path::Path) -> anyhow::Result<()> {
    anyhow::bail!(
        "--rrd: this program was built without `rerun`; build it with the default features"
    )
}

/// Is not come to.
#[cfg(not(feature = "rerun"))]
pub fn save(_: &super::run::Run, _: &std::path::Path) -> anyhow::Result<()> {
    Ok(())
}
