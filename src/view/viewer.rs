//! The viewer: found, of the right version, started, and watched until it stands.

use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail};
use replay::view::control::{self, ControlError};

/// Recordings of one version are for viewers of that version.
const VERSION: &str = "0.36.3";
/// A viewer that cannot open its window has ended by then.
const STANDS: Duration = Duration::from_secs(3);
/// A recording of an hour is open by then.
const OPENS: Duration = Duration::from_secs(60);
/// Between two looks at whether it still runs.
const LOOK: Duration = Duration::from_millis(50);
/// So much of what it said before it ended is told.
const LINES: usize = 4;
/// So many names are tried for the file that keeps what it says.
const NAMES: u32 = 1000;

/// A viewer that is there.
pub struct Viewer {
    program: PathBuf,
}

impl Viewer {
    /// Looks for it.
    pub fn find(program: &Path) -> Result<Self> {
        let install = format!("`pip install rerun-sdk=={VERSION}` brings it");
        let asked = Command::new(program).arg("--version").stdin(Stdio::null()).output();
        let said = asked.with_context(|| {
            format!(
                "no viewer: the program `{}` cannot be started; {install}, or save the recording: \
                 --save FLIGHT.rrd",
                program.display()
            )
        })?;
        let said = String::from_utf8_lossy(&said.stdout).into_owned();
        match version(&said) {
            Some(VERSION) => Ok(Self { program: program.into() }),
            Some(other) => bail!(
                "the viewer `{}` is of version {other}, and recordings are for {VERSION}; {install}",
                program.display()
            ),
            None => bail!(
                "`{}` is not the rerun viewer: asked for its version, it says {:?}; {install}",
                program.display(),
                said.lines().next().unwrap_or("nothing")
            ),
        }
    }

    /// Opens the recording, at a tick if one is given, and waits until the viewer stands.
    pub fn show(&self, recording: &Path, tick: Option<u64>) -> Result<()> {
        // A viewer of one's own: another one that listens at the usual port would get the recording.
        let port = free_port().context("no free port for the viewer")?;
        let (mut child, mut heard) = self.start(port, Some(recording))?;
        let began = Instant::now();
        let alive = || matches!(child.try_wait(), Ok(None));
        let gone = tick.map(|tick| control::go_to(port, tick, OPENS, alive));
        match gone {
            None | Some(Ok(()) | Err(ControlError::Ended)) => {}
            Some(Err(error)) => complain!("{error}; the time cursor is where the viewer puts it"),
        }
        stands(&mut child, STANDS.saturating_sub(began.elapsed()))
            .with_context(|| last_words(&mut heard))
    }
}

impl Viewer {
    /// Opens it empty, and waits until it listens at this port.
    pub fn listen(&self, port: u16) -> Result<()> {
        let (mut child, mut heard) = self.start(port, None)?;
        let began = Instant::now();
        while TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_err() {
            if let Some(ended) = child.try_wait()? {
                return Err(anyhow!("the viewer ended before it listened, with {ended}"))
                    .with_context(|| last_words(&mut heard));
            }
            if began.elapsed() > OPENS {
                bail!("the viewer does not listen at port {port}; {}", last_words(&mut heard));
            }
            thread::sleep(LOOK);
        }
        Ok(())
    }

    /// Starts it, and keeps what it says.
    fn start(&self, port: u16, recording: Option<&Path>) -> Result<(Child, File)> {
        let heard = tempfile().context("no file for what the viewer says")?;
        let mut command = Command::new(&self.program);
        command
            .args(["--bind", "127.0.0.1", "--port", &port.to_string()])
            .args(recording)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(heard.try_clone()?);
        // Ctrl-C ends a flight, and not the viewer.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child =
            command.spawn().with_context(|| format!("cannot start {}", self.program.display()))?;
        Ok((child, heard))
    }
}

/// The version in `rerun-cli 0.36.3 [rustc …]`.
fn version(said: &str) -> Option<&str> {
    let mut words = said.split_whitespace();
    words.find(|word| word.starts_with("rerun"))?;
    words.find(|word| word.starts_with(|c: char| c.is_ascii_digit()))
}

/// Waits until the viewer has run for a while, or been closed by whoever looked at it. Without patience it is
/// looked at, too: it may have ended while it was told where to go.
fn stands(child: &mut Child, patience: Duration) -> Result<()> {
    let began = Instant::now();
    loop {
        match child.try_wait()? {
            Some(ended) if ended.success() => return Ok(()),
            Some(ended) => bail!("the viewer ended without being closed, with {ended}"),
            None if began.elapsed() >= patience => return Ok(()),
            None => thread::sleep(LOOK),
        }
    }
}

/// What it said last, in one line.
fn last_words(heard: &mut File) -> String {
    let mut said = String::new();
    let read = heard.seek(SeekFrom::Start(0)).and_then(|_| heard.read_to_string(&mut said));
    let lines: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).collect();
    let last = lines[lines.len().saturating_sub(LINES)..].join(" / ");
    let said = if read.is_ok() && !last.is_empty() { last } else { "nothing".into() };
    format!(
        "the viewer said: {said}; without a screen, --save FLIGHT.rrd makes the recording alone"
    )
}

fn free_port() -> std::io::Result<u16> {
    Ok(TcpListener::bind((Ipv4Addr::LOCALHOST, 0))?.local_addr()?.port())
}

/// A file without a name.
fn tempfile() -> std::io::Result<File> {
    nameless(&std::env::temp_dir(), std::process::id())
}

/// A file without a name, which for a moment has one that nothing else had: the folder is everybody's, and
/// what stands there under such a name, a link to another file as well, is left alone.
fn nameless(folder: &Path, of: u32) -> std::io::Result<File> {
    let mut taken = None;
    for number in 0..NAMES {
        let path = folder.join(format!("tiltrotor-viewer-{of}-{number}"));
        match File::options().read(true).write(true).create_new(true).open(&path) {
            Ok(file) => {
                // Where an open file cannot be removed it stays, and its name is taken from then on.
                let _ = std::fs::remove_file(&path);
                return Ok(file);
            }
            Err(error) if error.kind() == ErrorKind::AlreadyExists => taken = Some(error),
            Err(error) => return Err(error),
        }
    }
    Err(taken.unwrap_or_else(|| ErrorKind::AlreadyExists.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a folder that everybody may write to, somebody else's file or link may stand already.
    #[test]
    #[cfg(unix)]
    fn what_the_viewer_says_is_kept_in_no_file_that_was_there() {
        use std::io::Write;
        let folder = std::env::temp_dir().join(format!("tiltrotor-names-{}", std::process::id()));
        std::fs::create_dir(&folder).expect("a folder");
        let notes = folder.join("notes");
        std::fs::write(&notes, "somebody's notes").expect("a file");
        let link = folder.join("tiltrotor-viewer-7-0");
        std::os::unix::fs::symlink(&notes, &link).expect("a link");
        let dangling = folder.join("tiltrotor-viewer-7-1");
        std::os::unix::fs::symlink(folder.join("nowhere"), &dangling).expect("a link");
        std::fs::write(folder.join("tiltrotor-viewer-7-2"), "another's").expect("a file");
        let mut file = nameless(&folder, 7).expect("a file without a name");
        file.write_all(b"no graphics adapter").expect("written");
        assert!(last_words(&mut file).contains("no graphics adapter"));
        assert_eq!(std::fs::read(&notes).expect("the notes"), b"somebody's notes");
        assert!(!folder.join("nowhere").exists(), "made through a link");
        assert!(!folder.join("tiltrotor-viewer-7-3").exists(), "it has a name");
        std::fs::remove_dir_all(&folder).expect("a folder of ours");
    }

    /// A viewer that was told where to go for longer than it is watched, and ended meanwhile.
    #[test]
    #[cfg(unix)]
    fn a_viewer_that_died_while_it_was_told_where_to_go_is_no_success() {
        let ends = |script: &str| {
            let mut child = Command::new("sh").args(["-c", script]).spawn().expect("a shell");
            while child.try_wait().expect("it is ours").is_none() {
                thread::sleep(LOOK);
            }
            stands(&mut child, Duration::ZERO)
        };
        assert!(ends("exit 3").is_err_and(|error| error.to_string().contains("exit status: 3")));
        assert!(ends("kill -9 $$").is_err_and(|error| error.to_string().contains("signal")));
        assert!(ends("exit 0").is_ok());
    }

    #[test]
    fn a_version_is_read_off_what_the_viewer_says_of_itself() {
        let said = "rerun-cli 0.36.3 [rustc 1.95.0 (abc 2026-04-01), LLVM 21] x86_64 release";
        assert_eq!(version(said), Some("0.36.3"));
        assert_eq!(version("rerun 0.30.0-alpha.1"), Some("0.30.0-alpha.1"));
        assert_eq!(version("ls (GNU coreutils) 9.1"), None);
        assert_eq!(version(""), None);
    }
}
