use super::*;

#[test]
fn the_keys_that_differ_are_named_and_comments_are_not() {
    let a = "[rotors]\nradius_ft = { value = 12.5, source = \"X\" }\nlist = [1, 2]\n";
    let b = "# other\n[rotors]\nradius_ft = { value = 12.6, source = \"X\" }\nlist = [1]\n";
    let found = keys(&values(a), &values(b));
    let told: Vec<_> =
        found.iter().map(|key| (key.key.as_str(), key.a.as_deref(), key.b.as_deref())).collect();
    assert_eq!(
        told,
        [
            ("rotors.list[1]", Some("2"), None),
            ("rotors.radius_ft.value", Some("12.5"), Some("12.6")),
        ]
    );
}

#[test]
fn the_first_event_that_differs_is_found_in_its_place() {
    let event = |value| DeviceEvent { value, ..DeviceEvent::default() };
    let mut events = EventsDifference::default();
    events.add(1, &[event(1)], &[event(1)]);
    events.add(2, &[event(1), event(2)], &[event(1)]);
    events.add(3, &[event(7)], &[event(8)]);
    assert_eq!(events.ticks, 2);
    assert_eq!(events.first, Some(FirstEvent { tick: 2, a: Some(event(2)), b: None }));
}

#[test]
fn the_largest_difference_is_kept_with_its_moment() {
    let names = Names::of::<State>().expect("recordable");
    let state = |fuel_kg| {
        let mut state = State::default();
        state.plant.fuel_kg = fuel_kg;
        cdr::encode(&state).expect("bytes")
    };
    let mut extents = BTreeMap::new();
    for (tick, fuel_kg) in [(3, 1.5), (4, 9.0), (5, 1.25)] {
        let (a, b) = (state(1.0), state(fuel_kg));
        names.differences(&a, &b).for_each(|found| extend(&mut extents, tick, &found));
    }
    let found = extents.into_values().next().expect("a field");
    assert_eq!((found.first_tick, found.ticks, found.largest_tick), (3, 3, 4));
    assert_eq!((found.a, found.b), (Value::F64(1.0), Value::F64(9.0)));
    assert_eq!(found.unit, "kg");
}

/// Two logs whose states have these amounts of fuel, tick by tick.
fn parted(ticks: &[(u64, f64, f64)]) -> Diff {
    let at = |tick, fuel_kg| {
        let mut state = State::default();
        state.plant.fuel_kg = fuel_kg;
        At { tick, state: cdr::encode(&state).expect("bytes"), led: None, restart: None }
    };
    let mut comparison = Comparison::new().expect("recordable");
    for &(tick, a, b) in ticks {
        comparison.add(&at(tick, a), &at(tick, b)).expect("compared");
    }
    let side = Side {
        start_tick: 0,
        last_tick: 9,
        digest: 7,
        end: End::Closed,
        judgement: Judgement::unusable("not looked at"),
        irregular: None,
        missing: 0,
        doubled: 0,
    };
    Diff {
        a: side.clone(),
        b: side,
        identity: Vec::new(),
        files: Vec::new(),
        compared: comparison.compared,
        ticks: comparison.ticks,
        events: comparison.events,
        world: Vec::new(),
        first: comparison.first,
        state: comparison.state.into_values().collect(),
    }
}

#[test]
fn states_part_at_the_start_when_the_first_ones_that_both_have_differ() {
    // What both have need not begin with tick 0.
    assert!(parted(&[(5, 1.0, 2.0), (6, 1.0, 2.0)]).parts_at_start());
    assert!(!parted(&[(5, 1.0, 1.0), (6, 1.0, 2.0)]).parts_at_start());
    assert!(!parted(&[(5, 1.0, 1.0), (6, 1.0, 1.0)]).parts_at_start());
    assert!(!parted(&[]).parts_at_start(), "nothing was compared");
}

#[test]
fn a_flight_is_the_same_only_when_nothing_that_flies_it_differs() {
    let same = || parted(&[(0, 1.0, 1.0)]);
    assert!(same().same() && same().usable());
    let who = KeyDifference { key: "program".into(), a: None, b: Some("other".into()) };
    assert!(Diff { identity: vec![who], ..same() }.same(), "who flew it moves no aircraft");
    assert!(!parted(&[(0, 1.0, 2.0)]).same());
    let changes: [fn(&mut Diff); 8] = [
        |diff| diff.files.push(FileDifference { name: "aircraft.toml", keys: Vec::new() }),
        |diff| diff.events.ticks = 1,
        |diff| diff.world = parted(&[(0, 1.0, 2.0)]).state,
        |diff| diff.b.start_tick = 1,
        |diff| diff.b.last_tick = 8,
        |diff| diff.b.missing = 1,
        |diff| diff.b.doubled = 1,
        |diff| diff.b.irregular = Some(Irregular::Doubled { tick: 3 }),
    ];
    for (number, change) in changes.iter().enumerate() {
        let mut changed = same();
        change(&mut changed);
        assert!(!changed.same() && changed.usable(), "change {number}");
    }
    for end in [End::Damaged("a checksum".into()), End::Disorder("no state".into())] {
        for of_a in [false, true] {
            let mut broken = same();
            let side = if of_a { &mut broken.a } else { &mut broken.b };
            side.end = end.clone();
            assert!(!broken.usable(), "{end}");
        }
    }
}
