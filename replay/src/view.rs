//! A flight as a rerun recording: the aircraft in 3D, its track, plots, modes and events.
//!
//! ```text
//! /world                    NED, origin on the ground at the start; x north, y east, z down
//!   ground, grid            a plane and its lines that stay under the aircraft, in whole steps
//!   pad                     where the origin is
//!   chase                   where the aircraft is, turned with its heading: the eye's frame
//!   path                    the whole flight, with a post to the ground now and then
//!   flown                   the last half minute
//!   plumb                   from the aircraft straight down to the ground
//!   aircraft                body axes at the centre of gravity
//!     airframe              drawing's axes turned to the body's: forward, right, down
//!       nacelle_{left,right}            tilts about the pivot
//!         rotor_{left,right}            turns about the mast
//!       gear                            moves up and down
//!     thrust_{left,right}   force of each rotor
//! /map                      the track in latitude and longitude
//! /plots, /modes, /events   see `plots` and `layout`
//! ```
//! Times are `tick` and `sim_time`, both exact; nothing carries the wall clock. An `.rrd` is a
//! rendering for the eye, in single precision where rerun has nothing else: the log is the truth.

mod airframe;
mod file;
mod layout;
mod plots;
mod scene;
mod scenery;

use std::path::{Path, PathBuf};

use engine::frames::{Ned, Vec3};
use engine::pair::Pair;
use engine::{Outputs, STEP_NS};
use rerun::external::re_log_encoding::rrd::EncodeError;
use rerun::sink::SinkFlushError;
use rerun::{
    LineStrips3D, RecordingStream, RecordingStreamBuilder, RecordingStreamError,
    RecordingStreamResult, Scalars, StateChange, TextLog, TimeColumn,
};

use file::RrdFile;
use plots::{MODES, PLOTS};
use scene::{Columns, PathPoint, moving_columns, point, send_path, send_still_life};

/// Of this many ticks one is drawn: 50 Hz.
const TICKS_PER_ROW: u64 = 5;
/// Rows gathered before they are written: ten seconds, about a megabyte.
const ROWS_PER_CHUNK: usize = 500;
/// Of this many rows one makes a piece of the flown line: 10 Hz.
const ROWS_PER_PIECE: usize = 5;
/// The path is thinned by half when it has more points than this.
const PATH_POINTS_MAX: usize = 8192;
/// Ticks of the timeline `tick`.
const TICK: &str = "tick";
/// Nanoseconds of the timeline that the viewer opens on.
const SIM_TIME: &str = "sim_time";

/// Left is red and right is green, as the navigation lights are.
const SIDES: Pair<u32> = Pair { left: 0xE0_4A_3F_FF, right: 0x3F_B9_5A_FF };

/// Why a flight could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The file could not be made, or did not take everything: disk full, or taken away.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// Which file.
        path: PathBuf,
        /// What rerun, or through it the system, says.
        source: EncodeError,
    },
    /// Rerun refused something.
    #[error("cannot draw the flight for {}: {source}", path.display())]
    Draw {
        /// Which file.
        path: PathBuf,
        /// What rerun says.
        source: Box<RecordingStreamError>,
    },
    /// Rerun stopped before everything was written.
    #[error("the recording {} is incomplete: {source}", path.display())]
    Flush {
        /// Which file.
        path: PathBuf,
        /// What rerun says.
        source: SinkFlushError,
    },
}

/// How much an event matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// Good to know: a marker, a device that appeared.
    Info,
    /// Needs attention: a device gone, a model beyond its data.
    Warning,
    /// Something failed.
    Error,
}

impl Level {
    fn name(self) -> &'static str {
        match self {
            Self::Info => rerun::TextLogLevel::INFO,
            Self::Warning => rerun::TextLogLevel::WARN,
            Self::Error => rerun::TextLogLevel::ERROR,
        }
    }
}

/// Draws a flight into an `.rrd` file while it is flown or reflown.
///
/// Memory hardly grows with the flight: ten seconds of rows, a path that is thinned, and rerun's
/// index of the file. The first error is kept and told by [`finish`](Self::finish), so that drawing
/// never stops a flight. Dropped without `finish`, the file is readable but lacks its last rows and
/// the whole path.
pub struct FlightView {
    recording: RecordingStream,
    file: RrdFile,
    path: PathBuf,
    rows: Vec<Outputs>,
    flown_to_m: Option<Vec3<Ned>>,
    modes: Vec<Option<&'static str>>,
    trail: Vec<PathPoint>,
    trail_spacing_m: f64,
    error: Option<RecordingStreamError>,
}

impl FlightView {
    /// Begins the file at `path`, with everything that does not move and the viewer's layout.
    pub fn new(path: &Path, title: &str) -> Result<Self, ViewError> {
        let file = RrdFile::create(path)
            .map_err(|source| ViewError::Write { path: path.into(), source })?;
        let recording = begin(&file, title)
            .map_err(|source| ViewError::Draw { path: path.into(), source: Box::new(source) })?;
        Ok(Self {
            recording,
            file,
            path: path.into(),
            rows: Vec::with_capacity(ROWS_PER_CHUNK),
            flown_to_m: None,
            modes: vec![None; MODES.len()],
            trail: Vec::new(),
            trail_spacing_m: 1.0,
            error: None,
        })
    }

    /// Takes what a step gave. Call it every tick; one in five is drawn.
    pub fn push(&mut self, outputs: &Outputs) {
        if !outputs.tick.is_multiple_of(TICKS_PER_ROW) {
            return;
        }
        self.follow(outputs);
        self.show_modes(outputs);
        self.rows.push(*outputs);
        if self.rows.len() >= ROWS_PER_CHUNK {
            self.flush();
        }
    }

    /// Notes an event.
    pub fn event(&mut self, tick: u64, level: Level, text: &str) {
        let columns = TextLog::new(text)
            .with_level(level.name())
            .columns_of_unit_batches()
            .map(Vec::from_iter);
        self.send("events", &times(&[tick]), columns);
    }

    /// Writes what is left and closes the file; its size in bytes.
    pub fn finish(mut self) -> Result<u64, ViewError> {
        self.flush();
        let ended =
            send_path(&self.recording, &self.trail).and_then(|()| layout::send(&self.recording, 2));
        if let Err(source) = ended {
            self.error.get_or_insert(source);
        }
        // Waits until everything is in the file.
        let flushed = self.recording.flush_blocking();
        let Self { file, path, error, .. } = self;
        let closed = file.close().and_then(|()| Ok(std::fs::metadata(&path)?.len()));
        match (closed, error, flushed) {
            (Err(source), ..) => Err(ViewError::Write { path, source }),
            (_, Some(source), _) => Err(ViewError::Draw { path, source: Box::new(source) }),
            (.., Err(source)) => Err(ViewError::Flush { path, source }),
            (Ok(bytes), None, Ok(())) => Ok(bytes),
        }
    }

    /// Adds to the path when the aircraft has moved on.
    fn follow(&mut self, outputs: &Outputs) {
        let moved_m = self.trail.last().map(|last| (outputs.position_m - last.position_m).norm());
        if moved_m.is_some_and(|moved_m| moved_m < self.trail_spacing_m) {
            return;
        }
        self.trail.push(PathPoint::new(outputs));
        if self.trail.len() > PATH_POINTS_MAX {
            self.trail = self.trail.iter().copied().step_by(2).collect();
            self.trail_spacing_m *= 2.0;
        }
    }

    /// Writes the modes that changed.
    fn show_modes(&mut self, outputs: &Outputs) {
        for (index, mode) in MODES.iter().enumerate() {
            let value = (mode.of)(outputs);
            if self.modes[index] == Some(value) {
                continue;
            }
            self.modes[index] = Some(value);
            let columns = StateChange::single(value).columns_of_unit_batches().map(Vec::from_iter);
            self.send(mode.path, &times(&[outputs.tick]), columns);
        }
    }

    /// Writes the rows gathered.
    fn flush(&mut self) {
        let rows = std::mem::replace(&mut self.rows, Vec::with_capacity(ROWS_PER_CHUNK));
        if rows.is_empty() {
            return;
        }
        let ticks: Vec<u64> = rows.iter().map(|row| row.tick).collect();
        let times = times(&ticks);
        for (entity, columns) in moving_columns(&rows) {
            self.send(entity, &times, columns);
        }
        for plot in PLOTS {
            let scalars = Scalars::new(rows.iter().map(plot.of));
            self.send(plot.path, &times, scalars.columns_of_unit_batches().map(Vec::from_iter));
        }
        self.send_flown(&rows);
    }

    /// The line behind the aircraft, piece by piece, so that the viewer can show the last of them.
    fn send_flown(&mut self, rows: &[Outputs]) {
        let mut ticks = Vec::new();
        let mut pieces = Vec::new();
        for row in rows.iter().step_by(ROWS_PER_PIECE) {
            let from_m = self.flown_to_m.replace(row.position_m).unwrap_or(row.position_m);
            ticks.push(row.tick);
            pieces.push([point(from_m), point(row.position_m)]);
        }
        let columns = LineStrips3D::new(pieces).columns_of_unit_batches().map(Vec::from_iter);
        self.send("world/flown", &times(&ticks), columns);
    }

    fn send(&mut self, entity: &str, times: &[TimeColumn], columns: Columns) {
        let sent = columns.map_err(Into::into).and_then(|columns| {
            self.recording.send_columns(entity, times.iter().cloned(), columns)
        });
        if let Err(error) = sent {
            self.error.get_or_insert(error);
        }
    }
}

/// A recording into `file` that knows no wall clock, with everything that does not move.
fn begin(file: &RrdFile, title: &str) -> RecordingStreamResult<RecordingStream> {
    // Of its properties only the name is sent: rerun would add when it began.
    let recording =
        RecordingStreamBuilder::new("tiltrotor").enabled(true).send_properties(false).buffered()?;
    recording.set_sink(Box::new(file.clone()));
    recording.set_log_time_enabled(false);
    recording.set_log_tick_enabled(false);
    recording.send_recording_name(title)?;
    send_still_life(&recording)?;
    layout::send(&recording, 1)?;
    Ok(recording)
}

/// Both timelines of some rows.
fn times(ticks: &[u64]) -> [TimeColumn; 2] {
    let signed = |value: u64| i64::try_from(value).unwrap_or(i64::MAX);
    [
        TimeColumn::new_sequence(TICK, ticks.iter().map(|&tick| signed(tick))),
        TimeColumn::new_duration_nanos(
            SIM_TIME,
            ticks.iter().map(|&tick| signed(tick.saturating_mul(STEP_NS))),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::frames::Euler;
    use engine::math::{FRAC_PI_2, clamp, cos, ramp, sin};
    use engine::state::Geodetic;

    const SECOND: u64 = 250;

    /// Twenty seconds: up from the pad, a climbing turn, nacelles going down.
    fn flight(tick: u64, before: &Outputs) -> Outputs {
        let time_s = tick as f64 * engine::STEP_S;
        let step_s = engine::STEP_S;
        let converted = ramp(time_s, 5.0, 18.0);
        let speed_mps = 55.0 * ramp(time_s, 2.0, 20.0);
        let turn_radps = 0.12 * ramp(time_s, 6.0, 8.0);
        let heading_rad = before.euler.heading_rad + turn_radps * step_s;
        let climb_mps = 4.0 * ramp(time_s, 0.5, 2.0);
        let mut now = *before;
        now.tick = tick;
        now.euler = Euler {
            roll_rad: 0.35 * ramp(time_s, 6.0, 8.0),
            pitch_rad: 0.06 * ramp(time_s, 3.0, 5.0) - 0.05 * ramp(time_s, 1.0, 3.0),
            heading_rad,
        };
        now.velocity_mps =
            Vec3::new(speed_mps * cos(heading_rad), speed_mps * sin(heading_rad), -climb_mps);
        now.position_m += now.velocity_mps * step_s;
        now.height_above_ground_m = -now.position_m.z;
        let origin = Geodetic { latitude_rad: 0.653_0, longitude_rad: -2.130_0, height_m: 0.0 };
        now.place = engine::outputs::place(&origin, now.position_m);
        now.airspeed_mps = speed_mps;
        now.calibrated_airspeed_mps = 0.97 * speed_mps;
        now.angular_rate_radps.z = turn_radps;
        now.load_factor = 1.0 + 0.07 * ramp(time_s, 6.0, 8.0);
        now.actuators.mast_tilt_rad = Pair::both(FRAC_PI_2 * converted);
        now.actuators.gear_extension_norm = 1.0 - ramp(time_s, 8.0, 13.0);
        now.actuators.flap_rad = 0.7 * (1.0 - 0.5 * converted);
        now.cockpit.stick_right_norm = 0.3 * (ramp(time_s, 6.0, 7.0) - ramp(time_s, 7.0, 8.0));
        now.cockpit.stick_aft_norm = 0.1 * sin(1.3 * time_s);
        now.cockpit.collective_norm = 0.6 - 0.2 * converted;
        now.cockpit.scas_on = 1;
        now.cockpit.flap_detent = if time_s < 12.0 { 2 } else { 1 };
        now.rotor_speed_radps = 61.68;
        now.rotor_azimuth_rad = 61.68 * time_s % engine::math::TAU;
        let thrust_n = 29_000.0 * (1.0 - 0.6 * converted);
        let tilt_rad = now.actuators.mast_tilt_rad.left;
        now.rotors = Pair::both(engine::rotors::Outputs {
            load: engine::frames::Load {
                force_n: Vec3::new(sin(tilt_rad), 0.0, -cos(tilt_rad)) * thrust_n,
                ..Default::default()
            },
            thrust_n,
            torque_n_m: 12_000.0 * (1.0 - 0.4 * converted),
            ..Default::default()
        });
        now.engines.power_w = Pair::both(760e3 * (1.0 - 0.4 * converted));
        now.engines.available_w = 1_156e3;
        now.fuel_kg = 650.0 - 0.1 * time_s;
        now.landing_gear.main = Pair::both(engine::landing_gear::Leg {
            push_n: 25_000.0 * clamp(1.0 - time_s, 0.0, 1.0),
            ..Default::default()
        });
        now
    }

    fn draw(path: &Path, ticks: u64) -> u64 {
        let mut view = FlightView::new(path, "a climbing turn").expect("a writable folder");
        let mut outputs = Outputs::default();
        outputs.balance.cg_m = Vec3::new(7.65, 0.0, 2.074);
        outputs.position_m.z = -2.2;
        view.event(0, Level::Info, "flight begins");
        for tick in 0..=ticks {
            outputs = flight(tick, &outputs);
            view.push(&outputs);
            if tick == 6 * SECOND {
                view.event(tick, Level::Info, "marker 1");
            }
            if tick == 13 * SECOND {
                view.event(tick, Level::Warning, "rotor wake meets the tail");
            }
        }
        view.finish().expect("a disk with room")
    }

    #[test]
    fn a_flight_becomes_a_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("flight.rrd");
        let bytes = draw(&path, 20 * SECOND);
        assert!(bytes > 100_000, "{bytes}");
        assert_eq!(std::fs::metadata(&path).expect("the file").len(), bytes);
    }

    #[test]
    fn a_long_flight_keeps_a_short_path() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut view = FlightView::new(&folder.path().join("long.rrd"), "long").expect("a file");
        let mut outputs = Outputs::default();
        for step in 0..20_000_u32 {
            outputs.position_m.x = f64::from(step) * 1.5;
            view.follow(&outputs);
        }
        assert!(view.trail.len() <= PATH_POINTS_MAX);
        assert!(view.trail_spacing_m > 1.0);
    }

    #[test]
    fn a_file_that_cannot_be_made_is_told() {
        let missing = Path::new("/nonexistent/folder/flight.rrd");
        assert!(matches!(FlightView::new(missing, "x"), Err(ViewError::Write { .. })));
    }
}
