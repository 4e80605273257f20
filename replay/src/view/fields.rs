//! Numbers of the log for layouts of one's own, drawn.

use rerun::{RecordingStream, RecordingStreamResult, Scalars, SeriesLines};

use super::canvas::{Canvas, times};
use super::field::{Channel, Field};
use super::look::{COLOURS, Look};

/// Sends names and colours: of each field its place in its view decides.
pub fn send_still(
    recording: &RecordingStream,
    look: &Look,
    fields: &[(usize, Field)],
) -> RecordingStreamResult<()> {
    for (place, field) in fields {
        recording.log_static(
            look.entity(&field.entity()),
            &SeriesLines::new()
                .with_names([format!("{}{}", look.name, field.path)])
                .with_colors([COLOURS[place % COLOURS.len()] & look.line_mask])
                .with_widths([1.5 + look.line_width]),
        )?;
    }
    Ok(())
}

/// Writes the fields of some messages: the ticks, and the messages of a channel.
pub fn send(
    canvas: &mut Canvas,
    look: &Look,
    fields: &[(usize, Field)],
    channel: Channel,
    ticks: &[u64],
    messages: &[Vec<u8>],
) {
    for (_, field) in fields.iter().filter(|(_, field)| field.channel == channel) {
        let scalars = Scalars::new(messages.iter().map(|message| field.of(message)));
        let columns = scalars.columns_of_unit_batches().map(Vec::from_iter);
        canvas.send(&look.entity(&field.entity()), &times(ticks), columns);
    }
}
