//! View channels: what plain viewers draw without knowing us, derived from the outputs.
//!
//! ROS 2 conventions: world x east, y north, z up; body x forward, y left, z up. The root frame is
//! called `tf#/`, which is where rerun looks.

use engine::frames::{Attitude, Body, Ned, Structural, Vec3};
use engine::math::{FRAC_PI_2, cos, sin};
use engine::units::degrees;
use engine::{Aircraft, Outputs};
use serde::Serialize;

pub use crate::level::Level;
use crate::schema::{MessageType, RULE};
use crate::{LogError, cdr};

/// Frames of the aircraft and its moving parts.
pub const TF: &str = "/tf";
/// The aircraft's shape.
pub const ROBOT_DESCRIPTION: &str = "/robot_description";
/// Where the pilot holds everything.
pub const JOY: &str = "/joy";
/// Where on earth.
pub const FIX: &str = "/fix";
/// Nacelles, surfaces and gear.
pub const JOINT_STATES: &str = "/joint_states";
/// Events in words.
pub const LOG: &str = "/log";

const ROOT: &str = "tf#/";
const BASE: &str = "base_link";
const TIME: &str = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
const HEADER: &str = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";

/// A message type with strings or lists: of ROS 2's own, or one of ours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RosType {
    /// With package.
    pub(crate) name: &'static str,
    /// Its fields; the types they are of come after it.
    pub(crate) own: &'static str,
    pub(crate) parts: &'static [&'static str],
}

impl From<RosType> for MessageType {
    fn from(ros: RosType) -> Self {
        let own = ros.own.to_string();
        let text = ros.parts.iter().fold(own, |text, part| format!("{text}{RULE}\n{part}"));
        Self { name: ros.name.into(), text, layout: None }
    }
}

pub(crate) const TF_TYPE: RosType = RosType {
    name: "tf2_msgs/msg/TFMessage",
    own: "geometry_msgs/TransformStamped[] transforms\n",
    parts: &[
        "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n\
         geometry_msgs/Transform transform\n",
        HEADER,
        TIME,
        "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\n\
         geometry_msgs/Quaternion rotation\n",
        "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n",
        "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
    ],
};

pub(crate) const STRING_TYPE: RosType =
    RosType { name: "std_msgs/msg/String", own: "string data\n", parts: &[] };

pub(crate) const JOY_TYPE: RosType = RosType {
    name: "sensor_msgs/msg/Joy",
    own: "std_msgs/Header header\nfloat32[] axes\nint32[] buttons\n",
    parts: &[HEADER, TIME],
};

pub(crate) const FIX_TYPE: RosType = RosType {
    name: "sensor_msgs/msg/NavSatFix",
    own: "std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\n\
          float64 longitude\nfloat64 altitude\nfloat64[9] position_covariance\n\
          uint8 position_covariance_type\n",
    parts: &[HEADER, TIME, "MSG: sensor_msgs/NavSatStatus\nint8 status\nuint16 service\n"],
};

pub(crate) const JOINT_TYPE: RosType = RosType {
    name: "sensor_msgs/msg/JointState",
    own: "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\n\
          float64[] effort\n",
    parts: &[HEADER, TIME],
};

pub(crate) const LOG_TYPE: RosType = RosType {
    name: "rcl_interfaces/msg/Log",
    own: "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\n\
          string function\nuint32 line\n",
    parts: &[TIME],
};

#[derive(Serialize)]
struct Time {
    sec: i32,
    nanosec: u32,
}

#[derive(Serialize)]
struct Header {
    stamp: Time,
    frame_id: &'static str,
}

#[derive(Serialize)]
struct Quaternion {
    x: f64,
    y: f64,
    z: f64,
    w: f64,
}

#[derive(Serialize)]
struct TransformStamped {
    header: Header,
    child_frame_id: &'static str,
    translation: [f64; 3],
    rotation: Quaternion,
}

/// `/tf` of one moment.
#[derive(Serialize)]
pub struct Tf {
    transforms: Vec<TransformStamped>,
}

/// `/robot_description`.
#[derive(Serialize)]
pub struct Text<'a> {
    /// URDF.
    pub data: &'a str,
}

/// `/joy` of one moment.
#[derive(Serialize)]
pub struct Joy {
    header: Header,
    axes: Vec<f32>,
    buttons: Vec<i32>,
}

/// `/fix` of one moment.
#[derive(Serialize)]
pub struct Fix {
    header: Header,
    status: i8,
    service: u16,
    latitude: f64,
    longitude: f64,
    altitude: f64,
    position_covariance: [f64; 9],
    position_covariance_type: u8,
}

/// A `/log` message.
#[derive(Serialize)]
pub struct Log<'a> {
    stamp: Time,
    level: u8,
    name: &'static str,
    msg: &'a str,
    file: &'static str,
    function: &'static str,
    line: u32,
}

/// A line of the flight's log, read back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogLine {
    /// Simulated time, ns.
    pub time_ns: u64,
    /// Severity.
    pub level: Level,
    /// What was said.
    pub words: String,
}

/// A `/log` message read back.
///
/// # Errors
/// When the bytes are none.
pub fn log_line(message: &[u8]) -> Result<LogLine, LogError> {
    #[derive(serde::Deserialize)]
    struct Said {
        sec: i32,
        nanosec: u32,
        level: u8,
        _name: String,
        msg: String,
    }
    let said: Said = cdr::decode_view(message, "the words of a /log message")?;
    let known = [Level::Info, Level::Warn, Level::Error];
    Ok(LogLine {
        time_ns: u64::from(said.sec.unsigned_abs()) * 1_000_000_000 + u64::from(said.nanosec),
        level: known.into_iter().find(|level| *level as u8 == said.level).unwrap_or(Level::Error),
        words: said.msg,
    })
}

/// The text of a `std_msgs/msg/String`.
///
/// # Errors
/// When the bytes are none.
pub fn text(message: &[u8]) -> Result<String, LogError> {
    #[derive(serde::Deserialize)]
    struct Said {
        data: String,
    }
    cdr::decode_view(message, "a text").map(|said: Said| said.data)
}

fn stamp(tick: u64) -> Time {
    let ns = crate::container::time_ns(tick);
    Time {
        sec: i32::try_from(ns / 1_000_000_000).unwrap_or(i32::MAX),
        nanosec: (ns % 1_000_000_000) as u32,
    }
}

fn header(tick: u64, frame_id: &'static str) -> Header {
    Header { stamp: stamp(tick), frame_id }
}

/// East, north, up.
fn enu(v: Vec3<Ned>) -> [f64; 3] {
    [v.y, v.x, -v.z]
}

/// Forward, left, up.
fn flu(v: Vec3<Body>) -> [f64; 3] {
    [v.x, -v.y, -v.z]
}

/// World (east, north, up) from body (forward, left, up).
fn attitude(a: Attitude) -> Quaternion {
    // The turn from NED to ENU, (0, √½, √½, 0), times ours, times half a turn about body x.
    let half = engine::math::sqrt(0.5);
    let (w, x, y, z) =
        (-half * (a.x + a.y), half * (a.w + a.z), half * (a.w - a.z), half * (a.y - a.x));
    Quaternion { w: -x, x: w, y: z, z: -y }
}

fn about(angle_rad: f64, axis: [f64; 3]) -> Quaternion {
    let s = sin(0.5 * angle_rad);
    Quaternion { w: cos(0.5 * angle_rad), x: axis[0] * s, y: axis[1] * s, z: axis[2] * s }
}

/// What the frames need to know of the aircraft.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shape {
    pivot_m: Vec3<Structural>,
    mast_m: f64,
}

impl Shape {
    /// Of an aircraft.
    pub fn of(aircraft: &Aircraft) -> Self {
        Self { pivot_m: aircraft.rotors.pivot_m, mast_m: aircraft.rotors.mast_length_m }
    }
}

/// `/tf` of one tick.
pub(crate) fn frames(outputs: &Outputs, attitude: Attitude, shape: &Shape) -> Tf {
    tf(outputs, attitude, shape.pivot_m.from_cg(outputs.balance.cg_m), shape.mast_m)
}

/// Frames: the aircraft in the world, nacelles on the aircraft, rotors on the nacelles.
///
/// `pivot_from_cg_m` and `mast_m` are those of the right nacelle.
pub fn tf(outputs: &Outputs, attitude_now: Attitude, pivot: Vec3<Body>, mast_m: f64) -> Tf {
    let tick = outputs.tick;
    let frame = |parent, child, translation, rotation| TransformStamped {
        header: header(tick, parent),
        child_frame_id: child,
        translation,
        rotation,
    };
    let tilt = outputs.actuators.mast_tilt_rad;
    let spin = outputs.rotor_azimuth_rad;
    // The nacelle's own axes are those of the helicopter: mast up. Tilting forward is a positive
    // turn about y to the left.
    let left_axis = [0.0, 1.0, 0.0];
    let mast_axis = [0.0, 0.0, 1.0];
    Tf {
        transforms: vec![
            frame(ROOT, BASE, enu(outputs.position_m), attitude(attitude_now)),
            frame(BASE, "nacelle_left", flu(pivot.mirrored()), about(tilt.left, left_axis)),
            frame(BASE, "nacelle_right", flu(pivot), about(tilt.right, left_axis)),
            frame("nacelle_left", "rotor_left", [0.0, 0.0, mast_m], about(-spin, mast_axis)),
            frame("nacelle_right", "rotor_right", [0.0, 0.0, mast_m], about(spin, mast_axis)),
        ],
    }
}

/// Sticks, lever, pedals, brakes, nacelle switch; switches and counters.
pub fn joy(outputs: &Outputs) -> Joy {
    let at = &outputs.cockpit;
    let axes = [
        at.stick_right_norm,
        at.stick_aft_norm,
        at.collective_norm,
        at.pedal_right_norm,
        at.brake_norm.left,
        at.brake_norm.right,
        at.nacelle_aft_norm,
    ];
    let buttons =
        [at.flap_detent, at.gear_down, at.parking_brake, at.scas_on, at.rpm_select, at.markers];
    Joy {
        header: header(outputs.tick, BASE),
        axes: axes.iter().map(|&axis| axis as f32).collect(),
        buttons: buttons.iter().map(|&on| i32::try_from(on).unwrap_or(i32::MAX)).collect(),
    }
}

/// Latitude and longitude in degrees, height above mean sea level in metres.
pub fn fix(outputs: &Outputs) -> Fix {
    Fix {
        header: header(outputs.tick, BASE),
        status: 0,
        service: 1,
        latitude: degrees(outputs.place.latitude_rad),
        longitude: degrees(outputs.place.longitude_rad),
        altitude: outputs.place.height_m,
        position_covariance: [0.0; 9],
        position_covariance_type: 0,
    }
}

/// A line of the flight's log.
pub fn log(tick: u64, level: Level, msg: &str) -> Log<'_> {
    Log {
        stamp: stamp(tick),
        level: level as u8,
        name: "tiltrotor",
        msg,
        file: "",
        function: "",
        line: 0,
    }
}

/// `/joint_states` of one moment: name and position, no speeds, no efforts.
#[derive(Serialize)]
pub struct JointStates {
    header: Header,
    name: Vec<&'static str>,
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

/// Nacelle incidence (π/2 as a helicopter, as cockpits count it), surfaces, gear.
pub fn joint_states(outputs: &Outputs) -> JointStates {
    let at = &outputs.actuators;
    let joints = [
        ("nacelle_left", FRAC_PI_2 - at.mast_tilt_rad.left),
        ("nacelle_right", FRAC_PI_2 - at.mast_tilt_rad.right),
        ("elevator", at.elevator_rad),
        ("rudder", at.rudder_right_rad),
        ("flap", at.flap_rad),
        ("flaperon_left", at.flaperon_rad.left),
        ("flaperon_right", at.flaperon_rad.right),
        ("gear", at.gear_extension_norm),
    ];
    JointStates {
        header: header(outputs.tick, BASE),
        name: joints.iter().map(|joint| joint.0).collect(),
        position: joints.iter().map(|joint| joint.1).collect(),
        velocity: Vec::new(),
        effort: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::frames::Euler;

    /// Turns `v` by `q`.
    fn turn(q: &Quaternion, v: [f64; 3]) -> [f64; 3] {
        let a = Attitude { w: q.w, x: q.x, y: q.y, z: q.z };
        let turned = a.ned_from_body() * Vec3::<Body>::new(v[0], v[1], v[2]);
        [turned.x, turned.y, turned.z]
    }

    #[test]
    fn an_aircraft_that_heads_east_points_along_x() {
        let east = Attitude::from_euler(Euler { heading_rad: FRAC_PI_2, ..Euler::default() });
        let q = attitude(east);
        let nose = turn(&q, [1.0, 0.0, 0.0]);
        let up = turn(&q, [0.0, 0.0, 1.0]);
        assert!((nose[0] - 1.0).abs() < 1e-12, "{nose:?}");
        assert!((up[2] - 1.0).abs() < 1e-12, "{up:?}");
    }

    #[test]
    fn words_are_read_back() {
        let message = cdr::encode_view(&log(375, Level::Warn, "left engine")).unwrap();
        let line = log_line(&message).unwrap();
        assert_eq!((line.time_ns, line.level), (1_500_000_000, Level::Warn));
        assert_eq!(line.words, "left engine");
    }

    #[test]
    fn world_and_body_axes_agree_in_any_attitude() {
        let a = Attitude::from_euler(Euler { roll_rad: 0.3, pitch_rad: -0.5, heading_rad: 2.0 });
        let v = Vec3::<Body>::new(0.2, -0.7, 1.1);
        let expected = enu(a.ned_from_body() * v);
        let got = turn(&attitude(a), flu(v));
        for (got, expected) in got.iter().zip(expected) {
            assert!((got - expected).abs() < 1e-12);
        }
    }
}
