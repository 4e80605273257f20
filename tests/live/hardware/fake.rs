//! Input devices that are not there, as files that umockdev makes the kernel's answers of.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

/// An axis: code, where it stands, and both ends.
pub type Axis = (u16, i32, i32, i32);

/// A device.
#[derive(Clone, Debug, Default)]
pub struct Fake {
    /// Of its files.
    pub label: &'static str,
    pub name: &'static str,
    /// Vendor, product, version.
    pub id: [u16; 3],
    /// Number of its node and of its USB port.
    pub number: u16,
    pub axes: Vec<Axis>,
    pub buttons: Vec<u16>,
}

/// In place of an event: so many tenths of a second in which nothing happens.
pub const PAUSE: u16 = u16::MAX;

/// The hat: left and right, forward and back.
pub const HAT: [Axis; 2] = [(16, 0, -1, 1), (17, 0, -1, 1)];

fn bits(codes: impl IntoIterator<Item = u16>, bytes: usize) -> Vec<u8> {
    let mut bits = vec![0; bytes];
    for code in codes {
        bits[usize::from(code / 8)] |= 1 << (code % 8);
    }
    bits
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02X}");
        hex
    })
}

/// As sysfs writes sets of bits: words of 64, the highest first.
fn words(bits: &[u8]) -> String {
    let words: Vec<u64> = bits
        .chunks(8)
        .map(|chunk| chunk.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte)))
        .collect();
    let last = words.iter().rposition(|&word| word != 0).unwrap_or(0);
    let words: Vec<String> = words[..=last].iter().rev().map(|word| format!("{word:x}")).collect();
    words.join(" ")
}

impl Fake {
    /// The port by which the map can choose it.
    pub fn port(&self) -> String {
        format!("pci-0000:00:14.0-usb-0:{}:1.0", self.number)
    }

    fn types(&self) -> Vec<u16> {
        let some = |there: bool, kind| there.then_some(kind);
        let kinds =
            [some(true, 0), some(!self.buttons.is_empty(), 1), some(!self.axes.is_empty(), 3)];
        kinds.into_iter().flatten().collect()
    }

    /// Writes the files for umockdev.
    pub fn write(&self, folder: &Path) {
        let Self { label, name, id: [vendor, product, version], number, .. } = self;
        let node = format!("event{number}");
        let keys = bits(self.buttons.iter().copied(), 96);
        let axes = bits(self.axes.iter().map(|axis| axis.0), 8);
        let kinds = bits(self.types(), 8);
        let parent =
            format!("/devices/pci0000:00/0000:00:14.0/usb1/1-{number}/input/input{number}");
        let port = self.port();
        let device = format!(
            "P: {parent}/{node}\nN: input/{node}\nE: DEVNAME=/dev/input/{node}\nE: ID_INPUT=1\n\
             E: ID_PATH={port}\nE: MAJOR=13\nE: MINOR={}\nE: SUBSYSTEM=input\nA: dev=13:{}\n\
             L: device=../../input{number}\n\n\
             P: {parent}\nE: ABS={}\nE: EV={}\nE: KEY={}\nE: NAME=\"{name}\"\n\
             E: PRODUCT=3/{vendor:x}/{product:x}/{version:x}\nE: SUBSYSTEM=input\nA: name={name}\n",
            64 + number,
            64 + number,
            words(&axes),
            words(&kinds),
            words(&keys),
        );
        let mut id = Vec::new();
        for part in [3, *vendor, *product, *version] {
            id.extend(part.to_le_bytes());
        }
        let mut called = name.as_bytes().to_vec();
        called.push(0);
        let length = called.len();
        called.resize(256, 0);
        let mut answers = format!(
            "@DEV /dev/input/{node}\nEVIOCGVERSION 0 01000100\nEVIOCGID 0 {}\n\
             EVIOCGNAME(0) {length} {}\nEVIOCGPROP(0) 4 00000000\nEVIOCGBIT(0) 4 {}\n\
             EVIOCGBIT(1) 96 {}\nEVIOCGBIT(3) 8 {}\nEVIOCGKEY(0) 96 {}\n",
            hex(&id),
            hex(&called),
            hex(&kinds[..4]),
            hex(&keys),
            hex(&axes),
            hex(&[0; 96]),
        );
        for &(code, value, low, high) in &self.axes {
            let numbers = [value, low, high, 0, 0, 0];
            let info: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
            let call = if code == 0 { "EVIOCGABS".into() } else { format!("EVIOCGABS({code})") };
            let _ = writeln!(answers, "{call} 0 {}", hex(&info));
        }
        fs::write(folder.join(format!("{label}.umockdev")), device).expect("a device");
        fs::write(folder.join(format!("{label}.ioctl")), answers).expect("its answers");
        self.script(folder, "sweep", &self.sweep());
    }

    /// Writes events that happen one after the other, a tenth of a second apart: `LABEL.NAME`.
    pub fn script(&self, folder: &Path, name: &str, events: &[(u16, u16, i32)]) {
        let mut lines = format!("# EVEMU 1.2\n# device /dev/input/event{}\n", self.number);
        let mut at = 0;
        for &(kind, code, value) in events {
            at += if kind == PAUSE { value } else { 1 };
            if kind == PAUSE {
                continue;
            }
            // umockdev takes microseconds with a leading zero for octal: whole tenths have none.
            let (seconds, tenths) = (at / 10, at % 10);
            let time = format!("{seconds}.{tenths}00000");
            let _ = writeln!(lines, "E: {time} {kind:04x} {code:04x} {value}");
            let _ = writeln!(lines, "E: {time} 0000 0000 0");
        }
        fs::write(folder.join(format!("{}.{name}", self.label)), lines).expect("its events");
    }

    /// Every axis to both ends and back, then the first four buttons.
    pub fn sweep(&self) -> Vec<(u16, u16, i32)> {
        let axes = self
            .axes
            .iter()
            .flat_map(|&(code, value, low, high)| [high, low, value].map(|at| (3, code, at)));
        let buttons = self.buttons.iter().take(4).flat_map(|&code| [(1, code, 1), (1, code, 0)]);
        axes.chain(buttons).collect()
    }
}

fn joystick_buttons(count: u16) -> Vec<u16> {
    (0x120..0x120 + count).collect()
}

const STICK_10: [Axis; 2] = [(0, 512, 0, 1023), (1, 512, 0, 1023)];

/// A device of what the public lists of capabilities say.
#[expect(clippy::too_many_lines, reason = "a table")]
pub fn known(label: &str) -> Fake {
    let with = |axes: &[Axis], hat: bool| {
        let mut axes = axes.to_vec();
        axes.extend(hat.then_some(HAT).into_iter().flatten());
        axes
    };
    let happy = |count: u16| (0x2c0..0x2c0 + count).collect::<Vec<u16>>();
    match label {
        "t16000m" => Fake {
            label: "t16000m",
            name: "Thrustmaster T.16000M",
            id: [0x44f, 0xb10a, 0x111],
            number: 20,
            axes: with(
                &[(0, 8192, 0, 16383), (1, 8192, 0, 16383), (5, 128, 0, 255), (6, 255, 0, 255)],
                true,
            ),
            buttons: joystick_buttons(16),
        },
        "trudder" => Fake {
            label: "trudder",
            name: "Thrustmaster T-Rudder",
            id: [0x44f, 0xb679, 0x110],
            number: 21,
            axes: vec![(0, 0, 0, 1023), (1, 0, 0, 1023), (2, 512, 0, 1023)],
            buttons: Vec::new(),
        },
        "saitekpedals" => Fake {
            label: "saitekpedals",
            name: "Saitek Saitek Pro Flight Rudder Pedals",
            id: [0x6a3, 0x763, 0x101],
            number: 22,
            axes: vec![(0, 0, 0, 127), (1, 0, 0, 127), (5, 255, 0, 511)],
            buttons: Vec::new(),
        },
        "homemade" => Fake {
            label: "homemade",
            name: "Arduino Pedals",
            id: [0x2341, 0x8036, 0x101],
            number: 33,
            axes: vec![(3, 0, 0, 1023), (4, 0, 0, 1023), (7, 512, 0, 1023)],
            buttons: Vec::new(),
        },
        "x52pro" => Fake {
            label: "x52pro",
            name: "Saitek X52 Pro Flight Control System",
            id: [0x6a3, 0x762, 0x111],
            number: 23,
            axes: with(
                &[
                    STICK_10[0],
                    STICK_10[1],
                    (2, 255, 0, 255),
                    (3, 128, 0, 255),
                    (4, 128, 0, 255),
                    (5, 512, 0, 1023),
                    (6, 255, 0, 255),
                    (0x28, 8, 0, 15),
                    (0x29, 8, 0, 15),
                ],
                true,
            ),
            buttons: [joystick_buttons(16), happy(23)].concat(),
        },
        "x56stick" => Fake {
            label: "x56stick",
            name: "Mad Catz Saitek Pro Flight X-56 Rhino Stick",
            id: [0x738, 0x2221, 0x111],
            number: 24,
            axes: with(&[(0, 32768, 0, 65535), (1, 32768, 0, 65535), (5, 2048, 0, 4095)], true),
            buttons: joystick_buttons(17),
        },
        "x56throttle" => Fake {
            label: "x56throttle",
            name: "Mad Catz Saitek Pro Flight X-56 Rhino Throttle",
            id: [0x738, 0xa221, 0x111],
            number: 25,
            axes: vec![(0, 1023, 0, 1023), (1, 1023, 0, 1023), (2, 255, 0, 255)],
            buttons: [joystick_buttons(16), happy(20)].concat(),
        },
        "st290" => Fake {
            label: "st290",
            name: "Saitek ST290 Pro",
            id: [0x6a3, 0x460, 0x100],
            number: 26,
            axes: with(
                &[(0, 128, 0, 255), (1, 128, 0, 255), (2, 255, 0, 255), (5, 128, 0, 255)],
                true,
            ),
            buttons: joystick_buttons(6),
        },
        "extreme3d" => Fake {
            label: "extreme3d",
            name: "Logitech Logitech Extreme 3D",
            id: [0x46d, 0xc215, 0x110],
            number: 27,
            axes: with(&[STICK_10[0], STICK_10[1], (5, 128, 0, 255), (6, 255, 0, 255)], true),
            buttons: joystick_buttons(12),
        },
        "xpad" => Fake {
            label: "xpad",
            name: "Microsoft X-Box One pad",
            id: [0x45e, 0x2ea, 0x301],
            number: 28,
            axes: with(
                &[
                    (0, 93, -32768, 32767),
                    (1, -208, -32768, 32767),
                    (2, 0, 0, 1023),
                    (3, 637, -32768, 32767),
                    (4, -192, -32768, 32767),
                    (5, 0, 0, 1023),
                ],
                true,
            ),
            buttons: vec![304, 305, 307, 308, 310, 311, 314, 315, 316, 317, 318],
        },
        "radio" => Fake {
            label: "radio",
            name: "OpenTX Radiomaster TX16S Joystick",
            id: [0x1209, 0x4f54, 0x111],
            number: 29,
            axes: [1024, 1024, 0, 1024, 1024, 0, 2047, 2047]
                .into_iter()
                .zip(0..)
                .map(|(value, code)| (code, value, 0, 2047))
                .collect(),
            buttons: joystick_buttons(16),
        },
        "nano" => Fake {
            label: "nano",
            name: "Microsoft Nano Transceiver v2.0",
            id: [0x45e, 0x745, 0x111],
            number: 30,
            axes: vec![(0, 0, 0, 255), (1, 0, 0, 255), (0x20, 0, 0, 1023)],
            buttons: (1..120).collect(),
        },
        other => panic!("no device is called {other}"),
    }
}
