//! Two flights in one recording: as recorded, as flown again, and the difference.

use std::path::Path;

use engine::inputs::{DeviceEvent, World};
use engine::math::{PI, TAU, ln};
use engine::{Aircraft, Inputs, State, observe, step};
use logs::cdr;
use logs::output::Output;
use logs::view::LogLine;
use rerun::{LineStrips3D, Radius, Scalars, SeriesLines};

use super::basics::{Severity, TICKS_PER_ROW, ViewError, level};
use super::canvas::{About, Canvas, times};
use super::columns::point;
use super::events::Happened;
use super::file::Saved;
use super::heading;
use super::largest::Largest;
use super::layout::Layout;
use super::look::Look;
use super::numbers::{self, Pages, ROWS_PER_PAGE};
use super::parts::{NUMBERS_OF_TWO, Plan};
use super::plots::GRAPHS;
use super::stamp::Mark;
use super::still::send_graphs;
use super::track::{Moment, Track};
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

/// How two flights are drawn.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What the recording is called.
    pub about: About,
    /// How it is arranged.
    pub layout: Layout,
    /// How both are called, everywhere.
    pub names: [String; 2],
    /// So many ticks later in the second log than in the first is what is laid beside it.
    pub shift_ticks: i64,
}

impl Comparison {
    /// Of a log and its reflight.
    pub fn of_reflight(title: &str) -> Self {
        Self {
            about: About {
                title: title.into(),
                recording_id: format!("tiltrotor-reflown-{title}"),
                flown: Vec::new(),
            },
            layout: Layout::Compare,
            names: ["recorded".into(), "reflown".into()],
            shift_ticks: 0,
        }
    }

    /// The tick of the second log that is laid beside one of the first.
    fn beside(&self, tick: u64) -> Option<u64> {
        tick.checked_add_signed(self.shift_ticks)
    }

    /// The tick of the first log that one of the second is laid beside.
    fn back(&self, tick: u64) -> u64 {
        tick.saturating_add_signed(self.shift_ticks.saturating_neg())
    }
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
/// states give the same picture. `status` says with which status what the logs are is told.
///
/// # Errors
/// When a log cannot be read, or the recording not be written.
pub fn draw_against(
    log: &Path,
    other: Other,
    saved: &Output,
    how: &Comparison,
    status: impl Fn(&[Judgement]) -> u8,
) -> Result<Drawn, DrawError> {
    let mut first = LoggedFlight::open(log)?;
    let mut other = match other {
        Other::Log(path) => Beside::Log(Box::new(LoggedFlight::open(path)?)),
        Other::Reflown => Beside::Reflown(Box::new(first.first()?)),
    };
    let file = Saved::new(saved)?;
    let is_reflown = matches!(other, Beside::Reflown(_));
    let mut page = Page::new(&file, (&first.aircraft, other.aircraft(&first)), how)?;
    while let Some(at) = first.cursor.now.take() {
        if let Some(restart) = &at.restart {
            page.first.restart(&mut page.canvas, restart.state.tick);
        }
        let world = world_of(&at);
        let state: State = cdr::decode(&at.state).map_err(ReplayError::from)?;
        let beside = match &mut other {
            Beside::Log(flight) => match how.beside(at.tick) {
                Some(tick) => flight.at(tick)?,
                None => None,
            },
            Beside::Reflown(reflown) => {
                if let Some((events, inputs)) = &at.led {
                    let inputs = Inputs { events, world: inputs.world };
                    let before = at.restart.as_ref().map_or(**reflown, |restart| restart.state);
                    if at.restart.is_some() {
                        page.second.restart(&mut page.canvas, before.tick);
                    }
                    **reflown = step(&first.aircraft, &before, &inputs).0;
                }
                Some((**reflown, world))
            }
        };
        if let Beside::Log(flight) = &mut other {
            for tick in flight.restarts.drain(..) {
                page.second.restart(&mut page.canvas, how.back(tick));
            }
        }
        let aircraft_beside = other.aircraft(&first);
        let events = at.led.as_ref().map_or(&[][..], |(events, _)| events);
        page.add(
            (&first.aircraft, &state, &world, events),
            beside.as_ref().map(|(state, world)| (aircraft_beside, state, world, &[][..])),
        )?;
        first.cursor.advance();
    }
    let start_tick = first.cursor.start_tick;
    let mut judgements = Vec::new();
    let (told, who, judgement) = first.told();
    page.first.facts.flown_by(&who);
    page.tell_first(start_tick, &judgement, &told);
    if is_reflown {
        page.second.facts.flown_by("this program from the log's inputs");
    }
    judgements.push(judgement);
    if let Beside::Log(flight) = other {
        let (told, who, judgement) = flight.told();
        page.second.facts.flown_by(&who);
        page.tell_second(start_tick, &judgement, &told, how);
        judgements.push(judgement);
    }
    let first_difference = page.first_difference.as_ref().map(|(tick, _)| *tick);
    let mark = Mark { status: status(&judgements), first_difference };
    page.finish(file, judgements, mark)
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
    /// Where another state took the place of the one flown, up to where it was looked at last.
    restarts: Vec<u64>,
}

impl LoggedFlight {
    fn open(path: &Path) -> Result<Self, ReplayError> {
        let cursor = Cursor::open(path)?;
        let aircraft = read(&cursor.reader.setup)?.aircraft;
        Ok(Self { cursor, aircraft, restarts: Vec::new() })
    }

    /// Reads what is left: what was told in it, who flew, and what it is.
    fn told(mut self) -> (Vec<LogLine>, String, Judgement) {
        while self.cursor.now.is_some() {
            self.cursor.advance();
        }
        let log_lines = std::mem::take(&mut self.cursor.reader.log_lines);
        let who = self.cursor.reader.identity.who(&self.cursor.reader.devices);
        (log_lines, who, self.cursor.finish().judgement)
    }

    fn first(&self) -> Result<State, ReplayError> {
        Ok(self.cursor.reader.initial)
    }

    /// The state after `tick`, if the log has it.
    fn at(&mut self, tick: u64) -> Result<Option<(State, World)>, ReplayError> {
        while self.cursor.now.as_ref().is_some_and(|now| now.tick < tick) {
            self.cursor.advance();
            let restart = self.cursor.now.as_ref().and_then(|now| now.restart.as_ref());
            self.restarts.extend(restart.map(|restart| restart.state.tick));
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
    first: Track,
    second: Track,
    names: Names,
    rows: Vec<Row>,
    pages: Pages,
    largest: Largest,
    /// The first tick where the states are not the same, and what is not.
    first_difference: Option<(u64, String)>,
}

/// The differences of one tick.
struct Row {
    tick: u64,
    plots: Vec<f64>,
    growth: [f64; GROWTH.len()],
    apart: [[f32; 3]; 2],
}

/// A state in its world, the aircraft, and what devices said for it.
type InWorld<'a> = (&'a Aircraft, &'a State, &'a World, &'a [DeviceEvent]);

impl Page {
    fn new(
        file: &Saved,
        (of_first, of_second): (&Aircraft, &Aircraft),
        how: &Comparison,
    ) -> Result<Self, DrawError> {
        let [first, second] = [Look::first(&how.names[0]), Look::second(&how.names[1])];
        let plan = (how.layout.clone(), Plan::new(&[&first.root, &second.root]));
        let drawn = [(&first, &**of_first), (&second, &**of_second)];
        let mut canvas = Canvas::begin(Box::new(file.file.clone()), &how.about, plan, &drawn)
            .map_err(|error| file.refused(error))?;
        let delta = Look { root: "delta/".into(), ..Look::alone() };
        let sent = send_graphs(&canvas.recording, &delta, GRAPHS, "Δ ");
        canvas.keep(sent);
        for (number, (name, _, colour)) in GROWTH.into_iter().enumerate() {
            let lines =
                SeriesLines::new().with_names([name]).with_colors([colour]).with_widths([1.5]);
            let sent = canvas.recording.log_static(growth_entity(number), &lines);
            canvas.keep(sent);
        }
        let sent = numbers::send_still(&canvas.recording, NUMBERS_OF_TWO);
        canvas.keep(sent);
        let line = LineStrips3D::update_fields()
            .with_radii([Radius::new_ui_points(2.0)])
            .with_colors([0xFF_20_20_FF]);
        let sent = canvas.recording.log_static("delta/apart", &line);
        canvas.keep(sent);
        let tracks = [(first, of_first), (second, of_second)]
            .map(|(look, aircraft)| Track::new(look, aircraft, how.layout.fields()));
        let [mut first, mut second] = tracks;
        first.begin(&mut canvas);
        second.begin(&mut canvas);
        Ok(Self {
            canvas,
            first,
            second,
            names: Names::of::<State>().map_err(ReplayError::from)?,
            rows: Vec::new(),
            pages: Pages::default(),
            largest: Largest::default(),
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
            self.first.say(tick, a.3);
            return Ok(());
        }
        let of_a = observe(a.0, a.1, a.2);
        let moment = Moment { outputs: &of_a, world: a.2, events: a.3 };
        self.first.push(&mut self.canvas, moment);
        let Some(b) = b else { return Ok(()) };
        let mut of_b = observe(b.0, b.1, b.2);
        // It is laid beside the first one's.
        of_b.tick = tick;
        self.second.push(&mut self.canvas, Moment { outputs: &of_b, world: b.2, events: b.3 });
        let lines =
            GRAPHS.iter().flat_map(|graph| graph.lines.iter().map(move |line| (graph, line)));
        let plots: Vec<f64> = lines
            .map(|(graph, line)| difference(graph.entity, (line.of)(&of_a), (line.of)(&of_b)))
            .collect();
        self.largest.add(tick, &plots);
        if tick.is_multiple_of(TICKS_PER_ROW * ROWS_PER_PAGE) {
            let page = numbers::page_of_two(self.names_of_both(), [&of_a, &of_b]);
            self.pages.add(tick, page);
        }
        self.rows.push(Row {
            tick,
            plots,
            growth: self.growth(a.1, b.1)?,
            apart: [point(of_a.position_m), point(of_b.position_m)],
        });
        if self.rows.len() >= self.first.rows_per_chunk() {
            self.flush();
        }
        Ok(())
    }

    fn names_of_both(&self) -> [&str; 2] {
        [&self.first, &self.second].map(|track| track.look.name.trim_end_matches(": "))
    }

    /// What the first log is, and what happened in it.
    fn tell_first(&mut self, start_tick: u64, judgement: &Judgement, log_lines: &[LogLine]) {
        let (track, canvas) = (&mut self.first, &mut self.canvas);
        track.judge(canvas, start_tick, judgement);
        for (number, line) in (1..).zip(log_lines) {
            let tick = line.time_ns / engine::STEP_NS;
            track.event(canvas, told(line, tick, number));
        }
    }

    /// The same of the second one, at the first one's times.
    fn tell_second(
        &mut self,
        start_tick: u64,
        judgement: &Judgement,
        log_lines: &[LogLine],
        how: &Comparison,
    ) {
        let (track, canvas) = (&mut self.second, &mut self.canvas);
        track.judge(canvas, start_tick, judgement);
        for (number, line) in (1..).zip(log_lines) {
            let tick = how.back(line.time_ns / engine::STEP_NS);
            track.event(canvas, told(line, tick, number));
        }
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
            let stage = stage.map_or("", Stage::name);
            let [a, b] = self.names_of_both();
            let words = format!(
                "{} ({stage}), {a} {}, {b} {}",
                difference.name.path, difference.a, difference.b
            );
            self.note(tick, Severity::Warning, &format!("first difference: {words}"));
            self.first_difference = Some((tick, words));
        }
        Ok(())
    }

    fn note(&mut self, tick: u64, level: Severity, words: &str) {
        self.first.event(&mut self.canvas, Happened { tick, level, words, number: None });
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
        self.pages.flush(&mut self.canvas, NUMBERS_OF_TWO);
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
        for number in 0..GROWTH.len() {
            send(&growth_entity(number), rows.iter().map(|row| row.growth[number]).collect());
        }
        let mut from = 0;
        for graph in GRAPHS {
            let to = from + graph.lines.len();
            let values = rows.iter().flat_map(|row| row.plots[from..to].iter().copied());
            let values: Vec<f64> = values.collect();
            let entity = format!("delta/{}", graph.entity);
            let drawn = ticks.iter().zip(values.chunks(graph.lines.len()));
            self.canvas.see(&entity, drawn.flat_map(|(tick, row)| graph.drawn(*tick, row)));
            let columns = Scalars::new(values)
                .columns(std::iter::repeat_n(graph.lines.len(), rows.len()))
                .map(Vec::from_iter);
            self.canvas.send(&entity, &times, columns);
            from = to;
        }
        let apart = LineStrips3D::new(rows.iter().map(|row| row.apart));
        let columns = apart.columns_of_unit_batches().map(Vec::from_iter);
        self.canvas.send("delta/apart", &times, columns);
    }

    fn finish(
        mut self,
        file: Saved,
        judgements: Vec<Judgement>,
        mark: Mark,
    ) -> Result<Drawn, DrawError> {
        self.flush();
        if self.first_difference.is_none() {
            let words = "no difference: the same states to the bit";
            self.note(0, Severity::Info, words);
        }
        self.first.finish(&mut self.canvas);
        self.second.finish(&mut self.canvas);
        let first_difference = self.first_difference.as_ref().map(|(tick, _)| *tick);
        let page = self.largest.page(self.names_of_both(), self.first_difference.as_ref());
        self.canvas.write("delta/largest", page);
        let flights = [&self.first, &self.second].map(|track| (&track.look, &track.facts));
        heading::send_two(&mut self.canvas, flights);
        let bytes = file.finish(self.canvas, &mark.name())?;
        Ok(Drawn { bytes, first_difference, judgements })
    }
}

/// An event of a log, at a tick.
fn told(line: &LogLine, tick: u64, number: u64) -> Happened<'_> {
    Happened { tick, level: level(line.level), words: &line.words, number: Some(number) }
}

fn growth_entity(number: usize) -> String {
    let group = GROWTH[number].1.trim_start_matches("plant.");
    format!("delta/growth/{group}")
}

/// The second less the first; angles round the shorter way.
fn difference(entity: &str, first: f64, second: f64) -> f64 {
    let apart = second - first;
    if ["/heading", "/attitude", "/flow"].iter().any(|round| entity.ends_with(round)) {
        let wrapped_rad = engine::math::wrap_angle(apart / 180.0 * PI);
        wrapped_rad / TAU * 360.0
    } else {
        apart
    }
}
