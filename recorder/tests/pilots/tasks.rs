//! The pilot models fly as they say, in calm and in rough air, and with an aircraft that answers
//! differently from the one they learned on.

use engine::aircraft::Params;
use engine::envelope::Corridor;
use engine::inputs::Failures;
use engine::math::{max, min};
use engine::outputs::Validity;
use engine::start::Start;
use engine::units::{DEGREE_RAD as DEG, KNOT_MPS, RPM_RADPS as RPM};
use engine::{Aircraft, Outputs, State};
use recorder::pilots::{PILOTS, Pilot};
use recorder::{Controller, Flight, Progress, RehearsedTick, TickContext, fly, rehearse};

const TICKS_PER_S: u64 = 250;

/// Greatest sink rate at touchdown that the gear was designed for, m/s: 10 ft/s (TM X-62,407 §10.6).
const SINK_MPS_DESIGN: f64 = 3.05;
/// A third of that: what a passenger calls gentle, m/s.
const SINK_MPS_GENTLE: f64 = 1.0;
/// Limit of the rotors' speed, rad/s (TM X-62,407).
const ROTOR_RADPS_LIMIT: f64 = 661.0 * RPM;

fn xv15() -> Aircraft {
    let map =
        aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap_or_else(|e| panic!("{e}"));
    aircraft::aircraft("xv15.toml", aircraft::XV15)
        .unwrap_or_else(|e| panic!("{e}"))
        .with_cockpit(map)
}

fn start(scenario: &str) -> Start {
    aircraft::start("scenario.toml", scenario).unwrap_or_else(|e| panic!("{e}"))
}

fn calm() -> Start {
    start(aircraft::DEFAULT_SCENARIO)
}

/// Wind of 10 kt and light turbulence.
fn rough(from_deg: u64, seed: u64) -> Start {
    start(
        &aircraft::DEFAULT_SCENARIO
            .replace("wind_kt = 0.0", "wind_kt = 10.0")
            .replace("wind_from_deg = 0.0", &format!("wind_from_deg = {from_deg}.0"))
            .replace(
                "[world]",
                &format!("[world]\nturbulence_mps = 1.0\nturbulence_seed = {seed}"),
            ),
    )
}

/// In steady flight.
fn aloft(nacelle_deg: f64, speed_kt: f64) -> Start {
    let tilt_deg = 90.0 - nacelle_deg;
    start(&format!(
        "{}\n[trim]\nmast_tilt_deg = {tilt_deg:?}\nairspeed_kt = {speed_kt:?}\naltitude_ft = 500.0\n\
         flap_detent = 1\nscas_on = 1\n",
        aircraft::DEFAULT_SCENARIO
    ))
}

fn pilot(name: &str, aircraft: &Aircraft) -> Vec<Box<dyn Controller>> {
    vec![Box::new(Pilot::named(name, &aircraft.cockpit, aircraft).expect(name))]
}

/// What is remembered of a flight.
#[derive(Default)]
struct Story {
    before: Option<(State, Outputs)>,
    phases: Vec<&'static str>,
    lift_offs: u64,
    touchdowns: u64,
    sink_mps: f64,
    touchdown_tilt_rad: f64,
    nacelles_rad: f64,
    airspeed_mps: f64,
    turned_left_rad: f64,
    corridor_mps: f64,
    rotor_radps_low: f64,
    rotor_radps_high: f64,
    load_factor: f64,
    leg_n: f64,
    bank_rad: f64,
    outside: Validity,
    end: Outputs,
}

impl Story {
    fn of(aircraft: &Aircraft, start: &Start, name: &str, seconds: u64) -> Self {
        let mut story =
            Self { corridor_mps: f64::INFINITY, rotor_radps_low: f64::INFINITY, ..Self::default() };
        let ticks = seconds * TICKS_PER_S;
        let flown = rehearse(aircraft, start, pilot(name, aircraft), ticks, |now| {
            story.see(&aircraft.envelope.corridor, now);
        });
        story.end = flown.unwrap_or_else(|failure| panic!("{failure}")).1;
        story
    }

    fn see(&mut self, corridor: &Corridor, now: &RehearsedTick<'_>) {
        let (state, seen) = (now.state, now.outputs);
        if self.phases.last() != Some(&now.phase) {
            self.phases.push(now.phase);
        }
        let wheels = state.plant.weight_on_wheels;
        if let Some((was, saw)) = &self.before {
            if was.plant.weight_on_wheels == 0 && wheels == 1 {
                self.touchdowns += 1;
                self.sink_mps = max(self.sink_mps, saw.velocity_mps.z);
                let tilted_rad = max(seen.euler.roll_rad.abs(), seen.euler.pitch_rad.abs());
                self.touchdown_tilt_rad = max(self.touchdown_tilt_rad, tilted_rad);
            }
            self.lift_offs += u64::from(was.plant.weight_on_wheels == 1 && wheels == 0);
        }
        let tilt_rad = seen.actuators.mast_tilt_rad.mean();
        self.nacelles_rad = max(self.nacelles_rad, tilt_rad);
        self.airspeed_mps = max(self.airspeed_mps, seen.calibrated_airspeed_mps);
        if tilt_rad > 89.0 * DEG {
            self.turned_left_rad -= seen.euler_rate.heading_radps * engine::STEP_S;
        }
        if wheels == 0 {
            let inside_mps = corridor.margin_mps(tilt_rad, seen.calibrated_airspeed_mps);
            self.corridor_mps = min(self.corridor_mps, inside_mps);
            self.rotor_radps_low = min(self.rotor_radps_low, seen.rotor_speed_radps);
        }
        self.rotor_radps_high = max(self.rotor_radps_high, seen.rotor_speed_radps);
        self.load_factor = max(self.load_factor, seen.load_factor);
        let legs = &seen.landing_gear;
        for leg in [legs.nose, legs.main.left, legs.main.right] {
            self.leg_n = max(self.leg_n, leg.push_n);
        }
        self.bank_rad = max(self.bank_rad, seen.euler.roll_rad.abs());
        self.outside |= seen.validity;
        self.before = Some((*state, *seen));
    }

    /// On its struts; a gust may rock it.
    fn stands_still(&self) -> bool {
        self.end.velocity_mps.norm() < 0.2 && self.end.angular_rate_radps.norm() < 0.1
    }

    /// Everything that is not as the paper's flight should be, whatever weather and aircraft.
    fn wrong(&self) -> Vec<String> {
        let end = &self.end;
        let off_m =
            (end.position_m.x * end.position_m.x + end.position_m.y * end.position_m.y).sqrt();
        let broken =
            Validity::GEAR_BOTTOMED | Validity::HULL | Validity::FROZEN | Validity::TUMBLING;
        let seconds = end.tick as f64 * engine::STEP_S;
        let limits = [
            ("nacelles, deg", self.nacelles_rad / DEG, 89.9, 90.1),
            ("greatest airspeed, kt", self.airspeed_mps / KNOT_MPS, 140.0, 169.0),
            ("turned left, deg", self.turned_left_rad / DEG, 180.0, 360.0),
            ("bank, deg", self.bank_rad / DEG, 30.0, 55.0),
            ("inside the corridor, kt", self.corridor_mps / KNOT_MPS, 0.0, 100.0),
            ("slowest rotors, rpm", self.rotor_radps_low / RPM, 0.9 * 589.0, 589.0),
            ("fastest rotors, rpm", self.rotor_radps_high / RPM, 589.0, ROTOR_RADPS_LIMIT / RPM),
            ("load factor", self.load_factor, 1.2, 2.0),
            ("touchdowns", self.touchdowns as f64, 1.0, 5.0),
            ("sink at touchdown, m/s", self.sink_mps, 0.0, SINK_MPS_GENTLE),
            ("tilt at touchdown, deg", self.touchdown_tilt_rad / DEG, 0.0, 4.0),
            ("off the spot, m", off_m, 0.0, 5.0),
            ("nacelles at the end, deg", end.actuators.mast_tilt_rad.mean() / DEG, -0.1, 0.5),
            ("gear at the end", end.actuators.gear_extension_norm, 0.999, 1.0),
            ("broken", (self.outside & broken).bits() as f64, 0.0, 0.0),
            ("stands still", f64::from(u8::from(self.stands_still())), 1.0, 1.0),
            ("length, s", seconds, 120.0, 300.0),
        ];
        limits
            .into_iter()
            .filter(|(_, value, low, high)| !(low..=high).contains(&value))
            .map(|(what, value, low, high)| format!("{what}: {value:.3}, not {low} to {high}"))
            .collect()
    }
}

#[track_caller]
fn assert_the_papers_flight(story: &Story, when: &str) {
    let wrong = story.wrong();
    assert!(wrong.is_empty(), "{when}: {wrong:#?}");
}

#[test]
fn the_demonstration_takes_off_converts_turns_reconverts_and_lands_where_it_began() {
    let story = Story::of(&xv15(), &calm(), "demo", 400);
    assert_the_papers_flight(&story, "calm");
    assert_eq!((story.lift_offs, story.touchdowns, story.end.cockpit.markers), (1, 1, 1));
    assert_eq!(story.outside, Validity::empty(), "no moment beyond the model's validity");
    assert!(story.corridor_mps > 5.0 * KNOT_MPS, "{} m/s", story.corridor_mps);
    // The reserve sink rate would load a leg with 3.1 times its share; standing, a main leg bears 0.43.
    let weight_n = story.end.balance.mass_kg * engine::GRAVITY_MPS2;
    assert!(story.leg_n < 0.86 * weight_n, "{:.2} weights on a leg", story.leg_n / weight_n);
    assert!(story.end.velocity_mps.norm() < 0.02, "{:?}", story.end.velocity_mps);
    let heading_off_rad = story.end.euler.heading_rad + 90.0 * DEG;
    assert!(heading_off_rad.abs() < 4.0 * DEG, "faces west again: {heading_off_rad} rad");
    let expected = [
        "on the ground",
        "take-off",
        "hover",
        "marker button",
        "acceleration",
        "conversion",
        "climb",
        "left turn",
        "approach",
        "hover turn",
        "hover",
        "landing",
    ];
    assert_eq!(story.phases, expected);
}

#[test]
fn wind_and_turbulence_change_the_demonstration_and_not_its_end() {
    let xv15 = xv15();
    let (winds, seeds) = if cfg!(debug_assertions) { (1, 1) } else { (8, 3) };
    for wind in 0..winds {
        for seed in 0..seeds {
            let from_deg = (225 + wind * 45) % 360;
            let story = Story::of(&xv15, &rough(from_deg, seed), "demo", 400);
            assert_the_papers_flight(&story, &format!("10 kt from {from_deg}°, seed {seed}"));
        }
    }
}

/// An aircraft that is not the one the pilot learned on.
type Change = (&'static str, fn(&mut Params));

const CHANGES: [Change; 8] = [
    ("SCAS off", |xv15| {
        let scas = &mut xv15.fcc.scas;
        for axis in [&mut scas.pitch, &mut scas.roll, &mut scas.yaw] {
            axis.authority_m = 0.0;
        }
    }),
    ("SCAS twice as strong", |xv15| {
        let scas = &mut xv15.fcc.scas;
        for axis in [&mut scas.pitch, &mut scas.roll, &mut scas.yaw] {
            axis.rate_gain_m_per_radps *= 2.0;
        }
    }),
    ("engines of 85 %", |xv15| xv15.engines.rated_power_w *= 0.85),
    ("blades 15 % wider", |xv15| {
        xv15.rotors.blade.blade_chord_m.y.iter_mut().for_each(|chord_m| *chord_m *= 1.15);
    }),
    ("blades 10 % narrower", |xv15| {
        xv15.rotors.blade.blade_chord_m.y.iter_mut().for_each(|chord_m| *chord_m *= 0.9);
    }),
    ("heavier by 5 %", |xv15| xv15.weight_balance.zero_fuel_mass_kg *= 1.05),
    ("tail smaller by 30 %", |xv15| xv15.horizontal_stabilizer.area_m2 *= 0.7),
    ("inertia half as much again", |xv15| {
        let inertia = &mut xv15.weight_balance.inertia;
        for moment in [&mut inertia.xx_kg_m2, &mut inertia.yy_kg_m2, &mut inertia.zz_kg_m2] {
            *moment *= 1.5;
        }
    }),
];

#[test]
fn an_aircraft_that_answers_differently_is_flown_too() {
    let some = if cfg!(debug_assertions) { &CHANGES[..1] } else { &CHANGES[..] };
    for (what, change) in some {
        let other = xv15().with(change);
        assert_the_papers_flight(&Story::of(&other, &calm(), "demo", 400), what);
    }
}

#[test]
fn the_hover_pilot_holds_height_place_and_heading() {
    let xv15 = xv15();
    let start = calm();
    let (mut height_off_m, mut off_m, mut turned_rad) = (0.0, 0.0, 0.0);
    rehearse(&xv15, &start, pilot("hover", &xv15), 35 * TICKS_PER_S, |now| {
        if now.state.tick > 20 * TICKS_PER_S {
            let seen = now.outputs;
            height_off_m = max(height_off_m, (seen.height_above_ground_m - 10.0).abs());
            off_m = max(off_m, max(seen.position_m.x.abs(), seen.position_m.y.abs()));
            let off_rad = seen.euler.heading_rad - start.heading_rad;
            turned_rad = max(turned_rad, engine::math::wrap_angle(off_rad).abs());
        }
    })
    .expect("a flight");
    assert!(height_off_m < 0.2, "{height_off_m} m of height");
    assert!(off_m < 1.0, "{off_m} m off the spot");
    assert!(turned_rad < 1.0 * DEG, "{turned_rad} rad");
}

#[test]
fn a_conversion_from_80_kt_keeps_inside_the_corridor_and_the_height() {
    let story = Story::of(&xv15(), &aloft(90.0, 80.0), "convert", 40);
    assert!(story.nacelles_rad > 89.9 * DEG, "converted");
    let airspeed_kt = story.end.calibrated_airspeed_mps / KNOT_MPS;
    assert!((airspeed_kt - 168.0).abs() < 8.0, "{airspeed_kt} kt, wanted some 170 kt true");
    assert!(story.corridor_mps > 0.0, "{} m/s inside the corridor", story.corridor_mps);
    let height_m = story.end.height_above_ground_m;
    assert!((height_m - 140.0).abs() < 20.0, "{height_m} m, wanted some 140 m");
}

/// Airspeed at which the nacelles of a conversion from 80 kt first pass 20 degrees, and how far the flight
/// kept inside its corridor, m/s.
fn converted(aircraft: &Aircraft) -> (f64, f64) {
    let (mut airspeed_mps, mut inside_mps) = (None, f64::INFINITY);
    let corridor = &aircraft.envelope.corridor;
    let hands = pilot("convert", aircraft);
    rehearse(aircraft, &aloft(90.0, 80.0), hands, 30 * TICKS_PER_S, |now| {
        let (seen, tilt_rad) = (now.outputs, now.outputs.actuators.mast_tilt_rad.mean());
        inside_mps = min(inside_mps, corridor.margin_mps(tilt_rad, seen.calibrated_airspeed_mps));
        if tilt_rad > 20.0 * DEG {
            airspeed_mps.get_or_insert(seen.calibrated_airspeed_mps);
        }
    })
    .expect("a flight");
    (airspeed_mps.expect("nacelles that come down"), inside_mps)
}

/// The lower limit twenty knots faster, where that leaves a corridor.
#[test]
fn a_pilot_keeps_to_the_corridor_of_the_aircrafts_file() {
    let was = "value = [0.0, 0.0, 64.0, 64.0, 80.0, 90.0, 102.0, 115.0, 123.0, 129.0]";
    let faster = "value = [0.0, 0.0, 74.0, 80.0, 100.0, 110.0, 122.0, 128.0, 129.0, 130.0]";
    assert_eq!(aircraft::XV15.matches(was).count(), 1);
    let text = aircraft::XV15.replace(was, faster);
    let narrow = aircraft::aircraft("narrow.toml", &text).expect("a corridor");
    let (wide_mps, _) = converted(&xv15());
    let (narrow_mps, inside_mps) = converted(&narrow.with_cockpit(xv15().cockpit.clone()));
    assert!(narrow_mps > wide_mps + 10.0 * KNOT_MPS, "{narrow_mps} m/s beside {wide_mps} m/s");
    assert!(inside_mps > 0.0, "{inside_mps} m/s inside the corridor");
}

#[test]
fn whatever_it_begins_in_the_land_pilot_lands() {
    let xv15 = xv15();
    let beginnings = [(0.0, 160.0), (60.0, 110.0), (90.0, 60.0), (90.0, 0.0)];
    let some = if cfg!(debug_assertions) { &beginnings[2..3] } else { &beginnings[..] };
    for &(nacelle_deg, speed_kt) in some {
        let story = Story::of(&xv15, &aloft(nacelle_deg, speed_kt), "land", 300);
        let from = format!("from {nacelle_deg} deg and {speed_kt} kt");
        assert!((1..=3).contains(&story.touchdowns), "{from}: {} touchdowns", story.touchdowns);
        assert!(story.sink_mps < SINK_MPS_GENTLE, "{from}: {} m/s", story.sink_mps);
        assert!(story.leg_n > 0.0 && story.sink_mps < SINK_MPS_DESIGN, "{from}");
        assert!(story.corridor_mps > 0.0, "{from}: {} m/s", story.corridor_mps);
        assert!(story.stands_still(), "{from}: {:?}", story.end.velocity_mps);
    }
}

/// Speeds at the greatest of which it keeps its nose and height: to the right and left 35 kt, rearward 20.
#[test]
fn the_sideways_pilot_flies_to_either_side_and_rearward_and_lands() {
    let xv15 = xv15();
    let start = calm();
    let (mut fastest_mps, mut turned_rad, mut height_off_m) = ([0.0; 3], 0.0, 0.0);
    let mut outside = Validity::empty();
    let mut phases = Vec::new();
    let (state, end) =
        rehearse(&xv15, &start, pilot("sideways", &xv15), 400 * TICKS_PER_S, |now| {
            let seen = now.outputs;
            outside |= seen.validity;
            if phases.last() != Some(&now.phase) {
                phases.push(now.phase);
            }
            let along = seen.body_velocity_mps;
            let speeds = [along.y, -along.y, -along.x];
            let names = ["to the right", "to the left", "rearward"];
            let Some(i) = names.iter().position(|name| *name == now.phase) else { return };
            fastest_mps[i] = max(fastest_mps[i], speeds[i]);
            let off_rad = seen.euler.heading_rad - start.heading_rad;
            turned_rad = max(turned_rad, engine::math::wrap_angle(off_rad).abs());
            height_off_m = max(height_off_m, (seen.height_above_ground_m - 10.0).abs());
        })
        .expect("a flight");
    println!(
        "{:.1?} kt, {:.2} deg, {height_off_m:.2} m, {outside}",
        fastest_mps.map(|v| v / KNOT_MPS),
        turned_rad / DEG
    );
    let wanted = [35.0, 35.0, 20.0];
    for (fastest_mps, wanted_kt) in fastest_mps.into_iter().zip(wanted) {
        assert!((fastest_mps / KNOT_MPS - wanted_kt).abs() < 2.0, "{fastest_mps} m/s");
    }
    assert!(turned_rad < 10.0 * DEG && height_off_m < 3.0, "{turned_rad} rad, {height_off_m} m");
    assert_eq!(outside, Validity::empty(), "no moment beyond the model's validity");
    assert_eq!(phases.last(), Some(&"landing"));
    assert!(state.tick < 400 * TICKS_PER_S && end.velocity_mps.norm() < 0.2);
}

/// An engine stops, and it lands on the wheels no harder than the gear was designed for.
#[test]
fn an_engine_out_landing_is_no_harder_than_the_gears_design() {
    let xv15 = xv15();
    let cases = [(90.0, 60.0), (90.0, 80.0), (0.0, 160.0)];
    let some = if cfg!(debug_assertions) { &cases[..1] } else { &cases[..] };
    for &(nacelle_deg, speed_kt) in some {
        let mut hands = pilot("land", &xv15);
        hands.push(Box::new(Fails { at_s: 2.0, failures: Failures::ENGINE_RIGHT }));
        let (mut sink_mps, mut touchdowns) = (0.0, 0);
        let mut before: Option<(u64, f64)> = None;
        let (state, end) =
            rehearse(&xv15, &aloft(nacelle_deg, speed_kt), hands, 400 * TICKS_PER_S, |now| {
                let wheels = now.state.plant.weight_on_wheels;
                if let Some((was, sank_mps)) = before
                    && was == 0
                    && wheels == 1
                {
                    sink_mps = max(sink_mps, sank_mps);
                    touchdowns += 1;
                }
                before = Some((wheels, now.outputs.velocity_mps.z));
            })
            .expect("a flight");
        let from = format!("engine out at {nacelle_deg} deg and {speed_kt} kt");
        println!("{from}: {sink_mps:.2} m/s, {touchdowns} touchdowns, {:.0} s", state.time_s());
        assert!(touchdowns > 0 && state.tick < 400 * TICKS_PER_S, "{from}: it never landed");
        assert!(sink_mps < SINK_MPS_DESIGN, "{from}: {sink_mps} m/s");
        assert!(!end.validity.intersects(Validity::HULL | Validity::FROZEN), "{from}: a wreck");
        assert!(end.velocity_mps.norm() < 0.5, "{from}: {:?}", end.velocity_mps);
    }
}

/// A failure during a flight.
struct Fails {
    at_s: f64,
    failures: Failures,
}

impl Controller for Fails {
    fn act(&mut self, _: &Outputs, context: &mut TickContext<'_>) {
        if context.tick as f64 * engine::STEP_S >= self.at_s {
            context.world.failures = self.failures;
        }
    }
}

#[test]
fn the_demonstration_ends_on_the_ground_with_engines_that_stop() {
    let xv15 = xv15();
    let both = Failures::ENGINES;
    let cases = [(100.0, Failures::ENGINE_RIGHT), (60.0, Failures::ENGINE_LEFT), (100.0, both)];
    let some = if cfg!(debug_assertions) { &cases[..1] } else { &cases[..] };
    for &(at_s, failures) in some {
        let mut hands = pilot("demo", &xv15);
        hands.push(Box::new(Fails { at_s, failures }));
        let (state, seen) =
            rehearse(&xv15, &calm(), hands, 600 * TICKS_PER_S, |_| {}).expect("a flight");
        let when = format!("{failures} stopped at {at_s} s");
        assert!(state.tick < 600 * TICKS_PER_S, "{when}: it never ended");
        assert!(seen.height_above_ground_m < 5.0, "{when}: {} m", seen.height_above_ground_m);
        assert!(seen.velocity_mps.norm() < 0.5, "{when}: {} m/s", seen.velocity_mps.norm());
        assert!(!seen.validity.contains(Validity::HULL), "{when}: a wreck");
    }
}

#[test]
fn every_pilot_takes_over_in_the_air_without_a_kick() {
    let xv15 = xv15();
    for (name, _) in PILOTS {
        let mut most_radps = 0.0;
        rehearse(&xv15, &aloft(90.0, 60.0), pilot(name, &xv15), TICKS_PER_S, |now| {
            most_radps = max(most_radps, now.outputs.angular_rate_radps.norm());
        })
        .expect("a flight");
        // The hands ask for 0.2 rad/s at most.
        assert!(most_radps < 0.2, "{name}: {most_radps} rad/s in the first second");
    }
}

#[test]
fn a_rehearsal_has_the_bits_of_the_flight() {
    let xv15 = xv15();
    let out = std::env::temp_dir().join(format!("tiltrotor-rehearsal-{}.mcap", std::process::id()));
    let flight = Flight {
        aircraft: xv15.clone(),
        start: calm(),
        setup: logs::Setup {
            aircraft_toml: aircraft::XV15.into(),
            cockpit_toml: aircraft::PILOT_MAP.into(),
            scenario_toml: aircraft::DEFAULT_SCENARIO.into(),
        },
        identity: logs::Identity::new(),
        robot_description: String::new(),
        controllers: pilot("demo", &xv15),
        #[cfg(feature = "sticks")]
        sticks: None,
        out: out.clone(),
        force: true,
        real_time: None,
        situation: None,
        ticks_max: Some(8 * TICKS_PER_S),
        link: None,
        self_check: false,
    };
    let landing = fly(flight, &Progress::default()).expect("a flight");
    let _ = std::fs::remove_file(&out);
    let rehearsed = rehearse(&xv15, &calm(), pilot("demo", &xv15), 8 * TICKS_PER_S, |_| {});
    let (_, outputs) = rehearsed.expect("a flight");
    assert!(landing.outputs.height_above_ground_m > 3.0, "it flew");
    assert_eq!(format!("{:?}", landing.outputs), format!("{outputs:?}"));
}
