//! The pictures of the panel, from what is to be seen alone.

use std::collections::VecDeque;

use engine::STEP_S;
use engine::inputs::World;
use engine::math::{atan2, max, sqrt};
use engine::outputs::Severity;
use engine::table::axis::RotorSpeed;
use engine::units::{FOOT_M, FPM_PER_MPS, RPM_PER_RADPS, degrees, knots};
use logs::view::Level;
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::canvas::{Canvas, Line as Stroke, Points};
use ratatui::widgets::{Block, Paragraph};
use recorder::{Shown, Snapshot, Told};

use super::cockpit::Cockpit;

/// The smallest terminal in which all of it fits.
const SIZE_MIN: (u16, u16) = (80, 24);
/// How long a tick lasts.
const TICK_MS: f64 = STEP_S * 1e3;
/// Columns beside a control's bar: its name, what its ends are called, the frame.
const AROUND_BAR: u16 = 19;

/// What is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// The flight.
    Flight,
    /// The active controls and keys, from this line on.
    Controls(usize),
}

impl Page {
    /// The page after it, on a terminal of this size.
    pub fn next(self, lines: usize, columns: u16, rows: u16) -> Self {
        let (columns, rows) = lists(columns.saturating_sub(2), rows.saturating_sub(AROUND_ROWS));
        match self {
            Self::Flight => Self::Controls(0),
            Self::Controls(from) if from + columns * rows < lines => {
                Self::Controls(from + columns * rows)
            }
            Self::Controls(_) => Self::Flight,
        }
    }
}

/// Rows of the screen around a list of controls.
const AROUND_ROWS: u16 = 10;
/// Columns that a line of it needs.
const LIST_COLUMNS: u16 = 58;

/// Lists side by side, and the lines of each.
fn lists(columns: u16, rows: u16) -> (usize, usize) {
    (usize::from((columns / LIST_COLUMNS).max(1)), usize::from(rows.max(1)))
}

/// Everything that a picture is made of.
pub struct Look<'a> {
    /// What does not change.
    pub cockpit: &'a Cockpit,
    /// Which picture.
    pub page: Page,
    /// The flight.
    pub shown: &'a Shown,
    /// How it goes beside the aircraft.
    pub now: &'a Snapshot,
    /// What was told, the newest last.
    pub told: &'a VecDeque<Told>,
    /// Whether there are colours.
    pub colours: bool,
}

impl Look<'_> {
    fn style(&self, colour: Color) -> Style {
        if self.colours { Style::new().fg(colour) } else { Style::new() }
    }

    fn good(&self) -> Style {
        self.style(Color::Green)
    }

    fn caution(&self) -> Style {
        self.style(Color::Yellow).add_modifier(Modifier::BOLD)
    }

    fn warning(&self) -> Style {
        self.style(Color::Red).add_modifier(Modifier::BOLD | Modifier::REVERSED)
    }

    fn of(&self, level: Level) -> Style {
        match level {
            Level::Info => Style::new(),
            Level::Warn => self.caution(),
            Level::Error => self.warning(),
        }
    }
}

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

fn flight(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let [left, middle, right] =
        Layout::horizontal([Constraint::Length(26), Constraint::Min(30), Constraint::Length(24)])
            .areas(area);
    let [attitude_area, numbers_area] =
        Layout::vertical([Constraint::Length(7), Constraint::Min(9)]).areas(left);
    attitude(frame, attitude_area, look);
    numbers(frame, numbers_area, look);
    let [controls_area, timing_area] =
        Layout::vertical([Constraint::Length(10), Constraint::Min(6)]).areas(middle);
    controls(frame, controls_area, look);
    timing(frame, timing_area, look);
    let [corridor_area, warnings_area] =
        Layout::vertical([Constraint::Length(9), Constraint::Min(7)]).areas(right);
    corridor(frame, corridor_area, look);
    warnings(frame, warnings_area, look);
}

/// The horizon as seen from the seat.
fn attitude(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let euler = look.shown.outputs.euler;
    let (s, c) = engine::math::sin_cos(euler.roll_rad);
    let pitch_deg = degrees(euler.pitch_rad);
    // No minus before a nought.
    let whole = |deg: f64| deg.round() + 0.0;
    let (roll, pitch) = (whole(degrees(euler.roll_rad)), whole(pitch_deg));
    let words = format!("roll {roll:+4.0}° pitch {pitch:+4.0}°");
    let canvas = Canvas::default()
        .block(Block::bordered().title(words))
        // Dots show in every font and without colours.
        .marker(Marker::Braille)
        .x_bounds([-30.0, 30.0])
        .y_bounds([-20.0, 20.0])
        .paint(|context| {
            // Degrees below the nose, turned against the roll: the horizon.
            let at = |along: f64| (along * c - pitch_deg * s, -along * s - pitch_deg * c);
            let ((x1, y1), (x2, y2)) = (at(-60.0), at(60.0));
            context.draw(&Stroke { x1, y1, x2, y2, color: Color::Reset });
            for (x1, x2) in [(-14.0, -5.0), (5.0, 14.0)] {
                context.draw(&Stroke { x1, y1: 0.0, x2, y2: 0.0, color: Color::Reset });
            }
        });
    frame.render_widget(canvas, area);
}

/// Speed, height, climb, heading, nacelles, rotors, torque, fuel.
fn numbers(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let o = &look.shown.outputs;
    let limits = &look.cockpit.envelope.rotors;
    let mast_n_m = o.engines.torque_n_m;
    let torque_max_n_m = limits.short_torque_n_m_max.at(RotorSpeed(o.rotor_speed_radps));
    let torque = 100.0 * max(mast_n_m.left, mast_n_m.right) / max(torque_max_n_m, 1.0);
    let rotor = 100.0 * o.rotor_speed_radps / limits.rated_radps;
    let rpm = format!("% {:.0} rpm", o.rotor_speed_radps * RPM_PER_RADPS);
    let torque_style = if torque > 100.0 { look.warning() } else { Style::new() };
    let v = o.body_velocity_mps;
    let (forward, right) = (knots(v.x).round() + 0.0, knots(v.y).round() + 0.0);
    let rows: [(&str, f64, &str, Style); 8] = [
        ("airspeed", knots(o.calibrated_airspeed_mps), "kt", Style::new()),
        ("height", o.height_above_ground_m / FOOT_M, "ft", Style::new()),
        ("climb", -o.velocity_mps.z * FPM_PER_MPS, "ft/min", Style::new()),
        ("heading", degrees(o.euler.heading_rad).rem_euclid(360.0), "deg", Style::new()),
        ("nacelles", 90.0 - degrees(o.actuators.mast_tilt_rad.mean()), "deg", Style::new()),
        ("rotors", rotor, &rpm, look.style_of_rotor()),
        ("torque", torque, "%", torque_style),
        ("fuel", o.fuel_kg, "kg", Style::new()),
    ];
    let lines = rows.map(|(name, value, unit, style)| {
        // No minus before a nought.
        let value = if value.abs() < 0.5 { 0.0 } else { value };
        let figure = Span::styled(format!("{value:>6.0}"), style.add_modifier(Modifier::BOLD));
        Line::from(vec![Span::raw(format!(" {name:<8}")), figure, Span::raw(format!(" {unit}"))])
    });
    let mut lines = lines.to_vec();
    lines.insert(1, Line::raw(format!(" drift kt  fwd {forward:+.0} right {right:+.0}")));
    frame.render_widget(Paragraph::new(lines), area);
}

impl Look<'_> {
    fn style_of_rotor(&self) -> Style {
        let (o, limits) = (&self.shown.outputs, &self.cockpit.envelope.rotors);
        if o.rotor_speed_radps > limits.overspeed_radps { self.warning() } else { Style::new() }
    }
}

/// A bar with a mark where the control is, and another where hardware waits to pick it up.
fn bar(count: usize, at_norm: f64, low_norm: f64, waits_at_norm: Option<f64>) -> String {
    let cell = |norm: f64| {
        let part = (norm - low_norm) / (1.0 - low_norm);
        ((part * (count - 1) as f64).round() as usize).min(count - 1)
    };
    let middle = if low_norm < 0.0 { Some(count / 2) } else { None };
    let mut cells: Vec<char> =
        (0..count).map(|i| if Some(i) == middle { '┼' } else { '─' }).collect();
    if let Some(waits) = waits_at_norm {
        cells[cell(waits)] = '○';
    }
    cells[cell(at_norm)] = '●';
    cells.into_iter().collect()
}

/// Where the pilot holds everything.
fn controls(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let o = &look.shown.outputs;
    let c = &o.cockpit;
    let waits = |control: engine::cockpit::AxisControl| {
        let mut waiting = engine::cockpit::waiting(c);
        waiting.find(|waits| waits.control == control).and_then(|waits| waits.hardware_norm)
    };
    use engine::cockpit::AxisControl as A;
    // Odd, so that there is a middle.
    let cells = usize::from(area.width.saturating_sub(AROUND_BAR).clamp(9, 41)) / 2 * 2 + 1;
    let axis = |low, at_norm, low_norm, waits_at_norm, high| {
        (low, bar(cells, at_norm, low_norm, waits_at_norm), high)
    };
    let rows = [
        axis("fwd", c.stick_aft_norm, -1.0, waits(A::StickAft), "aft"),
        axis("left", c.stick_right_norm, -1.0, waits(A::StickRight), "right"),
        axis("left", c.pedal_right_norm, -1.0, waits(A::PedalRight), "right"),
        axis("down", c.collective_norm, 0.0, waits(A::Collective), "up"),
    ];
    let names = ["stick", "stick", "pedal", "lever"];
    let mut lines: Vec<Line<'_>> = names
        .iter()
        .zip(rows)
        .map(|(name, (low, bar, high))| Line::raw(format!("{name} {low:>4} {bar} {high}")))
        .collect();
    let switch = |on: u64, yes: &'static str, no: &'static str| if on == 0 { no } else { yes };
    let nacelles = match c.nacelle_aft_norm {
        x if x > 0.0 => "aft",
        x if x < 0.0 => "forward",
        _ => "off",
    };
    let gear = 100.0 * o.actuators.gear_extension_norm;
    let flap_deg = degrees(o.actuators.flap_rad) + 0.0;
    lines.push(Line::raw(format!("nac. switch {nacelles:<7} flaps {flap_deg:.0}°")));
    let gear_handle = switch(c.gear_down, "down", "up");
    lines.push(Line::raw(format!("gear {gear_handle} {gear:.0} %  rpm no. {}", c.rpm_select)));
    let (scas, parking) = (switch(c.scas_on, "on", "OFF"), switch(c.parking_brake, "set", "off"));
    lines.push(Line::raw(format!("SCAS {scas}  parking brake {parking}")));
    let brakes = 100.0 * max(c.brake_norm.left, c.brake_norm.right);
    lines.push(Line::raw(format!("toe brakes {brakes:.0} %")));
    if engine::cockpit::waiting(c).next().is_some() {
        lines.pop();
        lines.push(Line::styled("○ waits to be picked up", look.caution()));
    }
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title("controls")), area);
}

/// Real time, latency, and the weather.
fn timing(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let (shown, now) = (look.shown, look.now);
    let ms = |ns: u64| ns as f64 * 1e-6;
    let late = if ms(shown.late_ns) > TICK_MS { look.warning() } else { Style::new() };
    let latency = match shown.latency_ns {
        0 => "no hardware moved".into(),
        ns => format!("input to picture {:.1} ms", ms(ns)),
    };
    let slips = format!("{} slips ({:.1} s)", now.slips, now.slipped_s);
    let lines = vec![
        Line::styled(
            format!("late {:.2} ms, max {:.2}", ms(shown.late_ns), ms(shown.late_ns_max)),
            late,
        ),
        Line::styled(
            format!("{} overruns, {slips}", shown.overruns),
            if now.slips > 0 { look.caution() } else { Style::new() },
        ),
        Line::styled(
            latency,
            if ms(shown.latency_ns) > 150.0 { look.warning() } else { Style::new() },
        ),
        Line::raw(wind(&shown.world)),
    ];
    frame.render_widget(
        Paragraph::new(lines).block(Block::bordered().title("real time, air")),
        area,
    );
}

fn wind(world: &World) -> String {
    let v = world.wind_mps;
    let kt = knots(sqrt(v.x * v.x + v.y * v.y));
    let mut words = if kt < 0.05 {
        String::from("wind calm")
    } else {
        let from_deg = degrees(atan2(-v.y, -v.x)).rem_euclid(360.0);
        format!("wind {from_deg:03.0}° {kt:.0} kt")
    };
    if world.turbulence_mps > 0.0 {
        words.push_str(&format!(", turbulence {:.1} m/s", world.turbulence_mps));
    }
    words
}

/// The conversion corridor: calibrated airspeed across, nacelles up, and where the aircraft is.
fn corridor(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let corridor = &look.cockpit.envelope.corridor;
    let o = &look.shown.outputs;
    let corners: Vec<f64> = corridor.corners_rad().collect();
    let tilt_rad = o.actuators.mast_tilt_rad.mean();
    let margin_mps = corridor.margin_mps(tilt_rad, o.calibrated_airspeed_mps);
    let flying = o.height_above_ground_m > 5.0;
    let (words, style) = if flying && margin_mps < 0.0 {
        ("OUTSIDE CORRIDOR", look.warning())
    } else {
        ("corridor 0..300 kt", Style::new())
    };
    let canvas = Canvas::default()
        .block(Block::bordered().title(Span::styled(words, style)))
        .marker(Marker::Braille)
        .x_bounds([0.0, 300.0])
        .y_bounds([-5.0, 95.0])
        .paint(|context| {
            let edges: [&dyn Fn(f64) -> f64; 2] =
                [&|tilt| corridor.slowest_mps(tilt), &|tilt| corridor.fastest_mps(tilt)];
            for edge in edges {
                for pair in corners.windows(2) {
                    let at = |tilt_rad: f64| (knots(edge(tilt_rad)), 90.0 - degrees(tilt_rad));
                    let ((x1, y1), (x2, y2)) = (at(pair[0]), at(pair[1]));
                    context.draw(&Stroke { x1, y1, x2, y2, color: Color::Reset });
                }
            }
            let here = (knots(o.calibrated_airspeed_mps), 90.0 - degrees(tilt_rad));
            context.draw(&Points { coords: &[here], color: Color::Reset });
            context.print(here.0, here.1, "◆");
        });
    frame.render_widget(canvas, area);
}

/// Validity, failures, self-check.
fn warnings(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
    let mut lines: Vec<Line<'_>> = Vec::new();
    for facts in look.shown.outputs.validity.told() {
        let style = match facts.severity {
            Severity::Caution => look.caution(),
            Severity::Warning | Severity::Final => look.warning(),
        };
        lines.push(Line::styled(facts.words, style));
    }
    for facts in look.shown.world.failures.told() {
        lines.push(Line::styled(format!("failed: {}", facts.words), look.warning()));
    }
    if look.now.mismatches > 0 {
        lines.push(Line::styled("not the same when reflown", look.warning()));
    }
    if lines.is_empty() {
        lines.push(Line::styled("none", look.good()));
    }
    frame.render_widget(Paragraph::new(lines).block(Block::bordered().title("warnings")), area);
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
    use engine::inputs::Failures;
    use engine::outputs::Validity;
    use ratatui::Terminal;
    use ratatui::backend::TestBackend;

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
