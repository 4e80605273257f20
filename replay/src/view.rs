//! A flight as a rerun recording: the aircraft in 3D, its track, plots, modes and events.
//!
//! ```text
//! /world                    NED, origin on the ground at the start; x north, y east, z down
//!   ground, grid            a plane and its lines that stay under the aircraft, in whole steps
//!   pad                     where the origin is
//!   start                   where the flight began, and along which heading
//!   chase                   where the aircraft is, turned with its heading: the eye's frame
//!   path                    the whole flight by configuration, with a post to the ground now and then
//!   flown                   the last half minute, by configuration
//!   plumb                   from the aircraft straight down to the ground
//!   wind                    where the air goes, over the aircraft
//!   aircraft                body axes at the centre of gravity
//!     airframe              drawing's axes turned to the body's: forward, right, down
//!       flap_…, flaperon_…, elevator, rudder_…      turn about their hinges
//!       gear_{nose,left,right}          move up and down, and are pressed in
//!       nacelle_{left,right}            tilts about the pivot
//!         tip_path_{left,right}         the gimballed disc on the mast
//!           rotor_{left,right}          turns in it
//!     forces, moments       arrows of the components
//! /map                      the track in latitude and longitude
//! /corridor                 airspeed over incidence, see `corridor`
//! /heading, /numbers        which flight it is, and numbers at the cursor, as pages
//! /plots, /times, /raw, /fields           see `plots`, `raw`, `fields`
//! /modes, /validity, /events              see `modes`, `events`
//! ```
//! Two flights in one recording ([`draw_against`]) are below their names with all of the above, and between
//! them
//! ```text
//! /delta/plots              the second less the first, of everything that is plotted
//! /delta/growth             logarithm of the difference in position, velocity, attitude, rates
//! /delta/numbers            numbers of both at the cursor
//! /delta/apart              a line in the world from one aircraft to the other
//! /delta/largest            the largest difference of each line
//! ```
//! Times are `tick` and `sim_time`, both exact; nothing carries the wall clock but the words that say when it was flown. An `.rrd` is a
//! rendering for the eye, in single precision where rerun has nothing else: the log is the truth.

mod against;
mod airframe;
mod basics;
mod blueprint;
mod canvas;
mod columns;
pub mod control;
mod corridor;
mod events;
mod field;
mod fields;
mod file;
mod forces;
mod heading;
mod lanes;
mod largest;
mod layout;
mod link;
pub mod live;
mod look;
mod modes;
mod numbers;
mod own;
mod parts;
mod plots;
mod raw;
#[cfg(test)]
mod read_back;
mod scene;
mod scenery;
mod sections;
mod solid;
mod stamp;
mod still;
mod surfaces;
mod track;

use engine::aircraft::Params as Aircraft;
use logs::output::Output;
use logs::records::TimingRecord;

pub use against::{Comparison, DrawError, Drawn, Other, draw_against};
pub use basics::{Severity, ViewError, level, severity};
pub use canvas::About;
use canvas::Canvas;
use events::Happened;
use file::Saved;
pub use layout::Layout;
use look::Look;
pub use own::{Own, OwnError};
use parts::Plan;
pub use stamp::{Mark, Stamp, Standing};
pub use track::Moment;
use track::Track;

use crate::judgement::Judgement;

/// Draws a flight into an `.rrd` file while it is flown or reflown.
///
/// Rows do not gather: those of a chunk and a path that is thinned are in memory, and rerun's index of the file,
/// which is written at its end. That has a value in each of its columns, one for every component on every
/// timeline, for every chunk (`RrdManifestBuilder`, 0.36.3): some kilobytes a chunk, .04 MB for a second of flight
/// were chunks ten seconds long. So they grow with the root of the flight up to half a minute, and a file of more
/// chunks than there is room for has no index: it is read whole, as those of older versions are. The first error
/// is kept and told by [`finish`](Self::finish), so that drawing never stops a flight. Dropped without `finish`, the file is readable but lacks its last rows and
/// the whole path.
pub struct FlightView {
    saved: Saved,
    canvas: Canvas,
    track: Track,
    /// Events so far.
    told: u64,
}

impl FlightView {
    /// Begins the file, which whoever asked for it finishes, with everything that does not move and the
    /// viewer's layout.
    pub fn new(
        out: &Output,
        about: &About,
        layout: &Layout,
        aircraft: &Aircraft,
    ) -> Result<Self, ViewError> {
        let saved = Saved::new(out)?;
        let look = Look::alone();
        let plan = (layout.clone(), Plan::new(&[&look.root]));
        let drawn = [(&look, aircraft)];
        let mut canvas = Canvas::begin(Box::new(saved.file.clone()), about, plan, &drawn)
            .map_err(|error| saved.refused(error))?;
        let mut track = Track::new(look, aircraft, layout.fields());
        track.begin(&mut canvas);
        Ok(Self { saved, canvas, track, told: 0 })
    }

    /// Takes what was seen at a tick. Call it every tick; one in five is drawn.
    pub fn push(&mut self, seen: Moment) {
        self.track.push(&mut self.canvas, seen);
    }

    /// Takes how a tick kept time.
    pub fn time(&mut self, timing: &TimingRecord) {
        self.track.time(&mut self.canvas, timing);
    }

    /// Another state took the place of the one at a tick, from which the next one is flown.
    pub fn restart(&mut self, tick: u64) {
        self.track.restart(&mut self.canvas, tick);
    }

    /// Notes the next event of the log.
    pub fn event(&mut self, tick: u64, level: Severity, text: &str) {
        self.told += 1;
        let happened = Happened { tick, level, words: text, number: Some(self.told) };
        self.track.event(&mut self.canvas, happened);
    }

    /// Notes what the log is, which begins at that tick.
    pub fn judge(&mut self, tick: u64, judgement: &Judgement) {
        self.track.judge(&mut self.canvas, tick, judgement);
    }

    /// Notes who flew.
    pub fn flown_by(&mut self, who: &str) {
        self.track.facts.flown_by(who);
    }

    /// Writes what is left and closes the file; its size in bytes.
    pub fn finish(mut self, mark: Mark) -> Result<u64, ViewError> {
        self.track.finish(&mut self.canvas);
        self.saved.finish(self.canvas, &mark.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Outputs;
    use engine::frames::{Euler, Vec3};
    use engine::inputs::World;
    use engine::math::{FRAC_PI_2, clamp, cos, ramp, sin};
    use engine::pair::Pair;
    use engine::state::Geodetic;
    use logs::LogError;
    use std::path::Path;

    const SECOND: u64 = 250;

    fn xv15() -> engine::Aircraft {
        aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap_or_else(|error| panic!("{error}"))
    }

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

    fn view(out: &Output, title: &str) -> Result<FlightView, ViewError> {
        let about =
            About { title: title.into(), recording_id: "a-test".into(), ..About::default() };
        FlightView::new(out, &about, &Layout::Pilot, &xv15())
    }

    fn draw(path: &Path, ticks: u64) -> u64 {
        let out = Output::beside(path, false, &[]).expect("a writable folder");
        let mut view = view(&out, "a climbing turn").expect("a recording");
        let mut outputs = Outputs::default();
        outputs.balance.cg_m = Vec3::new(7.65, 0.0, 2.074);
        outputs.position_m.z = -2.2;
        view.event(0, Severity::Info, "flight begins");
        for tick in 0..=ticks {
            outputs = flight(tick, &outputs);
            let world = World::default();
            view.push(Moment { outputs: &outputs, world: &world, events: &[] });
            view.time(&TimingRecord { tick, step_ns: 20_000, ..TimingRecord::default() });
            if tick == 6 * SECOND {
                view.event(tick, Severity::Info, "marker 1");
            }
            if tick == 13 * SECOND {
                view.event(tick, Severity::Warning, "rotor wake meets the tail");
            }
        }
        let mark = Mark { status: 0, first_difference: None };
        let bytes = view.finish(mark).expect("a disk with room");
        out.finish().expect("in its place");
        bytes
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
        let out = Output::beside(&folder.path().join("long.rrd"), false, &[]).expect("a file");
        let mut view = view(&out, "long").expect("a recording");
        let mut outputs = Outputs::default();
        for step in 0..20_000_u32 {
            outputs.position_m.x = f64::from(step) * 1.5;
            view.track.follow(&outputs);
        }
        assert!(view.track.trail.len() <= track::PATH_POINTS_MAX);
        assert!(view.track.trail_spacing_m > 1.0);
    }

    #[test]
    fn a_file_that_cannot_be_written_is_told() {
        let missing = Path::new("/nonexistent/folder/flight.rrd");
        assert!(matches!(Output::beside(missing, false, &[]), Err(LogError::Create { .. })));
        let full = Output::beside(Path::new("/dev/full"), true, &[]).expect("a device");
        assert!(matches!(view(&full, "x"), Err(ViewError::Write { .. })));
    }
}
