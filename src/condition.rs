//! The steady flight that a command is asked about, in a pilot's units.

use std::path::{Path, PathBuf};

use analysis::trim::{Power, Target};
use anyhow::{Context, Result, bail};
use engine::math::min;
use engine::units::{DEG_PER_RAD, FOOT_M, KNOT_MPS, POUND_KG, RPM_RADPS};
use engine::{Aircraft, GRAVITY_MPS2};

use crate::numbers::between;
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
    #[arg(value_parser = between(0.0, 100.0, "%"), allow_negative_numbers = true)]
    pub lever: Option<f64>,
    /// Rate of turn, right positive, deg/s
    #[arg(long, value_name = "DEGPS", default_value_t = 0.0)]
    #[arg(value_parser = between(-90.0, 90.0, "deg/s"), allow_negative_numbers = true)]
    pub turn_degps: f64,
    /// Bank of a turn, right positive, deg; instead of its rate
    #[arg(long, value_name = "DEG", conflicts_with = "turn_degps")]
    #[arg(value_parser = between(-75.0, 75.0, "deg"), allow_negative_numbers = true)]
    pub bank_deg: Option<f64>,
    /// Sideslip, air from the right positive, deg: 90 is flight to the right, 180 rearward
    #[arg(long, value_name = "DEG", default_value_t = 0.0)]
    #[arg(value_parser = between(-180.0, 180.0, "deg"), allow_negative_numbers = true)]
    pub sideslip_deg: f64,
    /// Gross weight, lb
    #[arg(long, value_name = "LB", default_value_t = 13_000.0)]
    #[arg(value_parser = between(2_500.0, 44_000.0, "lb"), allow_negative_numbers = true)]
    pub weight_lb: f64,
    /// Above mean sea level, ft
    #[arg(long, value_name = "FT", default_value_t = 0.0)]
    #[arg(value_parser = numbers::altitude_ft, allow_negative_numbers = true)]
    pub altitude_ft: f64,
    /// Centre of gravity above the ground, ft (the ground is not felt without)
    #[arg(long, value_name = "FT")]
    #[arg(value_parser = between(0.0, 60_000.0, "ft"), allow_negative_numbers = true)]
    pub height_ft: Option<f64>,
    /// Warmer than the standard atmosphere by, K
    #[arg(long, value_name = "K", default_value_t = 0.0)]
    #[arg(value_parser = between(-80.0, 80.0, "K"), allow_negative_numbers = true)]
    pub isa_k: f64,
    /// Flap lever: 0, 20, 40 or 75 deg (without: 40 with nacelles above 75 deg, 20 above 15, else 0)
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

/// The flap lever that the reference model's trims use at a nacelle incidence, deg.
fn usual_flap_deg(nacelle_deg: f64) -> f64 {
    if nacelle_deg > 75.0 {
        40.0
    } else if nacelle_deg > 15.0 {
        20.0
    } else {
        0.0
    }
}

/// The detent of a flap lever position, or of the usual one at a nacelle incidence.
pub fn flap_detent(aircraft: &Aircraft, flap_deg: Option<f64>, nacelle_deg: f64) -> Result<u64> {
    let wanted_deg = flap_deg.unwrap_or_else(|| usual_flap_deg(nacelle_deg));
    let offered = aircraft.fcc.mixer.flap_rad.map(|rad| rad * DEG_PER_RAD);
    let Some(detent) = offered.iter().position(|deg| (deg - wanted_deg).abs() < 0.5) else {
        bail!("--flap {wanted_deg}: the lever has detents at {offered:.0?} deg");
    };
    Ok(detent as u64)
}

/// The number of a rotor speed, or of the usual one at a nacelle incidence.
pub fn rpm_select(aircraft: &Aircraft, rpm: Option<f64>, nacelle_deg: f64) -> Result<u64> {
    let offered = aircraft.fcc.governor.rotor_speed_radps.map(|radps| radps / RPM_RADPS);
    match rpm {
        None if nacelle_deg < 1.0 => Ok(engine::cockpit::RPM_SELECT_LAST),
        None => Ok(0),
        Some(rpm) => match offered.iter().position(|offer| (offer - rpm).abs() < 1.0) {
            Some(0) => Ok(0),
            Some(number) if nacelle_deg < 1.0 => Ok(number as u64),
            Some(_) => bail!("--rpm {rpm}: only with the nacelles down, at --nacelle 0"),
            None => bail!("--rpm {rpm}: the governor offers {offered:.0?} rpm"),
        },
    }
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
        let airspeed_mps = self.speed_kt * KNOT_MPS;
        let (aircraft, fuel_kg) = weigh(aircraft, self.weight_lb * POUND_KG)?;
        let target = Target {
            mast_tilt_rad: (90.0 - self.nacelle) / DEG_PER_RAD,
            airspeed_mps,
            power: match self.lever {
                Some(percent) => Power::Lever(0.01 * percent),
                None => Power::Climb(self.climb_fpm * FOOT_M / 60.0),
            },
            turn_radps: self.turn_radps(airspeed_mps)?,
            sideslip_rad: self.sideslip_deg / DEG_PER_RAD,
            altitude_m: self.altitude_ft * FOOT_M,
            fuel_kg,
            flap_detent: flap_detent(&aircraft, self.flap, self.nacelle)?,
            rpm_select: rpm_select(&aircraft, self.rpm, self.nacelle)?,
            gear_down: u64::from(self.gear),
            scas_on: u64::from(self.scas),
            ..Target::default()
        };
        let mut world = target.world;
        world.temperature_offset_k = self.isa_k;
        if let Some(height_ft) = self.height_ft {
            world = world.with_ground((self.altitude_ft - height_ft) * FOOT_M);
        }
        Ok((aircraft, Target { world, ..target }))
    }

    fn turn_radps(&self, airspeed_mps: f64) -> Result<f64> {
        let Some(bank_deg) = self.bank_deg else { return Ok(self.turn_degps / DEG_PER_RAD) };
        if airspeed_mps < 5.0 || bank_deg.abs() > 75.0 {
            bail!("--bank-deg: expected up to 75 deg, and some speed to turn with");
        }
        Ok(GRAVITY_MPS2 * engine::math::tan(bank_deg / DEG_PER_RAD) / airspeed_mps)
    }
}

/// The aircraft at a gross mass, and its fuel in kg: by the fuel where that can be, by the empty mass
/// otherwise.
pub fn weigh(aircraft: Aircraft, mass_kg: f64) -> Result<(Aircraft, f64)> {
    let weights = &aircraft.weight_balance;
    let fuel_kg = mass_kg - weights.zero_fuel_mass_kg;
    if fuel_kg > 0.0 && fuel_kg <= weights.fuel_kg_max + 1.0 {
        return Ok((aircraft, fuel_kg));
    }
    let fuel_kg = min(0.5 * weights.fuel_kg_max, 0.1 * mass_kg);
    if mass_kg.is_finite() && mass_kg > 1000.0 && mass_kg < 20_000.0 {
        let zero_fuel_mass_kg = mass_kg - fuel_kg;
        let loaded = aircraft.with(|a| a.weight_balance.zero_fuel_mass_kg = zero_fuel_mass_kg);
        Ok((loaded, fuel_kg))
    } else {
        Err(anyhow::anyhow!("{:.0} lb", mass_kg / POUND_KG))
            .context("no weight of such an aircraft")
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
