//! Descent as an aeroplane with the engines at idle.

use analysis::trim::{Power, Target, Trim, trim};
use engine::Aircraft;

use crate::book::{Band, Book, Case, Class, DEG, FOOT_M, KNOT_MPS};
use crate::trims::why;

/// A descent with the lever at its bottom, at sea level.
#[derive(Clone, Copy)]
struct Descent {
    airspeed_kt: f64,
    rpm_select: u64,
    flap_detent: u64,
}

/// At 150 and 190 kt, 517 rpm, flaps up.
const ASKED: [Descent; 2] = [descent(150.0), descent(190.0)];

const fn descent(airspeed_kt: f64) -> Descent {
    Descent { airspeed_kt, rpm_select: 1, flap_detent: 0 }
}

impl Descent {
    fn trim(self, aircraft: &Aircraft) -> Result<Trim, String> {
        let Self { airspeed_kt, rpm_select, flap_detent } = self;
        let target = Target {
            mast_tilt_rad: 90.0 / DEG,
            airspeed_mps: airspeed_kt * KNOT_MPS,
            power: Power::Lever(0.0),
            flap_detent,
            rpm_select,
            ..Target::default()
        };
        trim(aircraft, &target).map_err(|failure| why(&failure))
    }

    /// ft/min.
    fn sink(self, aircraft: &Aircraft) -> Result<f64, String> {
        self.trim(aircraft).map(|trim| -trim.report.climb_mps / FOOT_M * 60.0)
    }
}

/// The sinks at both speeds, in words.
fn both(aircraft: &Aircraft, change: impl Fn(Descent) -> Descent) -> String {
    let [slow, fast] = ASKED.map(|descent| match change(descent).sink(aircraft) {
        Ok(sink) => format!("{sink:.0}"),
        Err(why) => why,
    });
    format!("{slow} and {fast}")
}

/// Case 15.
pub fn descents(aircraft: &Aircraft, book: &mut Book) {
    let same = |descent: Descent| descent;
    let still = aircraft.clone().with(|a| a.engines.idle_power_norm = 0.0);
    let set_up = "Sea level, flaps up, 517 rpm, as first flown; the source states none of it.";
    let parts = format!(
        "Part by part, ft/min at 150 and at 190 kt: {ours} as it is; {none} if the engines gave nothing at idle; \
         then {slow} at 458 rpm and {fast} at 589 rpm; then {flap_20} with flaps 20 and {flap_40} with flaps 40 \
         (beyond their 170 kt at the faster), at 517 rpm. Flaps are lowered before the reconversion by the \
         procedure of the same report.",
        ours = both(aircraft, same),
        none = both(&still, same),
        slow = both(&still, |descent| Descent { rpm_select: 2, ..descent }),
        fast = both(&still, |descent| Descent { rpm_select: 0, ..descent }),
        flap_20 = both(&still, |descent| Descent { flap_detent: 1, ..descent }),
        flap_40 = both(&still, |descent| Descent { flap_detent: 2, ..descent }),
    );
    let mut case = Case::new(
        15,
        Class::A,
        "descent as an aeroplane, power levers at idle",
        "NASA TM-81244: at least 3,000 ft/min at 150 KIAS, about 4,500 at 190.",
    )
    .tolerance("The slower one is a lower bound, the faster one \"about\": ±15 % as in case 13.")
    .set_up(set_up)
    .misses(parts)
    .misses(
        "Idle power is half of the miss: .16 of the take-off rating is no measurement but what keeps the \
         rotors at 589 rpm on the ground, at the pitch of least torque. At idle in flight less may come, but no \
         source has it; and because of its clutch an engine cannot take power from the rotors.",
    )
    .misses(
        "It is neither the windmilling rotor (at the thrust nearest to it its power is that of CR-2016-219086 to \
         4 %, case 17, aeroplane, V/ΩR .70) nor the rotor speed (250 to 350 ft/min) nor the governor, which holds \
         the rotor speed with its collective far inside its limits. What is left, 1,000 and 1,700 ft/min, would be \
         11 and 9 ft² of drag area, as much as the aeroplane has at all, against the top speed of case 7. An \
         intake's ram drag (m·V of two engines, some 100 lbf at 190 kt and idle) is not in the model.",
    )
    .settled_by("Flaps, rotor speed, weight and the torque at the masts in those descents.");
    let bands = [(3000.0, Band::AtLeast(3000.0)), (4500.0, Band::Part(0.15))];
    for (descent, (published, band)) in ASKED.into_iter().zip(bands) {
        let name = format!("{:.0} kt: sink, ft/min", descent.airspeed_kt);
        case.row(name, published, descent.sink(aircraft), band, 0);
    }
    book.add(case);
}
