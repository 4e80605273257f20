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
mod layout;
mod plots;
mod scenery;

use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use engine::frames::{Attitude, Body, Ned, Structural, Vec3};
use engine::math::{cos, sin};
use engine::pair::Pair;
use engine::state::Geodetic;
use engine::{Outputs, STEP_NS};
use rerun::{
    Arrows3D, GeoLineStrings, GeoPoints, LineStrips3D, Quaternion, Radius, RecordingStream,
    Scalars, SerializedComponentColumn, StateChange, StateConfiguration, TextLog, TimeColumn,
    Transform3D, ViewCoordinates,
};

use plots::{MODES, PLOTS};

/// Of this many ticks one is drawn: 50 Hz.
const TICKS_PER_ROW: u64 = 5;
/// Rows gathered before they are written: ten seconds, about a megabyte.
const ROWS_PER_CHUNK: usize = 500;
/// Of this many rows one makes a piece of the flown line: 10 Hz.
const ROWS_PER_PIECE: usize = 5;
/// The path is thinned by half when it has more points than this.
const PATH_POINTS_MAX: usize = 8192;
/// Posts under the path, at most.
const POSTS_MAX: usize = 60;
/// An arrow is this long per newton: a rotor that hovers has one of 4 m.
const ARROW_M_PER_N: f64 = 1.0 / 7000.0;
/// Ticks of the timeline `tick`.
const TICK: &str = "tick";
/// Nanoseconds of the timeline that the viewer opens on.
const SIM_TIME: &str = "sim_time";

/// Left is red and right is green, as the navigation lights are.
const SIDES: Pair<u32> = Pair { left: 0xE0_4A_3F_FF, right: 0x3F_B9_5A_FF };

/// Why a flight could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// The recording could not be begun or fed.
    #[error("cannot write the recording {path}: {source}")]
    Recording {
        /// Which file.
        path: PathBuf,
        /// What rerun says.
        source: Box<rerun::RecordingStreamError>,
    },
    /// The file did not take everything: disk full, or taken away.
    #[error("the recording {path} is incomplete: {reason}")]
    Incomplete {
        /// Which file.
        path: PathBuf,
        /// What rerun says.
        reason: String,
    },
    /// The finished file cannot be looked at.
    #[error("cannot read back the recording {path}: {source}")]
    ReadBack {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
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

/// A point of the path.
#[derive(Clone, Copy)]
struct PathPoint {
    position_m: Vec3<Ned>,
    ground_z_m: f64,
    place: Geodetic,
}

impl PathPoint {
    fn new(outputs: &Outputs) -> Self {
        Self {
            position_m: outputs.position_m,
            ground_z_m: outputs.position_m.z + outputs.height_above_ground_m,
            place: outputs.place,
        }
    }

    fn on_ground_m(&self) -> Vec3<Ned> {
        Vec3::new(self.position_m.x, self.position_m.y, self.ground_z_m)
    }
}

/// Draws a flight into an `.rrd` file while it is flown or reflown.
///
/// Memory stays bounded however long the flight is. The first error is kept and told by
/// [`finish`](Self::finish), so that drawing never stops a flight.
pub struct FlightView {
    recording: RecordingStream,
    path: PathBuf,
    rows: Vec<Outputs>,
    flown_to_m: Option<Vec3<Ned>>,
    modes: Vec<Option<&'static str>>,
    trail: Vec<PathPoint>,
    trail_spacing_m: f64,
    error: Option<rerun::RecordingStreamError>,
}

impl FlightView {
    /// Begins the file at `path`, with everything that does not move and the viewer's layout.
    pub fn new(path: &Path, title: &str) -> Result<Self, ViewError> {
        let failed = |source| ViewError::Recording { path: path.into(), source: Box::new(source) };
        // Properties are sent by name only: rerun would add the wall clock.
        let recording = rerun::RecordingStreamBuilder::new("tiltrotor")
            .enabled(true)
            .send_properties(false)
            .save(path)
            .map_err(failed)?;
        recording.set_log_time_enabled(false);
        recording.set_log_tick_enabled(false);
        recording.send_recording_name(title).map_err(failed)?;
        send_still_life(&recording).map_err(failed)?;
        layout::send(&recording).map_err(failed)?;
        Ok(Self {
            recording,
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
        let path = std::mem::take(&mut self.path);
        if let Err(source) = send_path(&self.recording, &self.trail) {
            self.error.get_or_insert(source);
        }
        if let Some(source) = self.error.take() {
            return Err(ViewError::Recording { path, source: Box::new(source) });
        }
        if let Err(source) = self.recording.flush_blocking() {
            return Err(ViewError::Incomplete { path, reason: source.to_string() });
        }
        // Closes the file and waits for its footer, whose failure rerun only logs.
        self.recording.disconnect();
        match whole_length(&path) {
            Ok(Some(bytes)) => Ok(bytes),
            Ok(None) => Err(ViewError::Incomplete { path, reason: "it has no end".into() }),
            Err(source) => Err(ViewError::ReadBack { path, source }),
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

    fn send(
        &mut self,
        entity: &str,
        times: &[TimeColumn],
        columns: rerun::SerializationResult<Vec<SerializedComponentColumn>>,
    ) {
        let sent = columns.map_err(Into::into).and_then(|columns| {
            self.recording.send_columns(entity, times.iter().cloned(), columns)
        });
        if let Err(error) = sent {
            self.error.get_or_insert(error);
        }
    }
}

/// Length of a file that has its footer; nothing for one without.
fn whole_length(path: &Path) -> std::io::Result<Option<u64>> {
    // The last twelve bytes: a checksum's end, this, and a count.
    const FOOTER: &[u8] = b"FOOT";
    let mut file = File::open(path)?;
    let bytes = file.metadata()?.len();
    let mut end = [0; 12];
    if bytes < end.len() as u64 {
        return Ok(None);
    }
    file.seek(SeekFrom::End(-(end.len() as i64)))?;
    file.read_exact(&mut end)?;
    Ok(end.windows(FOOTER.len()).any(|bytes| bytes == FOOTER).then_some(bytes))
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

type Columns = rerun::SerializationResult<Vec<SerializedComponentColumn>>;

/// Everything in the world that moves.
fn moving_columns(rows: &[Outputs]) -> Vec<(&'static str, Columns)> {
    let pose = |position: fn(&Outputs) -> [f32; 3], attitude: fn(&Outputs) -> Quaternion| {
        Transform3D::new()
            .with_many_translation(rows.iter().map(position))
            .with_many_quaternion(rows.iter().map(attitude))
            .columns_of_unit_batches()
            .map(Vec::from_iter)
    };
    let thrust = |hub: fn(&Outputs) -> Vec3<Body>, force: fn(&Outputs) -> Vec3<Body>| {
        Arrows3D::from_vectors(rows.iter().map(|row| point(force(row) * ARROW_M_PER_N)))
            .with_origins(rows.iter().map(|row| point(hub(row))))
            .columns_of_unit_batches()
            .map(Vec::from_iter)
    };
    let plumb = LineStrips3D::new(rows.iter().map(|row| {
        let below = PathPoint::new(row);
        [point(below.position_m), point(below.on_ground_m())]
    }));
    let track = GeoPoints::from_lat_lon(rows.iter().map(|row| degrees(&row.place)));
    vec![
        ("world/ground", pose(|row| under(row, scenery::PLANE_STEP_M), |_| Quaternion::IDENTITY)),
        ("world/grid", pose(|row| under(row, scenery::GRID_STEP_M), |_| Quaternion::IDENTITY)),
        ("world/chase", pose(|row| point(row.position_m), |row| turn(row.euler.heading_rad))),
        ("world/aircraft", pose(|row| point(row.position_m), attitude)),
        ("world/aircraft/airframe", pose(datum, |_| Quaternion::IDENTITY)),
        (
            "world/aircraft/airframe/nacelle_left",
            pose(|_| airframe::PIVOT_M.left, |row| tilt(row.actuators.mast_tilt_rad.left)),
        ),
        (
            "world/aircraft/airframe/nacelle_right",
            pose(|_| airframe::PIVOT_M.right, |row| tilt(row.actuators.mast_tilt_rad.right)),
        ),
        (
            "world/aircraft/airframe/nacelle_left/rotor_left",
            pose(|_| airframe::HUB_M, |row| turn(row.rotor_azimuth_rad)),
        ),
        (
            "world/aircraft/airframe/nacelle_right/rotor_right",
            pose(|_| airframe::HUB_M, |row| turn(-row.rotor_azimuth_rad)),
        ),
        ("world/aircraft/airframe/gear", pose(gear, |_| Quaternion::IDENTITY)),
        (
            "world/aircraft/thrust_left",
            thrust(|row| hub(row).left, |row| row.rotors.left.load.force_n),
        ),
        (
            "world/aircraft/thrust_right",
            thrust(|row| hub(row).right, |row| row.rotors.right.load.force_n),
        ),
        ("world/plumb", plumb.columns_of_unit_batches().map(Vec::from_iter)),
        ("map/aircraft", track.columns_of_unit_batches().map(Vec::from_iter)),
    ]
}

fn point<F>(v: Vec3<F>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

fn degrees(place: &Geodetic) -> [f64; 2] {
    [place.latitude_rad.to_degrees(), place.longitude_rad.to_degrees()]
}

fn attitude(outputs: &Outputs) -> Quaternion {
    let Attitude { w, x, y, z } = Attitude::from_euler(outputs.euler);
    Quaternion::from_xyzw([x as f32, y as f32, z as f32, w as f32])
}

/// On the ground under the aircraft, to whole steps: what repeats every step seems to stand still.
fn under(outputs: &Outputs, step_m: f64) -> [f32; 3] {
    let Vec3 { x, y, z, .. } = PathPoint::new(outputs).on_ground_m();
    let whole = |along_m: f64| (along_m / step_m).round() * step_m;
    point(Vec3::<Ned>::new(whole(x), whole(y), z))
}

/// Where the drawing's datum is, in body axes.
fn datum(outputs: &Outputs) -> [f32; 3] {
    point(Vec3::<Structural>::zero().from_cg(outputs.balance.cg_m))
}

/// The hubs, in body axes.
fn hub(outputs: &Outputs) -> Pair<Vec3<Body>> {
    let datum = Vec3::<Structural>::zero().from_cg(outputs.balance.cg_m);
    airframe::PIVOT_M.zip(outputs.actuators.mast_tilt_rad).map(|([x, y, z], tilt_rad)| {
        let pivot = datum + Vec3::new(f64::from(x), f64::from(y), f64::from(z));
        pivot + Vec3::new(sin(tilt_rad), 0.0, -cos(tilt_rad)) * airframe::MAST_M
    })
}

/// A nacelle: tilting forward is a turn about −y.
fn tilt(mast_tilt_rad: f64) -> Quaternion {
    let half_rad = -0.5 * mast_tilt_rad;
    Quaternion::from_xyzw([0.0, sin(half_rad) as f32, 0.0, cos(half_rad) as f32])
}

/// About z, down: a rotor on its mast, a heading.
fn turn(angle_rad: f64) -> Quaternion {
    let half_rad = 0.5 * angle_rad;
    Quaternion::from_xyzw([0.0, 0.0, sin(half_rad) as f32, cos(half_rad) as f32])
}

/// The gear: retracted it is inside the fuselage and its pods.
fn gear(outputs: &Outputs) -> [f32; 3] {
    let up = 1.0 - outputs.actuators.gear_extension_norm;
    [0.0, 0.0, -up as f32 * airframe::GEAR_TRAVEL_M]
}

/// Sends what does not move: shapes, colours, names.
fn send_still_life(recording: &RecordingStream) -> rerun::RecordingStreamResult<()> {
    recording.log_static("world", &ViewCoordinates::FRD())?;
    recording.log_static("world/ground", &scenery::plane())?;
    recording.log_static("world/ground/lines", &scenery::far_lines())?;
    recording.log_static("world/grid", &scenery::near_lines())?;
    recording.log_static("world/pad", &scenery::pad())?;
    recording.log_static("world/aircraft/airframe", &airframe::airframe().mesh())?;
    recording.log_static("world/aircraft/airframe/gear", &airframe::gear().mesh())?;
    for (side, colour) in [("left", SIDES.left), ("right", SIDES.right)] {
        let nacelle = format!("world/aircraft/airframe/nacelle_{side}");
        recording.log_static(nacelle.as_str(), &airframe::nacelle().mesh())?;
        let rotor = format!("{nacelle}/rotor_{side}");
        recording.log_static(rotor.as_str(), &airframe::blades().mesh())?;
        recording.log_static(format!("{rotor}/disc"), &airframe::disc(colour))?;
        recording.log_static(
            format!("world/aircraft/thrust_{side}"),
            &Arrows3D::update_fields().with_radii([0.11]).with_colors([colour]),
        )?;
    }
    recording.log_static(
        "world/flown",
        &LineStrips3D::update_fields()
            .with_radii([Radius::new_ui_points(2.5)])
            .with_colors([0xFF_C2_3A_FF]),
    )?;
    recording.log_static(
        "world/plumb",
        &LineStrips3D::update_fields()
            .with_radii([Radius::new_ui_points(0.7)])
            .with_colors([0xFF_FF_FF_90]),
    )?;
    recording.log_static(
        "map/aircraft",
        &GeoPoints::update_fields()
            .with_radii([Radius::new_ui_points(7.0)])
            .with_colors([0xFF_C2_3A_FF]),
    )?;
    for plot in PLOTS {
        recording.log_static(
            plot.path,
            &rerun::SeriesLines::new()
                .with_names([plot.name])
                .with_colors([plot.colour])
                .with_widths([plot.width()]),
        )?;
    }
    for mode in MODES {
        let (values, colours): (Vec<&str>, Vec<u32>) = mode.values.iter().copied().unzip();
        recording.log_static(
            mode.path,
            &StateConfiguration::new().with_values(values).with_colors(colours),
        )?;
    }
    Ok(())
}

/// Sends what is known only at the end: the whole path.
fn send_path(recording: &RecordingStream, trail: &[PathPoint]) -> rerun::RecordingStreamResult<()> {
    let path = trail.iter().map(|at| point(at.position_m));
    recording.log_static(
        "world/path",
        &LineStrips3D::new([path.collect::<Vec<_>>()])
            .with_radii([Radius::new_ui_points(1.0)])
            .with_colors([0x7F_D0_FF_FF]),
    )?;
    let spacing = (trail.len() / POSTS_MAX).max(20);
    let posts = trail.iter().step_by(spacing);
    recording.log_static(
        "world/path/posts",
        &LineStrips3D::new(posts.map(|at| [point(at.position_m), point(at.on_ground_m())]))
            .with_radii([Radius::new_ui_points(0.5)])
            .with_colors([0x7F_D0_FF_60]),
    )?;
    recording.log_static(
        "map/track",
        &GeoLineStrings::from_lat_lon([trail.iter().map(|at| degrees(&at.place))])
            .with_radii([Radius::new_ui_points(1.5)])
            .with_colors([0x7F_D0_FF_FF]),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::frames::Euler;
    use engine::math::{FRAC_PI_2, clamp, ramp};

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

    /// `TILTROTOR_VIEW=/tmp/flight.rrd cargo test -p replay -- --ignored a_flight_to_look_at`
    #[test]
    #[ignore = "writes a file to look at"]
    fn a_flight_to_look_at() {
        let path = std::env::var_os("TILTROTOR_VIEW").expect("TILTROTOR_VIEW names a file");
        draw(Path::new(&path), 20 * SECOND);
    }

    #[test]
    fn a_file_without_its_end_is_not_whole() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("flight.rrd");
        let bytes = draw(&path, SECOND);
        let file = File::options().write(true).open(&path).expect("the file");
        file.set_len(bytes - 100).expect("a shorter file");
        assert!(matches!(whole_length(&path), Ok(None)));
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
        assert!(matches!(FlightView::new(missing, "x"), Err(ViewError::Recording { .. })));
    }
}
