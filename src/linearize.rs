//! `tiltrotor linearize`.

use std::fs;
use std::path::PathBuf;

use anyhow::{Context, Result};
use engine::dense::Matrix;
use engine::linearize::{Linear, decibels, linearize};
use engine::modes::modes;
use engine::trim::trim;
use engine::units::{DEG_PER_RAD as DEG, INCH_M};

use crate::condition::Condition;
use crate::status::Status;

/// About which steady flight.
#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    condition: Condition,
    /// Print the matrices A, B, C, D too (SI and rad)
    #[arg(long)]
    matrices: bool,
    /// Print the modes of rotors, inflow and actuators too
    #[arg(long)]
    fast: bool,
    /// Print frequency responses
    #[arg(long)]
    response: bool,
    /// Write the matrices to a file, one number a line, units in the names
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// A response that is printed: input, output, names, factor to the printed unit.
struct Response {
    input: usize,
    output: usize,
    name: &'static str,
    unit: &'static str,
    factor: f64,
}

const RESPONSES: [Response; 4] = [
    Response {
        input: 0,
        output: 4,
        name: "aft stick to pitch rate",
        unit: "deg/s/in",
        factor: DEG * INCH_M,
    },
    Response {
        input: 1,
        output: 3,
        name: "right stick to roll rate",
        unit: "deg/s/in",
        factor: DEG * INCH_M,
    },
    Response {
        input: 2,
        output: 5,
        name: "right pedal to yaw rate",
        unit: "deg/s/in",
        factor: DEG * INCH_M,
    },
    Response {
        input: 3,
        output: 10,
        name: "lever to downward force",
        unit: "g/in",
        factor: INCH_M / engine::GRAVITY_MPS2,
    },
];

/// Frequencies of the table, rad/s.
const OMEGAS: [f64; 11] = [0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 10.0];

/// Trims, linearises, and prints modes and matrices.
pub fn run(args: &Args) -> Result<Status> {
    let (aircraft, target) = args.condition.read()?;
    let trim = trim(&aircraft, &target).map_err(anyhow::Error::new).context("no steady flight")?;
    let linear = linearize(&aircraft, &trim, &target.world);
    say!(
        "about {:.1} kt, nacelles {:.0} deg, pitch {:.2} deg, SCAS {}",
        args.condition.speed_kt,
        args.condition.nacelle,
        trim.report.pitch_rad * DEG,
        if args.condition.scas { "on" } else { "off" }
    );
    say!("{:<28} {:>20} {:>9} {:>7} {:>9}  led by", "mode", "eigenvalue", "omega", "zeta", "tau");
    say!("{:<28} {:>20} {:>9} {:>7} {:>9}", "", "1/s", "rad/s", "-", "s");
    for mode in modes(&linear, target.airspeed_mps) {
        if mode.fast && !args.fast {
            continue;
        }
        let value = if mode.swings() {
            format!("{:.4} ± {:.4}j", mode.eigenvalue.re, mode.eigenvalue.im)
        } else {
            format!("{:.4}", mode.eigenvalue.re)
        };
        say!(
            "{:<28} {value:>20} {:>9.3} {:>7.3} {:>9.2}  {}",
            mode.name,
            mode.frequency_radps(),
            mode.damping(),
            mode.time_s(),
            mode.state
        );
    }
    if args.response {
        responses(&linear);
    }
    if args.matrices {
        for (name, matrix, rows, columns) in named(&linear) {
            say!("\n{name} (rows: {})", rows.join(", "));
            say!("  columns: {}", columns.join(", "));
            for row in 0..matrix.rows() {
                let numbers: Vec<String> =
                    matrix.row(row).iter().map(|value| format!("{value:12.5e}")).collect();
                say!("  {}", numbers.join(" "));
            }
        }
    }
    if let Some(path) = &args.csv {
        fs::write(path, csv(&linear))
            .with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(Status::Done)
}

fn responses(linear: &Linear) {
    for response in &RESPONSES {
        say!("\n{}", response.name);
        say!("{:>9} {:>12} {:>9}", "rad/s", format!("dB {}", response.unit), "deg");
        for omega in OMEGAS {
            let g = linear.response(response.input, response.output, omega);
            let gain_db = decibels(g.abs() * response.factor);
            say!("{omega:>9.2} {gain_db:>12.1} {:>9.0}", g.arg_rad() * DEG);
        }
    }
}

type Named<'a> = (&'static str, &'a Matrix, &'a [String], &'a [String]);

fn named(linear: &Linear) -> [Named<'_>; 4] {
    [
        ("A", &linear.a, &linear.states, &linear.states),
        ("B", &linear.b, &linear.states, &linear.inputs),
        ("C", &linear.c, &linear.outputs, &linear.states),
        ("D", &linear.d, &linear.outputs, &linear.inputs),
    ]
}

fn csv(linear: &Linear) -> String {
    let mut text = String::from("matrix,row,column,value\n");
    for (name, matrix, rows, columns) in named(linear) {
        for (i, row) in rows.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                text += &format!("{name},{row},{column},{}\n", matrix[(i, j)]);
            }
        }
    }
    text
}
