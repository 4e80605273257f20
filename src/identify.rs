//! `tiltrotor identify`.

use std::path::{Path, PathBuf};

use analysis::linearize::decibels;
use anyhow::{Context, Result};
use engine::units::DEG_PER_RAD as DEG;
use logs::output;
use replay::Judgement;
use replay::identify::{Options, Point, Record, Signal, record};
use serde_json::{Value, json};

use crate::json;
use crate::numbers::between;
use crate::status::Status;
use crate::window::WindowArgs;

/// Which response, of which log.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// What moves: an input of `linearize` (stick_aft, stick_right, pedal_right, lever), or a number of
    /// the state by its name (actuators.elevator_rad)
    #[arg(long, value_name = "NAME")]
    input: String,
    /// What answers: an output of `linearize` (pitch_rate, roll_rate, specific_force_down, ...), or a number
    /// of the state
    #[arg(long, value_name = "NAME")]
    output: String,
    /// Lowest frequency, rad/s (without: the lowest that the record's length carries)
    #[arg(long, value_name = "RADPS", value_parser = between(0.001, 300.0, "rad/s"), allow_negative_numbers = true)]
    low: Option<f64>,
    /// Highest frequency, rad/s
    #[arg(long, value_name = "RADPS", default_value_t = Options::default().high_radps)]
    #[arg(value_parser = between(0.01, 190.0, "rad/s"), allow_negative_numbers = true)]
    high: f64,
    /// Frequencies in a decade
    #[arg(long, value_name = "N", default_value_t = 12.0, value_parser = between(1.0, 200.0, "frequencies"), allow_negative_numbers = true)]
    per_decade: f64,
    /// One segment length for all frequencies, s, instead of one that goes with the frequency
    #[arg(long, value_name = "SECONDS", value_parser = between(0.1, 1e5, "s"), allow_negative_numbers = true)]
    segment: Option<f64>,
    /// Write the response to a file, units in the names
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// How it is printed
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    #[command(flatten)]
    window: WindowArgs,
}

#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum Format {
    /// For people
    #[default]
    Text,
    /// For programs: docs/identify.md
    Json,
}

/// Reflies the log, and prints what its record says.
pub fn run(args: &Args) -> Result<Status> {
    let log = args.log.as_path();
    if let Some(path) = &args.csv {
        output::refuse(path, true, &[log])?;
    }
    let input = Signal::named(&args.input).context("--input")?;
    let output = Signal::named(&args.output).context("--output")?;
    let options = Options {
        low_radps: args.low,
        high_radps: args.high,
        per_decade: args.per_decade,
        segment_s: args.segment,
    };
    let window = args.window.of(log)?;
    let name = || log.display().to_string();
    let (record, judgement) = record(log, &window, input, output).with_context(name)?;
    let points = record.response(&options).with_context(name)?;
    if let Some(path) = &args.csv {
        output::write(path, &csv(&record, &points), &[log])?;
    }
    match args.format {
        Format::Text => text(log, &record, &points, &judgement),
        Format::Json => say!("{}", report(log, &record, &points, &judgement)),
    }
    complain!("tiltrotor: {}: {judgement}", log.display());
    Ok(Status::from(&judgement))
}

/// Output unit over input unit; nothing where both are the same.
fn unit(record: &Record) -> String {
    let (over, under) = (&record.output.unit, &record.input.unit);
    if over == under { String::new() } else { format!("{over}/{under}") }
}

/// Gain in dB and phase in deg, −180 to 180.
fn told(point: &Point) -> (f64, f64) {
    (decibels(point.response.norm()), point.response.arg() * DEG)
}

/// A coherence from which a response is worth something.
const TRUSTED: f64 = 0.6;

fn text(log: &Path, record: &Record, points: &[Point], judgement: &Judgement) {
    say!(
        "{}: {} over {}, {:.1} s",
        log.display(),
        record.output.name,
        record.input.name,
        record.length_s()
    );
    let unit = unit(record);
    say!(
        "{:>9} {:>14} {:>9} {:>10} {:>9} {:>10}",
        "rad/s",
        format!("dB {unit}").trim_end(),
        "deg",
        "coherence",
        "error %",
        "segment s"
    );
    for point in points {
        let (gain_db, phase_deg) = told(point);
        say!(
            "{:>9.3} {gain_db:>14.2} {phase_deg:>9.1} {:>10.3} {:>9.1} {:>10.1}",
            point.omega_radps,
            point.coherence,
            100.0 * point.error,
            point.segment_s
        );
    }
    let weak = points.iter().filter(|point| point.coherence < TRUSTED).count();
    if weak > 0 {
        say!(
            "{weak} of {} frequencies have a coherence under {TRUSTED}: there the output is not this input's",
            points.len()
        );
    }
    say!("log        {judgement}");
}

fn csv(record: &Record, points: &[Point]) -> String {
    let mut text = String::from(
        "frequency_radps,gain_db,phase_deg,coherence,gain_error_norm,segment_s,real,imaginary,unit\n",
    );
    let unit = unit(record);
    for point in points {
        let (gain_db, phase_deg) = told(point);
        let Point { omega_radps, response, coherence, error, segment_s } = point;
        text += &format!(
            "{omega_radps},{gain_db},{phase_deg},{coherence},{error},{segment_s},{},{},{unit}\n",
            response.re, response.im
        );
    }
    text
}

fn report(log: &Path, record: &Record, points: &[Point], judgement: &Judgement) -> Value {
    let signal = |signal: &Signal| json!({ "name": signal.name, "unit": signal.unit });
    let points: Vec<Value> = points
        .iter()
        .map(|point| {
            let (gain_db, phase_deg) = told(point);
            json!({
                "frequency_radps": point.omega_radps,
                "gain_db": gain_db,
                "phase_deg": phase_deg,
                "coherence": point.coherence,
                "gain_error_norm": point.error,
                "segment_s": point.segment_s,
                "real": point.response.re,
                "imaginary": point.response.im,
            })
        })
        .collect();
    json!({
        "log": log.display().to_string(),
        "input": signal(&record.input),
        "output": signal(&record.output),
        "length_s": record.length_s(),
        "judgement": json::judgement(judgement),
        "points": points,
    })
}
