//! The pictures of the panel, from what is to be seen alone.

use engine::STEP_S;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

use super::instruments::flight;
use super::look::{Look, Page, TICK_MS, lists};

/// The smallest terminal in which all of it fits.
const SIZE_MIN: (u16, u16) = (80, 24);

/// Draws a picture.
pub fn draw(frame: &mut Frame<'_>, look: &Look<'_>) {
    let area = frame.area();
    if area.width < SIZE_MIN.0 || area.height < SIZE_MIN.1 {
        let (columns, rows) = SIZE_MIN;
        let words = format!(
            "The panel needs {columns} columns and {rows} rows; this terminal has {} and {}.",
            area.width, area.height
        );
        frame.render_widget(Paragraph::new(words), area);
        return;
    }
    let [head, body, events, foot] = Layout::vertical([
        Constraint::Length(2),
        Constraint::Min(16),
        Constraint::Length(5),
        Constraint::Length(1),
    ])
    .areas(area);
    title(frame, head, look);
    match look.page {
        Page::Flight => flight(frame, body, look),
        Page::Controls(from) => controls_page(frame, body, look, from),
    }
    told(frame, events, look);
    let keys = match look.cockpit.keys_fly {
        true => " ? keys  arrows stick  PgUp/PgDn lever  n/b nacelles  p freeze  S save  Q end",
        false => " ? controls   Q or Ctrl-C end",
    };
    frame.render_widget(Paragraph::new(keys).style(Style::new().add_modifier(Modifier::DIM)), foot);
}

/// Aircraft, time, phase, recording; the verdict on real time.
fn title(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let (cockpit, now) = (look.cockpit, look.now);
    // Phases count from 1; 0 is before the first.
    let phase = usize::try_from(now.phase).ok().and_then(|number| number.checked_sub(1));
    let phase = phase.and_then(|place| cockpit.phases.get(place)).copied().unwrap_or("");
    let recording = if now.log_failed {
        Span::styled(" NOT RECORDED ANY FURTHER ", look.warning())
    } else {
        Span::styled("recording ", look.good())
    };
    let frozen = match look.shown.world.paused {
        0 => Span::raw(""),
        _ => Span::styled(" FROZEN ", look.warning()),
    };
    let first = Line::from(vec![
        Span::styled(format!(" {} ", cockpit.aircraft), Style::new().add_modifier(Modifier::BOLD)),
        Span::raw(format!(" {:9.1} s  ", now.tick as f64 * STEP_S)),
        recording,
        Span::raw(format!("{}  {phase} ", cockpit.log)),
        frozen,
    ]);
    let ms = look.shown.late_ns as f64 * 1e-6;
    let second = if ms > TICK_MS {
        let words = format!(" LATE: ticks up to {ms:.1} ms late within the last second ");
        Line::styled(words, look.warning())
    } else {
        Line::raw(format!(" {}", cockpit.verdict))
    };
    frame.render_widget(Paragraph::new(vec![first, second]), area);
}

/// What was told last.
fn told(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let rows = usize::from(area.height);
    let from = look.told.len().saturating_sub(rows);
    let lines: Vec<Line<'_>> = look
        .told
        .iter()
        .skip(from)
        .map(|told| {
            let at_s = told.tick as f64 * STEP_S;
            Line::styled(format!(" {at_s:9.1} s  {}", told.words), look.of(told.level))
        })
        .collect();
    frame.render_widget(Paragraph::new(lines), area);
}

/// The active controls, in as many columns as fit.
fn controls_page(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>, from: usize) {
    let lines = &look.cockpit.controls;
    let block = Block::bordered().title("controls of this flight");
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let (columns, rows) = lists(inner.width, inner.height);
    let widths = vec![Constraint::Fill(1); columns];
    for (column, place) in Layout::horizontal(widths).split(inner).iter().enumerate() {
        let part = lines.iter().skip(from + column * rows).take(rows);
        let part: Vec<Line<'_>> = part.map(|line| Line::raw(line.as_str())).collect();
        frame.render_widget(Paragraph::new(part), *place);
    }
}

#[cfg(test)]
mod tests {
    use std::collections::VecDeque;

    use engine::inputs::Failures;
    use engine::outputs::Validity;
    use engine::units::FOOT_M;
    use logs::view::Level;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;
    use recorder::{Shown, Snapshot, Told};

    use super::super::cockpit::Cockpit;
    use super::*;

    fn cockpit() -> Cockpit {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        Cockpit {
            log: "flight.mcap".into(),
            aircraft: xv15.name.clone(),
            envelope: xv15.envelope.clone(),
            phases: vec!["take-off"],
            verdict: "real time: ticks up to 0.1 ms late".into(),
            controls: crate::controls::keyboard(),
            keys_fly: true,
        }
    }

    fn flying() -> Shown {
        let mut shown = Shown::default();
        let o = &mut shown.outputs;
        o.calibrated_airspeed_mps = engine::units::mps_of_knots(140.0);
        o.height_above_ground_m = 300.0 * FOOT_M;
        o.velocity_mps.z = -2.54;
        o.euler.roll_rad = 0.35;
        o.euler.pitch_rad = 0.09;
        o.euler.heading_rad = -1.0;
        o.actuators.mast_tilt_rad = engine::pair::Pair::both(0.7);
        o.rotor_speed_radps = 61.68;
        o.cockpit.collective_norm = 0.6;
        o.cockpit.stick_aft_norm = -0.2;
        o.cockpit.pick_up.waiting = 1 << (engine::cockpit::AxisControl::Collective as u64);
        o.cockpit.pick_up.hardware.collective_norm = 0.2;
        o.fuel_kg = 600.0;
        o.validity = Validity::ROTOR_STALL;
        shown.world.failures = Failures::ENGINE_LEFT;
        shown.world.paused = 1;
        shown.world.wind_mps.y = 5.0;
        shown
    }

    fn picture(page: Page, shown: &Shown, size: (u16, u16)) -> String {
        let cockpit = cockpit();
        let now =
            Snapshot { tick: 1234, phase: 1, slips: 1, slipped_s: 0.5, ..Snapshot::default() };
        let words = "failed: left engine".into();
        let what = logs::records::FlightEvent::Failures;
        let told = VecDeque::from([Told { tick: 1200, what, level: Level::Warn, words }]);
        let look = Look { cockpit: &cockpit, page, shown, now: &now, told: &told, colours: false };
        let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).unwrap();
        terminal.draw(|frame| draw(frame, &look)).unwrap();
        terminal.backend().to_string()
    }

    #[test]
    fn regress_the_panel_in_flight() {
        insta::assert_snapshot!(picture(Page::Flight, &flying(), (80, 24)));
    }

    #[test]
    fn regress_the_panel_before_the_first_tick() {
        insta::assert_snapshot!(picture(Page::Flight, &Shown::default(), (100, 30)));
    }

    #[test]
    fn regress_the_page_of_controls() {
        insta::assert_snapshot!(picture(Page::Controls(0), &flying(), (120, 30)));
    }

    #[test]
    fn a_terminal_that_is_too_small_is_told_so() {
        let said = picture(Page::Flight, &flying(), (60, 10));
        assert!(said.contains("needs 80 columns and 24 rows"), "{said}");
    }
}
