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
