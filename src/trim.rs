//! `tiltrotor trim`.

use std::path::PathBuf;

use analysis::trim::{COLUMNS, Column, Failure, Target, Trim, trim, trim_near};
use anyhow::Result;
use engine::units::KNOT_MPS;
use logs::output;

use crate::condition::{Condition, sweep};
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
        let (least, greatest) = analysis::condition::limits::SPEED_KT;
        if speeds_kt.iter().all(|speed_kt| (least..=greatest).contains(speed_kt)) {
            Ok(Self(speeds_kt))
        } else {
            Err(format!("expected speeds of {least} to {greatest} kt"))
        }
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
