//! `tiltrotor verify --bless` and `--moved`.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use logs::text::size;

use crate::identity;
use crate::status::Status;

/// Says what moved in every log, and with `write` puts the new flights in their places. It ends with
/// [`Status::Differs`] when something moved and nothing was written, with [`Status::Unusable`] when a
/// log cannot be blessed.
pub fn run(logs: &[PathBuf], aircraft: Option<&Path>, write: bool) -> Result<Status> {
    let aircraft_toml = aircraft
        .map(|path| {
            std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
        })
        .transpose()?;
    let mut statuses = Vec::new();
    for log in logs {
        match replay::bless(log, identity::identity(), aircraft_toml.as_deref(), write) {
            Ok(moved) => {
                say!("{}: {moved}", log.display());
                let is_the_same = moved.is_same() && moved.models.0 == moved.models.1;
                if write && is_the_same {
                    say!("{}: left as it is", log.display());
                } else if write {
                    say!("{}: blessed, {}", log.display(), size(moved.bytes));
                } else if !moved.is_same() {
                    statuses.push(Status::Differs);
                }
            }
            Err(error) => {
                complain!("tiltrotor: {}: {error}", log.display());
                statuses.push(Status::Unusable);
            }
        }
    }
    Ok(Status::gravest(statuses))
}
