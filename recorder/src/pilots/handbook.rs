//! What a pilot model knows of the aircraft it flies: numbers of the aircraft's file, in one place.

use engine::Aircraft;
use engine::envelope::Corridor;
use engine::units::KNOT_MPS;

/// How far below the gear's own limit the pilot moves it, m/s: 10 kt.
const GEAR_MARGIN_MPS: f64 = 10.0 * KNOT_MPS;

/// The flap lever's detents by what they are for, the same in every aircraft; the angles are the aircraft's.
pub mod detent {
    /// Of an aeroplane.
    pub const AEROPLANE: u64 = 0;
    /// Of a conversion, and of a slow aeroplane.
    pub const CONVERSION: u64 = 1;
    /// Of a helicopter.
    pub const HELICOPTER: u64 = 2;
}

/// The aircraft's limits and speeds.
#[derive(Clone, Debug)]
pub struct Handbook {
    /// Airspeeds at which a mast tilt is flown.
    pub corridor: Corridor,
    /// Speeds to fly, and how the aircraft answers.
    pub pilot: engine::pilot::Params,
    /// Rotor speed at which the nacelles move.
    pub conversion_radps: f64,
    /// Torque of a mast that is not exceeded for long.
    pub torque_n_m_max: f64,
    /// Calibrated airspeed above which the gear stays as it is.
    pub gear_mps_max: f64,
    /// Mast tilt with the nacelles at their aft stop.
    pub aft_rad: f64,
}

impl Handbook {
    /// Of an aircraft.
    pub fn of(aircraft: &Aircraft) -> Self {
        Self {
            corridor: aircraft.envelope.corridor.clone(),
            pilot: aircraft.pilot,
            conversion_radps: aircraft.fcc.governor.rotor_speed_radps[0],
            torque_n_m_max: aircraft.engines.torque_n_m_max,
            gear_mps_max: aircraft.envelope.airspeed.gear_cycle_mps_max - GEAR_MARGIN_MPS,
            aft_rad: aircraft.actuators.mast_tilt_rad_min,
        }
    }
}
