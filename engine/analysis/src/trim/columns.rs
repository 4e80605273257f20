//! A trim as a table: its numbers by name, in a pilot's units.

use alloc::format;
use alloc::string::String;

use engine::units::{DEG_PER_RAD as DEG, FOOT_M, HOUR_S, INCH_M, KNOT_MPS, POUND_KG, POUND_N};

use super::{ROOT_FROM_THREE_QUARTERS_RAD, Trim};

/// One number of a trim.
pub struct Column {
    /// What it is.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Digits behind the point.
    pub digits: usize,
    /// The number.
    pub of: fn(&Trim) -> f64,
}

const fn column(
    name: &'static str,
    unit: &'static str,
    digits: usize,
    of: fn(&Trim) -> f64,
) -> Column {
    Column { name, unit, digits, of }
}

/// Everything that is told of a trim.
pub const COLUMNS: [Column; 23] = [
    column("speed", "kt", 1, |t| t.outputs.airspeed_mps / KNOT_MPS),
    column("nacelle", "deg", 1, |t| 90.0 - t.state.actuators.mast_tilt_rad.mean() * DEG),
    column("climb", "ft/min", 0, |t| t.report.climb_mps / FOOT_M * 60.0),
    column("pitch", "deg", 2, |t| t.report.pitch_rad * DEG),
    column("roll", "deg", 2, |t| t.report.roll_rad * DEG),
    column("alpha", "deg", 2, |t| t.report.alpha_rad * DEG),
    column("beta", "deg", 2, |t| t.report.beta_rad * DEG),
    column("stick", "in", 2, |t| t.report.stick_from_aft_m / INCH_M),
    column("stick forward", "%", 1, |t| 100.0 * t.report.stick_forward_norm),
    column("stick right", "in", 2, |t| t.report.stick_right_m / INCH_M),
    column("pedal right", "in", 2, |t| t.report.pedal_right_m / INCH_M),
    column("lever", "%", 1, |t| 100.0 * t.report.lever_norm),
    column("collective", "deg", 2, |t| t.report.collective_rad * DEG),
    column("at the root", "deg", 2, |t| {
        (t.report.collective_rad + ROOT_FROM_THREE_QUARTERS_RAD) * DEG
    }),
    column("cyclic B1", "deg", 2, |t| t.report.cyclic_forward_rad * DEG),
    column("elevator", "deg", 2, |t| t.report.elevator_rad * DEG),
    column("thrust left", "lbf", 0, |t| t.report.thrust_n.left / POUND_N),
    column("thrust right", "lbf", 0, |t| t.report.thrust_n.right / POUND_N),
    column("power", "kW", 0, |t| 1e-3 * t.report.power_w),
    column("available", "kW", 0, |t| 1e-3 * t.report.available_w),
    column("mast torque", "kN m", 2, |t| 1e-3 * t.report.torque_n_m),
    column("fuel", "lb/h", 0, |t| t.report.fuel_flow_kg_per_s * HOUR_S / POUND_KG),
    column("download", "lbf", 0, |t| t.report.download_n / POUND_N),
];

impl Column {
    /// Its value in words, −0 as 0.
    pub fn value(&self, trim: &Trim) -> String {
        let value = (self.of)(trim);
        let text = format!("{value:.*}", self.digits);
        // Nothing below zero is nothing.
        if text.trim_start_matches(['-', '0', '.']).is_empty() {
            format!("{:.*}", self.digits, 0.0)
        } else {
            text
        }
    }

    /// Its name and unit in tables for machines.
    pub fn key(&self) -> String {
        let unit = match self.unit {
            "ft/min" => "fpm",
            "%" => "percent",
            "kN m" => "kn_m",
            "lb/h" => "lb_per_h",
            "kW" => "kw",
            unit => unit,
        };
        format!("{}_{unit}", self.name.to_lowercase().replace(' ', "_"))
    }
}

#[cfg(test)]
mod tests {
    use engine::pair::Pair;
    use engine::{Outputs, State};

    use super::super::Report;
    use super::*;

    /// A trim of which every number is one or a few of the units in which it is told.
    fn told_in_whole_units() -> Trim {
        let degrees = |whole: f64| whole / 57.295_779_513_082_32;
        let mut state = State::default();
        state.actuators.mast_tilt_rad = Pair::both(degrees(30.0));
        let outputs = Outputs { airspeed_mps: 100.0 * 1852.0 / 3600.0, ..Outputs::default() };
        let report = Report {
            pitch_rad: degrees(2.0),
            roll_rad: degrees(3.0),
            alpha_rad: degrees(4.0),
            beta_rad: degrees(5.0),
            climb_mps: 1000.0 * 0.3048 / 60.0,
            stick_from_aft_m: 6.0 * 0.0254,
            stick_forward_norm: 0.07,
            stick_right_m: 8.0 * 0.0254,
            pedal_right_m: 9.0 * 0.0254,
            lever_norm: 0.1,
            collective_rad: degrees(11.0),
            cyclic_forward_rad: degrees(12.0),
            elevator_rad: degrees(13.0),
            thrust_n: Pair { left: 14.0 * 4.448_221_615_26, right: 15.0 * 4.448_221_615_26 },
            power_w: 16e3,
            available_w: 17e3,
            torque_n_m: 18e3,
            fuel_flow_kg_per_s: 19.0 * 0.453_592_37 / 3600.0,
            download_n: 20.0 * 4.448_221_615_26,
            ..Report::default()
        };
        Trim { state, outputs, report }
    }

    #[test]
    fn every_number_is_told_in_the_unit_beside_it() {
        let trim = told_in_whole_units();
        for (name, expected) in [
            ("speed_kt", 100.0),
            ("nacelle_deg", 60.0),
            ("climb_fpm", 1000.0),
            ("pitch_deg", 2.0),
            ("roll_deg", 3.0),
            ("alpha_deg", 4.0),
            ("beta_deg", 5.0),
            ("stick_in", 6.0),
            ("stick_forward_percent", 7.0),
            ("stick_right_in", 8.0),
            ("pedal_right_in", 9.0),
            ("lever_percent", 10.0),
            ("collective_deg", 11.0),
            // From three quarters of the radius to the root.
            (
                "at_the_root_deg",
                11.0 + ROOT_FROM_THREE_QUARTERS_RAD * 180.0 / core::f64::consts::PI,
            ),
            ("cyclic_b1_deg", 12.0),
            ("elevator_deg", 13.0),
            ("thrust_left_lbf", 14.0),
            ("thrust_right_lbf", 15.0),
            ("power_kw", 16.0),
            ("available_kw", 17.0),
            ("mast_torque_kn_m", 18.0),
            ("fuel_lb_per_h", 19.0),
            ("download_lbf", 20.0),
        ] {
            let column = COLUMNS.iter().find(|column| column.key() == name);
            let found = column.map(|column| (column.of)(&trim)).expect(name);
            assert!((found - expected).abs() < 1e-6 * expected, "{name}: {found}, not {expected}");
        }
    }

    #[test]
    fn nothing_below_zero_is_nothing() {
        let mut trim = told_in_whole_units();
        let roll = &COLUMNS[4];
        for (roll_deg, told) in
            [(-0.001, "0.00"), (0.0, "0.00"), (-0.01, "-0.01"), (-10.0, "-10.00")]
        {
            trim.report.roll_rad = roll_deg / DEG;
            assert_eq!(roll.value(&trim), told);
        }
    }
}
