//! Both engines stop as a helicopter: down without them, as far as rotors, flare and gear carry.

use engine::inputs::Failures;
use engine::math::{max, min};
use engine::outputs::Validity;
use engine::units::RPM_RADPS as RPM;
use engine::{Aircraft, Outputs};
use recorder::pilots::Pilot;
use recorder::{Controller, TickContext, rehearse};

const TICKS_PER_S: u64 = 250;
/// The gear's reserve, m/s: 12.25 ft/s (TM X-62,407 §10.6); the rate it was designed for is 3.05.
const SINK_MPS_RESERVE: f64 = 3.73;
/// The rotors between the failure and the pull of the lever: from 80 % of 589 rpm to the limit of 661.
const ROTORS_RPM: [f64; 2] = [471.0, 661.0];

/// Both engines stop a second after the beginning.
struct EnginesStop;

impl Controller for EnginesStop {
    fn act(&mut self, _: &Outputs, context: &mut TickContext<'_>) {
        if context.tick >= TICKS_PER_S {
            context.world.failures = Failures::ENGINES;
        }
    }
}

/// What is remembered of the way down.
struct Story {
    rpm: [f64; 2],
    glide_sink_mps: f64,
    touchdown: Option<Outputs>,
    outside: Validity,
    end: Outputs,
}

fn way_down(xv15: &Aircraft, speed_kt: f64, altitude_ft: f64) -> Story {
    let trim = format!(
        "[trim]\nmast_tilt_deg = 0.0\nairspeed_kt = {speed_kt:?}\naltitude_ft = {altitude_ft:?}\n\
         flap_detent = 2\nscas_on = 1\n"
    );
    let scenario = format!("{}\n{trim}", aircraft::DEFAULT_SCENARIO);
    let start = aircraft::start("scenario.toml", &scenario).unwrap_or_else(|e| panic!("{e}"));
    let pilot = Pilot::named("land", &xv15.cockpit, xv15).expect("land");
    let controllers: Vec<Box<dyn Controller>> = vec![Box::new(pilot), Box::new(EnginesStop)];
    let mut story = Story {
        rpm: [f64::INFINITY, 0.0],
        glide_sink_mps: 0.0,
        touchdown: None,
        outside: Validity::empty(),
        end: Outputs::default(),
    };
    let mut before = Outputs::default();
    let flown = rehearse(xv15, &start, controllers, 120 * TICKS_PER_S, |now| {
        let seen = now.outputs;
        if now.state.plant.weight_on_wheels == 1 {
            story.touchdown.get_or_insert(before);
        } else if story.touchdown.is_none() && seen.cockpit.collective_norm <= 0.0 {
            let rpm = seen.rotor_speed_radps / RPM;
            story.rpm = [min(story.rpm[0], rpm), max(story.rpm[1], rpm)];
            story.glide_sink_mps = max(story.glide_sink_mps, seen.velocity_mps.z);
        }
        story.outside |= seen.validity;
        before = *seen;
    });
    story.end = flown.unwrap_or_else(|failure| panic!("{failure}")).1;
    story
}

/// From 60 kt at 900 ft and up, in calm air, it comes down within the reserve of the gear, on its wheels, in one piece.
#[test]
fn without_engines_from_60_kt_it_lands_within_the_gears_reserve() {
    let map =
        aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap_or_else(|e| panic!("{e}"));
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15)
        .unwrap_or_else(|e| panic!("{e}"))
        .with_cockpit(map);
    for (speed_kt, altitude_ft) in [(60.0, 900.0), (60.0, 1000.0), (60.0, 1500.0)] {
        let story = way_down(&xv15, speed_kt, altitude_ft);
        let from = format!("{speed_kt} kt at {altitude_ft} ft");
        let at = story.touchdown.unwrap_or_else(|| panic!("{from}: it never landed"));
        let (sink_mps, ahead_mps) = (at.velocity_mps.z, at.body_velocity_mps.x);
        println!(
            "{from}: rotors {:.0?} rpm, sink at most {:.1} m/s; touchdown {sink_mps:.2} m/s, {ahead_mps:.1} \
             m/s ahead, nose {:.1} deg, {:.0} rpm; {}",
            story.rpm,
            story.glide_sink_mps,
            at.euler.pitch_rad.to_degrees(),
            at.rotor_speed_radps / RPM,
            story.outside
        );
        assert!(sink_mps < SINK_MPS_RESERVE, "{from}: {sink_mps} m/s");
        assert!(at.euler.roll_rad.abs() < 0.05, "{from}");
        let [low_rpm, high_rpm] = story.rpm;
        assert!(low_rpm > ROTORS_RPM[0] && high_rpm < ROTORS_RPM[1], "{from}: {:?}", story.rpm);
        let broken = Validity::HULL | Validity::FROZEN | Validity::TUMBLING;
        assert!(!story.outside.intersects(broken), "{from}: {}", story.outside);
        assert!(story.end.velocity_mps.norm() < 0.5, "{from}: {:?}", story.end.velocity_mps);
    }
}
