//! One flight on the canvas: what moves, gathered and written row by row.

use engine::Outputs;
use engine::aircraft::Params as Aircraft;
use engine::frames::{Ned, Vec3};
use engine::inputs::{DeviceEvent, World};
use logs::cdr;
use logs::records::TimingRecord;
use rerun::{LineStrips3D, Scalars};

use super::airframe::Mounts;
use super::basics::{Severity, TICKS_PER_ROW, severity};
use super::canvas::{Canvas, times};
use super::columns::point;
use super::corridor;
use super::events::{Events, Happened};
use super::field::{Channel, Field};
use super::fields;
use super::forces::Places;
use super::heading;
use super::lanes::Lanes;
use super::look::Look;
use super::modes::{MODES, Seen, alarm};
use super::numbers::{self, Pages, ROWS_PER_PAGE};
use super::parts::{NUMBERS, NUMBERS_OF_ROTORS};
use super::plots::{GRAPHS, Graph, TIMES};
use super::raw::Raw;
use super::scene::{PathPoint, send_moving};
use super::scenery::StartMark;
use super::still::send_path;
use crate::judgement::{Judgement, Outcome};

/// Rows gathered before they are written, at first: ten seconds, about a megabyte.
const ROWS_PER_CHUNK: usize = 500;
/// Later, this by the root of all rows so far: both rows in memory and chunks, each of which rerun's index of the
/// file keeps some kilobytes for, grow with the root of the flight;
const ROWS_PER_CHUNK_ROOT: usize = 10;
/// and no more than these, half a minute: by then the file has as many chunks as are kept an index of.
const ROWS_PER_CHUNK_MAX: usize = 1500;
/// The same while it is flown, for the plots: five times in two seconds.
const ROWS_PER_CHUNK_LIVE: usize = 10;
/// Of this many rows one makes a piece of the flown line: 10 Hz.
const ROWS_PER_PIECE: usize = 5;
/// The path is thinned by half when it has more points than this.
pub const PATH_POINTS_MAX: usize = 8192;

/// What is seen at a tick.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// What can be observed.
    pub outputs: &'a Outputs,
    /// Weather and failures.
    pub world: &'a World,
    /// What devices said for it.
    pub events: &'a [DeviceEvent],
}

/// A flight that is drawn.
///
/// Memory hardly grows with it: ten seconds of rows, and a path that is thinned.
pub struct Track {
    /// How it is told from others.
    pub look: Look,
    aircraft: Aircraft,
    mounts: Mounts,
    places: Places,
    own: Vec<(usize, Field)>,
    rows: Vec<Outputs>,
    times: Vec<TimingRecord>,
    raw: Raw,
    axes_told: Vec<(u64, u64)>,
    flown_to_m: Option<Vec3<Ned>>,
    lanes: Lanes,
    events: Events,
    trace: corridor::Trace,
    /// What stands above it.
    pub facts: heading::Facts,
    pages: Pages,
    rotor_pages: Pages,
    /// When the last one was, the settings that it told, and whether the flight was over by then.
    told: Option<(u64, numbers::Settings, bool)>,
    /// Where it began.
    begun: Option<StartMark>,
    /// Restarts so far.
    restarts: u32,
    /// Rows drawn so far.
    drawn: usize,
    /// The path.
    pub trail: Vec<PathPoint>,
    /// Least distance between its points.
    pub trail_spacing_m: f64,
}

impl Track {
    /// One that has not begun; with fields of one's own.
    pub fn new(look: Look, aircraft: &Aircraft, own: Vec<(usize, Field)>) -> Self {
        Self {
            look,
            aircraft: aircraft.clone(),
            mounts: Mounts::of(aircraft),
            places: Places::of(aircraft),
            own,
            rows: Vec::with_capacity(ROWS_PER_CHUNK),
            times: Vec::with_capacity(ROWS_PER_CHUNK),
            raw: Raw::default(),
            axes_told: Vec::new(),
            flown_to_m: None,
            lanes: Lanes::new(false),
            events: Events::default(),
            trace: corridor::Trace::new(),
            facts: heading::Facts::new(aircraft),
            pages: Pages::default(),
            rotor_pages: Pages::default(),
            told: None,
            begun: None,
            restarts: 0,
            drawn: 0,
            trail: Vec::new(),
            trail_spacing_m: 1.0,
        }
    }

    /// One that is drawn while it is flown.
    pub fn live(look: Look, aircraft: &Aircraft, own: Vec<(usize, Field)>) -> Self {
        let mut track = Self::new(look, aircraft, own);
        track.lanes = Lanes::new(true);
        track.facts.live = true;
        track
    }

    /// Whoever was told of it is gone: the next one begins with what was and what is, the path and the events.
    pub fn forget(&mut self) {
        self.rows.clear();
        self.times.clear();
        self.axes_told.clear();
        self.flown_to_m = None;
        self.pages = Pages::default();
        self.rotor_pages = Pages::default();
        self.told = None;
        self.events.forget();
    }

    /// Sends what its own fields are called, and which flight it is; to a viewer that comes late what was before:
    /// where it began, the lanes, and where it ended before its end.
    pub fn begin(&mut self, canvas: &mut Canvas) {
        let sent = fields::send_still(&canvas.recording, &self.look, &self.own);
        canvas.keep(sent);
        if self.is_alone() {
            for entity in [NUMBERS, NUMBERS_OF_ROTORS] {
                let sent = numbers::send_still(&canvas.recording, entity);
                canvas.keep(sent);
            }
        }
        for (tick, words) in self.lanes.write_all(canvas, &self.look) {
            self.warn(canvas, tick, &words);
        }
        self.send_start(canvas);
        if self.facts.endings().is_empty() {
            heading::send(canvas, &self.look, &self.facts);
        }
        for number in 0..self.facts.endings().len() {
            self.tell_ending(canvas, number);
        }
    }

    /// Whether it is the only flight of the recording.
    fn is_alone(&self) -> bool {
        self.look.root.is_empty()
    }

    /// Takes what was seen at a tick. Call it every tick; one in five is drawn, and what devices said is.
    pub fn push(&mut self, canvas: &mut Canvas, seen: Moment) {
        let outputs = seen.outputs;
        self.raw.add(outputs.tick, seen.events);
        if outputs.tick.is_multiple_of(TICKS_PER_ROW) {
            self.draw(canvas, outputs, seen.world);
        } else {
            self.look_for_ending(canvas, outputs);
        }
    }

    /// Rows between two writings.
    pub fn rows_per_chunk(&self) -> usize {
        if self.facts.live { ROWS_PER_CHUNK_LIVE } else { gathered(self.drawn) }
    }

    /// Takes what devices said for a tick that is not drawn.
    pub fn say(&mut self, tick: u64, events: &[DeviceEvent]) {
        self.raw.add(tick, events);
    }

    /// Notes when nothing from there on means anything.
    fn look_for_ending(&mut self, canvas: &mut Canvas, outputs: &Outputs) {
        self.look_at_margin(outputs);
        if self.facts.add(outputs) {
            self.tell_ending(canvas, self.facts.endings().len() - 1);
        }
    }

    /// Notes how far inside the corridor it is, while that means anything.
    fn look_at_margin(&mut self, outputs: &Outputs) {
        let margin_mps = self.aircraft.envelope.corridor.margin_in_flight_mps(outputs);
        if let (Some(margin_mps), None) = (margin_mps, self.facts.over()) {
            self.facts.add_margin(outputs.tick, margin_mps);
        }
    }

    /// Tells one of the endings, and all of them where they are told together.
    fn tell_ending(&mut self, canvas: &mut Canvas, number: usize) {
        let ending = self.facts.endings()[number];
        let words = format!("{}: nothing from here until a restart means anything", ending.name());
        let level = Severity::Error;
        self.event(canvas, Happened { tick: ending.tick, level, words: &words, number: None });
        self.events.end(ending.tick, &words);
        if let Some(tick) = ending.until {
            self.events.resume(tick);
        }
        self.mark_endings(canvas);
    }

    /// In space, and above the flight.
    fn mark_endings(&self, canvas: &mut Canvas) {
        let sent = heading::send_endings(&canvas.recording, &self.look, self.facts.endings());
        canvas.keep(sent);
        heading::send(canvas, &self.look, &self.facts);
    }

    /// Another state took the place of the one at a tick: the flight goes on elsewhere, and if it was over, it is
    /// not any more.
    pub fn restart(&mut self, canvas: &mut Canvas, tick: u64) {
        self.flush(canvas);
        if self.go_on_from(tick) {
            self.mark_endings(canvas);
        }
    }

    /// The same while nobody looks on; whether it was over.
    pub fn go_on_from(&mut self, tick: u64) -> bool {
        self.flown_to_m = None;
        self.restarts += 1;
        self.events.resume(tick);
        self.facts.restart(tick)
    }

    /// Draws a row.
    pub fn draw(&mut self, canvas: &mut Canvas, outputs: &Outputs, world: &World) {
        canvas.reach(outputs.tick);
        self.look_for_ending(canvas, outputs);
        let is_first = self.begun.is_none();
        let changed = self.remember(outputs, world);
        if is_first {
            self.send_start(canvas);
        }
        Lanes::write(canvas, &self.look, outputs.tick, &changed);
        for words in changed.iter().filter_map(|(lane, value)| alarm(&MODES[*lane], value)) {
            self.warn(canvas, outputs.tick, &words);
        }
        self.rows.push(*outputs);
        self.tell_numbers(canvas, outputs);
        self.drawn += 1;
        if self.facts.live {
            self.send_motion(canvas, std::slice::from_ref(outputs));
            self.events.go_on(canvas, &self.look, outputs.tick);
        }
        if self.rows.len() >= self.rows_per_chunk() {
            self.flush(canvas);
        }
    }

    /// Numbers at the cursor: at round times, and at once where a setting changes or the flight is over.
    fn tell_numbers(&mut self, canvas: &Canvas, outputs: &Outputs) {
        const PAGE_TICKS: u64 = TICKS_PER_ROW * ROWS_PER_PAGE;
        let over = self.facts.over().map(heading::Ending::words);
        let now = (outputs.tick / PAGE_TICKS, numbers::settings(outputs), over.is_some());
        if self.is_alone() && self.told != Some(now) {
            self.pages.add(outputs.tick, numbers::page(outputs, over.as_deref()));
            if canvas.shows_rotors() {
                self.rotor_pages.add(outputs.tick, numbers::page_of_rotors(outputs));
            }
            self.told = Some(now);
        }
    }

    /// Takes what was seen and is not drawn.
    pub fn miss(&mut self, outputs: &Outputs, world: &World) {
        self.look_at_margin(outputs);
        self.facts.add(outputs);
        self.remember(outputs, world);
    }

    /// Adds to the whole path, and to what lanes showed; which of these changed.
    fn remember(&mut self, outputs: &Outputs, world: &World) -> Vec<(usize, &'static str)> {
        self.begun.get_or_insert_with(|| StartMark::of(outputs));
        self.follow(outputs);
        self.trace.add(outputs, &self.aircraft, self.restarts);
        self.lanes.see(Seen { outputs, world, aircraft: &self.aircraft })
    }

    /// Marks where it began, on the ground that goes with it.
    fn send_start(&self, canvas: &mut Canvas) {
        let Some(begun) = self.begun.filter(|_| self.look.ground) else { return };
        let (lines, labels) = begun.drawn();
        let sent = canvas.recording.log_static(self.look.entity("world/start"), &lines);
        canvas.keep(sent);
        let sent = canvas.recording.log_static(self.look.entity("world/start/labels"), &labels);
        canvas.keep(sent);
    }

    /// Notes what a lane may be too short to say.
    fn warn(&mut self, canvas: &mut Canvas, tick: u64, words: &str) {
        self.event(canvas, Happened { tick, level: Severity::Warning, words, number: None });
    }

    /// Takes how a tick kept time: of those of a row the latest is drawn, and every one with an input of
    /// hardware, a slip or an overrun.
    pub fn time(&mut self, canvas: &mut Canvas, timing: &TimingRecord) {
        self.facts.time(timing);
        let grave = |timing: &TimingRecord| {
            timing.latency_ns > 0 || timing.slip_ns > 0 || timing.overrun > 0
        };
        match self.times.last_mut() {
            Some(last)
                if last.tick / TICKS_PER_ROW == timing.tick / TICKS_PER_ROW
                    && !grave(last)
                    && (grave(timing) || timing.late_ns >= last.late_ns) =>
            {
                *last = *timing;
            }
            Some(last)
                if last.tick / TICKS_PER_ROW == timing.tick / TICKS_PER_ROW && !grave(timing) => {}
            _ => {
                // Only before a new row: the last one is not complete until then.
                if self.times.len() >= self.rows_per_chunk() {
                    self.flush_times(canvas);
                }
                self.times.push(*timing);
            }
        }
    }

    /// Notes an event.
    pub fn event(&mut self, canvas: &mut Canvas, happened: Happened) {
        self.events.add(canvas, &self.look, happened);
    }

    /// Notes what the log is, which begins at that tick.
    pub fn judge(&mut self, canvas: &mut Canvas, tick: u64, judgement: &Judgement) {
        let (level, words) = (severity(judgement), judgement.words.as_str());
        let known = match judgement.outcome {
            Outcome::Exact => {
                let ticks = words.split(", digest").next().unwrap_or(words);
                &format!("unaltered, reflown to the same bits; {ticks}")
            }
            _ => words,
        };
        self.facts.judge(known);
        self.event(canvas, Happened { tick, level, words, number: None });
    }

    /// Writes what is left, and the whole path.
    pub fn finish(&mut self, canvas: &mut Canvas) {
        self.flush(canvas);
        self.flush_times(canvas);
        if !self.facts.live {
            self.events.finish(canvas, &self.look);
        }
        self.send_whole(canvas);
    }

    /// Writes the whole path.
    pub fn send_whole(&self, canvas: &mut Canvas) {
        heading::send(canvas, &self.look, &self.facts);
        let sent = send_path(&canvas.recording, &self.trail, &self.look);
        canvas.keep(sent);
        let sent = self.trace.send(&canvas.recording, &self.look);
        canvas.keep(sent);
    }

    /// Adds to the path when the aircraft has moved on.
    pub fn follow(&mut self, outputs: &Outputs) {
        let moved = self.trail.last().is_none_or(|last| {
            let moved_m = (outputs.position_m - last.position_m).norm();
            moved_m >= self.trail_spacing_m || last.start != self.restarts
        });
        if !moved {
            return;
        }
        self.trail.push(PathPoint::new(outputs, self.restarts));
        if self.trail.len() > PATH_POINTS_MAX {
            self.trail = self.trail.iter().copied().step_by(2).collect();
            self.trail_spacing_m *= 2.0;
        }
    }

    /// Writes the rows gathered.
    pub fn flush(&mut self, canvas: &mut Canvas) {
        self.raw.flush(canvas, &self.look, &self.aircraft.cockpit, &mut self.axes_told);
        let room = Vec::with_capacity(self.rows_per_chunk());
        let rows = std::mem::replace(&mut self.rows, room);
        if rows.is_empty() {
            return;
        }
        let ticks: Vec<u64> = rows.iter().map(|row| row.tick).collect();
        self.pages.flush(canvas, NUMBERS);
        self.rotor_pages.flush(canvas, NUMBERS_OF_ROTORS);
        if self.facts.live {
            self.flush_times(canvas);
        } else {
            self.send_motion(canvas, &rows);
        }
        send_graphs(canvas, &self.look, GRAPHS, &rows, &ticks);
        if self.own.iter().any(|(_, field)| field.channel == Channel::Outputs) {
            let messages: Vec<Vec<u8>> =
                rows.iter().filter_map(|row| cdr::encode(row).ok()).collect();
            fields::send(canvas, &self.look, &self.own, Channel::Outputs, &ticks, &messages);
        }
        self.send_flown(canvas, &rows);
    }

    /// Writes where and how it is in the rows.
    fn send_motion(&self, canvas: &mut Canvas, rows: &[Outputs]) {
        let ticks: Vec<u64> = rows.iter().map(|row| row.tick).collect();
        let times = times(&ticks);
        send_moving(rows, &self.mounts, &self.places, self.look.ground, |entity, columns| {
            canvas.send(&self.look.entity(entity), &times, columns);
        });
        canvas.send(&self.look.entity(corridor::NOW), &times, corridor::columns(rows));
    }

    /// Writes the times gathered.
    fn flush_times(&mut self, canvas: &mut Canvas) {
        let rows = std::mem::take(&mut self.times);
        if rows.is_empty() {
            return;
        }
        let ticks: Vec<u64> = rows.iter().map(|row| row.tick).collect();
        send_graphs(canvas, &self.look, TIMES, &rows, &ticks);
        if self.own.iter().any(|(_, field)| field.channel == Channel::Timing) {
            let messages: Vec<Vec<u8>> =
                rows.iter().filter_map(|row| cdr::encode(row).ok()).collect();
            fields::send(canvas, &self.look, &self.own, Channel::Timing, &ticks, &messages);
        }
    }

    /// The line behind the aircraft, piece by piece, so that the viewer can show the last of them.
    fn send_flown(&mut self, canvas: &mut Canvas, rows: &[Outputs]) {
        let mut ticks = Vec::new();
        let mut pieces = Vec::new();
        let mut colours = Vec::new();
        for row in rows.iter().step_by(ROWS_PER_PIECE) {
            let from_m = self.flown_to_m.replace(row.position_m).unwrap_or(row.position_m);
            ticks.push(row.tick);
            pieces.push([point(from_m), point(row.position_m)]);
            colours.push(self.look.trail(super::modes::configuration(row).1, 0xFF));
        }
        let columns = LineStrips3D::new(pieces)
            .with_colors(colours)
            .columns_of_unit_batches()
            .map(Vec::from_iter);
        canvas.send(&self.look.entity("world/flown"), &times(&ticks), columns);
    }
}

/// Rows to be gathered when so many are drawn.
fn gathered(drawn: usize) -> usize {
    (ROWS_PER_CHUNK_ROOT * drawn.isqrt()).clamp(ROWS_PER_CHUNK, ROWS_PER_CHUNK_MAX)
}

/// Writes rows of graphs: each as one entity with as many values in a row as it has lines.
fn send_graphs<T>(
    canvas: &mut Canvas,
    look: &Look,
    graphs: &[Graph<T>],
    rows: &[T],
    ticks: &[u64],
) {
    let times = times(ticks);
    for graph in graphs {
        let values = rows.iter().flat_map(|row| graph.lines.iter().map(|line| (line.of)(row)));
        let values: Vec<f64> = values.collect();
        let drawn = ticks.iter().zip(values.chunks(graph.lines.len()));
        canvas.see(graph.entity, drawn.flat_map(|(tick, row)| graph.drawn(*tick, row)));
        let columns = Scalars::new(values)
            .columns(std::iter::repeat_n(graph.lines.len(), rows.len()))
            .map(Vec::from_iter);
        canvas.send(&look.entity(graph.entity), &times, columns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Chunks of an entity, and the rows of the longest one.
    fn chunks(rows: usize) -> (usize, usize) {
        let (mut count, mut waiting, mut longest) = (0, 0, 0);
        for drawn in 1..=rows {
            waiting += 1;
            if waiting >= gathered(drawn) {
                longest = longest.max(waiting);
                (count, waiting) = (count + 1, 0);
            }
        }
        (count, longest)
    }

    #[test]
    fn rows_in_memory_grow_with_the_root_of_the_flight_up_to_half_a_minute() {
        // The first ones are short.
        assert_eq!(chunks(1500), (3, 500));
        // Ten minutes, an hour, a day.
        assert_eq!(chunks(30_000).1, 1500);
        let (hour, longest) = chunks(180_000);
        assert!(longest == 1500 && hour < 130, "{longest}, {hour}");
        assert_eq!(chunks(24 * 180_000).1, 1500);
    }
}
