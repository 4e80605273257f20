//! Sticks, throttles, pedals and pads on Linux: the kernel's own events, read-only, without any filter.
//!
//! One node has one reader. What udev says a device is does not count, only what it has. That a device
//! has gone shows in three ways, and any of them will do: the read fails or ends, the node vanishes, udev
//! says so.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

use engine::inputs::{DeviceEvent, EventKind};
use evdev::raw_stream::RawDevice;
use evdev::{EventType, InputEvent, PropType};
use inotify::{Inotify, WatchMask};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::OFlags;
use thread_priority::unix::{
    RealtimeThreadSchedulePolicy, ThreadSchedulePolicy, set_thread_priority_and_policy,
    thread_native_id,
};
use thread_priority::{ThreadPriority, ThreadPriorityValue};
use udev::MonitorBuilder;

use super::found::{Axis, Found, Ignored, Survey, Why, kind};
use super::stream::{Stream, of_kind};

/// Where the nodes are.
const NODES: &str = "/dev/input";
/// How long the thread waits before it looks whether it should end.
const WAIT: Timespec = Timespec { tv_sec: 0, tv_nsec: 100_000_000 };

/// `SYN_REPORT` and `SYN_DROPPED`.
const REPORT: u16 = 0;
const DROPPED: u16 = 3;

/// Asks for real-time scheduling of this thread, one above the loop's, so that an event waits for nobody;
/// returns what was not granted, in words.
pub fn claim_priority() -> Vec<String> {
    /// The loop has 40.
    const PRIORITY: u8 = 41;
    let fifo = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let granted = ThreadPriorityValue::try_from(PRIORITY).is_ok_and(|priority| {
        let priority = ThreadPriority::Crossplatform(priority);
        set_thread_priority_and_policy(thread_native_id(), priority, fifo).is_ok()
    });
    if granted {
        return Vec::new();
    }
    vec![format!(
        "no real-time scheduling (SCHED_FIFO) of the input thread: events may wait under load; \
         `ulimit -r {PRIORITY}` or CAP_SYS_NICE grants it"
    )]
}

/// All devices that are there.
pub fn survey() -> Survey {
    let mut survey = Survey::default();
    for node in nodes() {
        match Reading::open(&node) {
            Ok((reading, found)) => {
                drop(reading);
                survey.found.push(found);
            }
            Err(error) => {
                let why = match error.kind() {
                    ErrorKind::PermissionDenied => Why::Permission,
                    ErrorKind::NotFound => continue,
                    _ => Why::Broken,
                };
                survey.ignored.push(Ignored { name: name_of(&node), node, why });
            }
        }
    }
    survey
}

/// Which of the devices another program has taken for itself.
pub fn taken(survey: &Survey) -> Vec<Ignored> {
    let is_taken = |found: &&Found| {
        if !found.kind.flies() {
            return false;
        }
        let Ok((mut reading, _)) = Reading::open(&found.node) else { return false };
        let grabbed = reading.device.grab();
        let _ = reading.device.ungrab();
        grabbed.is_err_and(|error| error.kind() == ErrorKind::ResourceBusy)
    };
    let ignored = |found: &Found| Ignored {
        node: found.node.clone(),
        name: found.name.clone(),
        why: Why::Taken,
    };
    survey.found.iter().filter(is_taken).map(ignored).collect()
}

/// The nodes in the order of their numbers.
fn nodes() -> Vec<String> {
    let entries = fs::read_dir(NODES).into_iter().flatten().flatten();
    let mut numbers: Vec<u64> = entries
        .filter_map(|entry| entry.file_name().to_str()?.strip_prefix("event")?.parse().ok())
        .collect();
    numbers.sort_unstable();
    numbers.into_iter().map(|number| format!("{NODES}/event{number}")).collect()
}

/// What a device calls itself whose node cannot be opened.
fn name_of(node: &str) -> String {
    let name = node.rsplit('/').next().unwrap_or_default();
    let text = fs::read_to_string(format!("/sys/class/input/{name}/device/name"));
    text.map_or_else(|_| "unknown".into(), |text| text.trim().to_string())
}

/// A device as udev knows it.
fn in_udev(node: &str) -> Option<udev::Device> {
    let name = node.rsplit('/').next()?.to_string();
    udev::Device::from_subsystem_sysname("input".into(), name).ok()
}

/// Where a device is plugged in, as udev names it.
fn port_of(device: &udev::Device) -> Option<String> {
    Some(device.property_value("ID_PATH")?.to_str()?.to_string())
}

/// A device that is open.
struct Reading {
    device: RawDevice,
    node: String,
    /// Its place in sysfs, which the next device on the same node does not have.
    place: Option<PathBuf>,
    /// Its number in the map.
    number: usize,
    axes: Vec<Axis>,
    pressed: Vec<u64>,
    /// Events were lost; what comes before the next end of a packet is of before.
    lost: bool,
}

impl Reading {
    fn open(node: &str) -> io::Result<(Self, Found)> {
        let flags = (OFlags::NONBLOCK | OFlags::CLOEXEC).bits().cast_signed();
        let file: File = OpenOptions::new().read(true).custom_flags(flags).open(node)?;
        let device = RawDevice::from_fd(OwnedFd::from(file))?;
        let udevs = in_udev(node);
        let axes = axes_of(&device)?;
        let pressed = pressed_of(&device);
        let id = device.input_id();
        let keys: Vec<u64> =
            device.supported_keys().into_iter().flat_map(|keys| keys.iter()).map(code).collect();
        let properties = device.properties();
        let has_pointer = properties.contains(PropType::POINTER)
            || properties.contains(PropType::BUTTONPAD)
            || properties.contains(PropType::DIRECT);
        let is_motion = properties.contains(PropType::ACCELEROMETER);
        let has_relative = device.supported_events().contains(EventType::RELATIVE);
        let text = |text: Option<&str>| text.unwrap_or_default().to_string();
        let phys = text(device.physical_path());
        let found = Found {
            node: node.to_string(),
            name: text(device.name()),
            bus: u64::from(id.bus_type().0),
            vendor: u64::from(id.vendor()),
            product: u64::from(id.product()),
            version: u64::from(id.version()),
            uniq: text(device.unique_name()),
            port: udevs
                .as_ref()
                .and_then(port_of)
                .or_else(|| Some(phys.clone()).filter(|phys| !phys.is_empty()))
                .unwrap_or_else(|| node.to_string()),
            phys,
            kind: kind(&axes, &keys, has_pointer, is_motion, has_relative),
            axes: axes.clone(),
            keys,
            pressed: pressed.clone(),
        };
        let node = node.to_string();
        let place = udevs.map(|device| device.syspath().to_path_buf());
        Ok((Self { device, node, place, number: 0, axes, pressed, lost: false }, found))
    }

    /// Reads what there is; whether the device is still there.
    fn read(&mut self, stream: &mut Stream) -> bool {
        loop {
            let events: Vec<InputEvent> = match self.device.fetch_events() {
                Ok(events) => events.collect(),
                Err(error) if error.kind() == ErrorKind::WouldBlock => return true,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return false,
            };
            if events.is_empty() {
                return false;
            }
            for event in events {
                self.take(event, stream);
            }
        }
    }

    fn take(&mut self, event: InputEvent, stream: &mut Stream) {
        let (code, value) = (u64::from(event.code()), i64::from(event.value()));
        match (event.event_type(), event.code()) {
            (EventType::SYNCHRONIZATION, DROPPED) => {
                stream.say(self.number, &of_kind(EventKind::Dropped), event.timestamp());
                self.lost = true;
            }
            (EventType::SYNCHRONIZATION, REPORT) if self.lost => {
                self.lost = false;
                self.ask_anew(stream);
            }
            _ if self.lost => {}
            (EventType::ABSOLUTE, _) => {
                let axis = self.axes.iter_mut().find(|axis| axis.code == code);
                let (raw_min, raw_max) = axis.map_or((0, 0), |axis| {
                    axis.value = Some(value);
                    (axis.raw_min, axis.raw_max)
                });
                let moved =
                    DeviceEvent { code, value, raw_min, raw_max, ..of_kind(EventKind::Axis) };
                stream.say(self.number, &moved, event.timestamp());
            }
            // 2 is a key that repeats itself.
            (EventType::KEY, _) if value < 2 => {
                self.pressed.retain(|&pressed| pressed != code);
                if value != 0 {
                    self.pressed.push(code);
                }
                let pressed = DeviceEvent { code, value, ..of_kind(EventKind::Button) };
                stream.say(self.number, &pressed, event.timestamp());
            }
            // Scan codes, lights, and whatever a newer kernel has.
            _ => {}
        }
    }

    /// After lost events: what has moved moves, of the rest is told where it stands.
    fn ask_anew(&mut self, stream: &mut Stream) {
        let Ok(now) = axes_of(&self.device) else { return };
        for axis in &now {
            let known = self.axes.iter().find(|known| known.code == axis.code);
            let same = known.is_some_and(|known| known.value == axis.value);
            let kind = if same { EventKind::AxisPosition } else { EventKind::Axis };
            let Axis { code, raw_min, raw_max, value } = *axis;
            let value = value.unwrap_or_default();
            stream
                .put(self.number, &DeviceEvent { code, value, raw_min, raw_max, ..of_kind(kind) });
        }
        let pressed = pressed_of(&self.device);
        for &code in self.pressed.iter().filter(|code| !pressed.contains(code)) {
            let released = DeviceEvent { code, ..of_kind(EventKind::Button) };
            stream.put(self.number, &released);
        }
        for &code in &pressed {
            let known = self.pressed.contains(&code);
            let kind = if known { EventKind::ButtonPosition } else { EventKind::Button };
            stream.put(self.number, &DeviceEvent { code, value: 1, ..of_kind(kind) });
        }
        (self.axes, self.pressed) = (now, pressed);
    }
}

fn code(key: evdev::KeyCode) -> u64 {
    u64::from(key.code())
}

fn axes_of(device: &RawDevice) -> io::Result<Vec<Axis>> {
    let axes = device.get_absinfo()?.map(|(axis, info)| Axis {
        code: u64::from(axis.0),
        raw_min: i64::from(info.minimum()),
        raw_max: i64::from(info.maximum()),
        value: Some(i64::from(info.value())),
    });
    Ok(axes.collect())
}

/// Buttons and keys that are pressed; none where the device does not tell.
fn pressed_of(device: &RawDevice) -> Vec<u64> {
    if device.supported_keys().is_none() {
        return Vec::new();
    }
    device.get_key_state().map(|keys| keys.iter().map(code).collect()).unwrap_or_default()
}

/// The thread's end: all devices that are read, and what tells of new ones.
pub struct Reader {
    stream: Stream,
    reading: Vec<Reading>,
    /// Nodes that are there and not read, so that each is told of once.
    known: Vec<String>,
}

impl Reader {
    /// Opens the devices with their numbers, and tells where everything stands.
    pub fn new(mut stream: Stream, numbers: &[(usize, Found)], others: &[Found]) -> Self {
        let mut reading = Vec::new();
        for (number, found) in numbers {
            let Ok((mut opened, found)) = Reading::open(&found.node) else { continue };
            opened.number = *number;
            stream.plug_in(*number, &found);
            reading.push(opened);
        }
        let known = others.iter().map(|found| found.node.clone()).collect();
        Self { stream, reading, known }
    }

    /// Reads until it is to end.
    pub fn run(mut self, stop: &AtomicBool) {
        // Without either, devices are still read, and losses seen by the reads that fail.
        let mut nodes = watch_nodes().ok();
        let monitor = MonitorBuilder::new()
            .and_then(|builder| builder.match_subsystem("input"))
            .and_then(MonitorBuilder::listen)
            .ok();
        while !stop.load(Ordering::Relaxed) {
            let (ready, changed) = self.wait(nodes.as_ref(), monitor.as_ref());
            let mut gone = Vec::new();
            for (at, hung_up) in ready {
                if !self.reading[at].read(&mut self.stream) || hung_up {
                    gone.push(self.reading[at].node.clone());
                }
            }
            for node in gone {
                self.close(&node);
            }
            if changed {
                self.look(nodes.as_mut(), monitor.as_ref());
            }
        }
    }

    /// Waits for anything; which devices have something and whether it is the last, and whether devices
    /// come or go.
    fn wait(
        &self,
        nodes: Option<&Inotify>,
        monitor: Option<&udev::MonitorSocket>,
    ) -> (Vec<(usize, bool)>, bool) {
        let readable = |fd| PollFd::from_borrowed_fd(fd, PollFlags::IN);
        let devices = self.reading.iter().map(|reading| reading.device.as_fd());
        let others = nodes.map(AsFd::as_fd).into_iter().chain(monitor.map(AsFd::as_fd));
        let fds: Vec<BorrowedFd<'_>> = devices.chain(others).collect();
        let mut polled: Vec<PollFd<'_>> = fds.into_iter().map(readable).collect();
        if poll(&mut polled, Some(&WAIT)).is_err() {
            return (Vec::new(), false);
        }
        let has = |fd: &PollFd<'_>| !fd.revents().is_empty();
        let (devices, others) = polled.split_at(self.reading.len());
        let last = PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL;
        let ready = devices.iter().enumerate().filter(|(_, fd)| has(fd));
        let ready = ready.map(|(at, fd)| (at, fd.revents().intersects(last)));
        (ready.collect(), others.iter().any(has))
    }

    /// Devices that came or went, as the folder of nodes and udev tell it.
    fn look(&mut self, nodes: Option<&mut Inotify>, monitor: Option<&udev::MonitorSocket>) {
        if let Some(nodes) = nodes {
            let mut buffer = [0; 4096];
            let told = nodes.read_events(&mut buffer).into_iter().flatten();
            let told: Vec<(String, bool)> = told
                .filter_map(|event| {
                    let name = event.name?.to_str()?.to_string();
                    Some((name, event.mask.contains(inotify::EventMask::DELETE)))
                })
                .collect();
            for (name, gone) in told {
                self.told(&format!("{NODES}/{name}"), gone);
            }
        }
        let events: Vec<udev::Event> =
            monitor.map(|monitor| monitor.iter().collect()).unwrap_or_default();
        for event in events {
            let node = format!("{NODES}/{}", event.sysname().to_string_lossy());
            match event.event_type() {
                udev::EventType::Add | udev::EventType::Change => self.told(&node, false),
                // It may come late, when the next device has the node already.
                udev::EventType::Remove if !self.is_another(&node, event.syspath()) => {
                    self.told(&node, true);
                }
                _ => {}
            }
        }
    }

    /// Whether what is read from the node is not the device at this place in sysfs.
    fn is_another(&self, node: &str, place: &Path) -> bool {
        let reading = self.reading.iter().find(|reading| reading.node == node);
        reading.and_then(|reading| reading.place.as_deref()).is_some_and(|known| known != place)
    }

    fn told(&mut self, node: &str, gone: bool) {
        let number = node.strip_prefix(NODES).and_then(|name| name.strip_prefix("/event"));
        if number.is_none_or(|number| number.parse::<u64>().is_err()) {
            return;
        }
        if gone {
            self.close(node);
            self.known.retain(|known| known != node);
        } else if !self.known.iter().any(|known| known == node)
            && !self.reading.iter().any(|reading| reading.node == node)
        {
            // Not readable yet: it is told of once more when udev has given the permission.
            if let Ok((mut opened, found)) = Reading::open(node) {
                match self.stream.take_up(&found) {
                    Some(number) => {
                        opened.number = number;
                        self.reading.push(opened);
                    }
                    None => self.known.push(node.to_string()),
                }
            }
        }
    }

    /// A device has gone. Its node may come again.
    fn close(&mut self, node: &str) {
        if let Some(at) = self.reading.iter().position(|reading| reading.node == node) {
            let reading = self.reading.remove(at);
            self.stream.unplug(reading.number);
        }
    }
}

fn watch_nodes() -> io::Result<Inotify> {
    let nodes = Inotify::init()?;
    let mask = WatchMask::CREATE | WatchMask::ATTRIB | WatchMask::DELETE;
    nodes.watches().add(Path::new(NODES), mask)?;
    Ok(nodes)
}
