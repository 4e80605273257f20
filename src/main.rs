//! The `tiltrotor` command: flies, reflies, verifies and shows.

#[macro_use]
mod console;

mod afterwards;
mod claim;
mod completions;
mod condition;
mod controls;
mod demo;
mod devices;
mod diff;
mod doctor;
mod flightgear;
mod fly;
mod fmu;
mod ground;
mod identify;
mod identity;
mod json;
mod linearize;
mod link_args;
mod log;
mod made;
#[cfg(feature = "sticks")]
mod maps;
mod numbers;
mod page;
mod panel;
mod plot;
mod replay_live;
mod report;
mod status;
mod texts;
mod timing;
mod trim;
mod verify;
mod view;
mod whatif;
mod window;

use std::io::ErrorKind;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use status::Status;

/// A deterministic, piloted simulation of the Bell XV-15, and the tooling around its log.
#[derive(Parser)]
#[command(version = env!("TILTROTOR_VERSION"), arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Fly in real time (or --fast) with a stick, a pilot model or a script.
    Fly(Box<fly::Args>),
    /// Sticks, throttles, pedals and gamepads: what is there, what is flown with, a new map.
    Devices(devices::Args),
    /// Refly a log, live in FlightGear.
    Replay(replay_live::Args),
    /// Do logs refly to the same bits?
    Verify(verify::Args),
    /// Two logs, field by field, as they were recorded.
    Diff(diff::Args),
    /// Show a log in the rerun viewer, or save it for the viewer.
    View(view::Args),
    /// Figures of a flight, as a paper has them: SVG or PNG.
    Plot(plot::Args),
    /// A flight on one page: verdict, summary, figures, events, limits, how to refly it; HTML that needs nothing
    /// beside it.
    Report(page::Args),
    /// Refly the recorded inputs with changed parameters, or another aircraft, from a moment on, into a
    /// new log.
    Whatif(whatif::Args),
    /// What is in a log.
    #[command(subcommand)]
    Log(log::Command),
    /// Steady flight: attitude, controls, power.
    Trim(trim::Args),
    /// Small motions about a steady flight: modes, frequency responses, state-space matrices.
    Linearize(linearize::Args),
    /// What a flown sweep says: frequency response and coherence of two recorded signals.
    Identify(identify::Args),
    /// What this machine can hold in real time, and what to change.
    Doctor(doctor::Args),
    /// Start FlightGear with our aircraft, and wait until it is ready.
    Flightgear(flightgear::Args),
    /// The XV-15 as an FMU for simulation tools, packed from the library beside the program.
    Fmu(fmu::Args),
    /// A flight by the pilot model: recorded, verified, saved for the viewer, summed up.
    Demo(demo::Args),
    /// Completions of verbs and options for a shell, on standard output.
    Completions(completions::Args),
    /// The manual page of the command or of a verb, for `man -l -`.
    Man(completions::ManArgs),
}

fn main() -> ExitCode {
    let parsed = whole().try_get_matches().and_then(|matches| Cli::from_arg_matches(&matches));
    let status = match parsed {
        Ok(cli) => run(cli.command).unwrap_or_else(|error| {
            complain!("tiltrotor: {error:#}");
            Status::Unusable
        }),
        // Help and version go to standard output, and an error with them is one.
        Err(shown) if !shown.use_stderr() => match shown.print() {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => unwritten(&error),
            _ => Status::Done,
        },
        Err(error) => {
            match numbers::in_words(&error) {
                Some(words) => complain!("tiltrotor: {words}"),
                None => {
                    let _ = error.print();
                }
            }
            Status::Unusable
        }
    };
    console::finish().map_or_else(|error| unwritten(&error), |()| status).into()
}

/// The command with all its verbs, and what is to be known of their exit statuses.
fn whole() -> clap::Command {
    status::explained(Cli::command())
}

/// A report that nobody can read is no result, whatever it says.
fn unwritten(error: &std::io::Error) -> Status {
    complain!("tiltrotor: cannot write to standard output: {error}");
    Status::Unusable
}

fn run(command: Command) -> anyhow::Result<Status> {
    match command {
        Command::Fly(args) => fly::run(&args),
        Command::Devices(args) => devices::run(&args),
        Command::Replay(args) => replay_live::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::View(args) => view::run(&args),
        Command::Plot(args) => plot::run(&args),
        Command::Report(args) => page::run(&args),
        Command::Whatif(args) => whatif::run(&args),
        Command::Log(command) => log::run(&command),
        Command::Trim(args) => trim::run(&args),
        Command::Linearize(args) => linearize::run(&args),
        Command::Identify(args) => identify::run(&args),
        Command::Doctor(args) => doctor::run(&args),
        Command::Flightgear(args) => flightgear::run(&args),
        Command::Fmu(args) => fmu::run(&args),
        Command::Demo(args) => demo::run(&args),
        Command::Completions(args) => completions::run(&args, whole()),
        Command::Man(args) => completions::man(&args, whole()),
    }
}
