//! The steady flight that is asked about, in a pilot's units.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use engine::math::{min, tan};
use engine::units::{DEG_PER_RAD, FOOT_M, KNOT_MPS, POUND_KG, RPM_RADPS};
use engine::{Aircraft, GRAVITY_MPS2};

use crate::trim::{Power, Target};

/// A steady flight, in a pilot's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Nacelle incidence: 90 helicopter, 0 aeroplane, deg.
    pub nacelle_deg: f64,
    /// True airspeed, kt.
    pub speed_kt: f64,
    /// Rate of climb, ft/min.
    pub climb_fpm: f64,
    /// Power lever instead of a rate of climb, % of its travel: the climb follows.
    pub lever_percent: Option<f64>,
    /// Rate of turn, right positive, deg/s.
    pub turn_degps: f64,
    /// Bank of a turn, right positive, deg; instead of its rate.
    pub bank_deg: Option<f64>,
    /// Sideslip, air from the right positive, deg.
    pub sideslip_deg: f64,
    /// Gross weight, lb; with full tanks without.
    pub weight_lb: Option<f64>,
    /// Above mean sea level, ft.
    pub altitude_ft: f64,
    /// Centre of gravity above the ground, ft; the ground is not felt without.
    pub height_ft: Option<f64>,
    /// Warmer than the standard atmosphere by, K.
    pub isa_k: f64,
    /// Flap lever, one of its detents, deg; without: the one next to 40 with nacelles above 75 deg, to 20 above
    /// 15, else to 0.
    pub flap_deg: Option<f64>,
    /// Rotor speed, one of those the governor offers, rpm; without: the slowest below 1 deg of nacelle.
    pub rpm: Option<f64>,
    /// Gear down.
    pub gear_down: bool,
    /// SCAS on, centred.
    pub scas_on: bool,
}

impl Default for Condition {
    /// Hover as a helicopter at sea level, tanks full, far from the ground.
    fn default() -> Self {
        Self {
            nacelle_deg: 90.0,
            speed_kt: 0.0,
            climb_fpm: 0.0,
            lever_percent: None,
            turn_degps: 0.0,
            bank_deg: None,
            sideslip_deg: 0.0,
            weight_lb: None,
            altitude_ft: 0.0,
            height_ft: None,
            isa_k: 0.0,
            flap_deg: None,
            rpm: None,
            gear_down: false,
            scas_on: false,
        }
    }
}

/// A number of a condition, and what it may be.
struct Range {
    name: &'static str,
    unit: &'static str,
    least: f64,
    greatest: f64,
    of: fn(&Condition) -> Option<f64>,
}

const fn range(
    name: &'static str,
    unit: &'static str,
    (least, greatest): (f64, f64),
    of: fn(&Condition) -> Option<f64>,
) -> Range {
    Range { name, unit, least, greatest, of }
}

/// The least and the greatest of each number that is asked for.
pub mod limits {
    /// Nacelle incidence, deg: a degree beyond the stops, for trims at a stop.
    pub const NACELLE_DEG: (f64, f64) = (-1.0, 96.0);
    /// True airspeed, kt: backwards as far as helicopters fly so.
    pub const SPEED_KT: (f64, f64) = (-60.0, 400.0);
    /// Rate of climb, ft/min.
    pub const CLIMB_FPM: (f64, f64) = (-20_000.0, 20_000.0);
    /// Power lever, % of its travel.
    pub const LEVER_PERCENT: (f64, f64) = (0.0, 100.0);
    /// Rate of turn, deg/s.
    pub const TURN_DEGPS: (f64, f64) = (-90.0, 90.0);
    /// Bank of a turn, deg.
    pub const BANK_DEG: (f64, f64) = (-75.0, 75.0);
    /// Sideslip, deg.
    pub const SIDESLIP_DEG: (f64, f64) = (-180.0, 180.0);
    /// Gross weight, lb.
    pub const WEIGHT_LB: (f64, f64) = (2_500.0, 44_000.0);
    /// Above mean sea level, ft: as far as there is air.
    pub const ALTITUDE_FT: (f64, f64) = (-6_000.0, 60_000.0);
    /// Centre of gravity above the ground, ft.
    pub const HEIGHT_FT: (f64, f64) = (0.0, 60_000.0);
    /// Warmer than the standard atmosphere by, K.
    pub const ISA_K: (f64, f64) = (-80.0, 80.0);
    /// Flap lever, deg.
    pub const FLAP_DEG: (f64, f64) = (0.0, 90.0);
    /// Rotor speed, rpm.
    pub const RPM: (f64, f64) = (0.0, 2_000.0);
}

const RANGES: [Range; 13] = [
    range("nacelle_deg", "deg", limits::NACELLE_DEG, |c| Some(c.nacelle_deg)),
    range("speed_kt", "kt", limits::SPEED_KT, |c| Some(c.speed_kt)),
    range("climb_fpm", "ft/min", limits::CLIMB_FPM, |c| Some(c.climb_fpm)),
    range("lever_percent", "%", limits::LEVER_PERCENT, |c| c.lever_percent),
    range("turn_degps", "deg/s", limits::TURN_DEGPS, |c| Some(c.turn_degps)),
    range("bank_deg", "deg", limits::BANK_DEG, |c| c.bank_deg),
    range("sideslip_deg", "deg", limits::SIDESLIP_DEG, |c| Some(c.sideslip_deg)),
    range("weight_lb", "lb", limits::WEIGHT_LB, |c| c.weight_lb),
    range("altitude_ft", "ft", limits::ALTITUDE_FT, |c| Some(c.altitude_ft)),
    range("height_ft", "ft", limits::HEIGHT_FT, |c| c.height_ft),
    range("isa_k", "K", limits::ISA_K, |c| Some(c.isa_k)),
    range("flap_deg", "deg", limits::FLAP_DEG, |c| c.flap_deg),
    range("rpm", "rpm", limits::RPM, |c| c.rpm),
];

/// Why nothing flies so.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// A number that no condition has.
    Number {
        /// Which.
        name: &'static str,
        /// As asked for.
        value: f64,
        /// The least that is flown.
        least: f64,
        /// The greatest.
        greatest: f64,
        /// The unit of all three.
        unit: &'static str,
    },
    /// The flap lever has no such detent.
    Flap {
        /// As asked for, deg.
        wanted_deg: f64,
        /// The detents, deg.
        offered_deg: [f64; 4],
    },
    /// The governor has no such speed.
    Rpm {
        /// As asked for, rpm.
        wanted: f64,
        /// The speeds, rpm.
        offered: [f64; 3],
    },
    /// A speed of the aeroplane with the nacelles not down.
    RpmOfTheAeroplane {
        /// As asked for, rpm.
        wanted: f64,
    },
    /// A bank that is no turn.
    Bank,
    /// A weight that no such aircraft has.
    Weight {
        /// As asked for, lb.
        weight_lb: f64,
    },
}

/// `0, 20, 40, 75`.
fn listed(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|number| format!("{number:.0}")).collect();
    numbers.join(", ")
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { name, value, least, greatest, unit } => {
                write!(f, "{name} {value}: expected {least} to {greatest} {unit}")
            }
            Self::Flap { wanted_deg, offered_deg } => {
                write!(
                    f,
                    "flap {wanted_deg} deg: the lever has detents at {} deg",
                    listed(offered_deg)
                )
            }
            Self::Rpm { wanted, offered } => {
                write!(f, "rotor speed {wanted} rpm: the governor offers {} rpm", listed(offered))
            }
            Self::RpmOfTheAeroplane { wanted } => {
                write!(f, "rotor speed {wanted} rpm: only with the nacelles down, at 0 deg")
            }
            Self::Bank => f.write_str("bank: expected up to 75 deg, and some speed to turn with"),
            Self::Weight { weight_lb } => {
                write!(f, "{weight_lb:.0} lb: no weight of such an aircraft")
            }
        }
    }
}

impl core::error::Error for Fault {}

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

/// The detent of a flap lever position, or the one next to the usual position at a nacelle incidence.
///
/// # Errors
/// When the lever has no such detent.
pub fn flap_detent(
    aircraft: &Aircraft,
    flap_deg: Option<f64>,
    nacelle_deg: f64,
) -> Result<u64, Fault> {
    let offered_deg = aircraft.fcc.mixer.flap_rad.map(|rad| rad * DEG_PER_RAD);
    let wanted_deg = flap_deg.unwrap_or_else(|| {
        // Another aircraft has other detents: the one next to what the reference model uses.
        let usual_deg = usual_flap_deg(nacelle_deg);
        let nearer =
            |a: f64, b: f64| if (b - usual_deg).abs() < (a - usual_deg).abs() { b } else { a };
        offered_deg.into_iter().reduce(nearer).unwrap_or(usual_deg)
    });
    let detent = offered_deg.iter().position(|deg| (deg - wanted_deg).abs() < 0.5);
    detent.map(|detent| detent as u64).ok_or(Fault::Flap { wanted_deg, offered_deg })
}

/// The number of a rotor speed, or of the usual one at a nacelle incidence.
///
/// # Errors
/// When the governor has no such speed, or not at that incidence.
pub fn rpm_select(aircraft: &Aircraft, rpm: Option<f64>, nacelle_deg: f64) -> Result<u64, Fault> {
    let offered = aircraft.fcc.governor.rotor_speed_radps.map(|radps| radps / RPM_RADPS);
    let Some(wanted) = rpm else {
        return Ok(if nacelle_deg < 1.0 { engine::cockpit::RPM_SELECT_LAST } else { 0 });
    };
    match offered.iter().position(|offer| (offer - wanted).abs() < 1.0) {
        Some(0) => Ok(0),
        Some(number) if nacelle_deg < 1.0 => Ok(number as u64),
        Some(_) => Err(Fault::RpmOfTheAeroplane { wanted }),
        None => Err(Fault::Rpm { wanted, offered }),
    }
}

/// The aircraft at a gross mass, and its fuel in kg: by the fuel where that can be, by the empty mass
/// otherwise.
///
/// # Errors
/// When no such aircraft has that mass.
pub fn weigh(aircraft: &Aircraft, mass_kg: f64) -> Result<(Aircraft, f64), Fault> {
    let weights = &aircraft.weight_balance;
    let fuel_kg = mass_kg - weights.zero_fuel_mass_kg;
    if fuel_kg > 0.0 && fuel_kg <= weights.fuel_kg_max + 1.0 {
        return Ok((aircraft.clone(), fuel_kg));
    }
    let fuel_kg = min(0.5 * weights.fuel_kg_max, 0.1 * mass_kg);
    if mass_kg.is_finite() && mass_kg > 1000.0 && mass_kg < 20_000.0 {
        let zero_fuel_mass_kg = mass_kg - fuel_kg;
        let loaded =
            aircraft.clone().with(|a| a.weight_balance.zero_fuel_mass_kg = zero_fuel_mass_kg);
        Ok((loaded, fuel_kg))
    } else {
        Err(Fault::Weight { weight_lb: mass_kg / POUND_KG })
    }
}

impl Condition {
    /// The aircraft, as heavy as asked for, and the flight.
    ///
    /// # Errors
    /// When nothing flies so.
    pub fn target(&self, aircraft: &Aircraft) -> Result<(Aircraft, Target), Fault> {
        self.within()?;
        let airspeed_mps = self.speed_kt * KNOT_MPS;
        let (aircraft, fuel_kg) = match self.weight_lb {
            Some(weight_lb) => weigh(aircraft, weight_lb * POUND_KG)?,
            None => (aircraft.clone(), aircraft.weight_balance.fuel_kg_max),
        };
        let target = Target {
            mast_tilt_rad: (90.0 - self.nacelle_deg) / DEG_PER_RAD,
            airspeed_mps,
            power: match self.lever_percent {
                Some(percent) => Power::Lever(0.01 * percent),
                None => Power::Climb(self.climb_fpm * FOOT_M / 60.0),
            },
            turn_radps: self.turn_radps(airspeed_mps)?,
            sideslip_rad: self.sideslip_deg / DEG_PER_RAD,
            altitude_m: self.altitude_ft * FOOT_M,
            fuel_kg,
            flap_detent: flap_detent(&aircraft, self.flap_deg, self.nacelle_deg)?,
            rpm_select: rpm_select(&aircraft, self.rpm, self.nacelle_deg)?,
            gear_down: u64::from(self.gear_down),
            scas_on: u64::from(self.scas_on),
            ..Target::default()
        };
        let mut world = target.world;
        world.temperature_offset_k = self.isa_k;
        if let Some(height_ft) = self.height_ft {
            world = world.with_ground((self.altitude_ft - height_ft) * FOOT_M);
        }
        Ok((aircraft, Target { world, ..target }))
    }

    /// The table `[trim]` of a scenario that begins in this flight. It has a nacelle incidence, speed,
    /// altitude, climb, flap, rotor speed and SCAS; the rest is the scenario's.
    ///
    /// # Errors
    /// When nothing flies so.
    pub fn start_toml(&self, aircraft: &Aircraft, by: &str) -> Result<String, Fault> {
        self.within()?;
        let detent = flap_detent(aircraft, self.flap_deg, self.nacelle_deg)?;
        let rpm_select = rpm_select(aircraft, self.rpm, self.nacelle_deg)?;
        Ok(format!(
            "\n[trim] # by {by}\nmast_tilt_deg = {:?}\nairspeed_kt = {:?}\n\
             altitude_ft = {:?}\nclimb_fpm = {:?}\nflap_detent = {detent}\n\
             rpm_select = {rpm_select}\nscas_on = {}\n",
            90.0 - self.nacelle_deg,
            self.speed_kt,
            self.altitude_ft,
            self.climb_fpm,
            u64::from(self.scas_on),
        ))
    }

    /// Whether every number is one that is flown.
    fn within(&self) -> Result<(), Fault> {
        for Range { name, unit, least, greatest, of } in RANGES {
            match of(self) {
                Some(value) if !(least..=greatest).contains(&value) => {
                    return Err(Fault::Number { name, value, least, greatest, unit });
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn turn_radps(&self, airspeed_mps: f64) -> Result<f64, Fault> {
        let Some(bank_deg) = self.bank_deg else { return Ok(self.turn_degps / DEG_PER_RAD) };
        if airspeed_mps < 5.0 || bank_deg.abs() > 75.0 {
            return Err(Fault::Bank);
        }
        Ok(GRAVITY_MPS2 * tan(bank_deg / DEG_PER_RAD) / airspeed_mps)
    }
}

#[cfg(test)]
mod tests {
    use alloc::string::ToString;

    use super::*;

    fn xv15() -> Aircraft {
        aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap()
    }

    /// 589 rpm as a helicopter, 458 or 517 with the nacelles down.
    #[test]
    fn a_rotor_speed_is_one_that_the_governor_has_at_these_nacelles() {
        let xv15 = xv15();
        let select = |rpm, nacelle_deg| rpm_select(&xv15, rpm, nacelle_deg);
        for (rpm, nacelle_deg, number) in [
            (None, 90.0, 0),
            (None, 1.0, 0),
            (None, 0.5, 2),
            (Some(589.0), 90.0, 0),
            (Some(589.9), 0.0, 0),
            (Some(516.5), 0.0, 1),
            (Some(458.0), 0.9, 2),
        ] {
            assert_eq!(select(rpm, nacelle_deg).ok(), Some(number), "{rpm:?} at {nacelle_deg} deg");
        }
        assert!(matches!(select(Some(517.0), 1.0), Err(Fault::RpmOfTheAeroplane { .. })));
        for wanted in [591.0, 500.0, 0.0] {
            let Err(Fault::Rpm { offered, .. }) = select(Some(wanted), 0.0) else {
                panic!("{wanted} rpm")
            };
            let printed = [589.0, 517.0, 458.0];
            assert!(offered.iter().zip(printed).all(|(a, b)| (a - b).abs() < 1e-6), "{offered:?}");
        }
    }

    #[test]
    fn a_flap_setting_is_a_detent_or_the_usual_one_at_these_nacelles() {
        let xv15 = xv15();
        let detent = |flap_deg, nacelle_deg| flap_detent(&xv15, flap_deg, nacelle_deg);
        for (flap_deg, nacelle_deg, number) in [
            (Some(0.0), 90.0, 0),
            (Some(20.4), 90.0, 1),
            (Some(39.6), 0.0, 2),
            (Some(75.0), 0.0, 3),
            (None, 90.0, 2),
            (None, 75.0, 1),
            (None, 15.1, 1),
            (None, 15.0, 0),
        ] {
            let found = detent(flap_deg, nacelle_deg).ok();
            assert_eq!(found, Some(number), "{flap_deg:?} at {nacelle_deg} deg");
        }
        assert!(matches!(detent(Some(30.0), 90.0), Err(Fault::Flap { .. })));
    }

    #[test]
    fn what_is_no_number_of_a_flight_is_refused_with_its_unit() {
        for (condition, words) in [
            (
                Condition { speed_kt: f64::NAN, ..Condition::default() },
                "speed_kt NaN: expected -60 to 400 kt",
            ),
            (
                Condition { weight_lb: Some(1.0), ..Condition::default() },
                "weight_lb 1: expected 2500 to 44000 lb",
            ),
            (
                Condition { rpm: Some(f64::INFINITY), ..Condition::default() },
                "rpm inf: expected 0 to 2000 rpm",
            ),
        ] {
            let fault = condition.within().err().map(|fault| fault.to_string());
            assert_eq!(fault.as_deref(), Some(words));
        }
    }
}
