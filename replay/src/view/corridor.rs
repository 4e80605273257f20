//! The conversion corridor as a plane: calibrated airspeed to the right, nacelle incidence up.
//!
//! A plane of the viewer is as long across as up, and counts downwards: an incidence of 1° is drawn 1.2 kt high.

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::math::max;
use engine::units::{degrees, knots};
use rerun::{LineStrips2D, Points2D, Radius, RecordingStream, RecordingStreamResult};

use super::look::Look;

/// Entities of the limits and the grid, of where the flight is, and of where it was.
pub const LIMITS: &str = "corridor/limits";
const GRID: &str = "corridor/grid";
/// Where the flight is.
pub const NOW: &str = "corridor/now";
const TRACK: &str = "corridor/track";

/// What is seen of the plane at first: airspeeds, kt, and incidences, deg.
pub const SEEN: [[f64; 2]; 2] = [[-30.0, 310.0], [-26.0, 104.0]];

/// High by so much for 1°.
const KT_PER_DEG: f64 = 1.2;
/// Points of the track are so far apart at least.
const SPACING_KT: f64 = 0.5;
/// The track is thinned by half when it has more points than this.
const POINTS_MAX: usize = 4096;
/// Points of a limit.
const STEPS: u32 = 60;

const LIMIT: u32 = 0xE8_E8_E8_FF;
const LINE: u32 = 0x58_60_68_FF;
const OUTSIDE: u32 = 0xFF_40_38_FF;

/// A point of the plane.
pub fn place(airspeed_kt: f64, incidence_deg: f64) -> [f32; 2] {
    [airspeed_kt as f32, (-KT_PER_DEG * incidence_deg) as f32]
}

fn place_of(outputs: &Outputs) -> [f32; 2] {
    let tilt_rad = outputs.actuators.mast_tilt_rad.mean();
    place(knots(outputs.calibrated_airspeed_mps), 90.0 - degrees(tilt_rad))
}

/// Sends limits and grid.
pub fn send_still(
    recording: &RecordingStream,
    look: &Look,
    aircraft: &Aircraft,
) -> RecordingStreamResult<()> {
    let corridor = &aircraft.envelope.corridor;
    let (least, greatest) =
        (aircraft.actuators.mast_tilt_rad_min, aircraft.actuators.mast_tilt_rad_max);
    let limit = |airspeed: &dyn Fn(f64) -> f64| -> Vec<[f32; 2]> {
        (0..=STEPS)
            .map(|i| least + (greatest - least) * f64::from(i) / f64::from(STEPS))
            .map(|tilt_rad| (airspeed(tilt_rad), tilt_rad))
            // Where there is no slowest speed there is no line.
            .filter(|(mps, _)| *mps > 0.0)
            .map(|(mps, tilt_rad)| place(knots(mps), 90.0 - degrees(tilt_rad)))
            .collect()
    };
    let limits =
        [limit(&|tilt| corridor.slowest_mps(tilt)), limit(&|tilt| corridor.fastest_mps(tilt))];
    recording.log_static(
        look.entity(LIMITS),
        &LineStrips2D::new(limits)
            .with_radii([Radius::new_ui_points(1.8)])
            .with_colors([LIMIT])
            .with_draw_order(1.0),
    )?;
    let half_rad = 0.5 * (least + greatest);
    let beside = |mps: f64, right_kt: f64| place(knots(mps) + right_kt, 90.0 - degrees(half_rad));
    let (slow, fast) = (corridor.slowest_mps(half_rad), corridor.fastest_mps(half_rad));
    recording.log_static(
        look.entity("corridor/limits/labels"),
        &Points2D::new([beside(slow, -28.0), beside(fast, 52.0)])
            .with_radii([Radius::new_ui_points(0.0)])
            .with_colors([LIMIT])
            .with_labels(["wing stall", "rotor and mast loads"])
            .with_show_labels(look.ground),
    )?;
    if look.ground {
        send_grid(recording, look)?;
    }
    recording.log_static(
        look.entity(NOW),
        &Points2D::update_fields()
            .with_radii([Radius::new_ui_points(6.0)])
            .with_colors([look.flown])
            .with_draw_order(3.0),
    )
}

fn send_grid(recording: &RecordingStream, look: &Look) -> RecordingStreamResult<()> {
    let speeds_kt = (0..=6).map(|i| 50.0 * f64::from(i));
    let angles_deg = (0..=3).map(|i| 30.0 * f64::from(i));
    let upright = speeds_kt.clone().map(|kt| [place(kt, 0.0), place(kt, 95.0)]);
    let level = angles_deg.clone().map(|deg| [place(0.0, deg), place(300.0, deg)]);
    recording.log_static(
        look.entity(GRID),
        &LineStrips2D::new(upright.chain(level))
            .with_radii([Radius::new_ui_points(0.5)])
            .with_colors([LINE])
            .with_draw_order(0.0),
    )?;
    let labels = speeds_kt
        .map(|kt| (place(kt, -4.0), format!("{kt:.0} kt")))
        // A label hangs below its point.
        .chain(angles_deg.map(|deg| (place(-15.0, deg + 8.0), format!("{deg:.0}°"))));
    let (at, words): (Vec<_>, Vec<_>) = labels.unzip();
    recording.log_static(
        look.entity("corridor/grid/labels"),
        &Points2D::new(at)
            .with_radii([Radius::new_ui_points(0.0)])
            .with_colors([0xC0_C0_C0_FF])
            .with_labels(words)
            .with_show_labels(true),
    )
}

/// Where the flight is, row by row.
pub fn columns(rows: &[Outputs]) -> super::columns::Columns {
    Points2D::new(rows.iter().map(place_of)).columns_of_unit_batches().map(Vec::from_iter)
}

/// Where the flight was in the plane.
pub struct Trace {
    points: Vec<TracePoint>,
    spacing_kt: f64,
}

/// A point of it.
#[derive(Clone, Copy)]
struct TracePoint {
    at: [f32; 2],
    outside: bool,
    /// How many restarts were before it.
    start: u32,
}

impl Trace {
    /// Nothing yet.
    pub fn new() -> Self {
        Self { points: Vec::new(), spacing_kt: SPACING_KT }
    }

    /// Adds where it is after so many restarts, when that is somewhere else.
    pub fn add(&mut self, outputs: &Outputs, aircraft: &Aircraft, start: u32) {
        let at = place_of(outputs);
        let outside = is_outside(outputs, aircraft);
        let moved = self.points.last().is_none_or(|last| {
            let along = |axis: usize| f64::from(at[axis] - last.at[axis]).abs();
            let changed = last.outside != outside || last.start != start;
            max(along(0), along(1)) >= self.spacing_kt || changed
        });
        if !moved {
            return;
        }
        self.points.push(TracePoint { at, outside, start });
        if self.points.len() > POINTS_MAX {
            self.points = self.points.iter().copied().step_by(2).collect();
            self.spacing_kt *= 2.0;
        }
    }

    /// Sends all of it; what is outside is red.
    pub fn send(&self, recording: &RecordingStream, look: &Look) -> RecordingStreamResult<()> {
        let mut strips: Vec<Vec<[f32; 2]>> = Vec::new();
        let mut colours = Vec::new();
        let mut before: Option<&TracePoint> = None;
        for stretch in self.points.chunk_by(|a, b| a.outside == b.outside && a.start == b.start) {
            let joint = before.filter(|before| before.start == stretch[0].start);
            strips.push(joint.into_iter().chain(stretch).map(|point| point.at).collect());
            before = stretch.last();
            colours.push(if stretch[0].outside { OUTSIDE } else { look.path | 0xFF });
        }
        recording.log_static(
            look.entity(TRACK),
            &LineStrips2D::new(strips)
                .with_radii([Radius::new_ui_points(1.5)])
                .with_colors(colours)
                .with_draw_order(2.0),
        )
    }
}

/// Whether it is flown outside the corridor; near the ground that is not asked for.
fn is_outside(outputs: &Outputs, aircraft: &Aircraft) -> bool {
    aircraft.envelope.corridor.margin_in_flight_mps(outputs).is_some_and(|mps| mps < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(kt: f64, height_m: f64) -> Outputs {
        Outputs {
            calibrated_airspeed_mps: kt * engine::units::KNOT_MPS,
            height_above_ground_m: height_m,
            ..Outputs::default()
        }
    }

    #[test]
    fn a_trace_says_where_it_is_outside_and_stays_short() {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15)
            .unwrap_or_else(|error| panic!("{error}"));
        let fastest_kt = knots(xv15.envelope.corridor.fastest_mps(0.0));
        assert!(is_outside(&at(fastest_kt + 1.0, 50.0), &xv15));
        assert!(!is_outside(&at(fastest_kt - 1.0, 50.0), &xv15));
        assert!(!is_outside(&at(fastest_kt + 1.0, 1.0), &xv15));
        let mut trace = Trace::new();
        for i in 0..40_000_u32 {
            trace.add(&at(f64::from(i % 300), 50.0), &xv15, 0);
        }
        assert!(trace.points.len() <= POINTS_MAX);
        assert!(trace.points.iter().any(|point| point.outside));
    }
}
