//! Figures and the report of a flight: what they show, that the same log gives the same bytes, and that
//! nothing in a log becomes markup.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{
    self, DIVERGED, Forgery, INCOMPLETE, OK, UNUSABLE, folder, hover, text, tiltrotor,
};

/// A flight that lifts off, turns and lands, and one that differs from it.
fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

const FIGURES: [&str; 8] =
    ["trajectory", "plan", "profile", "euler", "controls", "rotors", "corridor", "latency"];

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn the_same_log_gives_the_same_figures_and_the_same_report() {
    let out = folder("figures_same");
    let log = out.join("hover.mcap");
    hover(&log, "12");
    let (one, other) = (out.join("one"), out.join("other"));
    for to in [&one, &other] {
        tiltrotor(&["plot", text(&log), "--out", text(to)]).ends(OK).says("exact");
        let painted = ["--format", "png", "--figure", "corridor"];
        let plot = ["plot", text(&log), "--out", text(to)];
        tiltrotor(&[&plot[..], &painted].concat()).ends(OK);
        tiltrotor(&["report", text(&log), "--out", text(&to.join("report.html"))]).ends(OK);
    }
    let svg = FIGURES.iter().map(|name| format!("hover-{name}.svg"));
    for name in svg.chain(["hover-corridor.png".into()]) {
        let (one, other) = (fs::read(one.join(&name)), fs::read(other.join(&name)));
        assert_eq!(one.expect(&name), other.expect(&name), "{name}");
    }
    assert_eq!(read(&one.join("report.html")), read(&other.join("report.html")));
    let page = read(&one.join("report.html"));
    // Nothing comes from elsewhere.
    for elsewhere in ["<script", "<img", "<link rel=\"style", "@import", "src="] {
        assert!(!page.contains(elsewhere), "{elsewhere}");
    }
    assert_eq!(page.matches("http").count(), page.matches("http://www.w3.org/2000/svg").count());
    let compact = out.join("compact.html");
    tiltrotor(&["report", text(&log), "--compact", "--out", text(&compact)]).ends(OK);
    assert!(read(&compact).len() < page.len() / 2);
}

#[test]
fn figures_have_titles_axes_units_and_moments() {
    let out = folder("figures_shown");
    let log = golden("landing.mcap");
    tiltrotor(&["plot", text(&log), "--out", text(&out)]).ends(OK);
    for (name, words) in [
        ("trajectory", "Height, m"),
        ("plan", "East of the start, m"),
        ("profile", "Airspeed, kt"),
        ("euler", "Pitch θ, deg"),
        ("controls", "Power lever, % of travel"),
        ("rotors", "Rotor speed, rpm"),
        ("corridor", "Calibrated airspeed, kt"),
    ] {
        let svg = read(&out.join(format!("landing-{name}.svg")));
        for words in [words, "touchdown", "landing.mcap", "<title id="] {
            assert!(svg.contains(words), "{name} lacks `{words}`");
        }
    }
}

#[test]
fn two_flights_are_told_apart_by_the_names_of_their_logs() {
    let out = folder("figures_two");
    let (a, b) = (out.join("calm.mcap"), out.join("longer.mcap"));
    hover(&a, "3");
    hover(&b, "4");
    tiltrotor(&["plot", text(&a), "--against", text(&b)]).ends(OK);
    for name in ["trajectory", "plan", "euler", "corridor", "latency"] {
        let svg = read(&out.join(format!("calm-longer-{name}.svg")));
        for words in [">calm.mcap", ">longer.mcap", "#4a4a4a", "#c7158b"] {
            assert!(svg.contains(words), "{name} lacks `{words}`");
        }
        let strip = svg.contains("longer.mcap less calm.mcap, deg");
        assert_eq!(strip, name == "euler", "{name}: a strip of differences");
    }
}

#[test]
fn nothing_is_overwritten_unless_it_is_wanted() {
    let out = folder("figures_force");
    let log = out.join("hover.mcap");
    hover(&log, "1");
    let page = out.join("hover.html");
    tiltrotor(&["report", text(&log)]).ends(OK);
    fs::write(&page, "mine").expect("a file");
    tiltrotor(&["report", text(&log)]).refused().says("exists");
    assert_eq!(read(&page), "mine");
    tiltrotor(&["report", text(&log), "--force"]).ends(OK);
    tiltrotor(&["report", text(&log), "--out", text(&log), "--force"]).refused();
    tiltrotor(&["plot", text(&log), "--figure", "euler"]).ends(OK);
    tiltrotor(&["plot", text(&log), "--figure", "plan", "euler"]).refused().says("exists");
    assert!(!out.join("hover-plan.svg").exists(), "refused before anything is written");
}

#[test]
fn a_log_that_is_not_exact_is_drawn_as_what_it_is() {
    let out = folder("figures_altered");
    let log = out.join("flight.mcap");
    hover(&log, "2");
    let mut forgery = Forgery::of(&log);
    common::flip_state_bit(&mut forgery, 100, "plant.velocity_mps.x");
    let altered = out.join("altered.mcap");
    forgery.write(&altered);
    let said = tiltrotor(&["report", text(&altered)]).ends(DIVERGED);
    assert!(said.out.contains("altered at tick 100"), "{said}");
    let page = read(&out.join("altered.html"));
    assert!(page.contains("verdict bad") && page.contains("altered at tick 100"));
    tiltrotor(&["plot", text(&altered), "--figure", "euler"]).ends(DIVERGED);
    assert!(read(&out.join("altered-euler.svg")).contains("altered at tick 100"));
    let cut = out.join("cut.mcap");
    let bytes = fs::read(&log).expect("a log");
    fs::write(&cut, &bytes[..bytes.len() * 3 / 4]).expect("a file");
    tiltrotor(&["report", text(&cut)]).ends(INCOMPLETE).says("never closed");
    assert!(read(&out.join("cut.html")).contains("verdict doubt"));
    let none = out.join("none.mcap");
    fs::write(&none, "no log").expect("a file");
    for verb in ["plot", "report"] {
        tiltrotor(&[verb, text(&none)]).refused();
    }
    tiltrotor(&["log", "fields", text(&none)]).ends(UNUSABLE);
}

/// Whoever writes a log writes what he likes into it.
#[test]
fn what_a_log_calls_a_device_is_text_on_the_page() {
    let out = folder("figures_hostile");
    let log = out.join("flight.mcap");
    hover(&log, "1");
    let mut forgery = Forgery::of(&log);
    let hostile = "</td><script>alert(1)</script><img src=x onerror=alert(2)>\"'&\u{202e}";
    let metadata = forgery.metadata.iter_mut().find(|record| record.name == "tiltrotor");
    let metadata = metadata.expect("who flew");
    metadata.metadata.insert("program".into(), hostile.into());
    metadata.metadata.insert(hostile.into(), hostile.into());
    // The first event in words.
    let place = forgery.places("/log")[0];
    forgery.messages[place].data = words_of(hostile).into();
    let path = out.join("<b>hostile.mcap");
    forgery.write(&path);
    let page = out.join("page.html");
    let said = tiltrotor(&["report", text(&path), "--out", text(&page)]);
    assert!(said.status != Some(OK), "nobody calls it exact: {said}");
    let page = read(&page);
    assert!(page.contains("&lt;script&gt;alert(1)"), "it is shown");
    for markup in ["<script", "<img", "<b>hostile", "\u{202e}"] {
        assert!(!page.contains(markup), "{markup} is markup");
    }
}

/// A `/log` message that says these words.
fn words_of(words: &str) -> Vec<u8> {
    let mut bytes = vec![0, 1, 0, 0];
    bytes.extend([0; 8]);
    bytes.extend([20, 0, 0, 0]);
    for text in ["t", words, "", ""] {
        bytes.extend((text.len() as u32 + 1).to_le_bytes());
        bytes.extend(text.bytes());
        bytes.push(0);
        // Numbers stand at places that four divides, counted after the header.
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes.extend([0; 4]);
    bytes
}

/// At 100 kt and 400 ft somebody rolls it over and holds the stick there: upside down it meets the ground
/// with the hull, and everything that tells of the flight says so.
#[test]
fn a_crash_is_named_in_events_summary_and_report() {
    let out = folder("figures_crash");
    let (script, log) = (out.join("roll.toml"), out.join("crash.mcap"));
    fs::write(&script, "[[event]]\nat_s = 1.0\naxis = { stick_right = 1.0 }\n").expect("a file");
    let more =
        ["--from-trim", "--speed-kt", "100", "--altitude-ft", "400", "--duration", "15", "--fast"];
    let flight = ["fly", "--no-flightgear", "--script", text(&script), "--out", text(&log)];
    tiltrotor(&[&flight[..], &more].concat()).ends(OK);
    let summary = tiltrotor(&["log", "summary", text(&log)]).ends(OK);
    let roll = summary.after("roll").to_string();
    let roll_deg = roll.split_whitespace().filter_map(|word| word.parse::<f64>().ok());
    assert!(
        roll_deg.fold(0.0, |most: f64, deg| if deg.abs() > most { deg.abs() } else { most })
            > 120.0,
        "{roll}"
    );
    for words in ["structural contact: the hull", "hull on the ground"] {
        tiltrotor(&["log", "info", text(&log)]).ends(OK).says(words);
        tiltrotor(&["log", "summary", text(&log)]).ends(OK).says(words);
    }
    tiltrotor(&["report", text(&log)]).ends(OK);
    let page = read(&out.join("crash.html"));
    assert!(page.contains("CRASH, hull on the ground at "), "the verdict");
    assert!(page.contains("<td>ERROR</td>"), "the event");
    tiltrotor(&["plot", text(&log), "--figure", "profile", "corridor"]).ends(OK);
    // Upright at 100 kt and more it is too fast, and the least margin is none.
    assert!(read(&out.join("crash-corridor.svg")).contains("least margin: −"));
    let profile = read(&out.join("crash-profile.svg"));
    // The red of what failed is on the disc of the impact.
    for words in ["impact", "CRASH at ", "Roll φ, deg", "Pitch θ, deg", "#c21f1f"] {
        assert!(profile.contains(words), "{words}");
    }
}

#[test]
fn a_report_begins_with_what_was_flown() {
    let out = folder("figures_flown");
    let log = out.join("flight.mcap");
    hover(&log, "2");
    tiltrotor(&["report", text(&log)]).ends(OK);
    let whole = read(&out.join("flight.html"));
    // A part is told as what it is.
    let page = out.join("part.html");
    let part = ["--from", "0.5", "--until", "1.5", "--out", text(&page)];
    tiltrotor(&[&["report", text(&log)], &part[..]].concat());
    let part = read(&page);
    for (page, words) in [(whole, "XV-15: 2.0 s of flight, "), (part, "XV-15: 1.0 s of flight, ")] {
        let sentence = page.split_once(words).map(|(_, sentence)| sentence).expect(words);
        let sentence = sentence.split('<').next().unwrap_or_default();
        // On its wheels: nowhere, and as high as it stands.
        assert!(sentence.starts_with("0 m over the ground, up to "), "{sentence}");
        assert!(sentence.trim_end().ends_with(" above it and 0 kt true airspeed."), "{sentence}");
    }
}
