//! What FlightGear tells: whether it draws, the ground under the wheels, and its own controls.
//!
//! Its generic protocol sends one packet a drawn frame; `data/Protocol/tiltrotor-out.xml`, made from
//! the table here, says of what. The ground comes from `Nasal/ground.nas` of the aircraft package.
//!
//! # Signs
//! Big-endian, tightly packed. The first number is a constant that FlightGear is told to send, so that
//! packets of others are not taken for its. Wheels: nose, left, right. Heights are FlightGear's, above
//! its sea level, as the pictures' heights are. Controls in FlightGear's sense: aileron right, elevator
//! back (it calls that negative), rudder right.

use std::fmt::Write as _;

use engine::math::max;

use crate::channel::Kind::{self, Double, Int};

/// Name of the protocol: FlightGear looks for `Protocol/tiltrotor-out.xml`.
pub const REPORT_PROTOCOL: &str = "tiltrotor-out";
/// The first number of a packet, "TRT1".
pub const MAGIC: i32 = 0x5452_5431;

/// What is sent, in order; the constant has no place in FlightGear's tree, so that it reads as 0 there,
/// and an offset.
const FIELDS: [(&str, Kind); COUNT] = [
    ("tiltrotor/out/nothing", Int),
    ("tiltrotor/tick", Double),
    ("sim/time/elapsed-sec", Double),
    ("sim/sceneryloaded", Int),
    ("position/latitude-deg", Double),
    ("position/longitude-deg", Double),
    ("position/altitude-ft", Double),
    ("tiltrotor/ground/samples", Int),
    ("tiltrotor/ground/latitude-deg", Double),
    ("tiltrotor/ground/longitude-deg", Double),
    ("tiltrotor/ground/wheel[0]/height-m", Double),
    ("tiltrotor/ground/wheel[1]/height-m", Double),
    ("tiltrotor/ground/wheel[2]/height-m", Double),
    ("controls/flight/aileron", Double),
    ("controls/flight/elevator", Double),
    ("controls/flight/rudder", Double),
    ("controls/engines/engine[0]/throttle", Double),
    ("controls/gear/brake-left", Double),
    ("controls/gear/brake-right", Double),
    ("controls/tiltrotor/nacelle-cmd", Int),
    ("controls/tiltrotor/flap-down", Int),
    ("controls/tiltrotor/flap-up", Int),
    ("controls/tiltrotor/gear-toggle", Int),
    ("controls/tiltrotor/parking-brake-toggle", Int),
    ("controls/tiltrotor/scas-toggle", Int),
    ("controls/tiltrotor/rpm-select", Int),
    ("controls/tiltrotor/marker", Int),
];
const COUNT: usize = 27;

/// Bytes of a packet.
pub const REPORT_LENGTH: usize = length();

/// Ground under the wheels, sampled at one place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GroundSample {
    /// How many samples there have been.
    pub number: i64,
    /// Where the aircraft was.
    pub latitude_deg: f64,
    /// Where the aircraft was.
    pub longitude_deg: f64,
    /// Under the wheels.
    pub height_m: [f64; 3],
}

/// FlightGear's own controls.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Controls {
    /// −1 left … 1 right.
    pub aileron: f64,
    /// −1 back … 1 forward, as FlightGear counts it.
    pub elevator: f64,
    /// −1 left … 1 right.
    pub rudder: f64,
    /// 0 … 1.
    pub throttle: f64,
    /// 0 … 1, left and right.
    pub brakes: [f64; 2],
    /// −1 forward, 0, 1 aft.
    pub nacelle: i64,
    /// How often each key was pressed, in the order of [`PRESSES`].
    pub presses: [i64; PRESSES.len()],
}

/// What the keys that are counted do: names of the cockpit's button controls.
pub const PRESSES: [&str; 7] = [
    "flap_down",
    "flap_up",
    "gear_toggle",
    "parking_brake_toggle",
    "scas_toggle",
    "rpm_select",
    "marker",
];

/// One packet.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The tick that FlightGear shows; 0 before it has got one.
    pub tick: f64,
    /// FlightGear's own time: it goes on while frames are drawn.
    pub elapsed_s: f64,
    /// Whether the scenery around is there.
    pub scenery_loaded: bool,
    /// Where FlightGear has the aircraft.
    pub latitude_deg: f64,
    /// Where FlightGear has the aircraft.
    pub longitude_deg: f64,
    /// Where FlightGear has the aircraft.
    pub altitude_ft: f64,
    /// The ground; `None` before it was sampled, and where the scenery is not there.
    pub ground: Option<GroundSample>,
    /// Its own controls.
    pub controls: Controls,
}

/// Why bytes are no report.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReportError {
    /// Too short or too long.
    #[error("packet of {got} bytes, expected {REPORT_LENGTH}")]
    Length {
        /// Bytes received.
        got: usize,
    },
    /// Somebody else's packet, or another version's.
    #[error("a packet that is not of the protocol {REPORT_PROTOCOL}")]
    Magic,
    /// A number that is not finite, or not what it is to be.
    #[error("{node} is out of range")]
    Range {
        /// Which.
        node: &'static str,
    },
}

impl Report {
    /// Reads a packet.
    ///
    /// # Errors
    /// When it is not one, whole and in range.
    pub fn parse(bytes: &[u8]) -> Result<Self, ReportError> {
        if bytes.len() != REPORT_LENGTH {
            return Err(ReportError::Length { got: bytes.len() });
        }
        let mut numbers = [0.0; COUNT];
        let mut at = 0;
        for (number, (node, kind)) in numbers.iter_mut().zip(FIELDS) {
            *number = kind.read(&bytes[at..at + kind.size()]);
            at += kind.size();
            if !number.is_finite() || number.abs() > 1e15 {
                return Err(ReportError::Range { node });
            }
        }
        let [
            magic,
            tick,
            elapsed_s,
            scenery,
            latitude_deg,
            longitude_deg,
            altitude_ft,
            samples,
            sample_latitude_deg,
            sample_longitude_deg,
            nose_m,
            left_m,
            right_m,
            aileron,
            elevator,
            rudder,
            throttle,
            brake_left,
            brake_right,
            nacelle,
            presses @ ..,
        ] = numbers;
        if magic as i32 != MAGIC {
            return Err(ReportError::Magic);
        }
        let scenery_loaded = scenery > 0.0;
        let sample = GroundSample {
            number: samples as i64,
            latitude_deg: sample_latitude_deg,
            longitude_deg: sample_longitude_deg,
            height_m: [nose_m, left_m, right_m],
        };
        let unit = |norm: f64| norm.clamp(-1.0, 1.0);
        Ok(Self {
            tick,
            elapsed_s,
            scenery_loaded,
            latitude_deg,
            longitude_deg,
            altitude_ft,
            ground: Some(sample).filter(|sample| scenery_loaded && sample.number > 0),
            controls: Controls {
                aileron: unit(aileron),
                elevator: unit(elevator),
                rudder: unit(rudder),
                throttle: max(0.0, unit(throttle)),
                brakes: [max(0.0, unit(brake_left)), max(0.0, unit(brake_right))],
                nacelle: unit(nacelle) as i64,
                presses: presses.map(|number| number as i64),
            },
        })
    }

    /// The packet, as FlightGear would send it.
    pub fn bytes(&self) -> Vec<u8> {
        let ground = self.ground.unwrap_or_default();
        let controls = &self.controls;
        let [nose_m, left_m, right_m] = ground.height_m;
        let mut numbers = vec![
            f64::from(MAGIC),
            self.tick,
            self.elapsed_s,
            f64::from(u8::from(self.scenery_loaded)),
            self.latitude_deg,
            self.longitude_deg,
            self.altitude_ft,
            ground.number as f64,
            ground.latitude_deg,
            ground.longitude_deg,
            nose_m,
            left_m,
            right_m,
            controls.aileron,
            controls.elevator,
            controls.rudder,
            controls.throttle,
            controls.brakes[0],
            controls.brakes[1],
            controls.nacelle as f64,
        ];
        numbers.extend(controls.presses.map(|number| number as f64));
        let mut bytes = vec![0; REPORT_LENGTH];
        let mut at = 0;
        for (number, (_, kind)) in numbers.into_iter().zip(FIELDS) {
            kind.write(number, &mut bytes[at..at + kind.size()]);
            at += kind.size();
        }
        bytes
    }
}

/// `Protocol/tiltrotor-out.xml`.
pub fn report_protocol() -> String {
    let mut xml = String::from(
        "<?xml version=\"1.0\"?>\n\
         <!-- Generated from flightgear/src/report.rs: change it there, then run\n     \
         BLESS=1 cargo test -p flightgear protocol. -->\n\
         <PropertyList>\n <generic>\n  <output>\n   <binary_mode>true</binary_mode>\n   \
         <byte_order>network</byte_order>\n   <binary_footer>none</binary_footer>\n",
    );
    for (place, (node, kind)) in FIELDS.into_iter().enumerate() {
        let offset = if place == 0 { format!("<offset>{MAGIC}</offset>") } else { String::new() };
        let _ = writeln!(
            xml,
            "   <chunk><node>/{node}</node><type>{}</type>{offset}</chunk>",
            kind.name()
        );
    }
    xml.push_str("  </output>\n </generic>\n</PropertyList>\n");
    xml
}

const fn length() -> usize {
    let (mut field, mut sum) = (0, 0);
    while field < COUNT {
        sum += FIELDS[field].1.size();
        field += 1;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        Report {
            tick: 1234.0,
            elapsed_s: 5.25,
            scenery_loaded: true,
            latitude_deg: 19.7,
            longitude_deg: -155.0,
            altitude_ft: 45.5,
            ground: Some(GroundSample {
                number: 7,
                latitude_deg: 19.7,
                longitude_deg: -155.0,
                height_m: [11.0, 12.0, 13.0],
            }),
            controls: Controls {
                aileron: 0.5,
                elevator: -1.0,
                rudder: 0.25,
                throttle: 0.75,
                brakes: [0.0, 1.0],
                nacelle: -1,
                presses: [1, 2, 3, 4, 5, 6, 7],
            },
        }
    }

    #[test]
    fn the_protocol_file_is_the_table() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/Protocol/tiltrotor-out.xml");
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(path, report_protocol()).expect("written");
        }
        let kept = std::fs::read_to_string(path).unwrap_or_default();
        let fresh = kept == report_protocol();
        assert!(fresh, "{path} is stale: BLESS=1 cargo test -p flightgear protocol");
    }

    #[test]
    fn what_was_sent_is_what_is_read() {
        assert_eq!(Report::parse(&report().bytes()), Ok(report()));
        let bare = Report { ground: None, scenery_loaded: false, ..report() };
        assert_eq!(Report::parse(&bare.bytes()), Ok(bare));
    }

    #[test]
    fn ground_without_scenery_is_none() {
        let loading = Report { scenery_loaded: false, ..report() };
        assert_eq!(Report::parse(&loading.bytes()).map(|report| report.ground), Ok(None));
    }

    #[test]
    fn what_is_no_report_is_refused() {
        let good = report().bytes();
        assert_eq!(Report::parse(&good[1..]), Err(ReportError::Length { got: REPORT_LENGTH - 1 }));
        assert_eq!(Report::parse(&[0; REPORT_LENGTH]), Err(ReportError::Magic));
        let mut bytes = good.clone();
        bytes[4..12].copy_from_slice(&f64::NAN.to_be_bytes());
        assert_eq!(Report::parse(&bytes), Err(ReportError::Range { node: "tiltrotor/tick" }));
    }

    #[test]
    fn controls_beyond_their_travel_are_at_their_ends() {
        let mut wild = report();
        wild.controls.throttle = -7.0;
        wild.controls.elevator = 1e6;
        let read = Report::parse(&wild.bytes()).expect("a report").controls;
        assert!(read.throttle.abs() < 1e-12 && (read.elevator - 1.0).abs() < 1e-12);
    }
}
