//! `tiltrotor doctor`: what this machine can hold in real time, and what to change.

use std::fs;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::Result;
use engine::inputs::Inputs;
use engine::{STEP_NS, step};
use recorder::statistics::Durations;
use recorder::{RealTime, check_clock};

use crate::flightgear::Found;
use crate::numbers::between;
use crate::status::Status;

/// How the machine is looked at.
#[derive(clap::Args)]
pub struct Args {
    /// How long the clock is tried, s
    #[arg(long, value_name = "SECONDS", default_value_t = 3.0)]
    #[arg(value_parser = between(0.1, 3600.0, "s"), allow_negative_numbers = true)]
    seconds: f64,
    /// Keep the tried loop on this processor, counted from 0
    #[arg(long, value_name = "N")]
    #[arg(value_parser = crate::numbers::processor, allow_negative_numbers = true)]
    cpu: Option<usize>,
    /// Where flights will be recorded: its disk is tried
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    folder: PathBuf,
}

/// What was found, and what to change if it is not as it should be.
struct Finding {
    name: &'static str,
    found: String,
    change: Option<String>,
}

impl Finding {
    fn good(name: &'static str, found: impl Into<String>) -> Self {
        Self { name, found: found.into(), change: None }
    }

    fn change(name: &'static str, found: impl Into<String>, change: impl Into<String>) -> Self {
        Self { name, found: found.into(), change: Some(change.into()) }
    }

    /// Good or not, with what to change if not.
    fn judged(name: &'static str, found: impl Into<String>, good: bool, change: &str) -> Self {
        if good { Self::good(name, found) } else { Self::change(name, found, change) }
    }
}

/// Looks at the machine, and says what it can hold.
pub fn run(args: &Args) -> Result<Status> {
    let mut findings = vec![processors(), governor(), clock_source(), preemption()];
    findings.extend(limits());
    findings.push(throttling());
    let model = model_speed()?;
    findings.push(model);
    let wanted = RealTime { cpu: args.cpu, ..RealTime::default() };
    let check = check_clock(wanted, Duration::from_secs_f64(args.seconds));
    let tried = format!("of {} ticks", check.late.count());
    findings.push(Finding::judged(
        "clock",
        format!("late {}, {tried}", told(&check.late)),
        check.late.percentile_ms(99.9) < 1.0 && !check.misses_ticks(),
        "see above, close other programs, or leave a processor to the loop: `fly --cpu N`",
    ));
    findings.extend(check.refused.iter().map(|why| {
        let (what, grant) = why.split_once("; ").unwrap_or((why, ""));
        Finding::change("not granted", what, grant)
    }));
    findings.push(disk(&args.folder));
    findings.push(terminal());
    findings.push(devices());
    findings.push(flightgear());
    for Finding { name, found, change } in &findings {
        let mark = if change.is_some() { "CHANGE" } else { "ok" };
        say!("{mark:<7} {name:<15} {found}");
        if let Some(change) = change.as_deref().filter(|change| !change.is_empty()) {
            say!("{:<7} {:<15} -> {change}", "", "");
        }
    }
    say!("{}", check.verdict());
    Ok(Status::Done)
}

fn told(durations: &Durations) -> String {
    format!(
        "p50 {:.3} ms, p99.9 {:.3}, max {:.3} ms",
        durations.percentile_ms(50.0),
        durations.percentile_ms(99.9),
        durations.longest_ms()
    )
}

/// The first line of a file of the system, if it has it.
fn system(path: &str) -> Option<String> {
    let text = fs::read_to_string(path).ok()?;
    Some(text.lines().next().unwrap_or_default().trim().to_string())
}

fn processors() -> Finding {
    let count = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let cpuinfo = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let of = |key: &str| {
        let line = cpuinfo.lines().find(|line| line.starts_with(key))?;
        Some(line.split_once(':')?.1.trim().to_string())
    };
    let name = of("model name").unwrap_or_else(|| "unknown".into());
    let is_virtual = of("flags").is_some_and(|flags| flags.contains("hypervisor"));
    let found = format!("{count} of {name}{}", if is_virtual { ", virtual" } else { "" });
    match (count, is_virtual) {
        (1, _) => {
            Finding::change("processors", found, "the loop shares its only one with all else")
        }
        (_, true) => Finding::change(
            "processors",
            found,
            "a virtual machine stands still when its host wants: fly on the host for real time",
        ),
        _ => Finding::good("processors", found),
    }
}

fn governor() -> Finding {
    let path = "/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor";
    let Some(governor) = system(path) else {
        return Finding::good("frequency", "not governed by this system");
    };
    let good = governor == "performance";
    let change = "`cpupower frequency-set --governor performance`: a slow clock makes late ticks";
    Finding::judged("frequency", format!("governor {governor}"), good, change)
}

fn clock_source() -> Finding {
    let path = "/sys/devices/system/clocksource/clocksource0/current_clocksource";
    let Some(source) = system(path) else { return Finding::good("clock source", "not told") };
    let slow = matches!(source.as_str(), "hpet" | "acpi_pm" | "jiffies");
    let change = "reading this clock is slow: `clocksource=tsc` on the kernel's command line";
    Finding::judged("clock source", source, !slow, change)
}

fn preemption() -> Finding {
    let version = system("/proc/version").unwrap_or_default();
    let word = version.split_whitespace().find(|word| word.starts_with("PREEMPT"));
    let real_time = system("/sys/kernel/realtime").as_deref() == Some("1");
    match (real_time, word) {
        (true, _) | (_, Some("PREEMPT_RT")) => Finding::good("kernel", "PREEMPT_RT"),
        (_, Some(word)) => Finding::good("kernel", format!("{word}: well below a tick as a rule")),
        _ => Finding::change(
            "kernel",
            "no preemption",
            "boot with `preempt=full`, or a kernel with PREEMPT_RT",
        ),
    }
}

/// Real-time priority and locked memory, timers.
fn limits() -> Vec<Finding> {
    let text = fs::read_to_string("/proc/self/limits").unwrap_or_default();
    let soft = |name: &str| {
        let line = text.lines().find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next().map(str::to_string)
    };
    let enough = |limit: &str, least: u64| {
        limit == "unlimited" || limit.parse::<u64>().is_ok_and(|limit| limit >= least)
    };
    let mut findings = Vec::new();
    // What the superuser wants is granted whatever the limits say.
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let uid = status.lines().find_map(|line| line.strip_prefix("Uid:"));
    let root = uid.and_then(|ids| ids.split_whitespace().nth(1)) == Some("0");
    if let Some(limit) = soft("Max realtime priority") {
        let change = "a line `@realtime - rtprio 40` in /etc/security/limits.conf, your user in that \
                      group, and log in again";
        let good = root || enough(&limit, 40);
        findings.push(Finding::judged("priority", format!("up to {limit}"), good, change));
    }
    if let Some(limit) = soft("Max locked memory") {
        let change = "a line `@realtime - memlock unlimited` in /etc/security/limits.conf";
        let good = root || enough(&limit, 512 << 20);
        findings.push(Finding::judged(
            "locked memory",
            format!("up to {limit} bytes"),
            good,
            change,
        ));
    }
    if let Some(slack_ns) = system("/proc/self/timerslack_ns").and_then(|text| text.parse().ok()) {
        let found = format!("{:.0} µs without real-time scheduling", slack_ns_us(slack_ns));
        findings.push(Finding::good("timer slack", found));
    }
    findings
}

fn slack_ns_us(slack_ns: u64) -> f64 {
    slack_ns as f64 * 1e-3
}

fn throttling() -> Finding {
    let Some(runtime) = system("/proc/sys/kernel/sched_rt_runtime_us") else {
        return Finding::good("rt throttling", "not told");
    };
    // A loop that runs for a twentieth of its time never meets the limit.
    Finding::good(
        "rt throttling",
        if runtime == "-1" { "off".into() } else { format!("{runtime} µs of 1 s") },
    )
}

/// How long the model takes for a tick.
fn model_speed() -> Result<Finding> {
    let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15)?;
    let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO)?;
    let mut state = start.on_wheels(&aircraft);
    let world = start.world.world();
    let mut durations = Durations::new();
    for _ in 0..1000 {
        let began = Instant::now();
        state = step(&aircraft, &state, &Inputs { events: &[], world }).0;
        durations.add(began.elapsed().as_nanos() as u64);
    }
    Ok(speed_judged(&durations))
}

/// A quarter of a tick is enough left to everything else; rarely may it take more than one.
fn speed_judged(durations: &Durations) -> Finding {
    let tick_ms = STEP_NS as f64 * 1e-6;
    let part = durations.percentile_ms(50.0) / tick_ms;
    let found = format!("a tick takes {}: {:.1} % of its 4 ms", told(durations), 100.0 * part);
    let is_fast = part < 0.25;
    let is_undisturbed = durations.percentile_ms(99.9) < tick_ms;
    let change = if is_fast {
        "other programs take the processor away for more than a tick: end them while flying"
    } else {
        "this processor is too slow, or this is a debug build: build with --release"
    };
    Finding::judged("flight model", found, is_fast && is_undisturbed, change)
}

/// Writes as a flight does, faster, and brings it to the disk each time.
fn disk(folder: &Path) -> Finding {
    const CHUNK: usize = 128 * 1024;
    const CHUNKS: usize = 32;
    let path = folder.join(format!(".tiltrotor-doctor-{}", std::process::id()));
    let tried = (|| {
        let mut file = fs::File::create_new(&path)?;
        let chunk = vec![0x5a_u8; CHUNK];
        let began = Instant::now();
        let mut longest = Duration::ZERO;
        for _ in 0..CHUNKS {
            let began = Instant::now();
            file.write_all(&chunk)?;
            file.sync_data()?;
            longest = longest.max(began.elapsed());
        }
        Ok::<_, std::io::Error>((began.elapsed(), longest))
    })();
    let _ = fs::remove_file(&path);
    match tried {
        Ok((took, longest)) => {
            let mb_per_s = (CHUNK * CHUNKS) as f64 * 1e-6 / took.as_secs_f64();
            let found = format!(
                "{mb_per_s:.1} MB/s brought to it, 128 kB in {:.0} ms at most; a flight writes 0.2 MB/s",
                longest.as_secs_f64() * 1e3
            );
            let change = "record on another disk: `fly --out FILE`";
            Finding::judged(
                "disk",
                found,
                mb_per_s > 1.0 && longest < Duration::from_secs(5),
                change,
            )
        }
        Err(error) => {
            let found = format!("cannot write to {}: {error}", folder.display());
            Finding::change("disk", found, "give a folder that can be written: `--folder`")
        }
    }
}

fn terminal() -> Finding {
    let on = std::io::stdin().is_terminal() && std::io::stderr().is_terminal();
    match crossterm::terminal::size() {
        Ok((columns, rows)) if on => Finding::judged(
            "terminal",
            format!("{columns} columns, {rows} rows"),
            columns >= 80 && rows >= 24,
            "the panel needs 80 columns and 24 rows",
        ),
        _ => Finding::good("terminal", "none here: no panel, no flying by keyboard"),
    }
}

fn devices() -> Finding {
    let nodes: Vec<PathBuf> = fs::read_dir("/dev/input").map_or_else(
        |_| Vec::new(),
        |entries| {
            let paths = entries.flatten().map(|entry| entry.path());
            let name = |path: &PathBuf| path.file_name().map(|n| n.display().to_string());
            paths.filter(|path| name(path).is_some_and(|n| n.starts_with("event"))).collect()
        },
    );
    let readable = nodes.iter().filter(|node| fs::File::open(node).is_ok()).count();
    let found = format!("{} input devices, {readable} of them readable", nodes.len());
    let change = "no permission for some: a rule of udev, or your user in the group `input`";
    Finding::judged("devices", found, readable == nodes.len(), change)
}

fn flightgear() -> Finding {
    match Found::look(None) {
        Ok(found) => Finding::good("FlightGear", found.program.display().to_string()),
        Err(error) => Finding::change("FlightGear", "none to be used", error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_good_where_it_is_fast_and_undisturbed() {
        // Ticks of 4 ms; a hundred of them, of which two took longer.
        let judged = |most_ms: f64, two_ms: f64| {
            let mut durations = Durations::new();
            (0..98).for_each(|_| durations.add((most_ms * 1e6) as u64));
            (0..2).for_each(|_| durations.add((two_ms * 1e6) as u64));
            speed_judged(&durations).change
        };
        assert_eq!(judged(0.1, 0.1), None);
        assert_eq!(judged(0.9, 3.9), None);
        let disturbed = judged(0.1, 4.1).unwrap();
        assert!(disturbed.contains("other programs"), "{disturbed}");
        for slow in [judged(1.1, 1.1), judged(4.1, 4.1)] {
            assert!(slow.as_deref().is_some_and(|slow| slow.contains("too slow")), "{slow:?}");
        }
    }
}
