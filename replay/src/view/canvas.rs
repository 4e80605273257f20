//! A recording that is written to a file, and the first thing that went wrong with it.

use std::io;
use std::path::PathBuf;

use engine::STEP_NS;
use engine::aircraft::Params as Aircraft;
use logs::output::Output;
use rerun::external::re_log_encoding::rrd::EncodeError;
use rerun::{
    RecordingStream, RecordingStreamBuilder, RecordingStreamError, RecordingStreamResult, TextLog,
    TimeColumn,
};

use super::file::RrdFile;
use super::layout::{self, Subject};
use super::scene::{Columns, send_still_life};
use super::track::Look;
use super::{SIM_TIME, Severity, ViewError};

/// Ticks of the timeline `tick`.
const TICK: &str = "tick";

/// What is drawn on.
pub struct Canvas {
    /// The recording.
    pub recording: RecordingStream,
    file: RrdFile,
    /// As it is named, and where it is until it is finished.
    path: PathBuf,
    unfinished: PathBuf,
    kind: Subject,
    error: Option<RecordingStreamError>,
}

impl Canvas {
    /// Begins the file, which whoever asked for it finishes, with everything that does not move and the viewer's layout.
    pub fn new(
        out: &Output,
        title: &str,
        kind: Subject,
        drawn: &[(&Look, &Aircraft)],
    ) -> Result<Self, ViewError> {
        let path = out.path();
        let file = out.file().map_err(|error| EncodeError::Write(io::Error::other(error)));
        let file = file
            .and_then(RrdFile::new)
            .map_err(|source| ViewError::Write { path: path.into(), source })?;
        let recording = begin(&file, title, kind, drawn)
            .map_err(|source| ViewError::Draw { path: path.into(), source: Box::new(source) })?;
        let unfinished = out.unfinished().into();
        Ok(Self { recording, file, path: path.into(), unfinished, kind, error: None })
    }

    /// Sends rows of an entity.
    pub fn send(&mut self, entity: &str, times: &[TimeColumn], columns: Columns) {
        let sent = columns.map_err(Into::into).and_then(|columns| {
            self.recording.send_columns(entity, times.iter().cloned(), columns)
        });
        self.keep(sent);
    }

    /// Keeps the first error.
    pub fn keep(&mut self, sent: RecordingStreamResult<()>) {
        if let Err(error) = sent {
            self.error.get_or_insert(error);
        }
    }

    /// Notes an event.
    pub fn event(&mut self, tick: u64, level: Severity, text: &str) {
        let columns = TextLog::new(text)
            .with_level(level.name())
            .columns_of_unit_batches()
            .map(Vec::from_iter);
        self.send("events", &times(&[tick]), columns);
    }

    /// Sends the layout once more and closes the file; its size in bytes.
    pub fn finish(mut self) -> Result<u64, ViewError> {
        let sent = layout::send(&self.recording, 2, self.kind);
        self.keep(sent);
        // Waits until everything is in the file.
        let flushed = self.recording.flush_blocking();
        let Self { file, path, unfinished, error, .. } = self;
        let closed = file.close().and_then(|()| Ok(std::fs::metadata(&unfinished)?.len()));
        match (closed, error, flushed) {
            (Err(source), ..) => Err(ViewError::Write { path, source }),
            (_, Some(source), _) => Err(ViewError::Draw { path, source: Box::new(source) }),
            (.., Err(source)) => Err(ViewError::Flush { path, source }),
            (Ok(bytes), None, Ok(())) => Ok(bytes),
        }
    }
}

/// A recording into `file` that knows no wall clock, with everything that does not move.
fn begin(
    file: &RrdFile,
    title: &str,
    kind: Subject,
    drawn: &[(&Look, &Aircraft)],
) -> RecordingStreamResult<RecordingStream> {
    // Of its properties only the name is sent: rerun would add when it began.
    let recording =
        RecordingStreamBuilder::new("tiltrotor").enabled(true).send_properties(false).buffered()?;
    recording.set_sink(Box::new(file.clone()));
    recording.set_log_time_enabled(false);
    recording.set_log_tick_enabled(false);
    recording.send_recording_name(title)?;
    drawn.iter().try_for_each(|(look, aircraft)| send_still_life(&recording, look, aircraft))?;
    layout::send(&recording, 1, kind)?;
    Ok(recording)
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
