use super::*;

fn hidden(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("one").path());
    entries.filter(|path| path.extension().is_some_and(|name| name == "unfinished")).collect()
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).expect("a file")
}

fn put(output: &Output, text: &str) {
    output.file().expect("the file").write_all(text.as_bytes()).expect("written");
}

#[test]
fn a_file_that_is_not_finished_leaves_what_was_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    fs::write(&path, "good").expect("a file");
    let output = Output::beside(&path, true, &[]).expect("begun");
    put(&output, "half");
    assert_eq!((text(&path).as_str(), text(output.unfinished()).as_str()), ("good", "half"));
    drop(output);
    assert_eq!(text(&path), "good");
    assert_eq!(hidden(folder.path()), Vec::<PathBuf>::new());
}

#[test]
fn without_force_nothing_is_replaced_even_when_it_came_meanwhile() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    let output = Output::beside(&path, false, &[]).expect("begun");
    put(&output, "late");
    fs::write(&path, "first").expect("a file");
    assert!(matches!(output.finish(), Err(LogError::Exists { .. })));
    assert!(matches!(Output::beside(&path, false, &[]), Err(LogError::Exists { .. })));
    assert_eq!(text(&path), "first");
    assert_eq!(hidden(folder.path()), Vec::<PathBuf>::new());
}

#[test]
fn an_empty_file_left_over_is_no_obstacle() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, flight) in [("a", false), ("b", true)] {
        let path = folder.path().join(name);
        fs::write(&path, "").expect("a file");
        let output =
            if flight { Output::flight(&path, false) } else { Output::beside(&path, false, &[]) };
        let output = output.expect("begun");
        put(&output, "whole");
        output.finish().expect("in its place");
        assert_eq!(text(&path), "whole");
    }
}

#[test]
fn an_input_is_never_written_over_under_any_of_its_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = |name: &str| folder.path().join(name);
    fs::write(name("log"), "good").expect("a file");
    fs::hard_link(name("log"), name("hard")).expect("a link");
    std::os::unix::fs::symlink(name("log"), name("soft")).expect("a link");
    for other in ["log", "hard", "soft"] {
        let refused = Output::beside(&name(other), true, &[&name("log")]);
        assert!(matches!(refused, Err(LogError::Input { .. })), "{other}");
    }
    assert_eq!(text(&name("log")), "good");
}

#[test]
fn a_flight_has_its_name_to_itself_until_it_is_closed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    let mut flight = Output::flight(&path, false).expect("claimed");
    put(&flight, "grow");
    assert!(!path.exists(), "no name before the first state");
    flight.begun().expect("begun");
    put(&flight, "ing");
    assert_eq!(text(&path), "growing");
    for force in [false, true] {
        assert!(matches!(Output::flight(&path, force), Err(LogError::InUse { .. })));
        assert!(matches!(Output::beside(&path, force, &[]), Err(LogError::InUse { .. })));
    }
    flight.finish().expect("closed");
    Output::beside(&path, true, &[]).expect("free again");
}

#[test]
fn a_file_begun_before_the_flight_does_not_replace_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    let late = Output::beside(&path, true, &[]).expect("begun");
    put(&late, "late");
    let mut flight = Output::flight(&path, false).expect("claimed");
    put(&flight, "flown");
    flight.begun().expect("begun");
    assert!(matches!(late.finish(), Err(LogError::InUse { .. })));
    flight.finish().expect("closed");
    assert_eq!(text(&path), "flown");
}

#[test]
fn of_two_flights_that_begin_at_once_one_is_flown() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    let mut one = Output::flight(&path, true).expect("claimed");
    let mut two = Output::flight(&path, true).expect("claimed: there is no file yet");
    put(&one, "one");
    put(&two, "two");
    one.begun().expect("begun");
    assert!(matches!(two.begun(), Err(LogError::InUse { .. })));
    drop(two);
    assert_eq!(text(&path), "one");
    assert_eq!(hidden(folder.path()), Vec::<PathBuf>::new());
}

#[test]
fn an_older_log_is_set_aside_until_the_new_one_is_closed() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    let taken = folder.path().join("flight.mcap.old");
    fs::write(&path, "older").expect("a file");
    fs::write(&taken, "somebody's").expect("a file");
    assert!(matches!(Output::flight(&path, false), Err(LogError::Exists { .. })));

    drop(Output::flight(&path, true).expect("claimed"));
    assert_eq!(text(&path), "older", "a flight that did not begin takes nothing");

    let mut flight = Output::flight(&path, true).expect("claimed");
    assert!(matches!(Output::flight(&path, true), Err(LogError::InUse { .. })), "claimed");
    put(&flight, "newer");
    flight.begun().expect("begun");
    let aside = flight.set_aside().expect("an older log").to_path_buf();
    assert_eq!((text(&path).as_str(), text(&aside).as_str()), ("newer", "older"));
    assert_eq!(aside, folder.path().join("flight.mcap.old-2"));
    flight.finish().expect("closed");
    assert_eq!(text(&path), "newer");
    assert!(!aside.exists());
    assert_eq!(text(&taken), "somebody's");
}

#[test]
fn a_flight_that_cannot_be_closed_leaves_both() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    fs::write(&path, "older").expect("a file");
    let mut flight = Output::flight(&path, true).expect("claimed");
    put(&flight, "cut");
    flight.begun().expect("begun");
    drop(flight);
    assert_eq!(text(&path), "cut");
    assert_eq!(text(&folder.path().join("flight.mcap.old")), "older");
}

#[test]
fn what_is_no_file_is_written_as_it_is_or_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = Output::beside(folder.path(), true, &[]);
    assert!(matches!(refused, Err(LogError::Create { .. })));
    let missing = folder.path().join("missing").join("flight.mcap");
    assert!(matches!(Output::beside(&missing, true, &[]), Err(LogError::Create { .. })));
    let null = Output::beside(Path::new("/dev/null"), true, &[]).expect("a device");
    put(&null, "gone");
    null.finish().expect("nothing to be renamed");
    let full = Output::beside(Path::new("/dev/full"), true, &[]).expect("a device");
    assert!(full.file().expect("the file").write_all(b"x").is_err());
}

#[test]
fn what_a_killed_program_left_goes_away_and_what_is_being_written_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("flight.mcap");
    let left = folder.path().join(".tiltrotor-1-0.unfinished");
    fs::write(&left, "half").expect("a file");
    let tables = folder.path().join(".tiltrotor-1-1.unfinished");
    fs::create_dir(&tables).expect("a folder");
    fs::write(tables.join(".lock~"), "").expect("a file");
    fs::write(tables.join("state"), "half").expect("a file");
    let other = folder.path().join(".theirs-1.unfinished");
    fs::write(&other, "theirs").expect("a file");
    let mut flight = Output::flight(&path, false).expect("claimed");
    put(&flight, "grow");
    assert!(!left.exists() && !tables.exists());
    hidden::sweep(folder.path());
    put(&flight, "ing");
    flight.begun().expect("begun");
    assert_eq!(text(&path), "growing");
    assert_eq!(hidden(folder.path()), [other]);
}
