//! Scripts: timed events in TOML, played on the virtual device.
//!
//! ```toml
//! [[event]]
//! at_s = 2.0
//! over_s = 0.5               # axes move there in this time; 0 when left out
//! axis = { stick_aft = 0.2, collective = 0.6 }
//!
//! [[event]]
//! at_s = 5.0
//! press = ["marker"]         # pressed and released at once
//! hold = ["nacelle_forward"] # pressed until released
//! release = []
//! fail = ["engine_left"]
//! mend = []
//! wind = { from_deg = 270.0, kt = 15.0 }
//! gust = { up_mps = 6.0, s = 2.0 }          # north_mps, east_mps, up_mps; 1 - cosine
//! turbulence_mps = 1.5                      # vertical intensity
//! pause = false              # true freezes the aircraft, false lets it go on
//! save = false               # true saves the situation in a file beside the log
//! restart = "saved"          # or "start", "marker": goes on from there
//! end = false                # true ends the flight
//! ```

use std::collections::BTreeMap;

use engine::cockpit::{self, AxisControl, ButtonControl};
use engine::frames::Vec3;
use engine::inputs::Failures;
use engine::math::{cos, sin};
use engine::units::{mps_of_knots, radians};
use engine::{Outputs, STEP_S};
use serde::de::Error;
use serde::{Deserialize, Deserializer};

use crate::controller::{Controller, TickContext};
use crate::pilots::VirtualDevice;
use crate::restart::Restart;

/// Why a script cannot be played.
#[derive(Debug, thiserror::Error)]
pub enum ScriptError {
    /// Not as the grammar wants it.
    #[error("{file}:{line}: {what}")]
    Syntax {
        /// File.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong, and what was expected.
        what: String,
    },
    /// A number that no control has.
    #[error("{file}: event {number} (at {at_s} s): {what}")]
    Event {
        /// File.
        file: String,
        /// Which event, from 1.
        number: usize,
        /// Its time.
        at_s: f64,
        /// What is wrong, and what was expected.
        what: String,
    },
    /// The cockpit map lacks the virtual device.
    #[error("the cockpit map has no device called `{}`, which scripts use", crate::pilots::DEVICE)]
    NoDevice,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    event: Vec<Event>,
}

/// One of the engine's failures, by its key.
#[derive(Clone, Copy, Debug)]
struct Failure(Failures);

impl<'de> Deserialize<'de> for Failure {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let key = String::deserialize(deserializer)?;
        let failure = Failures::from_key(&key);
        failure.map(Self).ok_or_else(|| D::Error::unknown_variant(&key, Failures::KEYS))
    }
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Wind {
    from_deg: f64,
    kt: f64,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Gust {
    #[serde(default)]
    north_mps: f64,
    #[serde(default)]
    east_mps: f64,
    #[serde(default)]
    up_mps: f64,
    s: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Event {
    at_s: f64,
    #[serde(default)]
    over_s: f64,
    #[serde(default)]
    axis: BTreeMap<String, f64>,
    #[serde(default)]
    press: Vec<ButtonControl>,
    #[serde(default)]
    hold: Vec<ButtonControl>,
    #[serde(default)]
    release: Vec<ButtonControl>,
    #[serde(default)]
    fail: Vec<Failure>,
    #[serde(default)]
    mend: Vec<Failure>,
    wind: Option<Wind>,
    gust: Option<Gust>,
    turbulence_mps: Option<f64>,
    pause: Option<bool>,
    #[serde(default)]
    save: bool,
    restart: Option<From>,
    #[serde(default)]
    end: bool,
}

/// What a script can go on from.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum From {
    Start,
    Marker,
    Saved,
}

/// An axis on its way.
struct Motion {
    control: AxisControl,
    from_norm: f64,
    to_norm: f64,
    start_s: f64,
    over_s: f64,
}

/// A script being played.
pub struct Script {
    device: VirtualDevice,
    events: Vec<(Event, Vec<(AxisControl, f64)>)>,
    next: usize,
    motions: Vec<Motion>,
    at: Vec<(AxisControl, f64)>,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// With file, line and what was expected.
    pub fn parse(file: &str, text: &str, map: &cockpit::Params) -> Result<Self, ScriptError> {
        let parsed: File = toml::from_str(text).map_err(|error| {
            let start = error.span().map_or(0, |span| span.start);
            let line =
                1 + text.as_bytes().iter().take(start).filter(|&&byte| byte == b'\n').count();
            ScriptError::Syntax { file: file.into(), line, what: error.message().to_string() }
        })?;
        let device = VirtualDevice::of(map).ok_or(ScriptError::NoDevice)?;
        let mut events = Vec::new();
        for (i, event) in parsed.event.into_iter().enumerate() {
            let axes = check(&event, &device).map_err(|what| ScriptError::Event {
                file: file.into(),
                number: i + 1,
                at_s: event.at_s,
                what,
            })?;
            events.push((event, axes));
        }
        events.sort_by(|(a, _), (b, _)| a.at_s.total_cmp(&b.at_s));
        // No memory is asked for in flight.
        let room = device.axes().count();
        let (motions, at) = (Vec::with_capacity(room + 1), Vec::with_capacity(room));
        Ok(Self { device, events, next: 0, motions, at })
    }

    fn begin(&mut self, i: usize, context: &mut TickContext<'_>) {
        let (event, axes) = &self.events[i];
        for &(control, to_norm) in axes {
            let from_norm = self.at.iter().find(|(at, _)| *at == control).map_or(0.0, |at| at.1);
            self.motions.retain(|motion| motion.control != control);
            self.motions.push(Motion {
                control,
                from_norm,
                to_norm,
                start_s: event.at_s,
                over_s: event.over_s,
            });
        }
        for &button in event.press.iter().chain(&event.hold) {
            self.device.press(context, button, true);
        }
        for &button in event.press.iter().chain(&event.release) {
            self.device.press(context, button, false);
        }
        for failure in &event.fail {
            context.world.failures.insert(failure.0);
        }
        for failure in &event.mend {
            context.world.failures.remove(failure.0);
        }
        if let Some(Wind { from_deg, kt }) = event.wind {
            let (from_rad, mps) = (radians(from_deg), mps_of_knots(kt));
            context.world.wind_mps = Vec3::new(-mps * cos(from_rad), -mps * sin(from_rad), 0.0);
        }
        if let Some(gust) = event.gust {
            context.world.gust_mps = Vec3::new(gust.north_mps, gust.east_mps, -gust.up_mps);
            context.world.gust_s = gust.s;
            context.world.gust_start_tick = context.tick;
        }
        if let Some(turbulence_mps) = event.turbulence_mps {
            context.world.turbulence_mps = turbulence_mps;
        }
        if let Some(pause) = event.pause {
            context.world.paused = u64::from(pause);
        }
        *context.save |= event.save;
        if let Some(from) = event.restart {
            *context.restart = Some(match from {
                From::Start => Restart::Start,
                From::Marker => Restart::Marker,
                From::Saved => Restart::Saved,
            });
        }
        if event.end {
            *context.done = true;
        }
    }
}

/// The event's axes by control, or what is wrong with it.
fn check(event: &Event, device: &VirtualDevice) -> Result<Vec<(AxisControl, f64)>, String> {
    if !event.at_s.is_finite() || event.at_s < 0.0 {
        return Err(format!("at_s: expected 0 s or later, got {}", event.at_s));
    }
    if !event.over_s.is_finite() || event.over_s < 0.0 {
        return Err(format!("over_s: expected 0 s or longer, got {}", event.over_s));
    }
    if let Some(wind) = event.wind
        && !(wind.from_deg.is_finite() && (0.0..=200.0).contains(&wind.kt))
    {
        return Err(format!("wind: expected 0 to 200 kt, got {} kt", wind.kt));
    }
    if let Some(gust) = event.gust
        && !([gust.north_mps, gust.east_mps, gust.up_mps].iter().all(|v| v.abs() <= 50.0)
            && (0.01..=60.0).contains(&gust.s))
    {
        return Err("gust: expected up to 50 m/s each way, for 0.01 to 60 s".into());
    }
    if let Some(turbulence_mps) = event.turbulence_mps
        && !(0.0..=15.0).contains(&turbulence_mps)
    {
        return Err(format!("turbulence_mps: expected 0 to 15 m/s, got {turbulence_mps}"));
    }
    event.axis.iter().map(|(key, &to_norm)| check_axis(device, key, to_norm)).collect()
}

/// The control of an axis by its key, if the device has it and it goes so far.
fn check_axis(
    device: &VirtualDevice,
    key: &str,
    to_norm: f64,
) -> Result<(AxisControl, f64), String> {
    let Some(control) = device.axes().find(|control| control.facts().key == key) else {
        let keys: Vec<&str> = device.axes().map(|control| control.facts().key).collect();
        return Err(format!("axis.{key}: expected one of {}", keys.join(", ")));
    };
    let low_norm = control.facts().travel.low_norm();
    if (low_norm..=1.0).contains(&to_norm) {
        Ok((control, to_norm))
    } else {
        Err(format!("axis.{key}: expected {low_norm} to 1, got {to_norm}"))
    }
}

impl Controller for Script {
    fn events_a_tick(&self) -> usize {
        let presses =
            |event: &Event| 2 * event.press.len() + event.hold.len() + event.release.len();
        // Those that begin within a tick after each of them.
        let together = self.events.iter().enumerate().map(|(i, (first, _))| {
            let soon = self.events[i..].iter().take_while(|(e, _)| e.at_s <= first.at_s + STEP_S);
            soon.map(|(event, _)| presses(event)).sum::<usize>()
        });
        self.device.axes().count() + together.max().unwrap_or(0)
    }

    fn act(&mut self, _: &Outputs, context: &mut TickContext<'_>) {
        let time_s = context.tick as f64 * STEP_S;
        while self.events.get(self.next).is_some_and(|(event, _)| event.at_s <= time_s) {
            self.begin(self.next, context);
            self.next += 1;
        }
        for motion in &self.motions {
            let t = if motion.over_s > 0.0 {
                engine::math::clamp((time_s - motion.start_s) / motion.over_s, 0.0, 1.0)
            } else {
                1.0
            };
            let at_norm = motion.from_norm + t * (motion.to_norm - motion.from_norm);
            match self.at.iter_mut().find(|(control, _)| *control == motion.control) {
                Some((_, at)) => *at = at_norm,
                None => self.at.push((motion.control, at_norm)),
            }
            self.device.set(context, motion.control, at_norm);
        }
        self.motions.retain(|motion| time_s < motion.start_s + motion.over_s);
    }
}
