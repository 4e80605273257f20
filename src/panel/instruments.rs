//! The instruments: the flight's page of the panel.

use engine::inputs::World;
use engine::math::{atan2, max, sqrt};
use engine::outputs::Severity;
use engine::table::axis::RotorSpeed;
use engine::units::{FOOT_M, FPM_PER_MPS, RPM_PER_RADPS, compass_deg, degrees, knots};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::canvas::{Canvas, Line as Stroke, Points};
use ratatui::widgets::{Block, Paragraph};

use super::look::{Look, TICK_MS};

/// Columns beside a control's bar: its name, what its ends are called, the frame.
const AROUND_BAR: u16 = 19;

/// The flight: attitude, numbers, controls, timing, corridor, warnings.
pub fn flight(frame: &mut Frame<'_>, area: Rect, look: &Look<'_>) {
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
    let too_fast = o.rotor_speed_radps > limits.overspeed_radps;
    let rotor_style = if too_fast { look.warning() } else { Style::new() };
    let rpm = format!("% {:.0} rpm", o.rotor_speed_radps * RPM_PER_RADPS);
    let torque_style = if torque > 100.0 { look.warning() } else { Style::new() };
    let v = o.body_velocity_mps;
    let (forward, right) = (knots(v.x).round() + 0.0, knots(v.y).round() + 0.0);
    let rows: [(&str, f64, &str, Style); 8] = [
        ("airspeed", knots(o.calibrated_airspeed_mps), "kt", Style::new()),
        ("height", o.height_above_ground_m / FOOT_M, "ft", Style::new()),
        ("climb", -o.velocity_mps.z * FPM_PER_MPS, "ft/min", Style::new()),
        ("heading", compass_deg(o.euler.heading_rad), "deg", Style::new()),
        ("nacelles", 90.0 - degrees(o.actuators.mast_tilt_rad.mean()), "deg", Style::new()),
        ("rotors", rotor, &rpm, rotor_style),
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
        let from_deg = compass_deg(atan2(-v.y, -v.x));
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_has_its_mark_at_the_part_of_the_travel_where_the_control_is() {
        for (at_norm, low_norm, waits_at_norm, expected) in [
            // Stick and pedals: half the travel to each side of the middle.
            (-1.0, -1.0, None, "●────┼─────"),
            (-0.6, -1.0, None, "──●──┼─────"),
            (0.0, -1.0, None, "─────●─────"),
            (0.2, -1.0, None, "─────┼●────"),
            (1.0, -1.0, None, "─────┼────●"),
            // The lever: from its end, and no middle.
            (0.0, 0.0, None, "●──────────"),
            (0.3, 0.0, None, "───●───────"),
            (1.0, 0.0, None, "──────────●"),
            // Never beyond its ends.
            (1.5, 0.0, None, "──────────●"),
            (-1.5, -1.0, None, "●────┼─────"),
            // Where hardware waits; where the control is goes before it.
            (-0.6, -1.0, Some(0.6), "──●──┼──○──"),
            (0.3, 0.0, Some(0.5), "───●─○─────"),
            (0.3, 0.0, Some(0.3), "───●───────"),
        ] {
            assert_eq!(bar(11, at_norm, low_norm, waits_at_norm), expected);
        }
    }

    #[test]
    fn the_wind_is_told_by_where_it_comes_from() {
        let of = |north_mps: f64, east_mps: f64, turbulence_mps: f64| {
            wind(&World {
                wind_mps: engine::frames::Vec3::new(north_mps, east_mps, 0.0),
                turbulence_mps,
                ..World::default()
            })
        };
        // 10 kt are 5.144 m/s.
        assert_eq!(of(0.0, 0.0, 0.0), "wind calm");
        assert_eq!(of(-5.144, 0.0, 0.0), "wind 000° 10 kt");
        assert_eq!(of(0.0, -5.144, 0.0), "wind 090° 10 kt");
        assert_eq!(of(5.144, 0.0, 0.0), "wind 180° 10 kt");
        assert_eq!(of(0.0, 10.289, 1.5), "wind 270° 20 kt, turbulence 1.5 m/s");
    }
}
