//! Hover with the flaps at five settings.

use analysis::trim::{Target, Trim, trim};
use engine::Aircraft;
use engine::math::pow_positive;
use engine::units::HORSEPOWER_W;

use crate::book::{Band, Book, Case, Class, DEG, RPM_RADPS};
use crate::fits::Fit;
use crate::weighing;

/// A hover of NASA CR-176970: flaps over the full span, deg; weight, lb; density over that at sea level;
/// rotor speed, rpm; shaft power of a rotor, hp, mean of the runs; download, % of thrust.
struct Hover {
    full_span_deg: f64,
    weight_lb: f64,
    density_norm: f64,
    rotor_speed_rpm: f64,
    power_hp: f64,
    download_percent: f64,
}

const fn hover(
    full_span_deg: f64,
    weight_lb: f64,
    density_norm: f64,
    rotor_speed_rpm: f64,
    power_hp: f64,
    download_percent: f64,
) -> Hover {
    Hover { full_span_deg, weight_lb, density_norm, rotor_speed_rpm, power_hp, download_percent }
}

/// Tables 1 and 5.
const HOVERS: [Hover; 5] = [
    hover(0.0, 13_550.0, 0.9917, 587.0, 1089.0, 13.2),
    hover(20.0, 13_537.0, 0.9917, 587.0, 1061.0, 11.9),
    hover(40.0, 13_657.0, 0.9955, 587.0, 1052.0, 10.3),
    hover(50.0, 13_673.0, 0.9917, 587.0, 1032.0, 9.4),
    hover(60.0, 13_614.0, 0.9936, 588.0, 1008.0, 8.5),
];

/// Mean deflection of flap and flaperon by their areas, 4.25 and 7.86 ft² a side, for each degree of flap: the
/// flaperon droops by .625 of it.
const MEAN_PER_FLAP: f64 = (4.25 + 0.625 * 7.86) / (4.25 + 7.86);

impl Hover {
    /// Where the standard atmosphere has that density, m: ISO 2533, ρ/ρ0 = (1 − 2.25577e-5·h)^4.2561.
    fn altitude_m(&self) -> f64 {
        (1.0 - pow_positive(self.density_norm, 1.0 / 4.2561)) / 2.25577e-5
    }

    fn ours(&self, aircraft: &Aircraft) -> Result<Trim, String> {
        let (aircraft, fuel_kg) = weighing(aircraft, self.weight_lb);
        let aircraft = aircraft.with(|a| {
            a.fcc.governor.rotor_speed_radps[0] = self.rotor_speed_rpm * RPM_RADPS;
            a.fcc.mixer.flap_rad[2] = self.full_span_deg / MEAN_PER_FLAP / DEG;
        });
        let altitude_m = self.altitude_m();
        let target = Target { altitude_m, fuel_kg, flap_detent: 2, ..Target::default() };
        trim(&aircraft, &target).map_err(|failure| failure.to_string())
    }
}

/// Case 16.
pub fn by_flap(aircraft: &Aircraft, book: &mut Book) {
    let mut case = Case::new(
        16,
        Class::A,
        "hover by flap, out of ground effect",
        "NASA CR-176970 Tables 1 and 5: power at the masts and what follows of download.",
    )
    .tolerance(
        "Power ±5 %, as for other hovers; download ±1 % of thrust, what the report's own ways to \
         it spread over.",
    )
    .set_up(
        "Weight, density and rotor speed are those of each setting (13,537 to 13,673 lb, 587 \
         rpm). The aircraft flew with flaps and flaperons as one over the full span. Ours has \
         their ratio of .625, and flies the flap whose mean deflection by area is the same: .757 \
         of the flap's. The lowest, 60 deg, would be a flap of 79; ours ends at 75, 57 deg. The \
         wing's drag across the flow is the tunnel's (Table 4) with flaps up and full down, and \
         CR-166536's between, which agrees with the tunnel's by the same mean to .02.",
    );
    for hover in &HOVERS {
        let found = hover.ours(aircraft);
        let of = |f: &dyn Fn(&Trim) -> f64| found.as_ref().map(f).map_err(Clone::clone);
        let name = format!("flaps {:.0} deg", hover.full_span_deg);
        let power_kw = of(&|t| 1e-3 * t.report.power_w);
        let published_kw = 2.0 * hover.power_hp * 1e-3 * HORSEPOWER_W;
        case.row(format!("{name}: power, kW"), published_kw, power_kw, Band::Part(0.05), 0)
            .fitted(&[Fit::Recirculation]);
        let download = of(&|t| 100.0 * t.report.download_n / t.report.thrust_n.sum());
        case.row(
            format!("{name}: download, % of thrust"),
            hover.download_percent,
            download,
            Band::Within(1.0),
            1,
        );
    }
    book.add(case);
}
