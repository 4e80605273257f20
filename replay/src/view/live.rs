//! A flight in a running viewer, while it is flown.
//!
//! What is seen of it is drawn as it is of a log, and goes out over a connection that may break: when a viewer is
//! there again, it is told everything that does not move, the layout, the path so far and what happened. Nothing
//! here waits for the viewer but the end, and that not for long.

use std::time::{Duration, Instant};

use engine::aircraft::Params as Aircraft;
use logs::records::TimingRecord;

use super::basics::Severity;
use super::canvas::{About, Canvas};
use super::events::Happened;
pub use super::heading::Pace;
use super::layout::Layout;
use super::link::{Link, Standing};
use super::look::Look;
use super::parts::Plan;
use super::track::{Moment, Track};

/// From one attempt to find a viewer to the next.
pub const AGAIN: Duration = Duration::from_secs(1);
/// What is under way at the end has arrived by then.
const ARRIVES: Duration = Duration::from_secs(2);
/// The path is sent again when the flight is longer by this many ticks, five seconds,
const PATH_TICKS: u64 = 1250;
/// or by this part of it.
const PATH_PART: u64 = 20;
/// So many events are told to a viewer that comes back.
const EVENTS_MAX: usize = 1000;

/// What its log is, for now.
const NOT_VERIFIED: &str = "not verified while it is flown";

/// What came of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rows that were sent.
    pub rows: u64,
    /// Rows that a viewer did not take in time.
    pub dropped: u64,
    /// Rows for which there was no viewer.
    pub unseen: u64,
    /// How often a viewer was found.
    pub found: u64,
    /// How often it was lost.
    pub lost: u64,
    /// Whether a viewer was there at the end and took everything.
    pub complete: bool,
}

/// A flight that is shown while it is flown.
pub struct LiveView {
    place: String,
    about: About,
    layout: Layout,
    aircraft: Aircraft,
    track: Track,
    events: Vec<(u64, Severity, String)>,
    /// Events so far, more than are told again.
    told: u64,
    link: Option<Link>,
    /// On the link, when that is open.
    canvas: Option<Canvas>,
    tried: Option<Instant>,
    /// When the path is sent again.
    path_tick: u64,
    first_tick: Option<u64>,
    tally: Tally,
}

impl LiveView {
    /// For the viewer that listens at `place`, `HOST:PORT`, now or later.
    pub fn new(place: &str, about: About, layout: Layout, aircraft: &Aircraft) -> Self {
        let mut track = Track::live(Look::alone(), aircraft, layout.fields());
        track.facts.judge(NOT_VERIFIED);
        Self {
            place: place.into(),
            about,
            track,
            layout,
            aircraft: aircraft.clone(),
            events: Vec::new(),
            told: 0,
            link: None,
            canvas: None,
            tried: None,
            path_tick: 0,
            first_tick: None,
            tally: Tally::default(),
        }
    }

    /// Looks whether there is a viewer, or still is one. Comes back at once.
    pub fn look(&mut self) {
        match self.link.as_ref().map(Link::standing) {
            Some(Standing::Open) if self.canvas.is_none() => self.begin(),
            Some(Standing::Gone) => {
                self.link = None;
                if self.canvas.take().is_some() {
                    self.tally.lost += 1;
                    self.track.forget();
                }
            }
            None if self.tried.is_none_or(|tried| tried.elapsed() >= AGAIN) => {
                self.tried = Some(Instant::now());
                // Without a thread for it there is no viewer this time.
                self.link = Link::open(&self.place).ok();
            }
            _ => {}
        }
    }

    /// Takes what is seen now, how the latest tick kept time, and how all of them did. Comes back at once.
    pub fn push(&mut self, seen: Moment, timing: &TimingRecord, pace: Pace) {
        self.look();
        let tick = seen.outputs.tick;
        let first_tick = *self.first_tick.get_or_insert(tick);
        let (Some(canvas), Some(link)) = (&mut self.canvas, &self.link) else {
            self.tally.unseen += 1;
            self.track.miss(seen.outputs, seen.world);
            self.track.facts.keep(pace);
            return;
        };
        if !link.has_room() {
            self.tally.dropped += 1;
            self.track.miss(seen.outputs, seen.world);
            self.track.facts.keep(pace);
            return;
        }
        self.track.time(canvas, timing);
        self.track.facts.keep(pace);
        self.track.draw(canvas, seen.outputs, seen.world);
        if tick >= self.path_tick {
            self.track.send_whole(canvas);
            let longer = tick.saturating_sub(first_tick) / PATH_PART;
            self.path_tick = tick + PATH_TICKS.max(longer);
        }
        self.tally.rows += 1;
    }

    /// Notes an event.
    pub fn event(&mut self, tick: u64, level: Severity, text: &str) {
        self.told += 1;
        if let Some(canvas) = &mut self.canvas {
            let happened = Happened { tick, level, words: text, number: Some(self.told) };
            self.track.event(canvas, happened);
        }
        if self.events.len() >= EVENTS_MAX {
            self.events.remove(0);
        }
        self.events.push((tick, level, text.into()));
    }

    /// Another state took the place of the one at a tick.
    pub fn restart(&mut self, tick: u64) {
        match &mut self.canvas {
            Some(canvas) => self.track.restart(canvas, tick),
            None => {
                self.track.go_on_from(tick);
            }
        }
    }

    /// Sends what is left, fits the layout to the whole flight, and says what came of it.
    pub fn finish(mut self) -> Tally {
        let (Some(mut canvas), Some(link)) = (self.canvas.take(), self.link.take()) else {
            return self.tally;
        };
        self.track.finish(&mut canvas);
        let (recording, error) = canvas.end("");
        // Into the queue, which does not wait.
        let flushed = recording.flush_blocking();
        drop(recording);
        let whole = error.is_none() && flushed.is_ok() && link.dropped() == 0;
        self.tally.complete = link.close(ARRIVES) && whole;
        self.tally
    }

    /// Tells a viewer that was found everything that is not told row by row.
    fn begin(&mut self) {
        let Some(link) = &self.link else { return };
        let plan = (self.layout.clone(), Plan::new(&[&self.track.look.root]));
        let drawn = [(&self.track.look, &self.aircraft)];
        let begun = Canvas::begin(link.sink(), &self.about, plan, &drawn);
        let Ok(mut canvas) = begun else {
            self.link = None;
            return;
        };
        self.track.begin(&mut canvas);
        let before = self.told - self.events.len() as u64;
        for (number, (tick, level, words)) in (before + 1..).zip(&self.events) {
            let happened = Happened { tick: *tick, level: *level, words, number: Some(number) };
            self.track.event(&mut canvas, happened);
        }
        self.path_tick = 0;
        self.tally.found += 1;
        self.canvas = Some(canvas);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Outputs;
    use engine::inputs::World;
    use std::net::{Ipv4Addr, TcpListener};

    /// Half a second of rows for whoever listens there.
    fn shown_at(place: &str) -> (Tally, usize, Duration) {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15)
            .unwrap_or_else(|error| panic!("{error}"));
        let about = About { title: "live".into(), ..About::default() };
        let mut view = LiveView::new(place, about, Layout::Pilot, &xv15);
        let mut longest = Duration::ZERO;
        for row in 1..=25 {
            let mut outputs = Outputs { tick: 10 * row, ..Outputs::default() };
            outputs.position_m.x = 3.0 * row as f64;
            let began = Instant::now();
            let world = World::default();
            let seen = Moment { outputs: &outputs, world: &world, events: &[] };
            view.push(seen, &TimingRecord::default(), Pace::default());
            longest = longest.max(began.elapsed());
            std::thread::sleep(Duration::from_millis(20));
        }
        let path = view.track.trail.len();
        (view.finish(), path, longest)
    }

    #[test]
    fn nobody_is_waited_for_and_the_path_is_kept_for_whoever_comes() {
        let silent = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).expect("a port");
        let place = silent.local_addr().expect("bound").to_string();
        let (told, path, longest) = shown_at(&place);
        assert_eq!((told, path), (Tally { unseen: 25, ..Tally::default() }, 25));
        // An answer is awaited for two seconds, by another thread.
        assert!(longest < Duration::from_millis(500), "{longest:?}");
        drop(silent);
        let (told, path, _) = shown_at(&place);
        assert_eq!((told, path), (Tally { unseen: 25, ..Tally::default() }, 25));
    }
}
