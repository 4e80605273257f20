//! A FlightGear that was started from here.

use std::fs::{self, File};
use std::net::UdpSocket;
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use flightgear::Receiver;
use flightgear::link::{CHANNEL_PORT, GHOST_PORT};

use super::command_line::Request;
use super::find;

/// So often its own time has gone on when it draws.
const FRAMES: u32 = 5;
/// Lines of what it said last.
const LAST_LINES: usize = 12;
/// So long it gets to end by itself.
const FAREWELL: Duration = Duration::from_secs(5);

/// A FlightGear that ends with this.
#[derive(Debug)]
pub struct Running {
    child: Child,
    log: PathBuf,
}

impl Running {
    /// Starts it.
    ///
    /// # Errors
    /// When something listens at its port already, or it cannot be started.
    pub fn start(request: &Request) -> Result<Self> {
        let (listen, port) = (request.ports.listen, request.ports.port);
        for port in [port, port + CHANNEL_PORT, port + GHOST_PORT] {
            if UdpSocket::bind((listen, port)).is_err() {
                bail!(
                    "something listens at {listen}:{port} already: a FlightGear that runs? Fly without \
                     starting one, or give another port"
                );
            }
        }
        let folder = find::cache();
        fs::create_dir_all(&folder)
            .with_context(|| format!("cannot write in {}", folder.display()))?;
        let log = folder.join(format!("fgfs-{port}.log"));
        let said = File::create(&log).with_context(|| format!("cannot write {}", log.display()))?;
        let mut command = Command::new(&request.fgfs);
        command.args(request.arguments()).stdin(Stdio::null());
        command.stdout(said.try_clone()?).stderr(said);
        if std::env::var_os("DBUS_SESSION_BUS_ADDRESS").is_none() {
            // Without a session's bus its wish to keep the screen on would end it.
            command.env("DBUS_FATAL_WARNINGS", "0");
        }
        // Ctrl-C is for the flight; FlightGear ends after it.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let child =
            command.spawn().with_context(|| format!("cannot start {}", request.fgfs.display()))?;
        Ok(Self { child, log })
    }

    /// Where what it says is kept.
    pub fn log(&self) -> std::path::Display<'_> {
        self.log.display()
    }

    /// How it ended, if it did.
    pub fn ended(&mut self) -> Result<Option<ExitStatus>> {
        Ok(self.child.try_wait()?)
    }

    /// Waits until its scenery is there and it draws.
    ///
    /// # Errors
    /// When it ends, or the patience does, or `stop` is set.
    pub fn ready(
        &mut self,
        receiver: &Receiver,
        patience: Duration,
        stop: &AtomicBool,
    ) -> Result<Duration> {
        let began = Instant::now();
        let (mut last_s, mut frames) = (f64::NEG_INFINITY, 0);
        loop {
            if let Some(report) = receiver.take().filter(|report| report.scenery_loaded)
                && report.elapsed_s > last_s
            {
                (last_s, frames) = (report.elapsed_s, frames + 1);
                if frames > FRAMES {
                    return Ok(began.elapsed());
                }
            }
            if let Some(ended) = self.ended()? {
                bail!(
                    "FlightGear ended before it was ready, with {ended}; {}\n{}",
                    what_to_do(),
                    self.last_words()
                );
            }
            if stop.load(Ordering::Relaxed) {
                bail!("ended before FlightGear was ready");
            }
            if began.elapsed() > patience {
                let what = match receiver.newest() {
                    None => "it has told nothing",
                    Some((report, _)) if !report.scenery_loaded => "its scenery is not there",
                    Some(_) => "it draws too slowly",
                };
                bail!(
                    "FlightGear is not ready after {:.0} s: {what}; a first start takes longer, and `tiltrotor \
                     flightgear --patience SECONDS` waits for it\n{}",
                    patience.as_secs_f64(),
                    self.last_words()
                );
            }
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// What it said last.
    pub fn last_words(&self) -> String {
        let said = fs::read(&self.log).unwrap_or_default();
        let said = String::from_utf8_lossy(&said);
        let lines: Vec<_> = said.lines().collect();
        lines[lines.len().saturating_sub(LAST_LINES)..].join("\n")
    }
}

/// What to do when it ended by itself.
fn what_to_do() -> &'static str {
    let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY") {
        "no screen is known here (neither DISPLAY nor WAYLAND_DISPLAY is set): start it at a desktop, or \
         under `xvfb-run -a`"
    } else {
        "`tiltrotor flightgear --print` says its command line, to be tried by hand"
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if !matches!(self.child.try_wait(), Ok(None)) {
            return;
        }
        // Told to end it ends at once; asked to, it hangs.
        #[cfg(unix)]
        let _ = Command::new("kill").arg(self.child.id().to_string()).status();
        let told = Instant::now();
        while cfg!(unix) && told.elapsed() < FAREWELL {
            if !matches!(self.child.try_wait(), Ok(None)) {
                return;
            }
            thread::sleep(Duration::from_millis(20));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
