//! `tiltrotor completions`, `tiltrotor man`: what shells and `man` know of the command.

use std::io::Write;

use anyhow::{Context, Result, bail};
use clap::Command;
use clap_complete::Shell;

use crate::console::Stdout;
use crate::status::Status;

/// For which shell.
#[derive(clap::Args)]
pub struct Args {
    /// The shell
    shell: Shell,
}

/// Of what.
#[derive(clap::Args)]
pub struct ManArgs {
    /// A verb, `log` and what follows it included; the whole command without
    verb: Vec<String>,
}

/// Prints the completions of a command.
pub fn run(args: &Args, mut command: Command) -> Result<Status> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut command, "tiltrotor", &mut text);
    // An error is kept there, and told at the end.
    let _ = Stdout.write_all(&text);
    Ok(Status::Done)
}

/// Prints a manual page of a command, or of a verb of its.
pub fn man(args: &ManArgs, mut command: Command) -> Result<Status> {
    command.build();
    for name in &args.verb {
        let Some(verb) = command.find_subcommand(name) else {
            let verbs: Vec<&str> = command.get_subcommands().map(Command::get_name).collect();
            bail!("{} has no verb `{name}`; it has {}", command.get_name(), verbs.join(", "));
        };
        command = verb.clone();
    }
    let title = std::iter::once("tiltrotor").chain(args.verb.iter().map(String::as_str));
    let title = title.collect::<Vec<_>>().join("-");
    let mut text = Vec::new();
    clap_mangen::Man::new(command)
        .title(title.to_uppercase())
        .render(&mut text)
        .context("cannot write the manual page")?;
    let _ = Stdout.write_all(&text);
    Ok(Status::Done)
}
