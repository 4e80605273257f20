//! A flight with a stick and pedals that the kernel makes: `virtual_devices FOLDER PROGRAM ARGUMENTS…`
//!
//! Makes both with uinput, starts the program, moves the devices, unplugs the pedals and plugs them in
//! again, and ends the program. Every step waits for what the program says of the one before, so that it
//! does not matter how slow the machine is. A second reader of each node writes down what the kernel
//! said, with the kernel's times: FOLDER/kernel.txt. For `tests/qemu_stick.sh`.

#[cfg(target_os = "linux")]
fn main() -> std::io::Result<()> {
    linux::main()
}

#[cfg(not(target_os = "linux"))]
fn main() {
    println!("uinput is Linux's");
}

#[cfg(target_os = "linux")]
mod linux {
    use std::fs;
    use std::io::{self, BufRead, BufReader, Write as _};
    use std::path::{Path, PathBuf};
    use std::process::{Command, Stdio};
    use std::sync::mpsc::{self, Receiver, Sender};
    use std::thread;
    use std::time::{Duration, UNIX_EPOCH};

    use evdev::raw_stream::RawDevice;
    use evdev::uinput::VirtualDevice;
    use evdev::{
        AbsInfo, AbsoluteAxisCode, AttributeSet, BusType, EventType, InputEvent, InputId, KeyCode,
        UinputAbsSetup,
    };

    /// Nothing takes longer than this, even on an emulated processor.
    const LIMIT: Duration = Duration::from_secs(300);

    const ABS: u16 = EventType::ABSOLUTE.0;
    const KEY: u16 = EventType::KEY.0;

    /// A device, and its node.
    struct Virtual {
        device: VirtualDevice,
        node: PathBuf,
    }

    impl Virtual {
        fn new(
            name: &str,
            (vendor, product): (u16, u16),
            axes: &[(u16, i32, i32, i32)],
            keys: &[u16],
            witness: &Sender<String>,
        ) -> io::Result<Self> {
            let keys: AttributeSet<KeyCode> = keys.iter().map(|&key| KeyCode(key)).collect();
            let id = InputId::new(BusType::BUS_USB, vendor, product, 0x111);
            let mut builder = VirtualDevice::builder()?.name(name).input_id(id);
            for &(code, value, low, high) in axes {
                let info = AbsInfo::new(value, low, high, 0, 0, 0);
                let axis = UinputAbsSetup::new(AbsoluteAxisCode(code), info);
                builder = builder.with_absolute_axis(&axis)?;
            }
            if keys.iter().next().is_some() {
                builder = builder.with_keys(&keys)?;
            }
            let mut device = builder.build()?;
            let node = device
                .enumerate_dev_nodes_blocking()?
                .next()
                .ok_or_else(|| io::Error::other("the kernel made no node"))??;
            write_down(name, open(&node)?, witness.clone());
            Ok(Self { device, node })
        }

        fn say(&mut self, events: &[(u16, u16, i32)]) -> io::Result<()> {
            for &(kind, code, value) in events {
                self.device.emit(&[InputEvent::new(kind, code, value)])?;
            }
            Ok(())
        }
    }

    /// The second reader: ends when the device is unplugged.
    fn write_down(name: &str, mut second: RawDevice, witness: Sender<String>) {
        let name = name.to_string();
        thread::spawn(move || {
            while let Ok(events) = second.fetch_events() {
                for event in events.filter(|event| [ABS, KEY].contains(&event.event_type().0)) {
                    let since = event.timestamp().duration_since(UNIX_EPOCH);
                    let ns = since.unwrap_or_default().as_nanos();
                    let (kind, code, value) = (event.event_type().0, event.code(), event.value());
                    let _ = witness.send(format!("{name}\t{ns}\t{kind}\t{code}\t{value}"));
                }
            }
        });
    }

    /// The node may be there before its permissions are.
    fn open(node: &Path) -> io::Result<RawDevice> {
        for _ in 0..100 {
            if let Ok(device) = RawDevice::open(node) {
                return Ok(device);
            }
            thread::sleep(Duration::from_millis(100));
        }
        RawDevice::open(node)
    }

    fn stick(witness: &Sender<String>) -> io::Result<Virtual> {
        let axes = [
            (0, 8192, 0, 16383),
            (1, 8192, 0, 16383),
            (5, 128, 0, 255),
            (6, 255, 0, 255),
            (16, 0, -1, 1),
            (17, 0, -1, 1),
        ];
        let keys: Vec<u16> = (0x120..0x130).collect();
        Virtual::new("Virtual T.16000M", (0x44f, 0xb10a), &axes, &keys, witness)
    }

    /// Without buttons.
    fn pedals(witness: &Sender<String>) -> io::Result<Virtual> {
        let axes = [(0, 0, 0, 127), (1, 0, 0, 127), (5, 255, 0, 511)];
        Virtual::new("Virtual Pedals", (0x6a3, 0x763), &axes, &[], witness)
    }

    /// Waits until the program has said it.
    fn wait_for(said: &Receiver<String>, words: &str) -> io::Result<()> {
        loop {
            match said.recv_timeout(LIMIT) {
                Ok(line) if line.contains(words) => return Ok(()),
                Ok(_) => {}
                Err(_) => {
                    return Err(io::Error::other(format!("the program did not say: {words}")));
                }
            }
        }
    }

    /// Movements of both: `count` steps from end to end, buttons and hat between them.
    fn move_about(stick: &mut Virtual, pedals: &mut Virtual, count: i32) -> io::Result<()> {
        for step in 0..count {
            let part = |range: i32| range * (step * 7 % count) / count;
            stick.say(&[
                (ABS, 0, part(16383)),
                (ABS, 1, 16383 - part(16383)),
                (ABS, 6, 255 - part(255)),
                (ABS, 17, step % 3 - 1),
            ])?;
            pedals.say(&[(ABS, 5, part(511)), (ABS, 0, part(127)), (ABS, 1, 127 - part(127))])?;
            if step % 10 == 0 {
                stick.say(&[(KEY, 0x122, 1), (KEY, 0x122, 0)])?;
            }
            // A kernel's queue holds 64 events, and both readers share two emulated processors.
            thread::sleep(Duration::from_millis(20));
        }
        Ok(())
    }

    /// The flight, and what it says.
    fn begin(folder: &Path) -> io::Result<(std::process::Child, Receiver<String>)> {
        let mut arguments = std::env::args().skip(2);
        let program = arguments.next().ok_or_else(|| io::Error::other("which program?"))?;
        let log = folder.join("flight.mcap");
        let mut flight = Command::new(program)
            .args(arguments)
            .arg("--out")
            .arg(&log)
            .stderr(Stdio::piped())
            .spawn()?;
        let stderr = flight.stderr.take().ok_or_else(|| io::Error::other("no standard error"))?;
        let (tell, said) = mpsc::channel();
        thread::spawn(move || {
            for line in BufReader::new(stderr).lines().map_while(Result::ok) {
                // An emulated console is slower than the slips of an emulated processor.
                if !line.contains("slipped") {
                    println!("  {line}");
                    let _ = tell.send(line);
                }
            }
        });
        wait_for(&said, "device 1:")?;
        while !log.exists() {
            if flight.try_wait()?.is_some() {
                return Err(io::Error::other("the flight ended before it began"));
            }
            thread::sleep(Duration::from_millis(100));
        }
        Ok((flight, said))
    }

    pub fn main() -> io::Result<()> {
        let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".into()));
        let (witness, seen) = mpsc::channel();
        let mut stick = stick(&witness)?;
        let mut first = pedals(&witness)?;
        println!("stick {}, pedals {}", stick.node.display(), first.node.display());
        let (mut flight, said) = begin(&folder)?;
        println!("moving both");
        move_about(&mut stick, &mut first, 40)?;
        println!("unplugging the pedals");
        drop(first);
        wait_for(&said, "is unplugged")?;
        stick.say(&[(ABS, 0, 1), (ABS, 0, 8192)])?;
        println!("plugging them in again");
        let mut second = pedals(&witness)?;
        wait_for(&said, "is plugged in")?;
        move_about(&mut stick, &mut second, 40)?;
        // The marker, last.
        stick.say(&[(KEY, 0x121, 1), (KEY, 0x121, 0)])?;
        thread::sleep(Duration::from_secs(3));
        println!("ending the flight");
        Command::new("kill").args(["-INT", &flight.id().to_string()]).status()?;
        let status = flight.wait()?;
        println!("the flight ended: {status}");
        drop((stick, second, witness));
        let mut kernel = fs::File::create(folder.join("kernel.txt"))?;
        // The second readers end with their devices.
        for line in seen {
            writeln!(kernel, "{line}")?;
        }
        kernel.sync_all()?;
        if status.success() { Ok(()) } else { Err(io::Error::other("the flight failed")) }
    }
}
