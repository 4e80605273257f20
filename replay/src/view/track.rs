//! One flight on the canvas: what moves, gathered and written row by row.

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::frames::{Ned, Vec3};
use rerun::{LineStrips3D, Scalars, StateChange};

use super::TICKS_PER_ROW;
use super::airframe::Mounts;
use super::canvas::{Canvas, times};
use super::plots::{MODES, PLOTS};
use super::scene::{PathPoint, moving_columns, point, send_path};

/// Rows gathered before they are written: ten seconds, about a megabyte.
const ROWS_PER_CHUNK: usize = 500;
/// Of this many rows one makes a piece of the flown line: 10 Hz.
const ROWS_PER_PIECE: usize = 5;
/// The path is thinned by half when it has more points than this.
pub const PATH_POINTS_MAX: usize = 8192;

/// How a flight is told from another one in the same recording.
pub struct Look {
    /// Before the names of its entities.
    pub root: &'static str,
    /// Before the names of its lines.
    pub name: &'static str,
    /// Whether the ground goes with it.
    pub ground: bool,
    /// RGBA over the aircraft's own colours.
    pub tint: u32,
    /// RGBA of the line behind it, and of its mark on the map.
    pub flown: u32,
    /// RGB of its whole path; the last byte is its own.
    pub path: u32,
    /// RGBA that is left of a line's colour.
    pub line_mask: u32,
    /// Added to the width of its lines.
    pub line_width: f32,
}

/// A flight by itself.
pub const ALONE: Look = Look {
    root: "",
    name: "",
    ground: true,
    tint: 0xFF_FF_FF_FF,
    flown: 0xFF_C2_3A_FF,
    path: 0x7F_D0_FF_00,
    line_mask: 0xFF_FF_FF_FF,
    line_width: 0.0,
};

/// The flight that was recorded: in its own colours; its lines are broad and pale.
pub const RECORDED: Look = Look {
    root: "recorded/",
    name: "recorded: ",
    line_mask: 0xFF_FF_FF_70,
    line_width: 3.0,
    ..ALONE
};

/// The flight beside it: the aircraft is orange; its lines are thin, within the other's.
pub const REFLOWN: Look = Look {
    root: "reflown/",
    name: "reflown: ",
    ground: false,
    tint: 0xFF_8A_30_FF,
    flown: 0xFF_5A_C8_FF,
    path: 0xFF_8A_C0_00,
    line_mask: 0xFF_FF_FF_FF,
    line_width: -0.3,
};

/// A flight that is drawn.
///
/// Memory hardly grows with it: ten seconds of rows, and a path that is thinned.
pub struct Track {
    look: &'static Look,
    mounts: Mounts,
    rows: Vec<Outputs>,
    flown_to_m: Option<Vec3<Ned>>,
    modes: Vec<Option<&'static str>>,
    /// The path.
    pub trail: Vec<PathPoint>,
    /// Least distance between its points.
    pub trail_spacing_m: f64,
}

impl Track {
    /// One that has not begun.
    pub fn new(look: &'static Look, aircraft: &Aircraft) -> Self {
        Self {
            look,
            mounts: Mounts::of(aircraft),
            rows: Vec::with_capacity(ROWS_PER_CHUNK),
            flown_to_m: None,
            modes: vec![None; MODES.len()],
            trail: Vec::new(),
            trail_spacing_m: 1.0,
        }
    }

    /// Takes what a step gave. Call it every tick; one in five is drawn.
    pub fn push(&mut self, canvas: &mut Canvas, outputs: &Outputs) {
        if !outputs.tick.is_multiple_of(TICKS_PER_ROW) {
            return;
        }
        self.follow(outputs);
        self.show_modes(canvas, outputs);
        self.rows.push(*outputs);
        if self.rows.len() >= ROWS_PER_CHUNK {
            self.flush(canvas);
        }
    }

    /// Writes what is left, and the whole path.
    pub fn finish(&mut self, canvas: &mut Canvas) {
        self.flush(canvas);
        let sent = send_path(&canvas.recording, &self.trail, self.look);
        canvas.keep(sent);
    }

    /// Adds to the path when the aircraft has moved on.
    pub fn follow(&mut self, outputs: &Outputs) {
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
    fn show_modes(&mut self, canvas: &mut Canvas, outputs: &Outputs) {
        for (index, mode) in MODES.iter().enumerate() {
            let value = mode.of(outputs);
            if self.modes[index] == Some(value) {
                continue;
            }
            self.modes[index] = Some(value);
            let columns = StateChange::single(value).columns_of_unit_batches().map(Vec::from_iter);
            canvas.send(&self.entity(&mode.path), &times(&[outputs.tick]), columns);
        }
    }

    /// Writes the rows gathered.
    fn flush(&mut self, canvas: &mut Canvas) {
        let rows = std::mem::replace(&mut self.rows, Vec::with_capacity(ROWS_PER_CHUNK));
        if rows.is_empty() {
            return;
        }
        let ticks: Vec<u64> = rows.iter().map(|row| row.tick).collect();
        let times = times(&ticks);
        for (entity, columns) in moving_columns(&rows, &self.mounts, self.look.ground) {
            canvas.send(&self.entity(entity), &times, columns);
        }
        for plot in PLOTS {
            let scalars = Scalars::new(rows.iter().map(plot.of));
            let columns = scalars.columns_of_unit_batches().map(Vec::from_iter);
            canvas.send(&self.entity(plot.path), &times, columns);
        }
        self.send_flown(canvas, &rows);
    }

    /// The line behind the aircraft, piece by piece, so that the viewer can show the last of them.
    fn send_flown(&mut self, canvas: &mut Canvas, rows: &[Outputs]) {
        let mut ticks = Vec::new();
        let mut pieces = Vec::new();
        for row in rows.iter().step_by(ROWS_PER_PIECE) {
            let from_m = self.flown_to_m.replace(row.position_m).unwrap_or(row.position_m);
            ticks.push(row.tick);
            pieces.push([point(from_m), point(row.position_m)]);
        }
        let columns = LineStrips3D::new(pieces).columns_of_unit_batches().map(Vec::from_iter);
        canvas.send(&self.entity("world/flown"), &times(&ticks), columns);
    }

    fn entity(&self, name: &str) -> String {
        format!("{}{name}", self.look.root)
    }
}
