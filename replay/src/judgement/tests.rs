use super::*;

/// A flight of ten ticks with which nothing is wrong.
fn sound() -> Facts {
    Facts {
        reflown: true,
        compacted: false,
        start_tick: 0,
        ticks: 10,
        same: 10,
        digest: 7,
        altered: None,
        irregular: None,
        missing: 0,
        doubled: 0,
        diverged: None,
        diverged_field: None,
        comparison: false,
        outputs: None,
        recovered: None,
        origin: None,
        end: End::Closed,
    }
}

fn judged(change: impl FnOnce(&mut Facts)) -> (Outcome, Option<u64>) {
    let mut facts = sound();
    change(&mut facts);
    let Judgement { outcome, first_bad_tick, words } = facts.judge();
    let word = outcome.name().replace('_', " ");
    assert!(words.starts_with(&word), "{word}: {words}");
    (outcome, first_bad_tick)
}

#[test]
fn a_log_is_exact_only_when_it_was_reflown_and_closed() {
    assert_eq!(judged(|_| {}), (Outcome::Exact, None));
    assert_eq!(judged(|facts| facts.reflown = false), (Outcome::NotReflown, None));
    assert_eq!(judged(|facts| facts.end = End::NeverClosed), (Outcome::NeverClosed, None));
    let recovered = |facts: &mut Facts| facts.end = End::Recovered("from a log".into());
    assert_eq!(judged(recovered), (Outcome::NeverClosed, None));
    assert_eq!(judged(|facts| facts.comparison = true), (Outcome::Compared, None));
    assert_eq!(judged(|facts| facts.end = End::Window), (Outcome::Exact, None));
}

#[test]
fn what_was_changed_is_altered_wherever_it_diverges() {
    let altered = |altered, diverged: Option<u64>| {
        judged(|facts| (facts.altered, facts.diverged) = (Some(altered), diverged))
    };
    assert_eq!(altered(5, None), (Outcome::Altered, Some(5)));
    assert_eq!(altered(5, Some(5)), (Outcome::Altered, Some(5)));
    assert_eq!(altered(5, Some(3)), (Outcome::Altered, Some(5)));
    assert_eq!(altered(0, Some(3)), (Outcome::Altered, Some(0)));
    let compared = judged(|facts| (facts.altered, facts.comparison) = (Some(5), true));
    assert_eq!(compared, (Outcome::Altered, Some(5)));
}

#[test]
fn a_compacted_log_whose_digests_are_not_those_flown_is_not_accused() {
    let judged = |altered, diverged| {
        judged(|facts| {
            facts.compacted = true;
            (facts.altered, facts.diverged) = (altered, diverged);
        })
    };
    assert_eq!(judged(Some(5), Some(5)), (Outcome::Diverged, Some(5)));
    assert_eq!(judged(None, Some(5)), (Outcome::Diverged, Some(5)));
    assert_eq!(judged(Some(5), None), (Outcome::Altered, Some(5)));
    assert_eq!(judged(Some(0), Some(0)), (Outcome::Altered, Some(0)));
}

#[test]
fn damage_is_told_by_what_could_not_be_read_and_a_difference_before_it_first() {
    let damaged = |facts: &mut Facts| facts.end = End::Damaged("a checksum".into());
    assert_eq!(judged(damaged), (Outcome::Damaged, Some(11)));
    let disorder = |facts: &mut Facts| facts.end = End::Disorder("no state".into());
    assert_eq!(judged(disorder), (Outcome::Damaged, Some(11)));
    let both = judged(|facts| {
        damaged(facts);
        facts.diverged = Some(4);
    });
    assert_eq!(both, (Outcome::Diverged, Some(4)));
    let compared = judged(|facts| {
        damaged(facts);
        (facts.comparison, facts.diverged) = (true, Some(4));
    });
    assert_eq!(compared, (Outcome::Damaged, Some(11)));
}

#[test]
fn no_altered_log_is_exact_up_to_its_end() {
    let facts = Facts { altered: Some(4), ..sound() };
    assert_eq!((facts.exact_tick(), facts.same_tick()), (3, 10));
    let facts = Facts { altered: Some(0), ..sound() };
    assert_eq!((facts.exact_tick(), facts.same_tick()), (0, 10));
    assert!(!facts.judge().words.contains("exact"), "{}", facts.judge());
}

#[test]
fn what_a_flight_diverged_in_is_named_where_it_is_known() {
    let words = |change: &dyn Fn(&mut Facts)| {
        let mut facts = Facts { diverged: Some(5), ..sound() };
        change(&mut facts);
        facts.judge().words
    };
    // Tick 5 is 5 times 4 ms.
    let at = "diverged at tick 5 (0.020 s): ";
    let unnamed = words(&|_| ());
    assert_eq!(unnamed, format!("{at}the reflown state is not the recorded one"));
    let fuel = |facts: &mut Facts| facts.diverged_field = Some("plant.fuel_kg".into());
    assert_eq!(words(&fuel), format!("{at}the reflown plant.fuel_kg is not the recorded one"));
    // Of a compacted log's ticks between keyframes only the digest was kept.
    for named in [false, true] {
        let by_digest = words(&|facts| {
            (facts.compacted, facts.altered) = (true, Some(5));
            if named {
                fuel(facts);
            }
        });
        let kept = format!("{at}the reflown state has not the digest that was kept: ");
        assert!(by_digest.starts_with(&kept), "{by_digest}");
    }
}

#[test]
fn what_was_changed_in_a_log_is_named_as_far_as_it_is_known() {
    let words = |tick, irregular| Facts { altered: Some(tick), irregular, ..sound() }.judge().words;
    let altered = |at: &str| format!("altered at {at}: the log was changed after the flight, ");
    let at_start = words(0, None);
    let files = "its aircraft, cockpit map, scenario or first state is not what it was flown with";
    assert_eq!(at_start, altered("tick 0 (0.000 s)") + files);
    let digest = "the digest does not follow from what was before";
    assert_eq!(words(5, None), altered("tick 5 (0.020 s)") + digest);
    let doubled = Irregular::Doubled { tick: 5 };
    let once_more = "tick 5 (0.020 s) is there once more";
    assert_eq!(words(5, Some(doubled)), altered("tick 5 (0.020 s)") + once_more);
    // Where ticks are irregular only later, that is not what was found first.
    assert_eq!(words(4, Some(doubled)), altered("tick 4 (0.016 s)") + digest);
}
