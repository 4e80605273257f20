//! FGNetFDM version 24: an aircraft as FlightGear's `--native-fdm` reads it, in 408 bytes.
//!
//! # Equations
//! ```text
//! position on the wire = degrees / 57.295 776 367 187 5
//! slip ball = atan2(−f_y, max(−f_z, 1 ft/s²))              f: specific force, body axes
//! ```
//! FlightGear turns latitude and longitude into degrees with a single-precision 180/π, which is
//! 5.5e-8 too small: sent as true radians, the aircraft would stand up to a metre beside its place.
//! They are therefore divided by FlightGear's own factor. The angles of single precision need no
//! such care.
//!
//! # Signs
//! Big-endian throughout. A little-endian packet, or a count beyond its array, does not upset
//! FlightGear: it kills it. Roll right, pitch up, clockwise heading, climb and wind from the right
//! (β) are positive. Surfaces: elevator, flap and each aileron trailing edge down, rudder trailing
//! edge right. Slip ball to the right. Engines: left, right. Wheels: nose, left, right.
//!
//! # Assumptions
//! The place is that of a fixed point of the structure, the centre of gravity as a helicopter: the
//! model must not shift in it as the nacelles tilt. The accelerations are those of the centre of
//! gravity, although FlightGear calls them the pilot's: the aircraft file holds no seat. Height above mean sea level is given as
//! FlightGear's, which is above the ellipsoid. One tank holds all fuel. The engine model gives the
//! fuel flow of both engines together; it is split as the power is. Pressures and temperatures of
//! the engines are not modelled: what is sent moves with their power, for display only.
//!
//! # Source
//! The offsets were produced by a compiler from FlightGear 2020.3's header and read back from the
//! running program. Version 25 was never released.

use engine::display::{Travel, Travels};
use engine::frames::{Body, Vec3};
use engine::math::{TAU, atan2, clamp, max, wrap_angle};
use engine::outputs::Validity;
use engine::pair::Pair;
use engine::units::{DEG_PER_RAD, FOOT_M, HOUR_S, KNOT_MPS, POUND_KG, RPM_PER_RADPS};
use zerocopy::network_endian::{F32, F64, I32, U32};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

use crate::channel::between;
use crate::display;
use crate::scene::Scene;

/// The version of the format.
pub const VERSION: u32 = 24;
/// Bytes of a packet.
pub const LENGTH: usize = 408;
/// FlightGear's room for engines, which it does not check.
pub const ENGINES_MAX: usize = 4;
/// FlightGear's room for tanks, which it does not check.
pub const TANKS_MAX: usize = 4;
/// FlightGear's room for wheels, which it does not check.
pub const WHEELS_MAX: usize = 3;

/// FlightGear's degrees per radian for latitude and longitude: 180/π in single precision.
pub const POSITION_DEG_PER_RAD: f64 = 57.295_776_367_187_5;

/// [`NetFdm::eng_state`] of an engine that stands.
pub const ENGINE_OFF: u32 = 0;
/// [`NetFdm::eng_state`] of an engine that runs.
pub const ENGINE_RUNNING: u32 = 2;

/// [`NetFdm::agl_m`] that leaves the height above ground to FlightGear, which knows its scenery.
const AGL_UNKNOWN_M: f64 = -9999.0;

/// JP-4 at 6.5 lb per US gallon, which makes the XV-15 tanks their 229 gallons. `R+`
const FUEL_KG_PER_GAL: f64 = 6.5 * POUND_KG;

/// One packet, as it is on the wire.
///
/// Fields are named as FlightGear names them, with their units added.
#[derive(
    Clone, Copy, Debug, PartialEq, IntoBytes, FromBytes, KnownLayout, Immutable, Unaligned,
)]
#[repr(C)]
pub struct NetFdm {
    /// [`VERSION`].
    pub version: U32,
    /// Aligns what follows; ignored.
    pub padding: U32,
    /// Longitude, east positive, rad of FlightGear's: see [`NetFdm::longitude_deg`].
    pub longitude_rad: F64,
    /// Geodetic latitude, north positive, rad of FlightGear's: see [`NetFdm::latitude_deg`].
    pub latitude_rad: F64,
    /// Height above FlightGear's sea level, m.
    pub altitude_m: F64,
    /// Height above ground, m; −9999 leaves it to FlightGear.
    pub agl_m: F32,
    /// Roll, rad.
    pub phi_rad: F32,
    /// Pitch, rad.
    pub theta_rad: F32,
    /// True heading, rad, 0..2π: FlightGear does not wrap it.
    pub psi_rad: F32,
    /// Angle of attack, rad.
    pub alpha_rad: F32,
    /// Sideslip, wind from the right positive, rad.
    pub beta_rad: F32,
    /// Rate of roll, rad/s.
    pub phidot_radps: F32,
    /// Rate of pitch, rad/s.
    pub thetadot_radps: F32,
    /// Rate of heading, rad/s.
    pub psidot_radps: F32,
    /// Calibrated airspeed, kt.
    pub vcas_kt: F32,
    /// Climb, ft/s.
    pub climb_rate_ftps: F32,
    /// Over the ground northwards, ft/s.
    pub v_north_ftps: F32,
    /// Over the ground eastwards, ft/s.
    pub v_east_ftps: F32,
    /// Over the ground downwards, ft/s.
    pub v_down_ftps: F32,
    /// Over the ground along body x, ft/s.
    pub v_body_u_ftps: F32,
    /// Over the ground along body y, ft/s.
    pub v_body_v_ftps: F32,
    /// Over the ground along body z, ft/s.
    pub v_body_w_ftps: F32,
    /// Specific force along body x, ft/s².
    pub a_x_pilot_ftps2: F32,
    /// Specific force along body y, ft/s².
    pub a_y_pilot_ftps2: F32,
    /// Specific force along body z, ft/s²; −32.17 in level flight.
    pub a_z_pilot_ftps2: F32,
    /// 0 or 1: a rotor is stalled or in its own wake.
    pub stall_warning: F32,
    /// Slip ball, to the right positive, deg.
    pub slip_deg: F32,
    /// Engines that follow, at most [`ENGINES_MAX`].
    pub num_engines: U32,
    /// [`ENGINE_OFF`], 1 while cranking, or [`ENGINE_RUNNING`].
    pub eng_state: [U32; ENGINES_MAX],
    /// Rotor speed, rev/min.
    pub rpm: [F32; ENGINES_MAX],
    /// Fuel flow, US gal/h.
    pub fuel_flow_gph: [F32; ENGINES_MAX],
    /// Fuel pressure, psi; for display only.
    pub fuel_px_psi: [F32; ENGINES_MAX],
    /// Exhaust gas temperature, °F; for display only.
    pub egt_degf: [F32; ENGINES_MAX],
    /// Cylinder head temperature, °F; there are none.
    pub cht_degf: [F32; ENGINES_MAX],
    /// Manifold pressure, inHg; there is none.
    pub mp_osi_inhg: [F32; ENGINES_MAX],
    /// Turbine inlet temperature, of no stated unit; not modelled.
    pub tit: [F32; ENGINES_MAX],
    /// Oil temperature, °F; for display only.
    pub oil_temp_degf: [F32; ENGINES_MAX],
    /// Oil pressure, psi; for display only.
    pub oil_px_psi: [F32; ENGINES_MAX],
    /// Tanks that follow, at most [`TANKS_MAX`].
    pub num_tanks: U32,
    /// Fuel, US gal.
    pub fuel_quantity_gal: [F32; TANKS_MAX],
    /// Wheels that follow, at most [`WHEELS_MAX`].
    pub num_wheels: U32,
    /// 1 while the wheel bears weight.
    pub wow: [U32; WHEELS_MAX],
    /// 0 up … 1 down.
    pub gear_pos_norm: [F32; WHEELS_MAX],
    /// Steering, right positive: the nose wheel as it casters along its way; 1 is a radian.
    pub gear_steer_norm: [F32; WHEELS_MAX],
    /// 0 extended … 1 fully compressed.
    pub gear_compression_norm: [F32; WHEELS_MAX],
    /// Unix time, s; ignored.
    pub cur_time_s: U32,
    /// Offset of the time, s; ignored.
    pub warp_s: I32,
    /// Visibility, m; ignored.
    pub visibility_m: F32,
    /// Elevator, trailing edge down positive; 1 is full travel (20°).
    pub elevator_norm: F32,
    /// Elevator trim tab; there is none.
    pub elevator_trim_tab_norm: F32,
    /// Left flap, down positive; 1 is full travel (75°). FlightGear overwrites it with the right one.
    pub left_flap_norm: F32,
    /// Right flap, down positive; 1 is full travel (75°).
    pub right_flap_norm: F32,
    /// Left flaperon beyond the flap's setting, trailing edge down positive; 1 is full travel up (23.8°).
    pub left_aileron_norm: F32,
    /// Right flaperon beyond the flap's setting, trailing edge down positive; 1 is full travel up (23.8°).
    pub right_aileron_norm: F32,
    /// Rudders, trailing edge right positive; 1 is full travel (20°).
    pub rudder_norm: F32,
    /// Nose wheel, as [`NetFdm::gear_steer_norm`].
    pub nose_wheel_norm: F32,
    /// Speed brake; there is none.
    pub speedbrake_norm: F32,
    /// Spoilers; there are none.
    pub spoilers_norm: F32,
}

const _: () = assert!(size_of::<NetFdm>() == LENGTH);

/// Why bytes are not a packet.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PacketError {
    /// Too short or too long.
    #[error("packet of {got} bytes, expected {LENGTH}")]
    Length {
        /// Bytes received.
        got: usize,
    },
    /// Another version, or another byte order.
    #[error("packet version {got}, expected {VERSION}")]
    Version {
        /// Version received.
        got: u32,
    },
    /// A count that FlightGear would follow out of its array.
    #[error("{field} is {got}, expected at most {most}")]
    Count {
        /// Field of [`NetFdm`].
        field: &'static str,
        /// Count received.
        got: u32,
        /// Room for them.
        most: usize,
    },
    /// A NaN or an infinity.
    #[error("{field} is not a finite number")]
    NotFinite {
        /// Field of [`NetFdm`].
        field: &'static str,
    },
}

impl NetFdm {
    /// What FlightGear is to show of a moment. Whatever is not a finite number is sent as 0.
    pub fn of(scene: &Scene<'_>) -> Self {
        let outputs = scene.outputs;
        let velocity = outputs.velocity_mps * (1.0 / FOOT_M);
        let body_velocity = outputs.body_velocity_mps * (1.0 / FOOT_M);
        let specific_force = outputs.specific_force_mps2 * (1.0 / FOOT_M);
        let rest = Self { version: U32::new(VERSION), ..zerocopy::FromZeros::new_zeroed() };
        Self {
            longitude_rad: position(wrap_angle(outputs.place.longitude_rad)),
            latitude_rad: position(outputs.place.latitude_rad),
            altitude_m: double(outputs.place.height_m),
            agl_m: single(AGL_UNKNOWN_M),
            phi_rad: single(outputs.euler.roll_rad),
            theta_rad: single(outputs.euler.pitch_rad),
            psi_rad: heading(outputs.euler.heading_rad),
            alpha_rad: single(outputs.alpha_rad),
            beta_rad: single(outputs.beta_rad),
            phidot_radps: single(outputs.euler_rate.roll_radps),
            thetadot_radps: single(outputs.euler_rate.pitch_radps),
            psidot_radps: single(outputs.euler_rate.heading_radps),
            vcas_kt: single(outputs.calibrated_airspeed_mps / KNOT_MPS),
            climb_rate_ftps: single(-velocity.z),
            v_north_ftps: single(velocity.x),
            v_east_ftps: single(velocity.y),
            v_down_ftps: single(velocity.z),
            v_body_u_ftps: single(body_velocity.x),
            v_body_v_ftps: single(body_velocity.y),
            v_body_w_ftps: single(body_velocity.z),
            a_x_pilot_ftps2: single(specific_force.x),
            a_y_pilot_ftps2: single(specific_force.y),
            a_z_pilot_ftps2: single(specific_force.z),
            stall_warning: stall_warning(outputs.validity),
            slip_deg: slip(outputs.specific_force_mps2),
            ..rest
        }
        .with_engines(scene)
        .with_gear(scene)
        .with_surfaces(scene)
    }

    fn with_engines(self, scene: &Scene<'_>) -> Self {
        let outputs = scene.outputs;
        let flow_gph = display::fuel_flow_kg_per_s(&outputs.engines)
            .map(|flow_kg_per_s| flow_kg_per_s * HOUR_S / FUEL_KG_PER_GAL);
        let fuel_gal = outputs.fuel_kg / FUEL_KG_PER_GAL;
        Self {
            num_engines: U32::new(2),
            eng_state: engine_states(&outputs.engines),
            rpm: engines(Pair::both(outputs.rotor_speed_radps * RPM_PER_RADPS)),
            fuel_flow_gph: engines(flow_gph),
            fuel_px_psi: engines(display::fuel_psi(scene)),
            egt_degf: engines(display::exhaust_gas_degf(scene)),
            oil_temp_degf: engines(display::oil_degf(scene)),
            oil_px_psi: engines(display::oil_psi(scene)),
            num_tanks: U32::new(1),
            fuel_quantity_gal: [single(fuel_gal), F32::ZERO, F32::ZERO, F32::ZERO],
            ..self
        }
    }

    fn with_gear(self, scene: &Scene<'_>) -> Self {
        let wheels = [0, 1, 2].map(|index| display::leg(scene.outputs, index));
        let gear = &scene.aircraft.landing_gear;
        let strokes_m = [gear.nose.stroke_m, gear.main.stroke_m, gear.main.stroke_m];
        let extension = single(scene.outputs.actuators.gear_extension_norm);
        let steer = single(display::castor_rad(scene) / display::CASTOR_RAD_MAX);
        let compression =
            |index: usize| single(clamp(wheels[index].compression_m / strokes_m[index], 0.0, 1.0));
        Self {
            num_wheels: U32::new(3),
            wow: wheels.map(|leg| U32::new(u32::from(leg.push_n > 0.0))),
            gear_pos_norm: [extension; WHEELS_MAX],
            gear_steer_norm: [steer, F32::ZERO, F32::ZERO],
            gear_compression_norm: [0, 1, 2].map(compression),
            nose_wheel_norm: steer,
            ..self
        }
    }

    fn with_surfaces(self, scene: &Scene<'_>) -> Self {
        let surfaces = &scene.outputs.actuators;
        let travels = Travels::of(&scene.aircraft.actuators);
        let part = |angle_rad: f64, travel: &Travel| single(angle_rad / travel.greatest_rad());
        let flap_norm = part(surfaces.flap_rad, &travels.flap);
        Self {
            elevator_norm: part(surfaces.elevator_rad, &travels.elevator),
            left_flap_norm: flap_norm,
            right_flap_norm: flap_norm,
            left_aileron_norm: part(surfaces.flaperon_rad.left, &travels.flaperon),
            right_aileron_norm: part(surfaces.flaperon_rad.right, &travels.flaperon),
            rudder_norm: part(surfaces.rudder_right_rad, &travels.rudder),
            ..self
        }
    }

    /// Reads a packet, and refuses one that would harm FlightGear or mislead a receiver.
    pub fn parse(bytes: &[u8]) -> Result<Self, PacketError> {
        let packet =
            Self::read_from_bytes(bytes).map_err(|_| PacketError::Length { got: bytes.len() })?;
        if packet.version.get() != VERSION {
            return Err(PacketError::Version { got: packet.version.get() });
        }
        for (field, count, most) in [
            ("num_engines", packet.num_engines, ENGINES_MAX),
            ("num_tanks", packet.num_tanks, TANKS_MAX),
            ("num_wheels", packet.num_wheels, WHEELS_MAX),
        ] {
            if count.get() as usize > most {
                return Err(PacketError::Count { field, got: count.get(), most });
            }
        }
        match packet.first_not_finite() {
            Some(field) => Err(PacketError::NotFinite { field }),
            None => Ok(packet),
        }
    }

    /// The packet as it is sent.
    pub fn bytes(&self) -> &[u8] {
        self.as_bytes()
    }

    /// Longitude as FlightGear understands it, deg.
    pub fn longitude_deg(&self) -> f64 {
        self.longitude_rad.get() * POSITION_DEG_PER_RAD
    }

    /// Latitude as FlightGear understands it, deg.
    pub fn latitude_deg(&self) -> f64 {
        self.latitude_rad.get() * POSITION_DEG_PER_RAD
    }
}

/// Single precision; 0 for what is not finite there, and no −0, which displays would show.
fn single(value: f64) -> F32 {
    let narrow = value as f32 + 0.0;
    F32::new(if narrow.is_finite() { narrow } else { 0.0 })
}

/// 0 for what is not finite, and no −0.
fn double(value: f64) -> F64 {
    F64::new(if value.is_finite() { value + 0.0 } else { 0.0 })
}

/// Latitude or longitude in FlightGear's radians.
fn position(angle_rad: f64) -> F64 {
    double(angle_rad * DEG_PER_RAD / POSITION_DEG_PER_RAD)
}

/// Heading from 0 up to, but without, 2π, also after rounding.
fn heading(heading_rad: f64) -> F32 {
    let wrapped_rad = wrap_angle(heading_rad);
    let positive = single(if wrapped_rad < 0.0 { wrapped_rad + TAU } else { wrapped_rad });
    if positive.get() < TAU as f32 { positive } else { F32::ZERO }
}

/// To a pilot both mean that the rotors no longer carry what is asked of them.
fn stall_warning(validity: Validity) -> F32 {
    let stalled = validity.intersects(Validity::ROTOR_STALL | Validity::VORTEX_RING);
    single(if stalled { 1.0 } else { 0.0 })
}

/// The ball hangs along the apparent weight. In free fall it has none and stays in its tube.
fn slip(specific_force_mps2: Vec3<Body>) -> F32 {
    let up_mps2 = max(-specific_force_mps2.z, FOOT_M);
    single(atan2(-specific_force_mps2.y, up_mps2) * DEG_PER_RAD)
}

fn engines(each: Pair<f64>) -> [F32; ENGINES_MAX] {
    [single(each.left), single(each.right), F32::ZERO, F32::ZERO]
}

fn engine_states(engines: &engine::engines::Outputs) -> [U32; ENGINES_MAX] {
    let state = |index| {
        let runs = display::runs(engines, index);
        U32::new(if runs { ENGINE_RUNNING } else { ENGINE_OFF })
    };
    [state(0), state(1), U32::ZERO, U32::ZERO]
}

/// Fields of floating-point numbers.
trait Floats {
    /// Whether all are finite.
    fn all_finite(&self) -> bool;
    /// `part` of the way to others, the shorter way round where they start again at `wrap`.
    fn toward(self, to: Self, part: f64, wrap: f64) -> Self;
}

impl Floats for F32 {
    fn all_finite(&self) -> bool {
        self.get().is_finite()
    }

    fn toward(self, to: Self, part: f64, wrap: f64) -> Self {
        single(between(f64::from(self.get()), f64::from(to.get()), part, wrap))
    }
}

impl Floats for F64 {
    fn all_finite(&self) -> bool {
        self.get().is_finite()
    }

    fn toward(self, to: Self, part: f64, wrap: f64) -> Self {
        double(between(self.get(), to.get(), part, wrap))
    }
}

impl<const N: usize> Floats for [F32; N] {
    fn all_finite(&self) -> bool {
        self.iter().all(Floats::all_finite)
    }

    fn toward(mut self, to: Self, part: f64, wrap: f64) -> Self {
        for (from, to) in self.iter_mut().zip(to) {
            *from = from.toward(to, part, wrap);
        }
        self
    }
}

/// Names every field without a rest pattern: a new field that is forgotten here does not compile.
macro_rules! fields {
    (integers { $($integer:ident),+ $(,)? } floats { $($float:ident),+ $(,)? }) => {
        impl NetFdm {
            fn first_not_finite(&self) -> Option<&'static str> {
                let Self { $($integer: _,)+ $($float),+ } = self;
                $(if !$float.all_finite() {
                    return Some(stringify!($float));
                })+
                None
            }

            /// Between two packets, `part` of the way from one to the other, for display only:
            /// numbers that are counted are those of the nearer one.
            #[must_use]
            pub fn between(from: &Self, to: &Self, part: f64) -> Self {
                let mut packet = if part < 0.5 { *from } else { *to };
                $(packet.$float = from.$float.toward(to.$float, part, wrap(stringify!($float)));)+
                packet
            }
        }
    };
}

/// Where a field starts again; 0 where it does not.
fn wrap(field: &str) -> f64 {
    match field {
        "psi_rad" | "phi_rad" => TAU,
        "longitude_rad" => 360.0 / POSITION_DEG_PER_RAD,
        _ => 0.0,
    }
}

fields! {
    integers {
        version, padding, num_engines, eng_state, num_tanks, num_wheels, wow, cur_time_s, warp_s,
    }
    floats {
        longitude_rad, latitude_rad, altitude_m, agl_m, phi_rad, theta_rad, psi_rad, alpha_rad,
        beta_rad, phidot_radps, thetadot_radps, psidot_radps, vcas_kt, climb_rate_ftps,
        v_north_ftps, v_east_ftps, v_down_ftps, v_body_u_ftps, v_body_v_ftps, v_body_w_ftps,
        a_x_pilot_ftps2, a_y_pilot_ftps2, a_z_pilot_ftps2, stall_warning, slip_deg, rpm,
        fuel_flow_gph, fuel_px_psi, egt_degf, cht_degf, mp_osi_inhg, tit, oil_temp_degf,
        oil_px_psi, fuel_quantity_gal, gear_pos_norm, gear_steer_norm, gear_compression_norm,
        visibility_m, elevator_norm, elevator_trim_tab_norm, left_flap_norm, right_flap_norm,
        left_aileron_norm, right_aileron_norm, rudder_norm, nose_wheel_norm, speedbrake_norm,
        spoilers_norm,
    }
}

#[cfg(test)]
mod tests;
