//! A recording that is drawn on, and the first thing that went wrong with it.

use engine::STEP_NS;
use engine::aircraft::Params as Aircraft;
use rerun::sink::LogSink;
use rerun::{
    MediaType, RecordingStream, RecordingStreamBuilder, RecordingStreamError,
    RecordingStreamResult, TextDocument, TimeColumn,
};

use super::basics::SIM_TIME;
use super::blueprint;
use super::columns::Columns;
use super::layout::Layout;
use super::look::Look;
use super::parts::{Plan, PointDrawn};
use super::stamp::APPLICATION;
use super::still::send_static_scene;

/// Ticks of the timeline `tick`.
const TICK: &str = "tick";

/// Rows that are waited for.
const ROWS_SETTLED: usize = 256;

/// Editions of a layout: for a flight that never ends, and for one that is over.
const BEGUN: u8 = 1;
const OVER: u8 = 2;

/// What a recording is called, and by what the viewer and we know it.
#[derive(Clone, Debug, Default)]
pub struct About {
    /// Shown.
    pub title: String,
    /// Of the same recording the same; of any other, another one.
    pub recording_id: String,
    /// Of each flight, when it was flown, in words; empty where that is not known.
    pub flown: Vec<String>,
}

/// What is drawn on.
pub struct Canvas {
    /// The recording.
    pub recording: RecordingStream,
    /// What it is called.
    pub about: About,
    /// First and last tick drawn.
    pub span: Option<(u64, u64)>,
    layout: Layout,
    plan: Plan,
    error: Option<RecordingStreamError>,
}

impl Canvas {
    /// Begins a recording that knows no wall clock, with everything that does not move and the viewer's
    /// layout.
    pub fn begin(
        sink: Box<dyn LogSink>,
        about: &About,
        (layout, plan): (Layout, Plan),
        drawn: &[(&Look, &Aircraft)],
    ) -> RecordingStreamResult<Self> {
        // Of its properties only the name is sent: rerun would add when it began.
        let recording = RecordingStreamBuilder::new(APPLICATION)
            .recording_id(about.recording_id.as_str())
            .enabled(true)
            .send_properties(false)
            .buffered()?;
        recording.set_sink(sink);
        recording.set_log_time_enabled(false);
        recording.set_log_tick_enabled(false);
        recording.send_recording_name(about.title.as_str())?;
        drawn
            .iter()
            .try_for_each(|(look, aircraft)| send_static_scene(&recording, look, aircraft))?;
        blueprint::send(&recording, BEGUN, (&layout, &plan), "", None)?;
        Ok(Self { recording, about: about.clone(), span: None, layout, plan, error: None })
    }

    /// Writes a page that does not move, in Markdown.
    pub fn write(&mut self, entity: &str, page: String) {
        let document = TextDocument::new(page).with_media_type(MediaType::markdown());
        let sent = self.recording.log_static(entity, &document);
        self.keep(sent);
    }

    /// Sends rows of an entity.
    pub fn send(&mut self, entity: &str, times: &[TimeColumn], columns: Columns) {
        let sent = columns.map_err(Into::into).and_then(|columns| {
            self.recording.send_columns(entity, times.iter().cloned(), columns)
        });
        self.keep(sent);
        // Many rows are written before the next ones are made: of a long flight they would wait in memory, all
        // entities of them. What cannot be written is told at the end.
        if times.iter().any(|times| times.num_rows() >= ROWS_SETTLED) {
            let _ = self.recording.flush_blocking();
        }
    }

    /// Notes what a graph draws, for its title.
    pub fn see(&mut self, entity: &str, points: impl Iterator<Item = PointDrawn>) {
        self.plan.see(entity, points);
    }

    /// Whether the layout has the numbers of both rotors.
    pub fn shows_rotors(&self) -> bool {
        self.layout == Layout::Rotor
    }

    /// Notes that a tick is drawn.
    pub fn reach(&mut self, tick: u64) {
        let (first, last) = self.span.unwrap_or((tick, tick));
        self.span = Some((first.min(tick), last.max(tick)));
    }

    /// Keeps the first error.
    pub fn keep(&mut self, sent: RecordingStreamResult<()>) {
        if let Err(error) = sent {
            self.error.get_or_insert(error);
        }
    }

    /// Sends the layout once more, fitted to the whole, under a name that says `mark`; the first error.
    pub fn end(mut self, mark: &str) -> (RecordingStream, Option<RecordingStreamError>) {
        let sent =
            blueprint::send(&self.recording, OVER, (&self.layout, &self.plan), mark, self.span);
        self.keep(sent);
        (self.recording, self.error)
    }
}

/// Both timelines of some rows.
pub fn times(ticks: &[u64]) -> [TimeColumn; 2] {
    let signed = |value: u64| i64::try_from(value).unwrap_or(i64::MAX);
    [
        TimeColumn::new_sequence(TICK, ticks.iter().map(|&tick| signed(tick))),
        TimeColumn::new_duration_nanos(
            SIM_TIME,
            ticks.iter().map(|&tick| signed(tick.saturating_mul(STEP_NS))),
        ),
    ]
}
