//! The isolated rotor in wind: as an aeroplane, tilted, and in hover, against another simulation.

use engine::Aircraft;
use engine::frames::Vec3;
use engine::isa::{DENSITY_SL_KG_PER_M3, SOUND_SPEED_SL_MPS};
use engine::math::{cos, sin};
use engine::motion::Motion;
use engine::rotors::{self, Inputs, Outputs, Params, State};

use crate::book::{Band, Book, Case, Class, DEG};

/// One point of the source.
struct Point {
    mode: &'static str,
    /// Between the mast and the wind: 0 as an aeroplane, 90 in edgewise flight.
    from_wind_deg: f64,
    /// V over the tip's speed.
    advance: f64,
    /// θ0 of the source.
    collective_deg: f64,
    thrust_n: f64,
    power_w: f64,
}

const fn point(
    mode: &'static str,
    from_wind_deg: f64,
    advance: f64,
    collective_deg: f64,
    thrust_n: f64,
    power_w: f64,
) -> Point {
    Point { mode, from_wind_deg, advance, collective_deg, thrust_n, power_w }
}

/// NASA CR-2016-219086, table of the steady results; in hover those with its stall delay.
const POINTS: [Point; 24] = [
    point("aeroplane", 0.0, 0.40, 23.0, 2906.0, 276_200.0),
    point("aeroplane", 0.0, 0.40, 25.0, 8577.0, 710_100.0),
    point("aeroplane", 0.0, 0.70, 37.0, 1369.0, 303_600.0),
    point("aeroplane", 0.0, 0.70, 38.5, 7193.0, 1_054_000.0),
    point("aeroplane", 0.0, 0.70, 40.5, 14_710.0, 2_073_000.0),
    point("tilted", 15.0, 0.32, 17.5, 6133.0, 476_500.0),
    point("tilted", 15.0, 0.32, 18.5, 10_090.0, 755_900.0),
    point("tilted", 15.0, 0.32, 20.0, 16_000.0, 1_193_000.0),
    point("tilted", 30.0, 0.32, 15.0, 7030.0, 417_400.0),
    point("tilted", 30.0, 0.32, 16.0, 10_950.0, 664_400.0),
    point("tilted", 30.0, 0.32, 17.5, 16_730.0, 1_046_000.0),
    point("tilted", 60.0, 0.32, 7.0, 11_490.0, 390_400.0),
    point("tilted", 60.0, 0.32, 9.0, 18_650.0, 691_100.0),
    point("tilted", 60.0, 0.32, 11.0, 25_250.0, 1_027_000.0),
    point("tilted", 75.0, 0.32, 2.0, 13_740.0, 330_400.0),
    point("tilted", 75.0, 0.32, 4.0, 20_410.0, 511_700.0),
    point("tilted", 75.0, 0.27, 1.0, 12_090.0, 267_300.0),
    point("tilted", 75.0, 0.27, 3.0, 18_570.0, 409_900.0),
    point("tilted", 75.0, 0.18, 1.0, 14_900.0, 279_200.0),
    point("tilted", 75.0, 0.18, 3.0, 20_530.0, 398_200.0),
    point("tilted", 75.0, 0.18, 5.0, 25_960.0, 551_900.0),
    point("hover", 90.0, 0.0, 0.0, 16_820.0, 290_300.0),
    point("hover", 90.0, 0.0, 4.0, 28_000.0, 561_700.0),
    point("hover", 90.0, 0.0, 8.0, 39_620.0, 994_500.0),
];

/// θ¾ less θ0 of the source.
const THREE_QUARTERS_DEG: f64 = 6.61;

/// Ticks until the rotor has settled at its thrust.
const TICKS: usize = 6000;

impl Point {
    fn tip_mps(&self) -> f64 {
        match self.mode {
            "aeroplane" => 183.76,
            "tilted" => 221.17,
            _ => 225.55,
        }
    }

    /// The author's own offset from tests and from another code.
    fn part(&self) -> f64 {
        if self.mode == "hover" { 0.03 } else { 0.05 }
    }

    fn name(&self) -> String {
        let Self { mode, from_wind_deg, advance, thrust_n, .. } = self;
        let wind = match *mode {
            "aeroplane" => format!(", V/ΩR {advance:.2}"),
            "tilted" => format!(" {from_wind_deg:.0} deg, V/ΩR {advance:.2}"),
            _ => String::new(),
        };
        format!("{mode}{wind}, {thrust_n:.0} N")
    }

    /// The rotor with the point's thrust, its tip path held square to the mast by cyclic.
    fn ours(&self, params: &Params) -> (Inputs, Outputs) {
        let wind_mps = self.advance * self.tip_mps();
        let from_wind = self.from_wind_deg / DEG;
        let mut inputs = Inputs {
            motion: Motion {
                cg_m: params.pivot_m,
                airspeed_mps: Vec3::new(wind_mps * sin(from_wind), 0.0, -wind_mps * cos(from_wind)),
                angular_rate_radps: Vec3::zero(),
                density_kg_per_m3: DENSITY_SL_KG_PER_M3,
            },
            sound_speed_mps: SOUND_SPEED_SL_MPS,
            mast_tilt_rad: 0.0,
            mast_tilt_rate_radps: 0.0,
            rotor_speed_radps: self.tip_mps() / params.radius_m,
            collective_rad: (self.collective_deg + THREE_QUARTERS_DEG) / DEG,
            cyclic_forward_rad: 0.0,
            cyclic_outboard_rad: 0.0,
            hub_height_m: 1e9,
            other_induced_mps: 0.0,
        };
        let blade = params.blade();
        let (mut state, mut out) = (State::default(), Outputs::default());
        for _ in 0..TICKS {
            (state, out) = rotors::evaluate(params, &blade, &state, &inputs);
            inputs.collective_rad += 1e-7 * (self.thrust_n - out.thrust_n);
            inputs.cyclic_forward_rad += 0.005 * out.tilt_aft_rad;
            inputs.cyclic_outboard_rad -= 0.005 * out.tilt_outboard_rad;
        }
        (inputs, out)
    }
}

/// Case 17.
pub fn in_wind(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        17,
        Class::B,
        "isolated rotor as an aeroplane, tilted, and in hover",
        "NASA CR-2016-219086, steady results: the rotor as a source of momentum in a flow solver, with \
         section tables of its own.",
    )
    .tolerance(
        "Power ±5 %, in hover ±3 %: what its author gives as the offset from tests. Collective ±1 \
         deg, as everywhere.",
    )
    .set_up(
        "Compared at the published thrust, at sea level, tip speeds 183.76 m/s (aeroplane), \
         221.17 (tilted) and 225.55 (hover). The source counts collective from another zero, \
         theta at 3/4 radius is its theta_0 + 6.61 deg, and says that no program is known to \
         match thrust, power and collective at once. The tip path is held square to the mast by \
         cyclic, which the source does not say of itself. Its stall delay is in the hover alone, \
         its hover without tip loss.",
    )
    .misses(
        "As an aeroplane the power agrees, at V/ΩR .70 and 1,369 N too, where two fifths of it \
         are lost in the blades' drag: the rotor is not what cases 4, 15 and 19 lack. The misses \
         in power at 30 to 75 deg are not the stall delay's, without which they are the same to 1 \
         %. A flapping disc held square by cyclic and a rigid one without cyclic differ most \
         there.",
    )
    .settled_by(
        "The source's cyclic and flapping.",
    );
    let stand = aircraft.clone().with(|stand| {
        // On the stand there is no wing, and no other rotor; its mast is where the angles say.
        stand.rotors.inflow.recirculation = 0.0;
        stand.rotors.mast_cant_rad = 0.0;
    });
    for point in &POINTS {
        let (inputs, out) = point.ours(&stand.rotors);
        let name = point.name();
        let reached = (out.thrust_n / point.thrust_n - 1.0).abs() < 1e-3;
        let of = |value: f64| {
            if reached { Ok(value) } else { Err("the rotor does not reach this thrust".to_owned()) }
        };
        let power_kw = of(1e-3 * out.power_w);
        case.row(
            format!("{name}: power, kW"),
            1e-3 * point.power_w,
            power_kw,
            Band::Part(point.part()),
            0,
        );
        let collective_deg = of(inputs.collective_rad * DEG - THREE_QUARTERS_DEG);
        case.row(
            format!("{name}: theta_0, deg"),
            point.collective_deg,
            collective_deg,
            Band::Within(1.0),
            2,
        );
    }
    book.add(case);
}
