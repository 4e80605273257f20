//! How late each tick's picture was, beside what is allowed and what others report.

use chart::stack::{Panel, Stack};
use chart::{Colour, Curve, Guide, Look, Pen};
use engine::STEP_S;
use engine::math::{max, min};

use super::flight::{Flight, StepTime};
use super::list::{Figure, Undrawn};
use super::look;

/// Columns of ticks across the figure: each is drawn by its median and its longest.
const COLUMNS: usize = 300;
/// Latency beyond which CS-FSTD(A) refuses a simulator, ms.
const LIMIT_MS: f64 = 150.0;
/// What the paper reports, ms.
const PAPER_MS: (f64, f64) = (2.5, 5.0);
/// Shorter than this is not told apart, ms: a microsecond.
const LEAST_MS: f64 = 1e-3;

/// The figure; of a log without times of its ticks there is none.
pub fn stack(flights: &[&Flight]) -> Result<Stack, Undrawn> {
    if flights.iter().any(|flight| flight.times.is_empty()) {
        return Err(Undrawn("the log has no times of its ticks: it was not flown, but made"));
    }
    let mut sent = panel("From when a tick was due to its picture's packet, lateness included, ms");
    let mut hands = panel("From the kernel's time of an input to the packet, ms");
    let mut steps = panel("The step of the flight model alone, ms");
    for (of, flight) in flights.iter().enumerate() {
        sent.curves.extend(curves(flights, of, |time| time.sent_ns));
        steps.curves.extend(curves(flights, of, |time| time.step_ns));
        let stamped = |time: &&StepTime| time.latency_ns > 0;
        let dot = |time: &StepTime| [time_s(time), ms(time.latency_ns)];
        let points: Vec<_> = flight.times.iter().filter(stamped).map(dot).collect();
        if !points.is_empty() {
            let look = Look::Dots(look::of_flight(of, flights.len() == 1), 0.7);
            let name = look::name(flights, of, "each input of hardware");
            hands.curves.push(Curve { name, look, points: thinned(&points) });
        }
    }
    let allowed = Guide {
        at: LIMIT_MS,
        to: None,
        words: "150 ms, limit of CS-FSTD(A)".into(),
        colour: look::ALARM,
    };
    let paper = Guide {
        at: PAPER_MS.0,
        to: Some(PAPER_MS.1),
        words: "2.5 to 5 ms, the paper".into(),
        colour: Colour(0xD9, 0x82, 0x00),
    };
    sent.guides = vec![paper.clone(), allowed.clone()];
    hands.guides = vec![paper, allowed];
    steps.guides = vec![Guide {
        at: STEP_S * 1e3,
        to: None,
        words: "4 ms, a tick".into(),
        colour: look::LIMIT,
    }];
    steps.height = 110.0;
    let mut panels = vec![sent];
    if !hands.curves.is_empty() {
        panels.push(hands);
    }
    panels.push(steps);
    let ranges = flights.iter().map(|flight| flight.range_s());
    let x_range = ranges.fold((f64::MAX, f64::MIN), |(a, b), (c, d)| (min(a, c), max(b, d)));
    Ok(Stack {
        title: Figure::Latency.facts().words.into(),
        subtitle: look::subtitle(flights, pace(flights)),
        x_title: "Time, s".into(),
        x_range,
        bands: look::bands(flights),
        panels,
        moments: look::moments(flights),
    })
}

/// A flight that nobody waited for was late by nothing.
fn pace(flights: &[&Flight]) -> &'static str {
    if flights.iter().all(|flight| flight.in_real_time) {
        "each column of ticks by its median and its longest"
    } else {
        "flown as fast as it went: times of the computation alone, nothing was due"
    }
}

fn panel(title: &str) -> Panel {
    Panel { logarithmic: true, height: 170.0, ..Panel::new(title, 0.0, Vec::new()) }
}

/// Median and longest of each column of ticks.
fn curves(flights: &[&Flight], of: usize, ns: fn(&StepTime) -> u64) -> Vec<Curve> {
    let times = &flights[of].times;
    let colour = look::of_flight(of, flights.len() == 1);
    let (mut medians, mut band) = (Vec::new(), Vec::new());
    for column in times.chunks(times.len().div_ceil(COLUMNS).max(1)) {
        let Some(middle) = column.get(column.len() / 2) else { continue };
        let mut found: Vec<u64> = column.iter().map(ns).collect();
        found.sort_unstable();
        let (median, longest) = (ms(found[found.len() / 2]), ms(found[found.len() - 1]));
        let at = time_s(middle);
        medians.push([at, median]);
        band.extend([[at, longest], [at, median]]);
    }
    let name = |words| look::name(flights, of, words);
    vec![
        Curve { name: name("up to the longest"), look: Look::Band(colour, 0.3), points: band },
        Curve::line(name("median"), Pen::solid(colour, 1.0), medians),
    ]
}

/// As many dots as can be told apart: of those in a row the longest.
fn thinned(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let row = points.len().div_ceil(10 * COLUMNS).max(1);
    let longest = |row: &[[f64; 2]]| row.iter().copied().max_by(|a, b| a[1].total_cmp(&b[1]));
    points.chunks(row).filter_map(longest).collect()
}

fn time_s(time: &StepTime) -> f64 {
    time.tick as f64 * STEP_S
}

fn ms(ns: u64) -> f64 {
    max(ns as f64 * 1e-6, LEAST_MS)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::figures::flight::Gatherer;

    /// A flight with these times of its ticks.
    fn flight(times: Vec<StepTime>) -> Flight {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
        let flight = Gatherer::new(Path::new("flight.mcap"), &xv15).flight;
        Flight { times, in_real_time: true, ..flight }
    }

    /// Three ticks for each column of the figure, sent after 2, 9 and 1 ms, each step of 20 µs.
    fn times() -> Vec<StepTime> {
        let sent_ns = [2_000_000, 9_000_000, 1_000_000].into_iter().cycle();
        let time = |(tick, sent_ns)| StepTime { tick, sent_ns, step_ns: 20_000, latency_ns: 0 };
        (0..3 * COLUMNS as u64).zip(sent_ns).map(time).collect()
    }

    #[test]
    fn a_column_of_ticks_is_drawn_by_its_median_and_its_longest() {
        let stack = stack(&[&flight(times())]).expect("drawn");
        let [sent, steps] = &stack.panels[..] else { panic!("no input of hardware, no panel") };
        let near = |a: [f64; 2], b: [f64; 2]| {
            assert!((a[0] - b[0]).abs() < 1e-9 && (a[1] - b[1]).abs() < 1e-9, "{a:?}, {b:?}");
        };
        let [band, medians] = &sent.curves[..] else { panic!("a band and a line") };
        assert_eq!((medians.points.len(), band.points.len()), (COLUMNS, 2 * COLUMNS));
        for (column, (median, edges)) in
            medians.points.iter().zip(band.points.as_chunks::<2>().0).enumerate()
        {
            // At the middle one of three ticks of 4 ms.
            let at_s = 0.012 * column as f64 + 0.004;
            near(*median, [at_s, 2.0]);
            near(edges[0], [at_s, 9.0]);
            near(edges[1], [at_s, 2.0]);
        }
        near(steps.curves[1].points[0], [0.004, 0.02]);
    }

    #[test]
    fn latencies_of_microseconds_and_of_a_tenth_of_a_second_are_read_off_one_axis() {
        let mut stamped = times();
        (stamped[500].latency_ns, stamped[501].latency_ns) = (4_000_000, 200);
        let panels = stack(&[&flight(stamped)]).expect("drawn").panels;
        let [sent, hands, steps] = &panels[..] else { panic!("three panels") };
        assert!(panels.iter().all(|panel| panel.logarithmic));
        // Each input is a dot, and nothing is shorter than a microsecond on that axis.
        let dots = &hands.curves[0].points;
        let [a, b] = dots[..] else { panic!("{dots:?}") };
        assert!((a[0] - 2.0).abs() < 1e-9 && (a[1] - 4.0).abs() < 1e-9, "{a:?}");
        assert!((b[0] - 2.004).abs() < 1e-9 && (b[1] - 1e-3).abs() < 1e-12, "{b:?}");
        let guides =
            |panel: &Panel| panel.guides.iter().map(|it| (it.at, it.to)).collect::<Vec<_>>();
        for panel in [sent, hands] {
            assert_eq!(guides(panel), [(2.5, Some(5.0)), (150.0, None)], "{}", panel.title);
        }
        assert!(matches!(guides(steps)[..], [(at, None)] if (at - 4.0).abs() < 1e-9));
        assert!(steps.height < sent.height && sent.height <= hands.height);
    }

    #[test]
    fn what_nobody_waited_for_is_said_to_be_and_a_log_without_times_is_not_drawn() {
        let timed = flight(times());
        let fast = Flight { in_real_time: false, ..flight(times()) };
        let subtitle = |flights: &[&Flight]| stack(flights).expect("drawn").subtitle;
        assert!(!subtitle(&[&timed]).contains("nothing was due"));
        assert!(subtitle(&[&fast]).contains("nothing was due"));
        assert!(subtitle(&[&timed, &fast]).contains("nothing was due"));
        assert!(stack(&[&timed, &flight(Vec::new())]).is_err());
    }
}
