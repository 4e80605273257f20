//! `tiltrotor trim`.

use std::path::PathBuf;

use analysis::trim::{Failure, ROOT_FROM_THREE_QUARTERS_RAD, Target, Trim, trim, trim_near};
use anyhow::Result;
use engine::units::{DEG_PER_RAD as DEG, FOOT_M, HOUR_S, INCH_M, KNOT_MPS, POUND_KG, POUND_N};
use logs::output;

use crate::condition::{Condition, sweep};
use crate::numbers;
use crate::status::Status;

/// Which steady flight, or flights.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    condition: Condition,
    /// Speeds FROM:TO:STEP instead of one, kt
    #[arg(long, value_name = "KT:KT:KT", value_parser = Sweep::parse, allow_hyphen_values = true, conflicts_with = "speed_kt")]
    sweep: Option<Sweep>,
    /// Write the table to a file too, units in the names
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// The speeds of a sweep.
#[derive(Clone)]
struct Sweep(Vec<f64>);

impl Sweep {
    fn parse(text: &str) -> Result<Self, String> {
        let speeds_kt = sweep(text)?;
        let (least, greatest) = numbers::SPEED_KT;
        if speeds_kt.iter().all(|speed_kt| (least..=greatest).contains(speed_kt)) {
            Ok(Self(speeds_kt))
        } else {
            Err(format!("expected speeds of {least} to {greatest} kt"))
        }
    }
}

/// One number of a trim.
struct Column {
    /// What it is.
    name: &'static str,
    /// Its unit.
    unit: &'static str,
    /// Digits behind the point.
    digits: usize,
    /// The number.
    of: fn(&Trim) -> f64,
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
const COLUMNS: [Column; 23] = [
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
    fn value(&self, trim: &Trim) -> String {
        let value = (self.of)(trim);
        let text = format!("{value:.*}", self.digits);
        // Nothing below zero is nothing.
        if text.trim_start_matches(['-', '0', '.']).is_empty() {
            format!("{:.*}", self.digits, 0.0)
        } else {
            text
        }
    }

    fn key(&self) -> String {
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

/// Trims, and prints a list or a table.
pub fn run(args: &Args) -> Result<Status> {
    if let Some(path) = &args.csv {
        output::refuse(path, true, &args.condition.files())?;
    }
    let (aircraft, target) = args.condition.read()?;
    let speeds_kt = match &args.sweep {
        Some(Sweep(speeds)) => speeds.clone(),
        None => vec![args.condition.speed_kt],
    };
    let mut near: Option<Trim> = None;
    let mut rows = Vec::new();
    for speed_kt in speeds_kt {
        let target = Target { airspeed_mps: speed_kt * KNOT_MPS, ..target };
        let found = match &near {
            Some(near) => trim_near(&aircraft, &target, near),
            None => trim(&aircraft, &target),
        };
        if let Ok(trim) = &found {
            near = Some(trim.clone());
        }
        rows.push((speed_kt, found));
    }
    if let Some(path) = &args.csv {
        output::write(path, &csv(&rows), &args.condition.files())?;
    }
    if args.sweep.is_some() {
        table(&rows);
    } else {
        list(&rows[0].1);
    }
    let steady = rows.iter().all(|(_, found)| found.is_ok());
    Ok(if steady { Status::Done } else { Status::NotConverged })
}

/// A row of a sweep: the speed, and what was found.
type Row = (f64, Result<Trim, Failure>);

/// What there is to show of a row: beyond the aircraft's means there is a flight too.
fn shown(found: &Result<Trim, Failure>) -> Option<&Trim> {
    match found {
        Ok(trim) => Some(trim),
        Err(Failure::Beyond { trim, .. }) => Some(trim),
        Err(Failure::Unsteady { .. } | Failure::Senseless(_)) => None,
    }
}

fn list(found: &Result<Trim, Failure>) {
    if let Some(trim) = shown(found) {
        for column in &COLUMNS {
            say!("{:<14} {:>9} {}", column.name, column.value(trim), column.unit);
        }
    }
    if let Err(failure) = found {
        say!("NO TRIM: {failure}");
    }
}

fn table(rows: &[Row]) {
    let width = |column: &Column| column.name.len().max(column.unit.len()).max(7);
    let line = |cell: &dyn Fn(&Column) -> String| {
        let cells: Vec<String> =
            COLUMNS.iter().map(|c| format!("{:>1$}", cell(c), width(c))).collect();
        cells.join("  ")
    };
    say!("{}", line(&|column| column.name.into()));
    say!("{}", line(&|column| column.unit.into()));
    for (speed_kt, found) in rows {
        match (shown(found), found) {
            (Some(trim), Ok(_)) => say!("{}", line(&|column| column.value(trim))),
            (Some(trim), Err(why)) => {
                say!("{}  NO TRIM: {why}", line(&|column| column.value(trim)));
            }
            (None, Err(why)) => say!("{speed_kt:>7.1}  NO TRIM: {why}"),
            (None, Ok(_)) => {}
        }
    }
}

fn csv(rows: &[Row]) -> String {
    let names: Vec<String> = COLUMNS.iter().map(Column::key).collect();
    let mut text = format!("{},trimmed\n", names.join(","));
    for (speed_kt, found) in rows {
        let numbers: Vec<String> = match shown(found) {
            Some(trim) => COLUMNS.iter().map(|column| format!("{}", (column.of)(trim))).collect(),
            None => {
                let blank = COLUMNS[1..].iter().map(|_| String::new());
                std::iter::once(format!("{speed_kt}")).chain(blank).collect()
            }
        };
        text += &format!("{},{}\n", numbers.join(","), u8::from(found.is_ok()));
    }
    text
}
