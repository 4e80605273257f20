use std::sync::OnceLock;

use engine::inputs::{Failures, World};
use engine::outputs::Validity;
use engine::pair::Pair;
use engine::{Aircraft, Outputs};

use super::*;
use crate::scene::{Lamps, Recording};

fn xv15() -> &'static Aircraft {
    static XV15: OnceLock<Aircraft> = OnceLock::new();
    XV15.get_or_init(|| aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15"))
}

fn shown(outputs: &Outputs, world: &World, lamps: Lamps) -> Channel {
    Channel::of(&Scene { aircraft: xv15(), outputs, world, lamps })
}

fn near(channel: &Channel, node: &str, expected: f64) {
    let got = channel.get(node).unwrap_or_else(|| panic!("{node} is in the table"));
    assert!(
        (got - expected).abs() <= 1e-5 * engine::math::max(expected.abs(), 1.0),
        "{node}: {got}, {expected}"
    );
}

/// Numbers without a pattern, the same every time.
fn random(seed: &mut u64) -> f64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn the_protocol_file_is_the_table() {
    for (name, root) in [(PROTOCOL, ""), (GHOST_PROTOCOL, GHOST)] {
        let path = format!("{}/data/Protocol/{name}.xml", env!("CARGO_MANIFEST_DIR"));
        let made = protocol(root);
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&path, &made).expect("written");
        }
        let kept = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(kept == made, "{path} is stale: BLESS=1 cargo test -p flightgear protocol");
    }
}

#[test]
fn no_property_is_there_twice() {
    let mut nodes: Vec<_> =
        ROWS.iter().flat_map(|row| (0..row.count).map(|index| row.node_of(index))).collect();
    assert_eq!(nodes.len(), COUNT);
    nodes.sort();
    nodes.dedup();
    assert_eq!(nodes.len(), COUNT);
    assert!(nodes.iter().all(|node| !node.starts_with('/') && node.starts_with("tiltrotor/")));
    assert!(ROWS.iter().all(|row| (row.count > 1) == row.node.contains('#')), "parts are numbered");
}

#[test]
fn schema_and_tick_come_first_and_big_endian() {
    let outputs = Outputs { tick: 1000, ..Outputs::default() };
    let channel = shown(&outputs, &World::default(), Lamps::default());
    assert_eq!(channel.bytes()[..4], [0, 0, 0, 2]);
    assert_eq!(channel.bytes()[4..12], 1000.0_f64.to_be_bytes());
    near(&channel, "tiltrotor/time-s", 4.0);
}

#[test]
fn what_was_sent_is_what_is_read() {
    let mut seed = 0x9e37_79b9_7f4a_7c15;
    for _ in 0..200 {
        // Any bytes that are finite numbers are a packet, and are read as they were written.
        let mut bytes = [0; LENGTH];
        let mut sent = Vec::new();
        let mut at = 0;
        for (number, row) in
            ROWS.iter().flat_map(|row| (0..row.count).map(move |_| row)).enumerate()
        {
            let value = (random(&mut seed) - 0.5) * 2e6;
            let value = match row.kind {
                _ if number == 0 => f64::from(SCHEMA),
                Kind::Int => value.round(),
                Kind::Float => f64::from(value as f32),
                Kind::Double => value,
            };
            row.kind.write(value, &mut bytes[at..at + row.kind.size()]);
            at += row.kind.size();
            sent.push(value.to_bits());
        }
        assert_eq!(at, LENGTH);
        let channel = Channel::parse(&bytes).expect("a packet");
        let read: Vec<_> = channel.values().map(|(_, _, value)| value.to_bits()).collect();
        assert_eq!(read, sent);
        assert_eq!(channel.bytes(), bytes);
    }
}

#[test]
fn values_are_in_the_cockpit_s_units_and_senses() {
    let mut outputs = Outputs {
        rotor_speed_radps: 60.0,
        rotor_azimuth_rad: 1.0,
        calibrated_airspeed_mps: 1852.0 / 36.0,
        ..Outputs::default()
    };
    outputs.actuators.mast_tilt_rad = Pair { left: 0.0, right: core::f64::consts::FRAC_PI_2 };
    outputs.actuators.rudder_right_rad = 0.1;
    outputs.rotors =
        Pair::both(engine::rotors::Outputs { tilt_outboard_rad: 0.1, ..Default::default() });
    outputs.euler.heading_rad = -0.1;
    outputs.air.wind_mps = engine::frames::Vec3::new(0.0, 10.0, 0.0);
    let channel = shown(&outputs, &World::default(), Lamps::default());
    near(&channel, "tiltrotor/nacelle-deg[0]", 90.0);
    near(&channel, "tiltrotor/nacelle-deg[1]", 0.0);
    near(&channel, "tiltrotor/rotor[1]/rpm", 572.957_8);
    near(&channel, "tiltrotor/rotor[0]/flap-right-deg", -5.729_578);
    near(&channel, "tiltrotor/rotor[1]/flap-right-deg", 5.729_578);
    near(&channel, "tiltrotor/surface/rudder-deg[0]", -5.729_578);
    near(&channel, "tiltrotor/air/cas-kt", 100.0);
    near(&channel, "tiltrotor/attitude/heading-deg", 354.270_42);
    // Air that moves eastwards is a west wind.
    near(&channel, "tiltrotor/air/wind-from-deg", 270.0);
}

#[test]
fn failures_warnings_and_lamps_are_told() {
    let mut outputs = Outputs { validity: Validity::ROTOR_STALL, ..Outputs::default() };
    outputs.engines.available_w = 1e6;
    outputs.engines.power_w = Pair { left: 0.0, right: 5e5 };
    outputs.cockpit.scas_on = 1;
    outputs.actuators.gear_extension_norm = 1.0;
    outputs.rotor_speed_radps = 61.0;
    let world = World { failures: Failures::SCAS_YAW | Failures::GOVERNOR, ..World::default() };
    let lamps = Lamps { recording: Recording::Failed, replay: false, paused: true };
    let channel = shown(&outputs, &world, lamps);
    for (node, expected) in [
        ("tiltrotor/scas/pitch", 1.0),
        ("tiltrotor/scas/yaw", 0.0),
        ("tiltrotor/governor/on", 0.0),
        ("tiltrotor/lamp/engine-fail[0]", 1.0),
        ("tiltrotor/lamp/engine-fail[1]", 0.0),
        ("tiltrotor/lamp/stall", 1.0),
        ("tiltrotor/lamp/warning", 1.0),
        ("tiltrotor/lamp/master-warning", 1.0),
        ("tiltrotor/lamp/low-rotor-rpm", 0.0),
        ("tiltrotor/lamp/gear-warning", 0.0),
        ("tiltrotor/lamp/recording", 2.0),
        ("tiltrotor/lamp/replay", 0.0),
        ("tiltrotor/lamp/paused", 1.0),
    ] {
        near(&channel, node, expected);
    }
    // Exhaust of the one that stands is as cold as the air; of the other it is not.
    let egt = |side| channel.get(&format!("tiltrotor/engine[{side}]/egt-degf")).expect("there");
    assert!(egt(1) > egt(0) + 500.0);
}

#[test]
fn lamps_of_torque_rotor_speed_and_gear_come_on_beyond_their_limits_and_not_at_them() {
    let (xv15, world) = (xv15(), World::default());
    let lamp = |name: &str, outputs: &Outputs| {
        let shown = shown(outputs, &world, Lamps::default());
        shown.get(&format!("tiltrotor/lamp/{name}")).expect("there") > 0.5
    };
    // One mast is enough.
    let torque = |part: f64| {
        let mut outputs = Outputs::default();
        outputs.rotors.right.torque_n_m = part * xv15.engines.torque_n_m_max;
        lamp("torque-limit", &outputs)
    };
    assert_eq!([0.999, 1.0, 1.001].map(torque), [false, false, true]);

    let least_radps = xv15.envelope.rotors.underspeed_norm * xv15.fcc.governor.rotor_speed_radps[0];
    let slow = |part: f64| {
        let rotor_speed_radps = part * least_radps;
        lamp("low-rotor-rpm", &Outputs { rotor_speed_radps, ..Outputs::default() })
    };
    assert_eq!([0.999, 1.0, 1.001].map(slow), [true, false, false]);

    // Low, slow and not all out: any of the three less, and nothing is missing.
    let gear = |height_ft: f64, airspeed_kt: f64, extended_norm: f64| {
        let mut outputs = Outputs {
            height_above_ground_m: height_ft * engine::units::FOOT_M + 3.0,
            calibrated_airspeed_mps: engine::units::mps_of_knots(airspeed_kt),
            ..Outputs::default()
        };
        outputs.actuators.gear_extension_norm = extended_norm;
        lamp("gear-warning", &outputs)
    };
    assert!(gear(100.0, 60.0, 0.9) && gear(180.0, 99.0, 0.0));
    assert!(!gear(220.0, 60.0, 0.0) && !gear(100.0, 101.0, 0.0) && !gear(100.0, 60.0, 1.0));
}

#[test]
fn what_is_no_packet_is_refused() {
    let good = shown(&Outputs::default(), &World::default(), Lamps::default());
    let with = |at: usize, new: &[u8]| {
        let mut bytes = good.bytes().to_vec();
        bytes[at..at + new.len()].copy_from_slice(new);
        Channel::parse(&bytes)
    };
    assert_eq!(Channel::parse(&good.bytes()[1..]), Err(ChannelError::Length { got: LENGTH - 1 }));
    assert_eq!(Channel::parse(&[]), Err(ChannelError::Length { got: 0 }));
    assert_eq!(with(0, &7_i32.to_be_bytes()), Err(ChannelError::Schema { got: 7 }));
    assert_eq!(with(0, &1_i32.to_le_bytes()), Err(ChannelError::Schema { got: 0x0100_0000 }));
    let node = "tiltrotor/tick".to_string();
    assert_eq!(with(4, &f64::NAN.to_be_bytes()), Err(ChannelError::NotFinite { node }));
    let node = "tiltrotor/nacelle-deg[0]".to_string();
    assert_eq!(with(36, &f32::INFINITY.to_be_bytes()), Err(ChannelError::NotFinite { node }));
}

#[test]
fn flightgear_never_sees_what_is_not_a_number() {
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -f64::MAX] {
        let mut outputs = Outputs {
            fuel_kg: odd,
            rotor_speed_radps: odd,
            rotor_azimuth_rad: odd,
            calibrated_airspeed_mps: odd,
            alpha_rad: odd,
            height_above_ground_m: odd,
            ..Outputs::default()
        };
        outputs.euler.heading_rad = odd;
        outputs.actuators.mast_tilt_rad = Pair::both(odd);
        outputs.engines.power_w = Pair::both(odd);
        outputs.air.temperature_k = odd;
        let channel = shown(&outputs, &World::default(), Lamps::default());
        assert_eq!(Channel::parse(channel.bytes()), Ok(channel), "{odd}");
    }
}

#[test]
fn numbers_of_every_kind_are_the_nearest_there_is_and_no_negative_zero() {
    let mut bytes = [0xff; 8];
    for kind in [Kind::Int, Kind::Float, Kind::Double] {
        let bytes = &mut bytes[..kind.size()];
        let mut written = |value: f64| {
            kind.write(value, bytes);
            kind.read(bytes)
        };
        for nought in [-0.0, 0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(written(nought).to_bits(), 0, "{kind:?} {nought}");
        }
        assert!((written(-3.0) + 3.0).abs() < 1e-12, "{kind:?}");
    }
    let mut int = |value: f64| {
        Kind::Int.write(value, &mut bytes[..4]);
        Kind::Int.read(&bytes[..4])
    };
    for (value, nearest) in
        [(2.5, 3.0), (-2.4, -2.0), (1e12, 2_147_483_647.0), (-1e12, -2_147_483_648.0)]
    {
        assert!((int(value) - nearest).abs() < 1e-9, "{value}");
    }
}

#[test]
fn between_two_packets_angles_go_the_shorter_way() {
    assert!((between(350.0, 10.0, 0.25, 360.0) - 355.0).abs() < 1e-12);
    assert!((between(350.0, 10.0, 0.75, 360.0) - 5.0).abs() < 1e-12);
    assert!((between(-170.0, 170.0, 0.5, 360.0).abs() - 180.0).abs() < 1e-12);
    assert!((between(-1.0, 2.0, 0.5, 0.0) - 0.5).abs() < 1e-12);
    let at = |tick, heading_rad| {
        let mut outputs = Outputs { tick, ..Outputs::default() };
        outputs.euler.heading_rad = heading_rad;
        outputs.cockpit.markers = tick;
        shown(&outputs, &World::default(), Lamps::default())
    };
    let (a, b) = (at(4, -0.02), at(5, 0.02));
    assert_eq!(Channel::between(&a, &b, 0.0), a);
    assert_eq!(Channel::between(&a, &b, 1.0), b);
    let middle = Channel::between(&a, &b, 0.5);
    near(&middle, "tiltrotor/tick", 4.5);
    near(&middle, "tiltrotor/lamp/marker", 5.0);
    let heading_deg = middle.get("tiltrotor/attitude/heading-deg").expect("there");
    assert!(!(1e-3..=359.999).contains(&heading_deg), "{heading_deg}");
}
