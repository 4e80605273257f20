//! `tiltrotor verify --bless` and `--moved`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result};
use logs::text::size;

use crate::{identity, report};

/// Says what moved in every log, and with `write` puts the new flights in their places. Exit status:
/// 0 when nothing moved or all was blessed, 1 when something moved and nothing was written, 2 when a
/// log cannot be blessed.
pub fn run(logs: &[PathBuf], aircraft: Option<&Path>, write: bool) -> Result<ExitCode> {
    let aircraft_toml = aircraft
        .map(|path| {
            std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))
        })
        .transpose()?;
    let mut status = 0;
    for log in logs {
        match replay::bless(log, identity::identity(), aircraft_toml.as_deref(), write) {
            Ok(moved) => {
                say!("{}: {moved}", log.display());
                if write {
                    say!("{}: blessed, {}", log.display(), size(moved.bytes));
                } else if !moved.is_same() {
                    status = status.max(report::DIVERGED);
                }
            }
            Err(error) => {
                complain!("tiltrotor: {}: {error}", log.display());
                status = report::UNUSABLE;
            }
        }
    }
    Ok(ExitCode::from(status))
}
