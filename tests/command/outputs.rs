//! Files are written whole or not at all, standard output is an output, and a named input is never
//! skipped. `tests/faults.sh` fails and kills the same verbs at every kind of system call.

use std::fs::{self, File};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::common::{
    self, INCOMPLETE, LOG_CUT_SHORT, OK, Said, UNUSABLE, command, folder, said, text, tiltrotor,
    verify,
};

/// No program of ours leaves anything hidden.
#[track_caller]
fn assert_nothing_hidden(place: &Path) {
    for entry in fs::read_dir(place).expect("a folder") {
        let name = entry.expect("an entry").file_name();
        assert!(!name.to_string_lossy().starts_with('.'), "left over: {}", name.display());
    }
}

/// A flight that begins at once: what stands on its wheels has to come to rest first.
const FLY: [&str; 5] = ["fly", "--from-trim", "--pilot", "hover", "--no-flightgear"];

/// A short flight, as fast as it goes.
#[track_caller]
fn fly(log: &Path, seconds: &str, more: &[&str]) -> Said {
    let short = ["--fast", "--duration", seconds, "--out", text(log)];
    tiltrotor(&[&FLY[..], &short, more].concat())
}

/// A flight in real time, begun.
struct Flying(Child);

impl Flying {
    fn begin(log: &Path, more: &[&str]) -> Self {
        let old = fs::read(log).ok();
        let program =
            command(&[&FLY[..], &["--duration", "60", "--out", text(log)], more].concat())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .expect("the command runs");
        let flying = Self(program);
        let since = Instant::now();
        while fs::read(log).ok() == old {
            assert!(since.elapsed() < Duration::from_secs(20), "no log begun");
            sleep(Duration::from_millis(20));
        }
        flying
    }

    /// Ends it with a signal; returns its status.
    fn end(mut self, signal: &str) -> Option<i32> {
        let id = self.0.id().to_string();
        let sent = Command::new("kill").args(["-s", signal, &id]).status().expect("kill runs");
        assert!(sent.success());
        self.0.wait().expect("a status").code()
    }
}

/// Every verb that makes a log of a log, with `log` or the compacted `compact` as its source.
fn verbs<'a>(log: &'a str, compact: &'a str, broken: &'a str) -> Vec<(&'a str, Vec<&'a str>)> {
    vec![
        (log, vec!["log", "compact", log]),
        (compact, vec!["log", "expand", compact]),
        (log, vec!["log", "trim", log, "--from", "50t", "--until", "150t"]),
        (log, vec!["whatif", log, "--set", "fcc.travel.pedal_in=2"]),
        (broken, vec!["log", "recover", broken]),
    ]
}

/// A log of one second, the same compacted, and the same cut.
fn sources(place: &Path) -> [PathBuf; 3] {
    let [log, compact, cut] = ["flight.mcap", "small.mcap", "cut.mcap"].map(|n| place.join(n));
    fly(&log, "1", &[]).ends(OK);
    tiltrotor(&["log", "compact", text(&log), "--out", text(&compact)]).ends(OK);
    let bytes = fs::read(&log).expect("a log");
    fs::write(&cut, &bytes[..bytes.len() * 2 / 3]).expect("a file");
    [log, compact, cut]
}

#[test]
fn a_flight_never_shares_its_path() {
    let place = folder("outputs-shared");
    let log = place.join("flight.mcap");
    let [source, ..] = sources(&folder("outputs-shared-source"));
    let flying = Flying::begin(&log, &[]);
    for force in [&[][..], &["--force"]] {
        fly(&log, "0.1", force).refused().says("flight.mcap is being flown");
        let compact = [&["log", "compact", text(&source), "--out", text(&log)], force].concat();
        tiltrotor(&compact).refused().says("flight.mcap is being flown");
    }
    assert_eq!(flying.end("TERM"), Some(OK));
    verify(&log).ends(OK).says("exact");
    assert_nothing_hidden(&place);
}

#[test]
fn an_older_log_is_kept_until_the_new_flight_has_closed() {
    let place = folder("outputs-aside");
    let (log, aside) = (place.join("flight.mcap"), place.join("flight.mcap.old"));
    fly(&log, "0.1", &[]).ends(OK);
    let old = fs::read(&log).expect("a log");
    let flying = Flying::begin(&log, &["--force"]);
    assert!(fs::read(&aside).expect("set aside") == old);
    assert_eq!(flying.end("KILL"), None);
    verify(&log).ends(INCOMPLETE);
    assert!(fs::read(&aside).expect("still there") == old);
    fs::rename(&aside, &log).expect("put back by hand");
    assert_eq!(Flying::begin(&log, &["--force"]).end("TERM"), Some(OK));
    verify(&log).ends(OK);
    assert!(!aside.exists(), "the new one has closed");
    assert_nothing_hidden(&place);
}

#[test]
fn a_flight_that_cannot_begin_leaves_the_older_log() {
    let place = folder("outputs-not-begun");
    let log = place.join("flight.mcap");
    fly(&log, "0.1", &[]).ends(OK);
    let old = fs::read(&log).expect("a log");
    let fly = format!("{} --fast --duration 2 --force --out", FLY.join(" "));
    limited(8, &fly, &log).ends(UNUSABLE).says("File too large");
    assert!(fs::read(&log).expect("a log") == old);
    limited(800, &fly, &log).ends(LOG_CUT_SHORT).says("the log that was there before is kept as");
    assert!(fs::read(place.join("flight.mcap.old")).expect("set aside") == old);
    verify(&log).ends(INCOMPLETE);
    assert_nothing_hidden(&place);
}

/// Runs the command with no file allowed to grow beyond so many blocks of 512 bytes.
#[track_caller]
fn limited(blocks: u32, arguments: &str, out: &Path) -> Said {
    let program = env!("CARGO_BIN_EXE_tiltrotor");
    // Ignored, the signal of that becomes an error.
    let script =
        format!("ulimit -f {blocks}; trap '' XFSZ; exec '{program}' {arguments} '{}'", text(out));
    said(Command::new("sh").args(["-c", &script]))
}

#[test]
fn a_verb_that_fails_leaves_what_was_there() {
    let place = folder("outputs-fails");
    let [log, compact, cut] = sources(&place);
    let made = folder("outputs-fails-made");
    let out = made.join("precious.mcap");
    let logs = [text(&log), text(&compact), text(&cut)];
    for (_, verb) in verbs(logs[0], logs[1], logs[2]) {
        let what = verb.join(" ");
        let with = |force: &'static str| [&verb[..], &[force, "--out", text(&out)]].concat();
        // Begun by somebody whose disk was full: no obstacle.
        fs::write(&out, "").expect("a file");
        // What is recovered is never a whole flight.
        let done = if verb[1] == "recover" { INCOMPLETE } else { OK };
        tiltrotor(&[&verb[..], &["--out", text(&out)]].concat()).ends(done);
        fs::write(&out, "precious").expect("a file");
        tiltrotor(&[&verb[..], &["--out", text(&out)]].concat()).refused().says("--force");
        limited(8, &with("--force")[..verb.len() + 2].join(" "), &out)
            .ends(UNUSABLE)
            .says("File too large");
        assert_eq!(fs::read(&out).expect("the file"), b"precious", "{what}");
        assert_nothing_hidden(&made);
        tiltrotor(&with("--force")).ends(done);
        assert_ne!(fs::read(&out).expect("the file"), b"precious", "{what}");
        assert_nothing_hidden(&made);
    }
}

#[test]
fn a_source_that_is_refused_costs_no_good_file() {
    let place = folder("outputs-refused");
    let [_, compact, cut] = sources(&place);
    let damaged = place.join("damaged.mcap");
    let mut bytes = fs::read(&compact).expect("a log");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x55;
    fs::write(&damaged, bytes).expect("a file");
    let out = place.join("precious.mcap");
    fs::write(&out, "precious").expect("a file");
    let window = ["--from", "200000t", "--until", "200100t"];
    for verb in [
        vec!["log", "compact", text(&damaged)],
        vec!["log", "expand", text(&damaged)],
        vec!["log", "expand", text(&cut)],
        [&["log", "trim", text(&cut)], &window[..]].concat(),
    ] {
        let said = tiltrotor(&[&verb[..], &["--force", "--out", text(&out)]].concat());
        assert_ne!(said.status, Some(OK), "{said}");
        assert_eq!(fs::read(&out).expect("the file"), b"precious", "{said}");
    }
    assert_nothing_hidden(&place);
}

#[test]
fn a_source_is_never_written_over_under_another_name() {
    let place = folder("outputs-same");
    let [log, compact, cut] = sources(&place);
    let logs = [text(&log), text(&compact), text(&cut)];
    for (number, (source, verb)) in verbs(logs[0], logs[1], logs[2]).into_iter().enumerate() {
        let before = fs::read(source).expect("a log");
        let names = ["hard", "soft"].map(|name| place.join(format!("{name}-{number}.mcap")));
        fs::hard_link(source, &names[0]).expect("a link");
        symlink(source, &names[1]).expect("a link");
        for out in [Path::new(source), &names[0], &names[1]] {
            tiltrotor(&[&verb[..], &["--force", "--out", text(out)]].concat())
                .refused()
                .says("from which it would be made");
        }
        assert!(fs::read(source).expect("a log") == before, "{source}");
    }
    let aircraft = place.join("xv15.toml");
    fs::write(&aircraft, include_str!("../../aircraft/xv15.toml")).expect("a file");
    let of = ["--speed-kt", "0", "--nacelle", "90", "--aircraft", text(&aircraft)];
    for verb in ["trim", "linearize"] {
        tiltrotor(&[&[verb], &of[..], &["--csv", text(&aircraft)]].concat())
            .ends(UNUSABLE)
            .says("from which it would be made");
    }
    let over = ["--force", "--aircraft", text(&aircraft)];
    fly(&aircraft, "0.1", &over).refused().says("from which it would be made");
    let kept = fs::read_to_string(&aircraft).expect("the aircraft");
    assert!(kept == include_str!("../../aircraft/xv15.toml"));
}

#[test]
fn tables_and_lists_are_written_whole() {
    let place = folder("outputs-tables");
    let [log, ..] = sources(&place);
    let tables = place.join("tables");
    let export = format!("log export {} --csv", text(&log));
    limited(8, &export, &tables).ends(UNUSABLE).says("File too large");
    assert_eq!(fs::read_dir(&tables).expect("a folder").count(), 0, "nothing of it is left");
    tiltrotor(&["log", "export", text(&log), "--csv", text(&tables)]).ends(OK);
    let csv = place.join("trim.csv");
    fs::write(&csv, "precious").expect("a file");
    let sweep = "trim --nacelle 90 --sweep 0:4:1 --csv";
    limited(1, sweep, &csv).ends(UNUSABLE).says("File too large");
    assert_eq!(fs::read(&csv).expect("the file"), b"precious");
    assert_nothing_hidden(&place);
}

#[test]
#[cfg(feature = "rerun")]
fn a_recording_never_takes_the_place_of_its_log() {
    let place = folder("outputs-view");
    let [log, ..] = sources(&place);
    let before = fs::read(&log).expect("a log");
    tiltrotor(&["view", text(&log), "--save", text(&log), "--force"])
        .refused()
        .says("from which it would be made");
    assert!(fs::read(&log).expect("a log") == before);
    let saved = place.join("flight.rrd");
    fs::write(&saved, "precious").expect("a file");
    limited(8, &format!("view {} --force --save", text(&log)), &saved).ends(UNUSABLE);
    assert_eq!(fs::read(&saved).expect("the file"), b"precious");
    tiltrotor(&["view", text(&log), "--force", "--save", text(&saved)]).ends(OK);
    assert_nothing_hidden(&place);
}

#[test]
fn an_error_on_standard_output_is_one() {
    let place = folder("outputs-stdout");
    let [log, ..] = sources(&place);
    let log = text(&log);
    let out = place.join("new.mcap");
    for arguments in [
        &["verify", log][..],
        &["verify", log, "--format", "junit"],
        &["verify", log, "--format", "json"],
        &["diff", log, log],
        &["diff", log, log, "--format", "json"],
        &["log", "cat", log],
        &["log", "info", log],
        &["log", "summary", log],
        &["log", "clip", log, "--until", "50t", "--force", "--out", text(&out)],
        &["log", "compact", log, "--force", "--out", text(&out)],
        &["replay", log, "--speed", "1000"],
        &["plot", log, "--force"],
        &["report", log, "--force"],
        &["log", "fields", log],
        &["completions", "bash"],
        &["man"],
        &["trim", "--speed-kt", "0", "--nacelle", "90"],
        &["linearize", "--speed-kt", "0", "--nacelle", "90"],
        &["--help"],
        &["log", "cat", "--help"],
        &["--version"],
    ] {
        let full = File::options().write(true).open("/dev/full").expect("the device");
        let output = command(arguments).stdout(full).output().expect("the command runs");
        common::understood(&arguments.join(" "), &output)
            .ends(UNUSABLE)
            .says("cannot write to standard output: No space left on device");
    }
}

#[test]
fn whoever_closes_the_pipe_has_seen_enough() {
    let place = folder("outputs-pipe");
    let [log, ..] = sources(&place);
    let log = text(&log);
    for arguments in
        [&["log", "cat", log][..], &["log", "info", log], &["verify", log], &["--help"]]
    {
        let mut child = command(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command runs");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("a status");
        let said = common::understood(&arguments.join(" "), &output).ends(OK);
        assert_eq!(said.err, "", "{said}");
    }
}

#[test]
fn a_named_input_is_never_skipped() {
    let place = folder("outputs-inputs");
    let [log, ..] = sources(&folder("outputs-inputs-source"));
    let (logs, elsewhere) = (place.join("logs"), place.join("elsewhere"));
    for folder in [&logs, &elsewhere] {
        fs::create_dir_all(folder.join("below")).expect("a folder");
    }
    let copy = |to: PathBuf| fs::copy(&log, to).map(|_| ()).expect("a copy");
    copy(logs.join("B.MCAP"));
    copy(logs.join("below").join("c.mcap"));
    copy(elsewhere.join("below").join("d.Mcap"));
    symlink("../elsewhere", logs.join("linked")).expect("a link");
    // Links that lead back are no reason to go round for ever, nor to count a log twice.
    symlink("..", logs.join("below").join("back")).expect("a link");
    symlink("../../logs", elsewhere.join("below").join("round")).expect("a link");
    tiltrotor(&["verify", text(&logs)])
        .ends(OK)
        .says("B.MCAP: exact")
        .says("c.mcap: exact")
        .says("d.Mcap: exact")
        .says("3 logs");

    symlink("nowhere", logs.join("gone.mcap")).expect("a link");
    tiltrotor(&["verify", text(&logs)]).ends(UNUSABLE).says("gone.mcap").says("4 logs");
    fs::remove_file(logs.join("gone.mcap")).expect("a link");

    symlink("nowhere", logs.join("gone")).expect("a link");
    tiltrotor(&["verify", text(&logs)]).refused().says("logs/gone: a link to nothing");
    fs::remove_file(logs.join("gone")).expect("a link");

    let pipe = logs.join("pipe.mcap");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    tiltrotor(&["verify", text(&logs)]).refused().says("pipe.mcap: neither a file nor a folder");
}

/// `-` is standard output elsewhere, and here it would be a file that nobody looks for.
#[test]
fn a_dash_is_no_name_for_a_result() {
    let place = folder("outputs-dash");
    let log = place.join("log.mcap");
    fly(&log, "0.1", &[]).ends(OK);
    for verb in [
        vec!["report", text(&log), "--out", "-"],
        vec!["log", "compact", text(&log), "--out", "-"],
        vec![
            "fly",
            "--pilot",
            "hover",
            "--fast",
            "--no-flightgear",
            "--duration",
            "1",
            "--out",
            "-",
        ],
    ] {
        said(command(&verb).current_dir(&place)).refused().says("standard output is for words");
        assert!(!place.join("-").exists(), "{verb:?}");
    }
    said(command(&["report", text(&log), "--out", "./-"]).current_dir(&place)).ends(OK);
    assert!(place.join("-").exists());
}

#[test]
fn an_export_without_a_form_names_both() {
    let log = folder("outputs-form").join("log.mcap");
    fly(&log, "0.1", &[]).ends(OK);
    tiltrotor(&["log", "export", text(&log)]).refused().says("--csv DIR, --parquet DIR or both");
}
