//! The `tiltrotor` command: flies, reflies, verifies and shows.

/// Prints a line. Whoever closes the pipe early, as `head` does, has seen enough: no error, no panic.
macro_rules! say {
    ($($what:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stdout(), $($what)*);
    }};
}

/// Prints a line for the eye only, on standard error.
macro_rules! complain {
    ($($what:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), $($what)*);
    }};
}

mod claim;
mod condition;
mod demo;
mod diff;
mod fly;
mod identity;
mod json;
mod linearize;
mod log;
mod numbers;
mod replay_live;
mod report;
mod status;
mod trim;
mod verify;
mod view;
mod whatif;
mod window;

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
    Fly(fly::Args),
    /// Refly a log, live in FlightGear.
    Replay(replay_live::Args),
    /// Do logs refly to the same bits?
    Verify(verify::Args),
    /// Two logs, field by field, as they were recorded.
    Diff(diff::Args),
    /// Show a log in the rerun viewer, or save it for the viewer.
    View(view::Args),
    /// Refly the recorded inputs with changed parameters, or another aircraft, from a moment on, into a
    /// new log.
    Whatif(whatif::Args),
    /// What is in a log.
    #[command(subcommand)]
    Log(log::Command),
    /// Steady flight: attitude, controls, power.
    Trim(trim::Args),
    /// Small motions about a steady flight: modes, frequency responses, state-space matrices. Exit 0
    /// solved, 5 no steady flight, or not converged.
    Linearize(linearize::Args),
    /// A flight by the pilot model: recorded, verified, saved for the viewer, summed up.
    Demo(demo::Args),
}

fn main() -> ExitCode {
    let parsed = status::explained(Cli::command())
        .try_get_matches()
        .and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = match parsed {
        Ok(cli) => cli,
        Err(error) => {
            let Some(words) = numbers::in_words(&error) else { error.exit() };
            complain!("tiltrotor: {words}");
            return Status::Unusable.into();
        }
    };
    let run = match cli.command {
        Command::Fly(args) => fly::run(&args),
        Command::Replay(args) => replay_live::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::View(args) => view::run(&args),
        Command::Whatif(args) => whatif::run(&args),
        Command::Log(command) => log::run(&command),
        Command::Trim(args) => trim::run(&args),
        Command::Linearize(args) => linearize::run(&args),
        Command::Demo(args) => demo::run(&args),
    };
    let status = run.unwrap_or_else(|error| {
        complain!("tiltrotor: {error:#}");
        Status::Unusable
    });
    status.into()
}
