//! Two flights in one recording: as recorded, as flown again, and the difference.

use std::path::Path;

use engine::inputs::World;
use engine::math::{PI, TAU, ln};
use engine::{Aircraft, Inputs, State, observe, step};
use logs::cdr;
use logs::output::Output;
use rerun::{LineStrips3D, Radius, Scalars, SeriesLines};

use super::canvas::{Canvas, times};
use super::layout::Subject;
use super::plots::PLOTS;
use super::scene::point;
use super::track::{RECORDED, REFLOWN, Track};
use super::{Severity, TICKS_PER_ROW, ViewError, severity};
use crate::compare::Names;
use crate::diff::{At, Cursor};
use crate::judgement::Judgement;
use crate::refly::{ReplayError, read};
use crate::stage::Stage;

/// The flight beside the recorded one.
#[derive(Clone, Copy, Debug)]
pub enum Other<'a> {
    /// Another log, as it was recorded.
    Log(&'a Path),
    /// The same log, reflown from its inputs.
    Reflown,
}

/// What was drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// Size of the file.
    pub bytes: u64,
    /// First tick where the states are not the same.
    pub first_difference: Option<u64>,
    /// What the logs are, as far as reading shows.
    pub judgements: Vec<Judgement>,
}

/// Rows of differences gathered before they are written.
const ROWS_PER_CHUNK: usize = 500;

/// What grows: entity, quantity of the state, colour.
const GROWTH: [(&str, &str, u32); 5] = [
    ("position, m", "plant.position_m", 0xF5_A0_3C_FF),
    ("velocity, m/s", "plant.velocity_mps", 0x5B_A8_F5_FF),
    ("attitude", "plant.attitude", 0xB6_8C_F0_FF),
    ("body rates, rad/s", "plant.angular_rate_radps", 0x3F_B9_5A_FF),
    ("rotor speed, rad/s", "plant.rotor_speed_radps", 0xE6_E6_E6_FF),
];

/// Draws the flight of `log` and another one beside it, tick by tick.
///
/// Both are drawn from their states alone, by what the model of today says of them, so that the same
/// states give the same picture.
///
/// # Errors
/// When a log cannot be read, or the recording not be written.
pub fn draw_against(log: &Path, other: Other, saved: &Output) -> Result<Drawn, DrawError> {
    let mut recorded = LoggedFlight::open(log)?;
    let mut other = match other {
        Other::Log(path) => Beside::Log(Box::new(LoggedFlight::open(path)?)),
        Other::Reflown => Beside::Reflown(Box::new(recorded.first()?)),
    };
    let title = log.file_stem().map_or_else(String::new, |stem| stem.display().to_string());
    let aircraft = (&recorded.aircraft, other.aircraft(&recorded));
    let drawn = [(&RECORDED, &**aircraft.0), (&REFLOWN, &**aircraft.1)];
    let canvas = Canvas::new(saved, &title, Subject::Comparison, &drawn)?;
    let mut page = Page::new(canvas, aircraft)?;
    while let Some(at) = recorded.cursor.now.take() {
        let world = world_of(&at);
        let state: State = cdr::decode(&at.state).map_err(ReplayError::from)?;
        let beside = match &mut other {
            Beside::Log(flight) => flight.at(at.tick)?,
            Beside::Reflown(reflown) => {
                if let Some((events, inputs)) = &at.led {
                    let inputs = Inputs { events, world: inputs.world };
                    let before = at.restart.as_ref().map_or(**reflown, |restart| restart.state);
                    **reflown = step(&recorded.aircraft, &before, &inputs).0;
                }
                Some((**reflown, world))
            }
        };
        let aircraft_beside = other.aircraft(&recorded);
        page.add(
            (&recorded.aircraft, &state, &world),
            beside.as_ref().map(|(state, world)| (aircraft_beside, state, world)),
        )?;
        recorded.cursor.advance();
    }
    let remarks = std::mem::take(&mut recorded.cursor.reader.remarks);
    let start_tick = recorded.cursor.start_tick;
    let mut judgements = vec![recorded.cursor.finish().judgement];
    if let Beside::Log(flight) = other {
        judgements.push(flight.cursor.finish().judgement);
    }
    for judgement in &judgements {
        page.canvas.event(start_tick, severity(judgement), &judgement.words);
    }
    for remark in &remarks {
        let level = match remark.level {
            logs::view::Level::Info => Severity::Info,
            logs::view::Level::Warn => Severity::Warning,
            logs::view::Level::Error => Severity::Error,
        };
        page.canvas.event(remark.time_ns / engine::STEP_NS, level, &remark.words);
    }
    page.finish(judgements)
}

/// Why two flights could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum DrawError {
    /// A log.
    #[error(transparent)]
    Replay(#[from] ReplayError),
    /// The recording.
    #[error(transparent)]
    View(#[from] ViewError),
}

/// What the second aircraft follows.
enum Beside {
    Log(Box<LoggedFlight>),
    Reflown(Box<State>),
}

impl Beside {
    /// What it is flown with.
    fn aircraft<'a>(&'a self, recorded: &'a LoggedFlight) -> &'a Aircraft {
        match self {
            Self::Log(flight) => &flight.aircraft,
            Self::Reflown(_) => &recorded.aircraft,
        }
    }
}

/// A log, with the aircraft in it.
struct LoggedFlight {
    cursor: Cursor,
    aircraft: Aircraft,
}

impl LoggedFlight {
    fn open(path: &Path) -> Result<Self, ReplayError> {
        let cursor = Cursor::open(path)?;
        let aircraft = read(&cursor.reader.setup)?.aircraft;
        Ok(Self { cursor, aircraft })
    }

    fn first(&self) -> Result<State, ReplayError> {
        Ok(self.cursor.reader.initial)
    }

    /// The state after `tick`, if the log has it.
    fn at(&mut self, tick: u64) -> Result<Option<(State, World)>, ReplayError> {
        while self.cursor.now.as_ref().is_some_and(|now| now.tick < tick) {
            self.cursor.advance();
        }
        let Some(now) = self.cursor.now.as_ref().filter(|now| now.tick == tick) else {
            return Ok(None);
        };
        Ok(Some((cdr::decode(&now.state)?, world_of(now))))
    }
}

fn world_of(at: &At) -> World {
    at.led.as_ref().map_or_else(World::default, |(_, inputs)| inputs.world)
}

/// What is being drawn.
struct Page {
    canvas: Canvas,
    recorded: Track,
    reflown: Track,
    names: Names,
    rows: Vec<Row>,
    first_difference: Option<u64>,
}

/// The differences of one tick.
struct Row {
    tick: u64,
    plots: Vec<f64>,
    growth: [f64; GROWTH.len()],
    apart: [[f32; 3]; 2],
}

/// A state in its world, and the aircraft.
type InWorld<'a> = (&'a Aircraft, &'a State, &'a World);

impl Page {
    fn new(
        mut canvas: Canvas,
        (recorded, reflown): (&Aircraft, &Aircraft),
    ) -> Result<Self, DrawError> {
        let names = Names::of::<State>().map_err(ReplayError::from)?;
        for plot in PLOTS {
            let sent = canvas.recording.log_static(
                format!("delta/{}", plot.path),
                &SeriesLines::new()
                    .with_names([format!("Δ {}", plot.name)])
                    .with_colors([plot.colour])
                    .with_widths([plot.width]),
            );
            canvas.keep(sent);
        }
        for (number, (name, _, colour)) in GROWTH.into_iter().enumerate() {
            let lines =
                SeriesLines::new().with_names([name]).with_colors([colour]).with_widths([1.5]);
            let sent = canvas.recording.log_static(growth_entity(number), &lines);
            canvas.keep(sent);
        }
        let line = LineStrips3D::update_fields()
            .with_radii([Radius::new_ui_points(2.0)])
            .with_colors([0xFF_20_20_FF]);
        let sent = canvas.recording.log_static("delta/apart", &line);
        canvas.keep(sent);
        Ok(Self {
            canvas,
            recorded: Track::new(&RECORDED, recorded),
            reflown: Track::new(&REFLOWN, reflown),
            names,
            rows: Vec::with_capacity(ROWS_PER_CHUNK),
            first_difference: None,
        })
    }

    fn add(&mut self, a: InWorld, b: Option<InWorld>) -> Result<(), DrawError> {
        let tick = a.1.tick;
        if let Some(b) = b {
            self.look_for_difference(tick, a.1, b.1)?;
        }
        // Only what is drawn is looked at.
        if !tick.is_multiple_of(TICKS_PER_ROW) {
            return Ok(());
        }
        let of_a = observe(a.0, a.1, a.2);
        self.recorded.push(&mut self.canvas, &of_a);
        let Some(b) = b else { return Ok(()) };
        let of_b = observe(b.0, b.1, b.2);
        self.reflown.push(&mut self.canvas, &of_b);
        self.rows.push(Row {
            tick,
            plots: PLOTS
                .iter()
                .map(|plot| difference(plot.path, (plot.of)(&of_a), (plot.of)(&of_b)))
                .collect(),
            growth: self.growth(a.1, b.1)?,
            apart: [point(of_a.position_m), point(of_b.position_m)],
        });
        if self.rows.len() >= ROWS_PER_CHUNK {
            self.flush();
        }
        Ok(())
    }

    fn look_for_difference(&mut self, tick: u64, a: &State, b: &State) -> Result<(), DrawError> {
        if self.first_difference.is_some() {
            return Ok(());
        }
        let a = cdr::encode(a).map_err(ReplayError::from)?;
        let b = cdr::encode(b).map_err(ReplayError::from)?;
        let first = self
            .names
            .differences(&a, &b)
            .map(|difference| (Stage::of_state(&difference.name.path), difference))
            .min_by_key(|(stage, difference)| (stage.is_none(), *stage, difference.index));
        if let Some((stage, difference)) = first {
            self.first_difference = Some(tick);
            let stage = stage.map_or("", Stage::name);
            let words = format!(
                "first difference: {} ({stage}), {} beside {}",
                difference.name.path, difference.a, difference.b
            );
            self.canvas.event(tick, Severity::Warning, &words);
        }
        Ok(())
    }

    /// Logarithms to base 10 of the largest difference in each quantity; NaN, which is not drawn,
    /// where there is none.
    fn growth(&self, a: &State, b: &State) -> Result<[f64; GROWTH.len()], DrawError> {
        let a = cdr::encode(a).map_err(ReplayError::from)?;
        let b = cdr::encode(b).map_err(ReplayError::from)?;
        let mut largest = [0.0; GROWTH.len()];
        for difference in self.names.differences(&a, &b) {
            let group = &self.names.groups[difference.name.group];
            if let Some(number) = GROWTH.iter().position(|(_, known, _)| known == group) {
                largest[number] = engine::math::max(largest[number], difference.absolute());
            }
        }
        Ok(largest.map(|largest| {
            if largest > 0.0 { ln(largest) / std::f64::consts::LN_10 } else { f64::NAN }
        }))
    }

    fn flush(&mut self) {
        let rows = std::mem::take(&mut self.rows);
        if rows.is_empty() {
            return;
        }
        let ticks: Vec<u64> = rows.iter().map(|row| row.tick).collect();
        let times = times(&ticks);
        let mut send = |entity: &str, values: Vec<f64>| {
            let columns = Scalars::new(values).columns_of_unit_batches().map(Vec::from_iter);
            self.canvas.send(entity, &times, columns);
        };
        for (number, plot) in PLOTS.iter().enumerate() {
            let values = rows.iter().map(|row| row.plots[number]).collect();
            send(&format!("delta/{}", plot.path), values);
        }
        for number in 0..GROWTH.len() {
            send(&growth_entity(number), rows.iter().map(|row| row.growth[number]).collect());
        }
        let apart = LineStrips3D::new(rows.iter().map(|row| row.apart));
        let columns = apart.columns_of_unit_batches().map(Vec::from_iter);
        self.canvas.send("delta/apart", &times, columns);
    }

    fn finish(mut self, judgements: Vec<Judgement>) -> Result<Drawn, DrawError> {
        self.flush();
        self.recorded.finish(&mut self.canvas);
        self.reflown.finish(&mut self.canvas);
        if self.first_difference.is_none() {
            self.canvas.event(0, Severity::Info, "no difference: the same states to the bit");
        }
        let bytes = self.canvas.finish()?;
        Ok(Drawn { bytes, first_difference: self.first_difference, judgements })
    }
}

fn growth_entity(number: usize) -> String {
    let group = GROWTH[number].1.trim_start_matches("plant.");
    format!("delta/growth/{group}")
}

/// Reflown less recorded; angles round the shorter way.
fn difference(path: &str, recorded: f64, reflown: f64) -> f64 {
    let apart = reflown - recorded;
    if path.contains("_deg/heading") {
        let wrapped_rad = engine::math::wrap_angle(apart / 180.0 * PI);
        wrapped_rad / TAU * 360.0
    } else {
        apart
    }
}
