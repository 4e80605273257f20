//! The state in which a flight begins, as its scenario says.

use engine::start::Start;
use engine::{Aircraft, State};

use crate::trim::{Failure, Power, Target, trim};

/// The state at tick 0: standing on the wheels, or, where the scenario has a `[trim]`, in that steady
/// flight. It is recorded: a log is reflown without it.
///
/// # Errors
/// When the steady flight in which it is to begin does not exist.
pub fn state_at(start: &Start, aircraft: &Aircraft) -> Result<State, Failure> {
    let Some(flight) = start.trim else { return Ok(start.on_wheels(aircraft)) };
    let target = Target {
        mast_tilt_rad: flight.mast_tilt_rad,
        airspeed_mps: flight.airspeed_mps,
        power: Power::Climb(flight.climb_mps),
        turn_radps: flight.turn_radps,
        sideslip_rad: 0.0,
        heading_rad: start.heading_rad,
        altitude_m: flight.altitude_m,
        origin: start.origin,
        fuel_kg: start.fuel_aboard_kg(aircraft),
        flap_detent: flight.flap_detent.unwrap_or(start.flap_detent),
        rpm_select: flight.rpm_select,
        gear_down: flight.gear_down,
        scas_on: flight.scas_on,
        world: start.world.world(),
    };
    let mut state = trim(aircraft, &target)?.state;
    state.environment.noise = start.world.turbulence_seed;
    Ok(state)
}
