//! A flight with devices that come and go.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use engine::inputs::DeviceEvent;
use engine::{State, cockpit};
use logs::{FlightReader, OpenOptions};

use super::fake::Fake;
use crate::common::{self, OK};

/// What happens, and how many seconds after the take-off: action, device, file of events.
pub type Step<'a> = (f64, &'a str, &'a str, &'a str);

/// A flight that was flown.
pub struct Flown {
    pub said: String,
    /// Processor time of the program, s.
    pub cpu_s: f64,
    pub log: PathBuf,
    pub cockpits: Vec<cockpit::State>,
    pub events: Vec<DeviceEvent>,
    pub reader: FlightReader,
}

/// Device, name and events: type, code, value.
pub type EventScript<'a> = (&'a str, &'a str, &'a [(u16, u16, i32)]);

/// What a flight is made of.
#[derive(Default)]
pub struct Job<'a> {
    pub name: &'a str,
    /// All devices of the flight.
    pub devices: &'a [Fake],
    /// Those of them that are there from the start.
    pub there: &'a [&'a str],
    /// Events beside the sweep.
    pub scripts: &'a [EventScript<'a>],
    pub plan: &'a [Step<'a>],
    /// The cockpit map; without one, the shipped ones.
    pub map: Option<&'a str>,
    pub more: &'a [&'a str],
    pub seconds: u32,
}

/// Whether devices can be staged here; CI must. The python is the one that the packages are for.
pub fn can_stage() -> bool {
    let tried = Command::new("umockdev-wrapper")
        .args(["/usr/bin/python3", "-c", "import gi; gi.require_version('UMockdev', '1.0')"])
        .stderr(Stdio::null())
        .status();
    let can = tried.is_ok_and(|status| status.success());
    if !can {
        let in_ci = std::env::var("CI").is_ok_and(|ci| ci == "true");
        let packages = "apt-get install umockdev gir1.2-umockdev-1.0 python3-gi";
        assert!(!in_ci, "CI must have umockdev's library: {packages}");
        println!("skipped: no umockdev library ({packages})");
    }
    can
}

impl Job<'_> {
    fn folder(&self) -> PathBuf {
        let folder = common::folder(&format!("hardware-{}", self.name));
        for device in self.devices {
            device.write(&folder);
        }
        for (label, name, events) in self.scripts {
            let device = self.devices.iter().find(|device| device.label == *label);
            device.expect("a device").script(&folder, name, events);
        }
        folder
    }

    /// Runs the program among the devices: status, what it said, processor time.
    pub fn run(&self, folder: &Path, arguments: &[String], begin: &str) -> (i64, String, f64) {
        let plan: Vec<serde_json::Value> = self
            .plan
            .iter()
            .map(|(at, action, device, file)| match *action {
                "play" => {
                    let path = folder.join(format!("{device}.{file}"));
                    serde_json::json!([at, action, device, path])
                }
                _ => serde_json::json!([at, action, device]),
            })
            .collect();
        let log = arguments.iter().skip_while(|word| *word != "--out").nth(1);
        let mut program = vec![env!("CARGO_BIN_EXE_tiltrotor").to_string()];
        program.extend_from_slice(arguments);
        let job = serde_json::json!({
            "folder": folder, "devices": self.there, "program": program, "plan": plan,
            "limit": self.seconds + 60, "begin": begin, "log": log,
        });
        let stage = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/devices/stage.py");
        let mut child = Command::new("umockdev-wrapper")
            .args(["/usr/bin/python3", stage])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the stage");
        let mut input = child.stdin.take().expect("its input");
        input.write_all(job.to_string().as_bytes()).expect("the job");
        drop(input);
        let output = child.wait_with_output().expect("its end");
        let result: serde_json::Value =
            serde_json::from_slice(&output.stdout).expect("the stage's result");
        let said = result["said"].as_str().expect("words").to_string();
        (result["status"].as_i64().expect("a status"), said, result["cpu"].as_f64().expect("s"))
    }

    /// Runs another verb among the devices.
    pub fn command(&self, arguments: &[&str]) -> (i64, String) {
        let arguments: Vec<String> = arguments.iter().map(|word| (*word).to_string()).collect();
        let (status, said, _) = self.run(&self.folder(), &arguments, "");
        (status, said)
    }

    /// Flies, and verifies what was flown when it was.
    pub fn fly(&self) -> Flown {
        let folder = self.folder();
        let log = folder.join("flight.mcap");
        let _ = fs::remove_file(&log);
        let text = |path: &Path| path.display().to_string();
        let mut arguments: Vec<String> =
            ["fly", "--stick", "--no-flightgear", "--force", "--out", &text(&log), "--duration"]
                .map(String::from)
                .to_vec();
        arguments.push(self.seconds.to_string());
        if let Some(map) = self.map {
            let path = folder.join("map.toml");
            fs::write(&path, map).expect("the map");
            arguments.extend(["--map".into(), text(&path)]);
        }
        arguments.extend(self.more.iter().map(|word| (*word).to_string()));
        let (status, said, cpu_s) = self.run(&folder, &arguments, "device 0");
        assert_eq!(status, 0, "{said}");
        let (mut cockpits, mut events) = (Vec::new(), Vec::new());
        let mut reader = logs::open(&log, OpenOptions::default()).expect("a log");
        while let Some(tick) = reader.next_tick().expect("a tick") {
            let State { cockpit, .. } = tick.record.state;
            cockpits.push(cockpit);
            events.extend_from_slice(&tick.events);
        }
        common::verify(&log).ends(OK).says("exact: all");
        Flown { said, cpu_s, log, cockpits, events, reader }
    }
}

impl Flown {
    /// The least and the most of a control.
    pub fn reached(&self, control: fn(&cockpit::State) -> f64) -> (f64, f64) {
        let at = self.cockpits.iter().map(control);
        at.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
            (if at < low { at } else { low }, if at > high { at } else { high })
        })
    }

    /// Whether a control went from end to end.
    pub fn full(&self, what: &str, control: fn(&cockpit::State) -> f64, low: f64) {
        let (least, most) = self.reached(control);
        let near = |a: f64, b: f64| (a - b).abs() < 0.002;
        assert!(
            near(least, low) && near(most, 1.0),
            "{what}: {least} to {most}, not {low} to 1\n{}",
            self.said
        );
    }

    /// Stick and pedals from end to end.
    pub fn stick_is_full(&self) {
        self.full("stick right", |c| c.stick_right_norm, -1.0);
        self.full("stick aft", |c| c.stick_aft_norm, -1.0);
    }

    pub fn says(&self, words: &str) {
        assert!(self.said.contains(words), "not said: {words}\n{}", self.said);
    }
}
