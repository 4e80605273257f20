//! `tiltrotor log files`.

use std::io::Write;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use logs::{Ending, Messages};

use super::ended::ended;
use crate::console::Stdout;
use crate::status::Status;

/// Which log, and which of its files.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Print this file as it is, instead of the list
    #[arg(long, value_name = "NAME")]
    extract: Option<String>,
}

/// Lists the files in a log, or prints one of them.
pub fn run(args: &Args) -> Result<Status> {
    let name = args.log.display();
    let mut messages = Messages::open(&args.log, replay::OPEN).with_context(|| name.to_string())?;
    // Other people's tools put files last: all of the log is read, and its checksums are looked at.
    while messages.next_message().is_some() {}
    match &args.extract {
        Some(wanted) => print(&messages, wanted).with_context(|| name.to_string())?,
        // Of what holds nothing only that is told.
        None if messages.files().is_empty() && messages.ending() != Ending::Closed => {}
        None => {
            let count = messages.files().len();
            say!("{name}: {count} file{}", if count == 1 { "" } else { "s" });
            for (file, data) in messages.files() {
                let lines = data.iter().filter(|&&byte| byte == b'\n').count();
                say!("  {file:<16} {lines} lines, {} bytes", data.len());
            }
        }
    }
    Ok(ended(&messages, &args.log))
}

/// Prints a file, byte for byte.
fn print(messages: &Messages, wanted: &str) -> Result<()> {
    let Some((_, data)) = messages.files().iter().find(|(name, _)| name == wanted) else {
        let names: Vec<&str> = messages.files().iter().map(|(name, _)| name.as_str()).collect();
        match &aircraft::near(wanted, &names)[..] {
            [] => bail!("no file {wanted} in it; there is {}", names.join(", ")),
            near => bail!("no file {wanted} in it; did you mean {}?", near.join(", or ")),
        }
    };
    // An error is kept there, and told at the end.
    let _ = Stdout.write_all(data);
    Ok(())
}
