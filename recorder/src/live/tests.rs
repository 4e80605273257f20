use engine::cockpit;
use logs::{Messages, OpenOptions, Setup};

use super::*;
use crate::controller::Controller;
use crate::keyboard::{KeyAction, Keyboard, Order};
use crate::pilots::Pilot;
use crate::script::Script;

/// A flight into a temporary log.
fn flight(name: &str, map: cockpit::Params, controllers: Vec<Box<dyn Controller>>) -> Flight {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
    let setup = Setup {
        aircraft_toml: aircraft::XV15.into(),
        cockpit_toml: String::new(),
        scenario_toml: aircraft::DEFAULT_SCENARIO.into(),
    };
    Flight {
        start: aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap(),
        aircraft: aircraft.with_cockpit(map),
        setup,
        identity: Identity::new(),
        robot_description: String::new(),
        controllers,
        #[cfg(feature = "sticks")]
        sticks: None,
        out: std::env::temp_dir().join(format!("tiltrotor-{name}-{}", std::process::id())),
        force: true,
        real_time: None,
        situation: None,
        ticks_max: None,
        link: Some(Link::new(&["127.0.0.1:9"]).unwrap()),
        self_check: true,
    }
}

/// Allocations and frees on the loop's thread from the second tick on.
fn counted(
    name: &str,
    map: cockpit::Params,
    controllers: Vec<Box<dyn Controller>>,
    ticks: u64,
) -> u64 {
    let progress = Progress::default();
    let flight = flight(name, map, controllers);
    let out = flight.out.clone();
    let mut live = Live::begin(flight, &progress, step).unwrap();
    live.tick();
    let counted = allocation_counter::measure(|| (1..ticks).for_each(|_| live.tick()));
    // In real time as well: from here on ticks wait for the clock.
    live.pace = Some(Pace::starting_now());
    let waited = allocation_counter::measure(|| live.tick());
    assert_eq!(live.state.tick, ticks + 1);
    let landing = live.land(End::Done);
    assert!(landing.log.is_ok());
    assert_eq!(landing.checked.unwrap().mismatches, 0);
    let _ = std::fs::remove_file(&out);
    counted.count_total + waited.count_total
}

#[test]
fn a_counter_that_counts() {
    let counted = allocation_counter::measure(|| drop(std::hint::black_box(vec![1_u8; 100])));
    assert_eq!(counted.count_total, 1);
}

#[test]
fn a_script_with_more_than_a_thousand_events_a_tick_allocates_nothing() {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
    let marker = ["\"marker\""; 700].join(", ");
    let text = format!(
        "[[event]]\nat_s = 0.0\nover_s = 0.4\naxis = {{ collective = 0.7, stick_aft = 0.1 }}\n\
         [[event]]\nat_s = 0.1\npress = [{marker}]\nfail = [\"scas_yaw\"]\n\
         [[event]]\nat_s = 0.2\npress = [{marker}]\nrestart = \"start\"\n\
         [[event]]\nat_s = 0.3\nrestart = \"marker\"\nwind = {{ from_deg = 270.0, kt = 9.0 }}\n"
    );
    let script = Script::parse("many.toml", &text, &map).unwrap();
    assert_eq!(counted("many", map, vec![Box::new(script)], 125), 0);
}

#[test]
fn a_pilot_model_allocates_nothing() {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
    let pilot = Pilot::named("hover", &map, &xv15).unwrap();
    assert_eq!(counted("pilot", map, vec![Box::new(pilot)], 1000), 0);
}

#[test]
fn keys_allocate_nothing() {
    let map = aircraft::cockpit("keyboard.toml", aircraft::KEYBOARD_MAP).unwrap();
    let (keyboard, mut orders) = Keyboard::of(&map).unwrap();
    let files = [KeyAction::SaveSituation];
    for &action in KeyAction::ALL.iter().filter(|action| !files.contains(action)) {
        assert!(orders.give(Order::Press(action)));
    }
    assert_eq!(counted("keys", map, vec![Box::new(keyboard)], 500), 0);
}

#[test]
fn an_event_from_before_the_flight_or_from_the_future_is_no_latency() {
    let map = cockpit::Params::default();
    let flight = flight("latency", map, Vec::new());
    let out = flight.out.clone();
    let progress = Progress::default();
    let mut live = Live::begin(flight, &progress, step).unwrap();
    let now_ns = wall_ns();
    let at = |kernel_time_ns| DeviceEvent { kernel_time_ns, ..DeviceEvent::default() };
    let minute_ns = 60_000_000_000;
    live.begun_wall_ns = now_ns - 10_000_000;
    live.events = vec![
        at(0),
        at(now_ns - 3_000_000),
        at(now_ns - 5_000_000),
        at(now_ns - minute_ns),
        at(now_ns + minute_ns),
    ];
    let (stamped, implausible, oldest_ns) = live.latencies(now_ns);
    assert_eq!((stamped, implausible, oldest_ns), (4, 2, Some(now_ns - 5_000_000)));
    assert_eq!(live.statistics.latency.count(), 2);
    assert_eq!(live.statistics.synthetic_events, 1);
    assert!((live.statistics.latency.longest_ms() - 5.0).abs() < 0.1);
    live.land(End::Done);
    let _ = std::fs::remove_file(&out);
}

#[test]
fn the_parts_of_a_tick_are_told_as_the_times_between_its_moments() {
    let flight = flight("parts", cockpit::Params::default(), Vec::new());
    let out = flight.out.clone();
    let progress = Progress::default();
    let mut live = Live::begin(flight, &progress, step).unwrap();
    let pace = Pace::starting_now();
    live.pace = Some(pace);
    live.begun_wall_ns = 0;
    let mut told = |late_ns: u64, handed_ns: u64, events: Vec<DeviceEvent>| {
        live.events = events;
        let woke_ns = pace.due_ns(0) + late_ns;
        let times = Times {
            woke_ns,
            slip_ns: 70,
            wall_ns: 5_000_000,
            sampled_ns: woke_ns + 20,
            recorded_ns: woke_ns + 23,
            stepped_ns: woke_ns + 423,
            sent_ns: woke_ns + 473,
            handed_ns: woke_ns + 473 + handed_ns,
        };
        live.account(0, &times);
        live.shown.timing
    };
    let moved = DeviceEvent { kernel_time_ns: 4_999_000, ..DeviceEvent::default() };
    let expected = TimingRecord {
        tick: 0,
        wall_ns: 5_000_000,
        late_ns: 100,
        step_ns: 400,
        sent_ns: 473,
        // From 1 µs before it woke until the picture was sent.
        latency_ns: 1473,
        // The inputs before the step, the state after the picture.
        record_ns: 3 + 7,
        slip_ns: 70,
        overrun: 0,
        stamped_events: 1,
        implausible_events: 0,
    };
    assert_eq!(told(100, 7, vec![moved]), expected);
    // Until the next tick is due it is no overrun.
    assert_eq!(told(200, STEP_NS - 673, Vec::new()).overrun, 0);
    let late = told(200, STEP_NS - 672, Vec::new());
    assert_eq!((late.overrun, late.latency_ns, late.stamped_events), (1, 0, 0));
    live.land(End::Done);
    let _ = std::fs::remove_file(&out);
}

/// What reads a log in order of time meets every message: a state is of the moment after its tick, and the
/// tick's timing of the one before.
#[test]
fn the_times_of_a_log_never_go_back() {
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
    let pilot = Pilot::named("hover", &map, &xv15).unwrap();
    let flight = Flight { ticks_max: Some(20), ..flight("times", map, vec![Box::new(pilot)]) };
    let out = flight.out.clone();
    fly(flight, &Progress::default()).unwrap();
    let mut messages = Messages::open(&out, OpenOptions::default()).unwrap();
    let (mut before_ns, mut states) = (0, 0);
    while let Some(message) = messages.next_message() {
        assert!(message.time_ns >= before_ns, "{} at {}", message.topic(), message.time_ns);
        before_ns = message.time_ns;
        states += u64::from(message.topic() == "/state");
    }
    // That of the beginning, and one after every tick.
    assert_eq!(states, 21);
    let _ = std::fs::remove_file(&out);
}

#[test]
fn flightgear_has_a_lamp_that_says_whether_the_flight_is_recorded() {
    let flight = flight("lamp", cockpit::Params::default(), Vec::new());
    let out = flight.out.clone();
    let progress = Progress::default();
    let mut live = Live::begin(flight, &progress, step).unwrap();
    let picture = live.picture().unwrap();
    // 0 would say that nothing is, 2 that the log has failed.
    assert_eq!(picture.channel.get("tiltrotor/lamp/recording"), Some(1.0));
    live.link = None;
    assert!(live.picture().is_none(), "nobody is shown anything");
    live.land(End::Done);
    let _ = std::fs::remove_file(&out);
}
