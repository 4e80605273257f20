//! `log recover` makes a proper file of a broken one, and never a good tick of a bad one.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use logs::records::{HARDWARE, INPUTS, OUTPUTS, STATE, TIMING, TimingRecord};
use logs::{Ending, OpenOptions, Tick};

use crate::common::{
    DIVERGED, Dice, Forgery, INCOMPLETE, OK, Said, UNUSABLE, all, flip_state_bit, folder, hover,
    place_of, text, tiltrotor, verify,
};

/// Two seconds by the pilot model.
fn flight() -> &'static Path {
    static LOG: OnceLock<PathBuf> = OnceLock::new();
    LOG.get_or_init(|| {
        let log = folder("recover").join("flight.mcap");
        hover(&log, "2");
        log
    })
}

fn recover(broken: &Path, fixed: &Path) -> Said {
    tiltrotor(&["log", "recover", text(broken), "--out", text(fixed)])
}

/// All ticks of a log, as far as they can be read and follow from each other.
fn ticks(log: &Path) -> Vec<Tick> {
    let mut reader = logs::open(log, OpenOptions::default()).expect("a flight log");
    let mut ticks = Vec::new();
    while let Ok(Some(tick)) = reader.next_tick() {
        if !tick.chained {
            break;
        }
        ticks.push(tick.clone());
    }
    ticks
}

/// Recovers, and holds the result against the flight as it was flown.
fn recovered(broken: &Path, fixed: &Path) -> Result<usize, String> {
    let said = recover(broken, fixed);
    if said.status != Some(INCOMPLETE) {
        return Err(format!("{said}"));
    }
    let kept = ticks(fixed);
    if kept[..] != ticks(flight())[..kept.len()] {
        return Err(format!("a tick that was never flown: {said}"));
    }
    let (tick, verdict) = (kept.len(), verify(fixed));
    let honest = verdict.status == Some(INCOMPLETE)
        && verdict.out.contains(&format!("exact up to tick {tick} of {tick} or more ("))
        && verdict.out.contains("it was recovered from ")
        && !verdict.out.contains("damaged");
    if honest { Ok(tick) } else { Err(format!("{said}\n{verdict}")) }
}

#[test]
fn a_log_cut_anywhere_is_recovered_up_to_there() {
    let place = folder("recover-cut");
    let whole = fs::read(flight()).expect("a log");
    let mut dice = Dice(11);
    let cuts: Vec<_> = (0..12)
        .map(|_| (whole.len() / 4) as u64 + dice.below(whole.len() as u64 * 3 / 4))
        .collect();
    all(cuts, |cut| {
        let (broken, fixed) =
            (place.join(format!("{cut}.mcap")), place.join(format!("{cut}-ok.mcap")));
        fs::write(&broken, &whole[..cut as usize]).expect("a file");
        let expected = ticks(&broken).len();
        match recovered(&broken, &fixed) {
            Ok(kept) if kept == expected => None,
            Ok(kept) => Some(format!("cut at {cut}: kept {kept} of {expected} ticks")),
            Err(what) => Some(format!("cut at {cut}: {what}")),
        }
    });
}

#[test]
fn a_log_with_a_flipped_bit_is_recovered_up_to_there() {
    let place = folder("recover-flip");
    let whole = fs::read(flight()).expect("a log");
    let mut dice = Dice(12);
    let bits: Vec<_> = (0..12)
        .map(|_| 8 * (whole.len() as u64 / 2) + dice.below(8 * (whole.len() as u64) * 2 / 5))
        .collect();
    all(bits, |bit| {
        let (broken, fixed) =
            (place.join(format!("{bit}.mcap")), place.join(format!("{bit}-ok.mcap")));
        let mut bytes = whole.clone();
        bytes[bit as usize / 8] ^= 1 << (bit % 8);
        fs::write(&broken, bytes).expect("a file");
        recovered(&broken, &fixed).err().map(|what| format!("bit {bit}: {what}"))
    });
}

#[test]
fn a_bad_tick_with_every_checksum_right_stays_outside() {
    let place = folder("recover-forged");
    let mut log = Forgery::of(flight());
    flip_state_bit(&mut log, 300, "plant.velocity_mps.x");
    let (broken, fixed) = (place.join("forged.mcap"), place.join("fixed.mcap"));
    log.write(&broken);
    verify(&broken).ends(DIVERGED);
    recover(&broken, &fixed)
        .ends(INCOMPLETE)
        .says("new log    never closed: ")
        .says("kept 299 ticks (1.196 s)")
        .says("lost       all after tick 299: the digest breaks at tick 300")
        .says("201 ticks after it can be read, but not trusted");
    assert_eq!(recovered(&broken, &place.join("again.mcap")), Ok(299));
    tiltrotor(&["log", "info", text(&fixed)])
        .says("recovered_from")
        .says("forged.mcap")
        .says("recovered_tick   299")
        .says("the digest breaks at tick 300");
}

#[test]
fn a_log_that_lacks_a_message_is_recovered_up_to_there() {
    let place = folder("recover-missing");
    for (name, topic) in [("event", HARDWARE), ("state", STATE)] {
        let mut log = Forgery::of(flight());
        let places = log.places(topic);
        log.messages.remove(places[places.len() / 2]);
        let broken = place.join(format!("{name}.mcap"));
        log.write(&broken);
        let kept = recovered(&broken, &place.join(format!("{name}-ok.mcap"))).expect("recovered");
        assert!((1..500).contains(&kept), "{kept}");
    }
}

#[test]
fn what_other_tools_repaired_beside_the_flight_is_named_and_the_flight_is_kept() {
    let place = folder("recover-beside");
    type Repair<'a> = &'a dyn Fn(&mut Forgery);
    let cases: [(&str, Repair); 4] = [
        ("timing", &|log| log.bytes(TIMING, 100)[place_of::<TimingRecord>("step_ns")] ^= 1),
        ("viewers", &|log| log.bytes(OUTPUTS, 10)[40] ^= 1),
        ("time", &|log| {
            let at = log.places("/tf")[10];
            log.messages[at].log_time += 1;
        }),
        ("missing", &|log| {
            let at = log.places("/fix")[3];
            log.messages.remove(at);
        }),
    ];
    for (name, change) in cases {
        let mut log = Forgery::of(flight());
        change(&mut log);
        let broken = place.join(format!("{name}.mcap"));
        log.write(&broken);
        // Changed outputs are told by tick and field, before the end of the log is reached.
        let (status, states) = match name {
            "viewers" => (DIVERGED, "the states refly to the same bits up to tick 500"),
            _ => (UNUSABLE, "exact up to tick 500 of 500"),
        };
        verify(&broken).ends(status).says(states).says("a message beside the flight itself");
        let fixed = place.join(format!("{name}-ok.mcap"));
        assert_eq!(recovered(&broken, &fixed), Ok(500), "{name}");
        let left_out = fs::remove_file(&fixed).map(|()| recover(&broken, &fixed)).expect("a file");
        let what = "1 messages for viewers and tables that the kept ticks do not prove";
        let unproven = ["viewers", "time"].contains(&name);
        assert_eq!(left_out.out.contains(what), unproven, "{left_out}");
    }
}

#[test]
fn a_tick_s_message_before_the_first_state_is_refused() {
    let place = folder("recover-before");
    for topic in [HARDWARE, INPUTS] {
        let mut log = Forgery::of(flight());
        let again = log.messages[log.places(topic)[20]].clone();
        log.messages.insert(0, again);
        let broken = place.join("before.mcap");
        log.write(&broken);
        let why = format!("{topic} before the first /state");
        verify(&broken).refused().says(&why);
        recover(&broken, &place.join("fixed.mcap")).refused().says(&why);
    }
}

#[test]
fn a_tick_with_a_wrong_time_is_the_same_tick() {
    let place = folder("recover-time");
    let mut log = Forgery::of(flight());
    let at = log.places(STATE)[100];
    log.messages[at].log_time = u64::MAX / 2;
    let broken = place.join("time.mcap");
    log.write(&broken);
    verify(&broken).ends(UNUSABLE).says("a message beside the flight itself");
    assert_eq!(recovered(&broken, &place.join("fixed.mcap")), Ok(500));
}

#[test]
fn who_flew_cannot_be_rewritten_without_a_word() {
    let place = folder("recover-who");
    let mut log = Forgery::of(flight());
    log.metadata[0].metadata.insert("dirty".into(), "perhaps".into());
    let broken = place.join("who.mcap");
    log.write(&broken);
    verify(&broken).ends(UNUSABLE).says("the metadata that says who flew is not as written");
    let fixed = place.join("fixed.mcap");
    assert_eq!(recovered(&broken, &fixed), Ok(500));
    tiltrotor(&["log", "info", text(&fixed)]).says("recovered_identity").says("not as written");
}

#[test]
fn a_definition_that_was_rewritten_is_named() {
    let place = folder("recover-schema");
    let mut log = Forgery::of(flight());
    for message in &mut log.messages {
        if message.channel.topic == TIMING {
            let mut channel = (*message.channel).clone();
            let mut schema = (**channel.schema.as_ref().expect("a schema")).clone();
            schema.data.to_mut()[0] ^= 1;
            channel.schema = Some(schema.into());
            message.channel = channel.into();
        }
    }
    let broken = place.join("schema.mcap");
    log.write(&broken);
    verify(&broken).ends(UNUSABLE).says("the definition of /timing is not as written");
}

#[test]
fn a_recovered_log_is_a_proper_file_whose_flight_is_not_whole() {
    let place = folder("recover-proper");
    let whole = fs::read(flight()).expect("a log");
    let (broken, fixed) = (place.join("cut.mcap"), place.join("fixed.mcap"));
    fs::write(&broken, &whole[..whole.len() / 2]).expect("a file");
    recover(&broken, &fixed).ends(INCOMPLETE).says("it ends without having been closed");
    // Other people's strict reader goes through it to its end, and finds its index.
    let bytes = fs::read(&fixed).expect("a log");
    let summary = mcap::Summary::read(&bytes).expect("an index").expect("an index");
    let messages = mcap::MessageStream::new(&bytes).expect("an MCAP file");
    let messages: Vec<_> = messages.map(|message| message.expect("a message")).collect();
    let count = messages.len() as u64;
    assert_eq!(summary.stats.expect("statistics").message_count, count);
    // Recovered twice, it is the same flight, and says where it is from.
    let cut = place.join("cut again.mcap");
    fs::write(&cut, &bytes[..bytes.len() * 2 / 3]).expect("a file");
    let again = place.join("again.mcap");
    recovered(&cut, &again).expect("recovered");
    verify(&again).says("it was recovered from cut again.mcap, from cut.mcap up to tick ");
    let mut reader = logs::open(&fixed, OpenOptions::default()).expect("a log");
    while reader.next_tick().expect("whole ticks").is_some() {}
    assert_eq!(reader.ending(), Some(&Ending::Truncated));
}

#[test]
fn of_a_broken_compacted_log_all_states_come_back() {
    let place = folder("recover-compacted");
    let (compact, broken) = (place.join("compact.mcap"), place.join("broken.mcap"));
    let keyframes = ["--keyframes", "0.2", "--out", text(&compact)];
    tiltrotor(&[&["log", "compact", text(flight())], &keyframes[..]].concat()).ends(OK);
    let whole = fs::read(&compact).expect("a log");
    let chunks = mcap::Summary::read(&whole).expect("an index").expect("an index").chunk_indexes;
    let middle = chunks[chunks.len() / 2].chunk_start_offset as usize;
    fs::write(&broken, &whole[..middle + 10]).expect("a file");
    let kept = recovered(&broken, &place.join("fixed.mcap")).expect("recovered");
    assert!((100..500).contains(&kept), "{kept}");
}

#[test]
fn a_message_of_another_definition_is_not_copied_under_todays() {
    let place = folder("recover-definition");
    let mut log = Forgery::of(flight());
    for at in log.places(TIMING) {
        let mut channel = (*log.messages[at].channel).clone();
        let mut schema = (**channel.schema.as_ref().expect("a schema")).clone();
        let text = String::from_utf8(schema.data.to_vec()).expect("text");
        schema.data = text.replacen("late_ns", "early_ns", 1).into_bytes().into();
        channel.schema = Some(schema.into());
        log.messages[at].channel = channel.into();
    }
    let (broken, fixed) = (place.join("broken.mcap"), place.join("fixed.mcap"));
    log.write(&broken);
    recover(&broken, &fixed).ends(INCOMPLETE).says("500 messages on channels of others");
    assert!(Forgery::of(&fixed).places(TIMING).is_empty());
}

#[test]
fn what_cannot_be_recovered_is_refused_in_one_line_and_nothing_is_written() {
    let place = folder("recover-refused");
    let fixed = place.join("fixed.mcap");
    let mut log = Forgery::of(flight());
    log.rewrite(
        "aircraft.toml",
        "mast_length_ft = { value = 4.667",
        "mast_length_ft = { value = 4.668",
    );
    let changed = place.join("changed.mcap");
    log.write(&changed);
    let empty = place.join("empty.mcap");
    fs::write(&empty, b"").expect("a file");
    let cases = [
        (flight(), "there is nothing to recover: it is whole"),
        (&changed, "there is nothing to recover: its aircraft"),
        (&empty, "not an MCAP file"),
        (&place.join("missing.mcap"), "No such file"),
    ];
    for (broken, why) in cases {
        recover(broken, &fixed).refused().says(why).says(text(broken));
        assert!(!fixed.exists(), "{why}");
    }
    let whole = fs::read(flight()).expect("a log");
    let cut = place.join("cut.mcap");
    fs::write(&cut, &whole[..whole.len() / 2]).expect("a file");
    tiltrotor(&["log", "recover", text(&cut), "--force", "--out", text(&cut)])
        .refused()
        .says("from which it would be made");
    assert_eq!(fs::read(&cut).expect("still there").len(), whole.len() / 2);
    fs::write(&fixed, "precious").expect("a file");
    recover(&cut, &fixed).refused().says("exists").says("--force");
    assert_eq!(fs::read(&fixed).expect("still there"), b"precious");
}
