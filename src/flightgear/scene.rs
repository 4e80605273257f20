//! Where, when and in which wind FlightGear begins.

use std::path::Path;

use anyhow::{Context, Result};
use engine::start::Start;

use super::moment::Moment;

/// What FlightGear is to show first.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Where, and in which wind.
    pub start: Option<Start>,
    /// When; at noon without.
    pub moment: Option<Moment>,
}

impl Scene {
    /// As a log begins.
    pub fn of_log(path: &Path) -> Result<Self> {
        let reader = logs::open(path, replay::OPEN)
            .with_context(|| format!("cannot read {}", path.display()))?;
        let mut start = aircraft::start("scenario.toml", &reader.setup.scenario_toml)?;
        start.origin = reader.initial.plant.origin;
        let began = &reader.identity;
        let began = Moment::of_unix_ns(began.get(logs::Identity::STARTED));
        Ok(Self { start: Some(start), moment: began })
    }
}
