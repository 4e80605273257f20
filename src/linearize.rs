//! `tiltrotor linearize`.

use std::path::PathBuf;

use analysis::linearize::{INPUTS, Linear, OUTPUTS, decibels, linearize};
use analysis::modes::{Mode, modes};
use analysis::trim::{Trim, trim};
use analysis::{Complex, Matrix, Polar, Unsolved};
use anyhow::Result;
use engine::units::{DEG_PER_RAD as DEG, INCH_M};
use logs::output;

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
    /// Write matrices and eigenvalues to a file, one number a line, units in the names
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
    if let Some(path) = &args.csv {
        output::refuse(path, true, &args.condition.files())?;
    }
    let (aircraft, target) = args.condition.read()?;
    let trim = match trim(&aircraft, &target) {
        Ok(trim) => trim,
        Err(failure) => return Ok(unsolved(&format!("no steady flight: {failure}"))),
    };
    let linear = linearize(&aircraft, &trim, &target.world);
    match Found::new(args, &linear, target.airspeed_mps) {
        Ok(found) => {
            found.print(args, &trim, &linear);
            if let Some(path) = &args.csv {
                let text = csv(&linear, &found.eigenvalues);
                output::write(path, &text, &args.condition.files())?;
            }
            Ok(Status::Done)
        }
        Err(why) => Ok(unsolved(&why.to_string())),
    }
}

/// Says that there is no answer; nothing of it is printed or written.
fn unsolved(why: &str) -> Status {
    complain!("tiltrotor: {why}");
    Status::NotConverged
}

/// What is found of a linear system.
struct Found {
    eigenvalues: Vec<Complex>,
    modes: Vec<Mode>,
    /// Of each of [`RESPONSES`], over [`OMEGAS`]; none when not asked for.
    responses: Vec<Vec<Complex>>,
}

impl Found {
    fn new(args: &Args, linear: &Linear, airspeed_mps: f64) -> Result<Self, Unsolved> {
        let over = |response: &Response| {
            let at = |&omega: &f64| linear.response(response.input, response.output, omega);
            OMEGAS.iter().map(at).collect()
        };
        let asked = if args.response { &RESPONSES[..] } else { &[] };
        Ok(Self {
            eigenvalues: linear.eigenvalues()?,
            modes: modes(linear, airspeed_mps)?,
            responses: asked.iter().map(over).collect::<Result<_, _>>()?,
        })
    }

    fn print(&self, args: &Args, trim: &Trim, linear: &Linear) {
        say!(
            "about {:.1} kt, nacelles {:.0} deg, pitch {:.2} deg, SCAS {}",
            args.condition.speed_kt,
            args.condition.nacelle,
            trim.report.pitch_rad * DEG,
            if args.condition.scas { "on" } else { "off" }
        );
        say!(
            "{:<28} {:>20} {:>9} {:>7} {:>9}  led by",
            "mode",
            "eigenvalue",
            "omega",
            "zeta",
            "tau"
        );
        say!("{:<28} {:>20} {:>9} {:>7} {:>9}", "", "1/s", "rad/s", "-", "s");
        for mode in self.modes.iter().filter(|mode| args.fast || !mode.fast) {
            line(mode);
        }
        for (response, over) in RESPONSES.iter().zip(&self.responses) {
            say!("\n{}", response.name);
            say!("{:>9} {:>12} {:>9}", "rad/s", format!("dB {}", response.unit), "deg");
            for (omega, g) in OMEGAS.iter().zip(over) {
                let gain_db = decibels(g.magnitude() * response.factor);
                say!("{omega:>9.2} {gain_db:>12.1} {:>9.0}", g.phase_rad() * DEG);
            }
        }
        if args.matrices {
            matrices(linear);
        }
    }
}

fn line(mode: &Mode) {
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

fn matrices(linear: &Linear) {
    for (name, matrix, rows, columns) in named(linear) {
        say!("\n{name} (rows: {})", rows.join(", "));
        say!("  columns: {}", columns.join(", "));
        for row in matrix.row_iter() {
            let numbers: Vec<String> = row.iter().map(|value| format!("{value:12.5e}")).collect();
            say!("  {}", numbers.join(" "));
        }
    }
}

/// A matrix with its name and those of its rows and columns.
type Named<'a> = (&'static str, &'a Matrix, Vec<String>, Vec<String>);

fn named(linear: &Linear) -> [Named<'_>; 4] {
    let states = || linear.states.iter().map(ToString::to_string).collect();
    let inputs = || INPUTS.iter().map(ToString::to_string).collect();
    let outputs = || OUTPUTS.iter().map(ToString::to_string).collect();
    [
        ("A", &linear.a, states(), states()),
        ("B", &linear.b, states(), inputs()),
        ("C", &linear.c, outputs(), states()),
        ("D", &linear.d, outputs(), inputs()),
    ]
}

/// Every number to the bit: the matrices, then all eigenvalues of A, numbered from the slowest.
fn csv(linear: &Linear, eigenvalues: &[Complex]) -> String {
    let mut text = String::from("matrix,row,column,value\n");
    for (name, matrix, rows, columns) in named(linear) {
        for (i, row) in rows.iter().enumerate() {
            for (j, column) in columns.iter().enumerate() {
                text += &format!("{name},{row},{column},{}\n", matrix[(i, j)]);
            }
        }
    }
    for (i, eigenvalue) in eigenvalues.iter().enumerate() {
        text += &format!("eigenvalue,{i},re_per_s,{}\n", eigenvalue.re);
        text += &format!("eigenvalue,{i},im_radps,{}\n", eigenvalue.im);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Controls move in m and answers are in rad and m/s²: an inch of the control is .0254 m, a radian 57.29578
    /// deg, and 1 g 9.80665 m/s².
    #[test]
    fn responses_are_told_of_an_inch_of_the_control_that_they_name() {
        let rate = 57.295_779_513 * 0.0254;
        for (response, (input, output, unit, factor)) in RESPONSES.iter().zip([
            ("stick_aft_m", "pitch_rate_radps", "deg/s/in", rate),
            ("stick_right_m", "roll_rate_radps", "deg/s/in", rate),
            ("pedal_right_m", "yaw_rate_radps", "deg/s/in", rate),
            ("lever_m", "specific_force_down_mps2", "g/in", 0.0254 / 9.80665),
        ]) {
            let Response { name, .. } = response;
            assert_eq!(INPUTS[response.input], input, "{name}");
            assert_eq!(OUTPUTS[response.output], output, "{name}");
            assert_eq!(response.unit, unit, "{name}");
            assert!((response.factor / factor - 1.0).abs() < 1e-9, "{name}: {}", response.factor);
        }
    }
}
