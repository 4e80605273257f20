//! Everything that comes in from outside, and nothing else does.
//!
//! Whoever calls [`step`](crate::step()) records these before the step that uses them.

use serde::{Deserialize, Serialize};

use crate::controls::Commands;
use crate::enumeration;
use crate::frames::{Ned, Vec3};
use crate::listing::flags;
use crate::math::clamp;
use crate::struts::Struts;

/// One raw event of an input device (or of a pilot model or script, which look the same).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DeviceEvent {
    /// The tick whose step uses it.
    pub tick: u64,
    /// When the kernel saw it, ns since the Unix epoch; 0 where there was no kernel.
    pub kernel_time_ns: u64,
    /// Which device: its place in the cockpit map.
    pub device: u64,
    /// What happened: one of [`EventKind`].
    pub kind: u64,
    /// Which axis or button: the kernel's event code.
    pub code: u64,
    /// Raw value: counts of an axis; 1 pressed, 0 released of a button; how many events were lost.
    pub value: i64,
    /// Raw value at the lower end of the axis, as the device tells it; both ends are 0 where it does not,
    /// and for all else.
    pub raw_min: i64,
    /// Raw value at its upper end.
    pub raw_max: i64,
}

/// What is told of an [`EventKind`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EventKindFacts {
    /// Its name, in reports and in words; never changed.
    pub key: &'static str,
    /// What happened.
    pub description: &'static str,
}

enumeration! {
    /// What a [`DeviceEvent`] tells.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u64)]
    pub enum EventKind tells EventKindFacts {
        /// An axis moved.
        Axis = 1 { key: "axis" }
        /// A button changed.
        Button = 2 { key: "button" }
        /// The device appeared.
        Connected = 3 { key: "connected" }
        /// The device went away.
        Disconnected = 4 { key: "disconnected" }
        /// The kernel lost events of the device (SYN_DROPPED); what it asks for anew follows.
        Dropped = 5 { key: "dropped" }
        /// Where an axis stands, found out without its having moved: when the device appeared, or after
        /// lost events. It moves no control.
        AxisPosition = 6 { key: "axis_position" }
        /// The same of a button.
        ButtonPosition = 7 { key: "button_position" }
    }
}

impl EventKind {
    /// The kind recorded as `kind`, if it is one.
    pub fn from_u64(kind: u64) -> Option<Self> {
        Self::ALL.iter().copied().find(|&known| known as u64 == kind)
    }
}

/// What is told of a flag of [`Failures`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FailureFacts {
    /// Which.
    pub flag: Failures,
    /// Its name in scripts; never changed.
    pub key: &'static str,
    /// What failed, in words.
    pub words: &'static str,
    /// What it does.
    pub description: &'static str,
}

flags! {
    /// What has failed.
    pub struct Failures tells FailureFacts {
        /// The left engine stops.
        ENGINE_LEFT = 0 { key: "engine_left", words: "left engine" }
        /// The right engine stops.
        ENGINE_RIGHT = 1 { key: "engine_right", words: "right engine" }
        /// The SCAS pitch axis goes dead.
        SCAS_PITCH = 2 { key: "scas_pitch", words: "SCAS pitch" }
        /// The SCAS roll axis goes dead.
        SCAS_ROLL = 3 { key: "scas_roll", words: "SCAS roll" }
        /// The SCAS yaw axis goes dead.
        SCAS_YAW = 4 { key: "scas_yaw", words: "SCAS yaw" }
        /// The collective governor holds its last correction.
        GOVERNOR = 5 { key: "governor", words: "governor" }
    }
}

impl Failures {
    /// Both engines.
    pub const ENGINES: Self = Self::ENGINE_LEFT.union(Self::ENGINE_RIGHT);
}

/// What is told of an [`InputLevel`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InputLevelFacts {
    /// Its name; never changed.
    pub key: &'static str,
    /// What moves the aircraft.
    pub description: &'static str,
}

enumeration! {
    /// At which level the aircraft is controlled from outside.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u64)]
    pub enum InputLevel tells InputLevelFacts {
        /// The pilot's controls, through the flight control computer.
        Controls = 0 { key: "controls" }
        /// The actuators, by the commands in the inputs: somebody else's SCAS, governor or autopilot.
        Actuators = 1 { key: "actuators" }
    }
}

/// The world around the aircraft during one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct World {
    /// Steady motion of the air, m/s; at 20 ft when there is shear.
    pub wind_mps: Vec3<Ned>,
    /// Roughness length of the ground, m; 0 for the same wind at every height.
    pub wind_roughness_m: f64,
    /// Amplitude of a discrete gust, m/s.
    pub gust_mps: Vec3<Ned>,
    /// Its duration, s.
    pub gust_s: f64,
    /// When it begins.
    pub gust_start_tick: u64,
    /// Intensity of the vertical turbulence, m/s; 0 for still air.
    pub turbulence_mps: f64,
    /// Ground under each wheel, above the origin's ground, m.
    pub ground_height_m: Struts<f64>,
    /// Warmer than the standard atmosphere by, K.
    pub temperature_offset_k: f64,
    /// Sea-level pressure above the standard one by, Pa.
    pub pressure_offset_pa: f64,
    /// What has failed.
    pub failures: Failures,
    /// 1 while the simulation is paused: the tick passes, the aircraft does not.
    pub paused: u64,
    /// One of [`InputLevel`]; any other number is [`InputLevel::Controls`].
    pub input_level: u64,
    /// What the actuators are asked for at [`InputLevel::Actuators`]; not used at the other.
    pub commands: Commands,
}

impl World {
    /// Whether one of these has failed.
    pub fn failed(&self, failures: Failures) -> bool {
        self.failures.intersects(failures)
    }

    /// Level ground of that height under all wheels, m.
    #[must_use]
    pub fn with_ground(self, height_m: f64) -> Self {
        Self { ground_height_m: Struts::all(height_m), ..self }
    }

    /// Ground under the aircraft: the mean of that under the main wheels, m.
    pub fn ground_under_aircraft_m(&self) -> f64 {
        self.ground_height_m.main.mean()
    }

    /// The commands of somebody else's control computer, when it moves the aircraft, no lever, brake or
    /// switch beyond its travel. (The actuators keep the rest within their stops.)
    pub fn outside_commands(&self) -> Option<Commands> {
        let commands = Commands {
            nacelle_aft_norm: clamp(self.commands.nacelle_aft_norm, -1.0, 1.0),
            lever_norm: clamp(self.commands.lever_norm, 0.0, 1.0),
            brake_norm: self.commands.brake_norm.map(|norm| clamp(norm, 0.0, 1.0)),
            ..self.commands
        };
        (self.input_level == InputLevel::Actuators as u64).then_some(commands)
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        let (wind, gust, ground) = (self.wind_mps, self.gust_mps, self.ground_height_m);
        [wind.x, wind.y, wind.z, gust.x, gust.y, gust.z]
            .into_iter()
            .chain([self.wind_roughness_m, self.gust_s, self.turbulence_mps])
            .chain([ground.nose, ground.main.left, ground.main.right])
            .chain([self.temperature_offset_k, self.pressure_offset_pa])
            .all(f64::is_finite)
            && self.commands.is_finite()
    }
}

/// What one step gets from outside.
#[derive(Clone, Copy, Debug)]
pub struct Inputs<'a> {
    /// Device events since the step before, in the order they are to be applied.
    pub events: &'a [DeviceEvent],
    /// The world.
    pub world: World,
}
