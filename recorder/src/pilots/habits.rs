//! Habits of the pilot models: how hard, how near and how long, the same in every aircraft. What is an
//! aircraft's stands in its file, and in the [handbook](super::handbook).
//!
//! None is from a source. They are what made the models fly as a careful pilot does, with an aircraft that
//! answers half or twice as strongly, too.

use engine::units::KNOT_MPS;

/// Distance inside the corridor that the pilot keeps, m/s: 8 kt.
pub const CORRIDOR_MPS: f64 = 8.0 * KNOT_MPS;
/// The nacelles' way from the decision to the next one, rad: four degrees.
pub const AHEAD_RAD: f64 = 0.07;
/// Part of the conversion's rotor speed by which the rotors may be off while the nacelles move.
pub const ROTORS_OFF_MAX: f64 = 0.05;
/// Nearer to an end than this the nacelles are there, rad.
pub const END_RAD: f64 = 0.003;
/// An autorotation is flown with the nacelles at their aft stop (TM-81244), nearer to it than this, rad.
pub const AFT_STOP_RAD: f64 = 2.7e-4;
/// Nearer to a stop than this the thumb leaves the switch: the stop holds the nacelles, rad.
pub const STOP_RAD: f64 = 1e-4;
/// What an approach or a stop from far away takes at most, and every other phase, s. It is given up beyond.
pub const APPROACH_S_MAX: f64 = 300.0;
pub const PHASE_S_MAX: f64 = 120.0;
/// Faster than this a flight that is taken over goes on as fast as it is, m/s.
pub const MOVING_MPS: f64 = 20.0;
/// Acceleration along the nose: over a spot, on the way to a conversion, in one, and in an approach, m/s².
/// A third of what is to be had, so that the height can be kept with the rest.
pub const HOVER_MPS2: f64 = 1.5;
pub const HELICOPTER_MPS2: f64 = 1.6;
pub const CONVERSION_MPS2: f64 = 3.0;
pub const SLOWING_MPS2: f64 = 2.0;
/// Climb or sink: over a spot, on the way to a conversion, in one, and as an aeroplane, m/s.
pub const GENTLE_MPS: f64 = 2.5;
pub const HELICOPTER_CLIMB_MPS: f64 = 4.0;
pub const CONVERSION_CLIMB_MPS: f64 = 3.0;
pub const AEROPLANE_CLIMB_MPS: f64 = 7.0;
/// Sink of a steep descent in clear air, m/s.
pub const STEEP_MPS: f64 = 5.0;
/// Sink by airspeed while it slows down, a slope of 7°, and at most, m/s: beyond it the descent is in the
/// rotors' own wake.
pub const SINK_BY_SPEED: f64 = 0.12;
pub const SINK_MPS_MAX: f64 = 6.0;
/// Bank that is allowed when nothing else is asked for, rad.
pub const BANK_RAD: f64 = 0.5;
/// Time constant with which the airspeed indicator is read, s.
pub const READING_S: f64 = 0.5;
/// A height is reached within this: of a hover, of an approach, of an acceleration, and of a climb, m.
pub const HOVER_NEAR_M: f64 = 1.0;
pub const APPROACH_NEAR_M: f64 = 1.5;
pub const ACCELERATION_NEAR_M: f64 = 10.0;
pub const CLIMB_NEAR_M: f64 = 15.0;
/// A speed is reached within this: of a helicopter, and of an aeroplane, m/s.
pub const HELICOPTER_NEAR_MPS: f64 = 4.0 * KNOT_MPS;
pub const AEROPLANE_NEAR_MPS: f64 = 8.0 * KNOT_MPS;
/// The wheels stay down until it is higher and faster than this, m, m/s: a take-off may be given up.
pub const WHEELS_UP_M: f64 = 15.0;
pub const WHEELS_UP_MPS: f64 = 20.0;
/// A turn is asked for by a heading so far ahead, rad: any that the bank limits.
pub const TURN_AHEAD_RAD: f64 = 1.0;
/// Rolling out of a turn takes a second or two, s.
pub const ROLL_OUT_S: f64 = 2.2;
/// Nearer to the direction than this it rolls out, rad.
pub const ROLL_OUT_RAD: f64 = 0.03;
/// Half a circle at least, or the spot is behind, rad.
pub const HALF_TURN_RAD: f64 = 2.5;
/// Nearer to the spot than this its bearing says nothing, m.
pub const HERE_M: f64 = 1.0;
/// Farther than this from the spot, m, and less than this beside it, rad, an approach steers by its direction.
pub const STEER_M: f64 = 150.0;
pub const STEER_RAD: f64 = 1.0;
/// It has faced the start when it is nearer than this, rad, and turns slower than this, rad/s.
pub const FACED_RAD: f64 = 0.05;
pub const FACED_RADPS: f64 = 0.03;
/// The deceleration ends so far before the spot, m: the hover takes the rest.
pub const STOP_SHORT_M: f64 = 15.0;
/// Slope of an approach, and from where on it is level, m.
pub const APPROACH_SLOPE: f64 = 0.07;
pub const LEVEL_OFF_M: f64 = 150.0;
/// A hover over the spot begins slower, m/s, and nearer, m, than this, and has begun within these.
pub const ARRIVING_MPS: f64 = 3.0;
pub const ARRIVING_M: f64 = 30.0;
pub const ARRIVED_MPS: f64 = 1.0;
pub const ARRIVED_M: f64 = 3.0;
/// Higher than this over the hover it descends with speed, m.
pub const HIGH_M: f64 = 40.0;
/// Part of the speed of a steep descent from which on it is one.
pub const STEEP_NORM: f64 = 0.8;
/// A run-on landing is slow enough so much above its speed, m/s.
pub const RUN_ON_NEAR_MPS: f64 = 3.0;
/// What counts as no slower, m/s.
pub const SAME_MPS: f64 = 0.1;
/// The nacelles come aft when less than this above the speed that is asked for is flown, m/s.
pub const NACELLES_MPS: f64 = 3.0;
/// Sink of a landing by height over the wheels' touch, 1/s; least and greatest, m/s.
pub const LANDING_PER_S: f64 = 0.3;
pub const LANDING_MPS: [f64; 2] = [0.4, 1.6];
/// So far over standing the sink of a landing is to have become the least, m.
pub const TOUCH_M: f64 = 0.2;
/// Climb by height that is missing: while the wing carries, and else, 1/s.
pub const HEIGHT_PER_S: [f64; 2] = [0.2, 0.4];
/// Slower than this it may hover where it is, m/s.
pub const HOVERING_MPS: f64 = 4.0;
/// Speed towards a spot by the distance from it, 1/s, and at most, ahead and to the side, m/s.
pub const SPOT_PER_S: f64 = 0.12;
pub const SPOT_MPS_MAX: [f64; 2] = [4.0, 3.0];
/// The same to the side while it approaches, 1/s.
pub const BESIDE_PER_S: f64 = 0.2;
/// The nacelles go forward with less angle of attack than this over the pilot's limit, rad.
pub const FORWARD_ALPHA_RAD: f64 = 0.01;
/// Part of what is available that an engine gives when the other one's silence is a failure.
pub const WORKING_NORM: f64 = 0.2;
/// Nacelle incidence above which the flaps are a helicopter's, with the nacelles coming aft and going forward:
/// down early and up late, as the handbook has it, deg.
pub const HELICOPTER_FLAPS_DEG: [f64; 2] = [60.0, 75.0];
/// Nacelle incidence below which they may be an aeroplane's, deg.
pub const AEROPLANE_FLAPS_DEG: f64 = 5.0;
/// Deceleration of an approach, m/s².
pub const APPROACH_MPS2: f64 = 1.4;
/// Part of an engine's power that the other one is left with when it is out.
pub const OUT_NORM: f64 = 0.1;
/// How hard it brakes after a landing with speed.
pub const BRAKE_NORM: f64 = 0.4;
/// How fast it picks up speed to the side or back, m/s².
pub const SIDLE_MPS2: f64 = 1.0;
/// How fast the lever goes down after touchdown, 1/s.
pub const LOWER_PER_S: f64 = 0.3;
/// From touchdown to the end of the flight, s.
pub const SETTLE_S: f64 = 5.0;
/// A run-on landing that is faster than this is still one, m/s, and for this long, s.
pub const ROLLING_MPS: f64 = 0.3;
pub const ROLL_S: f64 = 60.0;
/// Between two movements of flap lever and gear handle, s.
pub const HANDLE_S: f64 = 1.0;
