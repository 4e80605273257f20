//! The steady flight that a command is asked about, in a pilot's units.

use std::path::{Path, PathBuf};

use analysis::condition::limits;
use analysis::trim::Target;
use anyhow::Result;
use engine::Aircraft;

use crate::numbers::within;
use crate::{numbers, texts};

/// Which steady flight.
#[derive(Clone, clap::Args)]
pub struct Condition {
    /// Nacelle incidence: 90 helicopter, 0 aeroplane, deg
    #[arg(long, value_name = "DEG", default_value_t = 90.0)]
    #[arg(value_parser = numbers::nacelle_deg, allow_negative_numbers = true)]
    pub nacelle: f64,
    /// True airspeed, kt
    #[arg(long, value_name = "KT", default_value_t = 0.0)]
    #[arg(value_parser = numbers::speed_kt, allow_negative_numbers = true)]
    pub speed_kt: f64,
    /// Rate of climb, ft/min
    #[arg(long, value_name = "FPM", default_value_t = 0.0)]
    #[arg(value_parser = numbers::climb_fpm, allow_negative_numbers = true)]
    pub climb_fpm: f64,
    /// Power lever instead of a rate of climb, % of its travel: the climb follows
    #[arg(long, value_name = "PERCENT", conflicts_with = "climb_fpm")]
    #[arg(value_parser = within(limits::LEVER_PERCENT, "%"), allow_negative_numbers = true)]
    pub lever: Option<f64>,
    /// Rate of turn, right positive, deg/s
    #[arg(long, value_name = "DEGPS", default_value_t = 0.0)]
    #[arg(value_parser = within(limits::TURN_DEGPS, "deg/s"), allow_negative_numbers = true)]
    pub turn_degps: f64,
    /// Bank of a turn, right positive, deg; instead of its rate
    #[arg(long, value_name = "DEG", conflicts_with = "turn_degps")]
    #[arg(value_parser = within(limits::BANK_DEG, "deg"), allow_negative_numbers = true)]
    pub bank_deg: Option<f64>,
    /// Sideslip, air from the right positive, deg: 90 is flight to the right, 180 rearward
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    #[arg(value_parser = within(limits::SIDESLIP_DEG, "deg"), allow_negative_numbers = true)]
    pub sideslip_deg: f64,
    /// Gross weight, lb (without: tanks full, 13000 for the XV-15)
    #[arg(long, value_name = "LB")]
    #[arg(value_parser = within(limits::WEIGHT_LB, "lb"), allow_negative_numbers = true)]
    pub weight_lb: Option<f64>,
    /// Above mean sea level, ft
    #[arg(long, value_name = "FT", default_value_t = 0.0)]
    #[arg(value_parser = numbers::altitude_ft, allow_negative_numbers = true)]
    pub altitude_ft: f64,
    /// Centre of gravity above the ground, ft (the ground is not felt without)
    #[arg(long, value_name = "FT")]
    #[arg(value_parser = within(limits::HEIGHT_FT, "ft"), allow_negative_numbers = true)]
    pub height_ft: Option<f64>,
    /// Warmer than the standard atmosphere by, K
    #[arg(long, value_name = "K", default_value_t = 0.0)]
    #[arg(value_parser = within(limits::ISA_K, "K"), allow_negative_numbers = true)]
    pub isa_k: f64,
    /// Flap lever, one of its detents: the XV-15's are 0, 20, 40 and 75 deg (without: the one next to 40 with
    /// nacelles above 75 deg, to 20 above 15, else to 0)
    #[arg(long, value_name = "DEG")]
    #[arg(value_parser = numbers::flap_deg, allow_negative_numbers = true)]
    pub flap: Option<f64>,
    /// Rotor speed, one of those the governor offers, rpm (without: the slowest below 1 deg of nacelle)
    #[arg(long, value_name = "RPM")]
    #[arg(value_parser = numbers::rotor_rpm, allow_negative_numbers = true)]
    pub rpm: Option<f64>,
    /// Gear down
    #[arg(long)]
    pub gear: bool,
    /// SCAS on, centred
    #[arg(long)]
    pub scas: bool,
    /// Aircraft file (the XV-15 without)
    #[arg(long, value_name = "FILE")]
    pub aircraft: Option<PathBuf>,
}

impl Condition {
    /// The files that it is read from.
    pub fn files(&self) -> Vec<&Path> {
        self.aircraft.iter().map(PathBuf::as_path).collect()
    }

    /// The aircraft, as heavy as asked for, and the flight.
    pub fn read(&self) -> Result<(Aircraft, Target)> {
        let (name, text) = texts::text_or(self.aircraft.as_deref(), "xv15.toml", aircraft::XV15)?;
        let aircraft = aircraft::aircraft(&name, &text)?;
        Ok(self.in_a_pilots_units().target(&aircraft)?)
    }

    fn in_a_pilots_units(&self) -> analysis::condition::Condition {
        analysis::condition::Condition {
            nacelle_deg: self.nacelle,
            speed_kt: self.speed_kt,
            climb_fpm: self.climb_fpm,
            lever_percent: self.lever,
            turn_degps: self.turn_degps,
            bank_deg: self.bank_deg,
            sideslip_deg: self.sideslip_deg,
            weight_lb: self.weight_lb,
            altitude_ft: self.altitude_ft,
            height_ft: self.height_ft,
            isa_k: self.isa_k,
            flap_deg: self.flap,
            rpm: self.rpm,
            gear_down: self.gear,
            scas_on: self.scas,
        }
    }
}

/// From, to and step of a sweep, `0:100:10`.
pub fn sweep(text: &str) -> Result<Vec<f64>, String> {
    let numbers: Vec<f64> = text
        .split(':')
        .map(|number| number.parse().map_err(|_| format!("`{number}` is no number")))
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [from, to, step] if from.is_finite() && to >= from && step > 0.0 => {
            let steps = ((to - from) / step + 1e-9).floor();
            if steps > 10_000.0 {
                return Err("expected at most 10000 steps".into());
            }
            Ok((0..=steps as u64).map(|i| from + step * i as f64).collect())
        }
        _ => Err("expected FROM:TO:STEP with FROM <= TO and a positive STEP".into()),
    }
}
