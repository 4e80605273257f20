use core::mem::offset_of;
use std::sync::OnceLock;

use engine::frames::Euler;
use engine::landing_gear::Leg;
use engine::math::PI;
use engine::state::Geodetic;

use engine::inputs::World;
use engine::{Aircraft, Outputs};

use super::*;
use crate::scene::Lamps;

/// Rounding of single precision.
const SINGLE: f64 = 1e-6;

fn near(got: F32, expected: f64) -> bool {
    (f64::from(got.get()) - expected).abs() <= SINGLE * max(1.0, expected.abs())
}

fn xv15() -> &'static Aircraft {
    static XV15: OnceLock<Aircraft> = OnceLock::new();
    XV15.get_or_init(|| aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15"))
}

fn sent(outputs: &Outputs) -> NetFdm {
    let (world, lamps) = (World::default(), Lamps::default());
    NetFdm::of(&Scene { aircraft: xv15(), outputs, world: &world, lamps })
}

/// A whole packet with the bytes at `offset` replaced.
fn packet_with(offset: usize, bytes: &[u8]) -> Vec<u8> {
    let mut packet = sent(&Outputs::default()).bytes().to_vec();
    packet[offset..offset + bytes.len()].copy_from_slice(bytes);
    packet
}

#[test]
fn every_field_is_where_flightgear_reads_it() {
    macro_rules! assert_offsets {
        ($($field:ident $offset:literal),+ $(,)?) => {
            $(assert_eq!(offset_of!(NetFdm, $field), $offset, stringify!($field));)+
        };
    }
    assert_offsets! {
        version 0, padding 4, longitude_rad 8, latitude_rad 16, altitude_m 24, agl_m 32,
        phi_rad 36, theta_rad 40, psi_rad 44, alpha_rad 48, beta_rad 52,
        phidot_radps 56, thetadot_radps 60, psidot_radps 64, vcas_kt 68, climb_rate_ftps 72,
        v_north_ftps 76, v_east_ftps 80, v_down_ftps 84,
        v_body_u_ftps 88, v_body_v_ftps 92, v_body_w_ftps 96,
        a_x_pilot_ftps2 100, a_y_pilot_ftps2 104, a_z_pilot_ftps2 108,
        stall_warning 112, slip_deg 116, num_engines 120, eng_state 124, rpm 140,
        fuel_flow_gph 156, fuel_px_psi 172, egt_degf 188, cht_degf 204, mp_osi_inhg 220,
        tit 236, oil_temp_degf 252, oil_px_psi 268, num_tanks 284, fuel_quantity_gal 288,
        num_wheels 304, wow 308, gear_pos_norm 320, gear_steer_norm 332,
        gear_compression_norm 344, cur_time_s 356, warp_s 360, visibility_m 364,
        elevator_norm 368, elevator_trim_tab_norm 372, left_flap_norm 376,
        right_flap_norm 380, left_aileron_norm 384, right_aileron_norm 388, rudder_norm 392,
        nose_wheel_norm 396, speedbrake_norm 400, spoilers_norm 404,
    }
    assert_eq!(size_of::<NetFdm>(), 408);
}

#[test]
fn the_wire_is_big_endian() {
    let place = Geodetic { height_m: 1.0, ..Geodetic::default() };
    let euler = Euler { roll_rad: -2.0, ..Euler::default() };
    let packet = sent(&Outputs { place, euler, ..Outputs::default() });
    let bytes = packet.bytes();
    assert_eq!(bytes[0..4], [0, 0, 0, 0x18]);
    assert_eq!(bytes[24..32], [0x3f, 0xf0, 0, 0, 0, 0, 0, 0]);
    assert_eq!(bytes[36..40], [0xc0, 0, 0, 0]);
    assert_eq!(bytes[120..124], [0, 0, 0, 2]);
    assert_eq!(bytes[284..288], [0, 0, 0, 1]);
    assert_eq!(bytes[304..308], [0, 0, 0, 3]);
}

#[test]
fn flightgear_gets_the_right_degrees_from_its_wrong_pi() {
    // The factor is what FlightGear's own expression gives.
    let factor = f64::from(180.0_f32 / core::f32::consts::PI);
    assert_eq!(factor.to_bits(), POSITION_DEG_PER_RAD.to_bits());
    for (latitude_deg, longitude_deg) in
        [(19.721_39, -155.048_47), (64.13, -21.940_6), (-90.0, 179.999_999), (45.0, 7.65)]
    {
        let place = Geodetic {
            latitude_rad: latitude_deg / DEG_PER_RAD,
            longitude_rad: longitude_deg / DEG_PER_RAD,
            height_m: 11.28,
        };
        let packet = sent(&Outputs { place, ..Outputs::default() });
        let shown_deg = packet.latitude_rad.get() * 57.295_776_367_187_5;
        assert!((shown_deg / latitude_deg - 1.0).abs() < 1e-12, "{shown_deg}");
        let shown_deg = packet.longitude_rad.get() * 57.295_776_367_187_5;
        assert!((shown_deg / longitude_deg - 1.0).abs() < 1e-12, "{shown_deg}");
        assert_eq!(packet.altitude_m.get().to_bits(), 11.28_f64.to_bits());
    }
}

#[test]
fn beyond_the_date_line_longitude_starts_again() {
    let place = Geodetic { longitude_rad: 181.0 / DEG_PER_RAD, ..Geodetic::default() };
    let packet = sent(&Outputs { place, ..Outputs::default() });
    assert!((packet.longitude_deg() + 179.0).abs() < 1e-9);
}

#[test]
fn heading_stays_within_a_turn() {
    let heading = |heading_rad: f64| {
        let euler = Euler { heading_rad, ..Euler::default() };
        sent(&Outputs { euler, ..Outputs::default() }).psi_rad
    };
    assert!(near(heading(-1.0), TAU - 1.0));
    assert!(near(heading(1.0), 1.0));
    for heading_rad in [-PI, -1e-3, -1e-9, -1e-300, 0.0, 1e-9, 3.0, PI, 7.0] {
        let psi_rad = f64::from(heading(heading_rad).get());
        assert!((0.0..TAU).contains(&psi_rad), "{heading_rad} sent as {psi_rad}");
    }
}

#[test]
fn level_flight_weighs_one_g_and_keeps_the_ball_in_the_middle() {
    let packet = sent(&Outputs {
        specific_force_mps2: Vec3::new(0.0, 0.0, -engine::GRAVITY_MPS2),
        velocity_mps: Vec3::new(30.48, 3.048, -0.3048),
        calibrated_airspeed_mps: 1852.0 / 36.0,
        ..Outputs::default()
    });
    assert!(near(packet.a_z_pilot_ftps2, -32.174_049));
    assert!(near(packet.slip_deg, 0.0));
    assert!(near(packet.v_north_ftps, 100.0));
    assert!(near(packet.v_east_ftps, 10.0));
    assert!(near(packet.climb_rate_ftps, 1.0));
    assert!(near(packet.v_down_ftps, -1.0));
    assert!(near(packet.vcas_kt, 100.0));
    assert!(near(packet.agl_m, -9999.0));
}

#[test]
fn a_push_to_the_left_sends_the_ball_right() {
    let slip_deg = |y: f64, z: f64| slip(Vec3::new(0.0, y, z));
    assert!(near(slip_deg(-9.8, -9.8), 45.0));
    assert!(near(slip_deg(9.8, -9.8), -45.0));
    assert!(near(slip_deg(0.0, 0.0), 0.0));
}

#[test]
fn surfaces_at_full_travel_are_one() {
    let mut outputs = Outputs::default();
    outputs.actuators.elevator_rad = -20.0 / DEG_PER_RAD;
    outputs.actuators.rudder_right_rad = 20.0 / DEG_PER_RAD;
    outputs.actuators.flap_rad = 75.0 / DEG_PER_RAD;
    outputs.actuators.flaperon_rad = Pair { left: 13.8 / DEG_PER_RAD, right: -23.8 / DEG_PER_RAD };
    let packet = sent(&outputs);
    assert!(near(packet.elevator_norm, -1.0));
    assert!(near(packet.rudder_norm, 1.0));
    assert!(near(packet.left_flap_norm, 1.0) && near(packet.right_flap_norm, 1.0));
    assert!(near(packet.left_aileron_norm, 13.8 / 23.8));
    assert!(near(packet.right_aileron_norm, -1.0));
}

#[test]
fn wheels_are_nose_left_right() {
    let mut outputs = Outputs::default();
    outputs.actuators.gear_extension_norm = 0.5;
    outputs.landing_gear.nose = Leg { compression_m: 0.07, push_n: 0.0, ..Leg::default() };
    outputs.landing_gear.main.right = Leg { compression_m: 0.9, push_n: 1.0, ..Leg::default() };
    let packet = sent(&outputs);
    assert_eq!(packet.wow.map(U32::get), [0, 0, 1]);
    assert!(packet.gear_pos_norm.iter().all(|&norm| near(norm, 0.5)));
    let [nose, left, right] = packet.gear_compression_norm;
    assert!(near(nose, 0.07 / (14.5 * 0.0254)) && near(left, 0.0) && near(right, 1.0));
}

#[test]
fn a_failed_engine_is_off_and_the_other_burns_the_fuel() {
    let mut outputs = Outputs { rotor_speed_radps: TAU * 10.0, ..Outputs::default() };
    outputs.fuel_kg = 65.0 * 0.453_592_37;
    outputs.engines.available_w = 1e6;
    outputs.engines.power_w = Pair { left: 0.0, right: 5e5 };
    outputs.engines.fuel_flow_kg_per_s = 650.0 * 0.453_592_37 / 3600.0;
    let packet = sent(&outputs);
    assert_eq!(packet.eng_state.map(U32::get), [0, 2, 0, 0]);
    assert!(near(packet.fuel_flow_gph[0], 0.0) && near(packet.fuel_flow_gph[1], 100.0));
    assert!(near(packet.rpm[0], 600.0) && near(packet.rpm[1], 600.0));
    assert!(near(packet.fuel_quantity_gal[0], 10.0));
}

#[test]
fn a_stalled_rotor_warns() {
    let warning =
        |validity: Validity| sent(&Outputs { validity, ..Outputs::default() }).stall_warning;
    assert!(near(warning(Validity::ROTOR_STALL), 1.0));
    assert!(near(warning(Validity::VORTEX_RING), 1.0));
    assert!(near(warning(Validity::SPEED | Validity::GEAR_BOTTOMED), 0.0));
}

#[test]
fn flightgear_never_sees_what_is_not_a_number() {
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        let mut outputs = Outputs {
            place: Geodetic { latitude_rad: odd, longitude_rad: odd, height_m: odd },
            velocity_mps: Vec3::new(odd, odd, odd),
            body_velocity_mps: Vec3::new(odd, odd, odd),
            specific_force_mps2: Vec3::new(odd, odd, odd),
            euler: Euler { roll_rad: odd, pitch_rad: odd, heading_rad: odd },
            euler_rate: engine::outputs::EulerRate {
                roll_radps: odd,
                pitch_radps: odd,
                heading_radps: odd,
            },
            calibrated_airspeed_mps: odd,
            alpha_rad: odd,
            beta_rad: odd,
            fuel_kg: odd,
            rotor_speed_radps: odd,
            ..Outputs::default()
        };
        outputs.actuators.elevator_rad = odd;
        outputs.actuators.flap_rad = odd;
        outputs.actuators.rudder_right_rad = odd;
        outputs.actuators.flaperon_rad = Pair::both(odd);
        outputs.actuators.gear_extension_norm = odd;
        outputs.engines.power_w = Pair::both(odd);
        outputs.engines.fuel_flow_kg_per_s = odd;
        outputs.landing_gear.nose.compression_m = odd;
        let packet = sent(&outputs);
        assert_eq!(NetFdm::parse(packet.bytes()), Ok(packet), "{odd}");
    }
}

#[test]
fn what_was_sent_is_what_is_read() {
    let packet = sent(&Outputs::default());
    assert_eq!(NetFdm::parse(packet.bytes()), Ok(packet));
}

#[test]
fn a_packet_of_another_length_is_refused() {
    let mut bytes = packet_with(0, &[]);
    assert_eq!(NetFdm::parse(&bytes[..407]), Err(PacketError::Length { got: 407 }));
    assert_eq!(NetFdm::parse(&[]), Err(PacketError::Length { got: 0 }));
    bytes.push(0);
    assert_eq!(NetFdm::parse(&bytes), Err(PacketError::Length { got: 409 }));
}

#[test]
fn another_version_or_byte_order_is_refused() {
    let error = NetFdm::parse(&packet_with(0, &25_u32.to_be_bytes()));
    assert_eq!(error, Err(PacketError::Version { got: 25 }));
    let error = NetFdm::parse(&packet_with(0, &24_u32.to_le_bytes()));
    assert_eq!(error, Err(PacketError::Version { got: 0x1800_0000 }));
}

#[test]
fn counts_beyond_their_arrays_are_refused() {
    for (field, offset, most) in [("num_engines", 120, 4), ("num_tanks", 284, 4)] {
        let error = NetFdm::parse(&packet_with(offset, &5_u32.to_be_bytes()));
        assert_eq!(error, Err(PacketError::Count { field, got: 5, most }));
        assert!(NetFdm::parse(&packet_with(offset, &4_u32.to_be_bytes())).is_ok());
    }
    let error = NetFdm::parse(&packet_with(304, &4_u32.to_be_bytes()));
    assert_eq!(error, Err(PacketError::Count { field: "num_wheels", got: 4, most: 3 }));
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let error = NetFdm::parse(&packet_with(36, &f32::NAN.to_be_bytes()));
    assert_eq!(error, Err(PacketError::NotFinite { field: "phi_rad" }));
    let error = NetFdm::parse(&packet_with(8, &f64::INFINITY.to_be_bytes()));
    assert_eq!(error, Err(PacketError::NotFinite { field: "longitude_rad" }));
    let error = NetFdm::parse(&packet_with(152, &f32::NEG_INFINITY.to_be_bytes()));
    assert_eq!(error, Err(PacketError::NotFinite { field: "rpm" }));
}

#[test]
fn an_engine_that_stops_gets_cold_and_loses_its_pressures() {
    let mut outputs = Outputs::default();
    outputs.air.temperature_k = 288.15;
    outputs.engines.available_w = 1e6;
    outputs.engines.power_w = Pair { left: 0.0, right: 9e5 };
    let packet = sent(&outputs);
    let of = |field: [F32; ENGINES_MAX]| [field[0].get(), field[1].get()];
    assert!(near(packet.egt_degf[0], 59.0) && packet.egt_degf[1].get() > 900.0);
    assert!(near(packet.oil_temp_degf[0], 59.0) && packet.oil_temp_degf[1].get() > 140.0);
    for pressures in [of(packet.oil_px_psi), of(packet.fuel_px_psi)] {
        assert!(pressures[0].abs() < 1e-6 && pressures[1] > 10.0, "{pressures:?}");
    }
}

/// 400 °C at no power and 600 °C at all of it on a standard day, and with the air.
#[test]
fn an_engine_gets_hotter_with_its_power_and_the_air() {
    let rated_w = xv15().engines.rated_power_w;
    let mut outputs = Outputs::default();
    outputs.engines.available_w = rated_w;
    for (air_c, part, exhaust_c, oil_c) in
        [(15.0, 1.0, 600.0, 85.0), (15.0, 0.5, 500.0, 72.5), (25.0, 0.5, 510.0, 82.5)]
    {
        outputs.air.temperature_k = air_c + 273.15;
        outputs.engines.power_w = Pair { left: rated_w, right: part * rated_w };
        let packet = sent(&outputs);
        let degf = |c: f64| c * 9.0 / 5.0 + 32.0;
        assert!(near(packet.egt_degf[1], degf(exhaust_c)), "{}", packet.egt_degf[1]);
        assert!(near(packet.oil_temp_degf[1], degf(oil_c)), "{}", packet.oil_temp_degf[1]);
    }
}

#[test]
fn the_nose_wheel_casters_along_its_way_and_is_straight_in_the_air() {
    let mut outputs =
        Outputs { body_velocity_mps: Vec3::new(10.0, 5.0, 0.0), ..Outputs::default() };
    assert!(near(sent(&outputs).nose_wheel_norm, 0.0));
    outputs.landing_gear.nose.push_n = 1.0;
    assert!(near(sent(&outputs).nose_wheel_norm, atan2(5.0, 10.0)));
    outputs.body_velocity_mps = Vec3::new(-10.0, -5.0, 0.0);
    assert!(near(sent(&outputs).gear_steer_norm[0], atan2(5.0, 10.0)), "backwards it trails");
    outputs.body_velocity_mps = Vec3::new(0.1, 0.1, 0.0);
    assert!(near(sent(&outputs).nose_wheel_norm, 0.0), "at rest");
}

#[test]
fn between_two_packets_is_between_them_also_over_north_and_the_date_line() {
    let at = |longitude_rad, heading_rad, height_m| {
        let place = Geodetic { longitude_rad, height_m, ..Geodetic::default() };
        let euler = Euler { heading_rad, ..Euler::default() };
        sent(&Outputs { place, euler, ..Outputs::default() })
    };
    let (a, b) = (at(PI - 0.001, -0.02, 10.0), at(-PI + 0.003, 0.04, 20.0));
    assert_eq!(NetFdm::between(&a, &b, 0.0), a);
    let middle = NetFdm::between(&a, &b, 0.5);
    assert!((middle.altitude_m.get() - 15.0).abs() < 1e-9);
    assert!((f64::from(middle.psi_rad.get()) - 0.01).abs() < 1e-5, "{:?}", middle.psi_rad);
    let beyond_deg = middle.longitude_deg().abs() - 180.0;
    assert!((beyond_deg + 0.001 * DEG_PER_RAD).abs() < 1e-6, "{}", middle.longitude_deg());
    assert_eq!(NetFdm::parse(middle.bytes()), Ok(middle));
}
