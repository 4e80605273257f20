//! FlightGear's command line.

use std::net::Ipv4Addr;
use std::path::PathBuf;

use engine::units::{compass_deg, degrees, knots};
use flightgear::channel;
use flightgear::link::{CHANNEL_PORT, GHOST_PORT};
use flightgear::package::Package;
use flightgear::report::REPORT_PROTOCOL;

use super::scene::Scene;

/// Read and sent as often as frames are drawn: FlightGear does so once a frame at most.
const RATE_HZ: u32 = 250;
/// Hilo, whose scenery comes with FlightGear.
const HILO_DEG: (f64, f64) = (19.7214, -155.0485);
/// Near enough to begin at the airport, deg.
const AIRPORT_DEG: f64 = 0.1;

/// Where packets go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ports {
    /// Of FlightGear's own packets; others follow it.
    pub port: u16,
    /// Where FlightGear listens.
    pub listen: Ipv4Addr,
    /// Where what FlightGear tells goes.
    pub tell: (Ipv4Addr, u16),
}

/// A FlightGear to be started.
#[derive(Clone, Debug)]
pub struct Request {
    /// The program.
    pub fgfs: PathBuf,
    /// Our aircraft and protocols.
    pub package: Package,
    /// Where packets go.
    pub ports: Ports,
    /// What it shows first.
    pub scene: Scene,
    /// Whether scenery is downloaded.
    pub terrasync: bool,
    /// Arguments of the user's.
    pub extra: Vec<String>,
}

impl Request {
    /// The arguments, in an order that matters: what comes in is read before what goes out is written,
    /// so that what FlightGear tells is of the picture it has just got.
    pub fn arguments(&self) -> Vec<String> {
        let Ports { port, listen, tell } = self.ports;
        let incoming = |after: u16, protocol: &str| {
            format!("--generic=socket,in,{RATE_HZ},{listen},{},udp,{protocol}", port + after)
        };
        let mut arguments = vec![
            format!("--fg-aircraft={}", self.package.aircraft.display()),
            format!("--data={}", self.package.data.display()),
            "--aircraft=xv15".into(),
            "--fdm=null".into(),
            format!("--native-fdm=socket,in,{RATE_HZ},{listen},{port},udp"),
            incoming(CHANNEL_PORT, channel::PROTOCOL),
            incoming(GHOST_PORT, channel::GHOST_PROTOCOL),
            format!("--generic=socket,out,{RATE_HZ},{},{},udp,{REPORT_PROTOCOL}", tell.0, tell.1),
        ];
        arguments.extend(self.place());
        arguments.push(match self.scene.moment {
            Some(moment) => format!("--start-date-gmt={}", moment.date()),
            None => "--timeofday=noon".into(),
        });
        arguments
            .push(if self.terrasync { "--enable-terrasync" } else { "--disable-terrasync" }.into());
        // The weather is the flight's, and nobody else flies here.
        arguments.extend(
            [
                "--disable-real-weather-fetch",
                "--disable-ai-traffic",
                "--disable-fgcom",
                "--disable-hud",
                "--disable-save-on-exit",
                "--prop:bool:/sim/menubar/visibility=false",
            ]
            .map(String::from),
        );
        arguments.extend(self.extra.iter().cloned());
        arguments
    }

    /// Where it begins, and the wind there.
    fn place(&self) -> Vec<String> {
        let Some(start) = &self.scene.start else {
            return vec!["--airport=PHTO".into(), "--wind=0@0".into()];
        };
        let latitude_deg = degrees(start.origin.latitude_rad);
        let longitude_deg = degrees(start.origin.longitude_rad);
        let at_hilo = (latitude_deg - HILO_DEG.0).abs() < AIRPORT_DEG
            && (longitude_deg - HILO_DEG.1).abs() < AIRPORT_DEG;
        let mut place = if at_hilo {
            vec!["--airport=PHTO".into()]
        } else {
            vec![
                format!("--lat={latitude_deg:.6}"),
                format!("--lon={longitude_deg:.6}"),
                format!("--altitude={:.0}", start.origin.height_m / engine::units::FOOT_M),
            ]
        };
        let from_deg = compass_deg(start.world.wind_from_rad);
        place.push(format!("--wind={from_deg:.0}@{:.0}", knots(start.world.wind_mps)));
        place
    }

    /// As it is typed in a shell.
    pub fn in_a_shell(&self) -> String {
        let quoted = |text: &str| {
            let plain = |c: char| c.is_ascii_alphanumeric() || "-_=./,:@".contains(c);
            if !text.is_empty() && text.chars().all(plain) {
                text.to_string()
            } else {
                format!("'{}'", text.replace('\'', "'\\''"))
            }
        };
        let mut words = vec![quoted(&self.fgfs.display().to_string())];
        words.extend(self.arguments().iter().map(|argument| quoted(argument)));
        words.join(" \\\n    ")
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn request() -> Request {
        let scenario = aircraft::DEFAULT_SCENARIO;
        let start = aircraft::start("default.toml", scenario).expect("our own file");
        Request {
            fgfs: "/usr/games/fgfs".into(),
            package: Package::in_folder(Path::new("/a b/flightgear")),
            ports: Ports {
                port: 5501,
                listen: Ipv4Addr::LOCALHOST,
                tell: (Ipv4Addr::LOCALHOST, 5503),
            },
            scene: Scene { start: Some(start), moment: None },
            terrasync: false,
            extra: vec!["--geometry=640x480".into()],
        }
    }

    #[test]
    fn what_comes_in_is_read_before_what_goes_out_is_written() {
        let arguments = request().arguments();
        let place = |words: &str| {
            arguments.iter().position(|argument| argument.contains(words)).expect("there")
        };
        assert!(place("--native-fdm=socket,in,250,127.0.0.1,5501") < place("socket,out"));
        assert!(place("socket,in,250,127.0.0.1,5502,udp,tiltrotor") < place("socket,out"));
        assert!(arguments.contains(&"--airport=PHTO".into()), "{arguments:?}");
        assert!(arguments.contains(&"--wind=0@0".into()), "{arguments:?}");
        assert_eq!(arguments.last().map(String::as_str), Some("--geometry=640x480"));
    }

    #[test]
    fn elsewhere_it_begins_where_the_scenario_does_in_its_wind() {
        let mut elsewhere = request();
        let start = elsewhere.scene.start.as_mut().expect("there");
        (start.origin.latitude_rad, start.origin.longitude_rad) = (0.785, 0.13);
        (start.world.wind_mps, start.world.wind_from_rad) = (5.144, -std::f64::consts::FRAC_PI_2);
        let arguments = elsewhere.arguments();
        assert!(arguments.contains(&"--lat=44.977187".into()), "{arguments:?}");
        assert!(arguments.contains(&"--wind=270@10".into()), "{arguments:?}");
    }

    #[test]
    fn a_shell_understands_it() {
        let words = request().in_a_shell();
        assert!(words.contains("'--fg-aircraft=/a b/flightgear/Aircraft'"), "{words}");
    }
}
