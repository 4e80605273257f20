//! What stands on the page, from the top.

use chrono::{DateTime, Utc};
use engine::STEP_S;
use engine::units::knots;
use logs::Identity;
use logs::devices::DeviceIdentity;
use logs::view::Level;
use replay::Outcome;
use replay::figures::{Figure, draw};

use super::histogram;
use super::html::Html;
use super::words::{crash, s, summary};
use crate::afterwards::Afterwards;
use crate::timing;

/// The page's looks: for a screen of any width, and for paper.
const STYLE: &str = include_str!("style.css");
/// How far lines may lie beside their points where the page is to be small, points.
const COARSE: f64 = 0.5;
/// Figures of a page that is to be small.
const COMPACT: [Figure; 3] = [Figure::Plan, Figure::Profile, Figure::Corridor];
/// Seconds in which a crew flies it again around something.
const AROUND_S: u64 = 5;

/// The page.
pub fn page(flown: &Afterwards, compact: bool) -> String {
    let mut html = Html::default();
    html.markup("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    html.markup("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    html.markup(
        "<meta name=\"color-scheme\" content=\"light\">\n<link rel=\"icon\" href=\"data:,\">\n",
    );
    html.element("title", &format!("Flight report: {}", flown.flight.name));
    html.markup("<style>\n").markup(STYLE).markup("</style>\n</head>\n<body>\n<main>\n");
    html.element("h1", &format!("Flight report: {}", flown.flight.name));
    verdict(&mut html, flown);
    html.markup("<section>\n<h2>Summary</h2>\n");
    for sentence in summary(flown) {
        html.element("p", &sentence);
    }
    html.facts(&who(flown));
    html.markup("</section>\n");
    figures(&mut html, flown, compact);
    events(&mut html, flown, compact);
    html.markup("<section>\n<h2>Handling and limits</h2>\n");
    html.facts(&handling(flown));
    html.markup("<h3>Extremes</h3>\n");
    html.table(&["quantity", "least", "at", "greatest", "at"], &extremes(flown));
    html.markup("</section>\n");
    real_time(&mut html, flown, compact);
    if !compact {
        devices(&mut html, &flown.devices);
    }
    provenance(&mut html, flown);
    html.markup("</main>\n</body>\n</html>\n");
    html.finish()
}

/// What the log is and what became of the flight, where nobody can overlook it.
fn verdict(html: &mut Html, flown: &Afterwards) {
    let class = match flown.judgement.outcome {
        Outcome::Exact | Outcome::NotReflown => "<p class=\"verdict good\">",
        Outcome::NeverClosed | Outcome::Compared => "<p class=\"verdict doubt\">",
        _ => "<p class=\"verdict bad\">",
    };
    html.markup(class).markup("<strong>The log</strong> ").text(&flown.judgement.words);
    html.markup("</p>\n");
    if let Some(crash) = crash(flown) {
        html.markup("<p class=\"verdict bad\"><strong>The flight</strong> ").text(&crash);
        html.markup("</p>\n");
    }
}

/// Who flew what, when.
fn who(flown: &Afterwards) -> Vec<(String, String)> {
    let identity = &flown.identity;
    let started =
        identity.get(Identity::STARTED).parse().ok().map(DateTime::<Utc>::from_timestamp_nanos);
    let when = started.map_or_else(
        || "the log does not say".to_string(),
        |time| time.format("%Y-%m-%d %H:%M:%S UTC").to_string(),
    );
    let (first, last) = flown.ticks;
    let fact = |name: &str, what: String| (name.to_string(), what);
    vec![
        fact("Flown by", identity.who(&flown.devices)),
        fact("Aircraft", flown.aircraft.clone()),
        fact("Begun", when),
        fact(
            "Ticks",
            format!("{} of {:.0} ms, from {} to {}", last - first, STEP_S * 1e3, s(first), s(last)),
        ),
        fact(
            "Program",
            format!("{}, flight model {}", identity.get("program"), identity.get(Identity::MODEL)),
        ),
    ]
}

fn figures(html: &mut Html, flown: &Afterwards, compact: bool) {
    html.markup("<section>\n<h2>Figures</h2>\n");
    let (wanted, tolerance) =
        if compact { (&COMPACT[..], COARSE) } else { (Figure::ALL, chart::TOLERANCE) };
    for figure in wanted {
        let facts = figure.facts();
        match draw(*figure, &[&flown.flight], tolerance) {
            Ok(page) => html.figure(&page, facts.key, facts.description),
            Err(why) => {
                html.element("p", &format!("{}: not drawn: {}.", facts.words, why.0));
            }
        }
    }
    html.markup("</section>\n");
}

fn events(html: &mut Html, flown: &Afterwards, compact: bool) {
    html.markup("<section>\n<h2>Events</h2>\n");
    let (numbered, left) = flown.flight.moments();
    let all: Vec<_> = flown.flight.happened.iter().collect();
    let shown = if compact { &numbered } else { &all };
    let mut number = 0;
    let rows: Vec<Vec<String>> = shown
        .iter()
        .map(|event| {
            // The discs of the figures.
            let disc = numbered.iter().any(|numbered| std::ptr::eq(*numbered, *event));
            number += usize::from(disc);
            vec![
                if disc { number.to_string() } else { String::new() },
                s(event.tick),
                level(event.level).into(),
                event.words.clone(),
            ]
        })
        .collect();
    if rows.is_empty() {
        html.markup("<p>The log tells of none.</p>\n");
    } else {
        html.table(&["figures", "time", "level", "what happened"], &rows);
    }
    if compact && left > 0 {
        html.element("p", &format!("{left} more are in the log: `tiltrotor log info` lists them."));
    }
    html.markup("</section>\n");
}

fn level(level: Level) -> &'static str {
    match level {
        Level::Info => "",
        Level::Warn => "warning",
        Level::Error => "ERROR",
    }
}

fn handling(flown: &Afterwards) -> Vec<(String, String)> {
    let (debrief, margins) = (&flown.debrief, &flown.margins);
    let fact = |name: &str, what: String| (name.to_string(), what);
    let touchdown = debrief.touchdown.as_ref().map_or_else(
        || "none".to_string(),
        |touchdown| format!("at {}: {touchdown}", s(touchdown.tick)),
    );
    let outside = |what: &str, excursions: &recorder::debrief::Excursions| match excursions.times {
        0 => format!("never {what}"),
        times => format!(
            "{what} {times} times, {:.1} s in all, by {:.0} kt at most",
            excursions.ticks as f64 * STEP_S,
            knots(excursions.by_mps_max)
        ),
    };
    let corridor = match margins.corridor_mps_min {
        None => "not flown high enough to be asked for".into(),
        Some((least_mps, tick)) => format!(
            "{}; least margin {:.1} kt at {}",
            outside("outside", &debrief.corridor),
            knots(least_mps),
            s(tick)
        ),
    };
    let torque = margins.torque_norm_max.map_or_else(String::new, |(most, tick)| {
        format!("{:.0} % of the short-time limit of a mast at most, at {}", 100.0 * most, s(tick))
    });
    let used_kg = margins.fuel_kg.map_or(0.0, |first_kg| first_kg - flown.last.fuel_kg);
    let flown_s = (flown.ticks.1 - flown.ticks.0) as f64 * STEP_S;
    let exceeded = if debrief.validity.is_empty() {
        "nothing: the model's data cover all of it".to_string()
    } else {
        debrief.validity.to_string()
    };
    vec![
        fact("Touchdown", touchdown),
        fact("Conversion corridor", corridor),
        fact("Flap speed", outside("exceeded", &debrief.flap_speed)),
        fact("Torque", torque),
        fact(
            "Power",
            format!(
                "{:.0} kW of both engines in the mean; {:.1} kg of fuel used, {:.1} kg left",
                1e-3 * margins.energy_j / engine::math::max(flown_s, STEP_S),
                used_kg,
                flown.last.fuel_kg
            ),
        ),
        fact("Limits of the model exceeded", exceeded),
    ]
}

fn extremes(flown: &Afterwards) -> Vec<Vec<String>> {
    let number = |value: f64| chart::with_minus(format!("{value:.2}"));
    flown
        .gathered
        .extremes()
        .map(|(name, unit, least, greatest)| {
            vec![
                format!("{name}, {unit}"),
                number(least.value),
                s(least.tick),
                number(greatest.value),
                s(greatest.tick),
            ]
        })
        .collect()
}

/// How it kept time, as its log's histograms say.
fn real_time(html: &mut Html, flown: &Afterwards, compact: bool) {
    html.markup("<section>\n<h2>Real time</h2>\n");
    let Some((_, facts)) = flown.facts.iter().find(|(name, _)| timing::is_timing(name)) else {
        html.markup("<p>The log has no record of it: it was not flown, but made of another, or never closed.</p>\n");
        html.markup("</section>\n");
        return;
    };
    if !flown.flight.in_real_time {
        html.markup("<p>Flown as fast as it went: nothing waited for the clock.</p>\n");
    }
    let count = |key: &str| facts.get(key).map_or("0", String::as_str);
    let counts = format!(
        "{} overruns (ticks that ended after the next one was due), {} slips of the clock, {} events without \
         a time of the kernel's, {} with one that cannot be.",
        count("overruns"),
        count("slips"),
        count("synthetic_events"),
        count("implausible_events")
    );
    html.element("p", &counts);
    let mut rows = Vec::new();
    let mut pictures = Vec::new();
    for (key, _, what) in timing::KINDS {
        let Some(steps) = facts.get(key).and_then(|text| timing::steps(text)) else { continue };
        let Some(percentiles) = timing::percentiles(&steps) else { continue };
        let mut row = vec![what.to_string()];
        row.extend(percentiles.map(|ms| format!("{ms:.3}")));
        rows.push(row);
        pictures.push(histogram::page(&format!("From 0 ms: {what}"), &steps));
    }
    html.table(&["ms", "p50", "p99", "p99.9", "longest"], &rows);
    html.markup(
        "<p>CS-FSTD(A) allows 150 ms from input to picture; the paper reports 2.5 to 5 ms.</p>\n",
    );
    if !compact {
        for (number, picture) in pictures.iter().enumerate() {
            html.figure(picture, &format!("histogram{number}"), "");
        }
    }
    html.markup("</section>\n");
}

fn devices(html: &mut Html, devices: &[DeviceIdentity]) {
    html.markup("<section>\n<h2>Devices</h2>\n");
    if devices.is_empty() {
        html.markup(
            "<p>No device of hardware was found, or none was looked for.</p>\n</section>\n",
        );
        return;
    }
    let row = |device: &DeviceIdentity| {
        let DeviceIdentity { bus, vendor, product, version, .. } = device;
        vec![
            device.device.to_string(),
            device.name.clone(),
            format!("{bus:04x}:{vendor:04x}:{product:04x}:{version:04x}"),
            device.port.clone(),
            device.uniq.clone(),
            if device.mapped == 0 { "no".into() } else { "yes".into() },
            s(device.tick),
        ]
    };
    let rows: Vec<_> = devices.iter().map(row).collect();
    let head = [
        "number",
        "name",
        "bus:vendor:product:version",
        "port",
        "serial number",
        "mapped",
        "found",
    ];
    html.table(&head, &rows);
    html.markup("</section>\n");
}

fn provenance(html: &mut Html, flown: &Afterwards) {
    html.markup("<section>\n<h2>Provenance, and how to refly it</h2>\n");
    let mut facts: Vec<(String, String)> =
        flown.identity.0.iter().map(|(key, value)| (key.clone(), value.clone())).collect();
    for (name, text) in flown.setup.files() {
        facts.push((name.into(), format!("{} lines, {} bytes", text.lines().count(), text.len())));
    }
    facts.push(("digest".into(), format!("{:016x}", flown.digest)));
    facts.push(("end".into(), flown.end.clone()));
    html.facts(&facts);
    html.markup("<p>The log holds all that it was flown with. The program of the same flight model reflies it to \
                 the same bits:</p>\n");
    let name = shell(&flown.flight.name);
    let mut commands = vec![
        format!("tiltrotor verify {name}"),
        format!("tiltrotor replay {name}"),
        format!("tiltrotor plot {name}"),
    ];
    let (numbered, _) = flown.flight.moments();
    let gravest =
        numbered.iter().max_by_key(|event| (event.level as u8, std::cmp::Reverse(event.tick)));
    if let Some(event) = gravest {
        let at_s = event.tick as f64 * STEP_S;
        commands.push(format!("tiltrotor log find {name} --around {at_s:.3} --window {AROUND_S}"));
    }
    html.markup("<pre>");
    for command in commands {
        html.text(&command).markup("\n");
    }
    html.markup("</pre>\n");
    html.markup("</section>\n");
}

/// A name as a shell takes it.
fn shell(name: &str) -> String {
    let plain = |letter: char| letter.is_ascii_alphanumeric() || "._-/+".contains(letter);
    if !name.is_empty() && name.chars().all(plain) && !name.starts_with('-') {
        return name.into();
    }
    format!("'{}'", name.replace('\'', "'\\''"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_device_calls_itself_is_text() {
        let hostile = "</td><script>alert(1)</script>\"'\u{202e}";
        let device = DeviceIdentity {
            name: hostile.into(),
            port: hostile.into(),
            uniq: hostile.into(),
            mapped: 1,
            ..DeviceIdentity::default()
        };
        let mut html = Html::default();
        devices(&mut html, &[device]);
        let page = html.finish();
        assert!(!page.contains("<script") && !page.contains('\u{202e}'), "{page}");
        assert_eq!(page.matches("&lt;script&gt;alert(1)").count(), 3, "{page}");
    }

    #[test]
    fn a_name_is_quoted_where_a_shell_would_read_it_otherwise() {
        for (name, written) in [
            ("flight.mcap", "flight.mcap"),
            ("my flight.mcap", "'my flight.mcap'"),
            ("$(rm -r x).mcap", "'$(rm -r x).mcap'"),
            ("it's.mcap", "'it'\\''s.mcap'"),
            ("-f.mcap", "'-f.mcap'"),
        ] {
            assert_eq!(shell(name), written);
        }
    }
}
