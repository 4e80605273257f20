//! A flight that is stepped by a program instead of a clock.
//!
//! It takes the path that hardware takes: what the program moves goes through the cockpit map as raw
//! device events of the virtual device, as a script's events do, and is recorded before the step that uses
//! it. The same movements at the same ticks give the same log, whoever makes them.

use std::path::Path;
use std::sync::Arc;

use engine::cockpit::{AxisControl, ButtonControl};
use engine::inputs::{DeviceEvent, World};
use engine::start::Start;
use engine::{Aircraft, Inputs, Outputs, State, observe, step};
use logs::output::Output;
use logs::records::{FlightEvent, InputsRecord};
use logs::{Closed, EventDetector, FlightWriter, Identity, LogError, Observed, Setup};

use crate::clock::wall_ns;
use crate::controller::TickContext;
use crate::end::End;
use crate::pilots::VirtualDevice;

/// A movement that the next step uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Movement {
    /// An axis moves to a position: −1 to 1, or 0 to 1 for lever and brakes.
    Axis(AxisControl, f64),
    /// A button is pressed, or let go.
    Button(ButtonControl, bool),
}

/// All that a flight goes on from beside its aircraft and its texts.
#[derive(Clone, Debug)]
pub struct Moment {
    /// After the last step.
    pub state: State,
    /// What could be observed after it.
    pub outputs: Outputs,
    /// The world of the steps to come.
    pub world: World,
    /// Where the axes were sent to: code and raw value. An axis that stands there already sends nothing.
    pub sent: Vec<(u64, i64)>,
    /// What the next step moves.
    pub movements: Vec<Movement>,
}

/// A flight that its caller steps.
pub struct Stepped {
    /// What is flown.
    pub aircraft: Arc<Aircraft>,
    /// The texts that it is reflown from.
    pub setup: Setup,
    /// After the last step.
    pub state: State,
    /// What could be observed after the last step; before the first one, of the state at the start.
    pub outputs: Outputs,
    /// Weather, failures, and commands from outside, for the steps to come.
    pub world: World,
    device: VirtualDevice,
    movements: Vec<Movement>,
    events: Vec<DeviceEvent>,
    log: Option<Log>,
}

/// Why a flight cannot be stepped.
#[derive(Debug, thiserror::Error)]
pub enum StepError {
    /// There is no steady flight to begin in.
    #[error("the flight cannot begin in the air: {0}")]
    Trim(#[from] analysis::trim::Failure),
    /// Nothing could move its controls.
    #[error("the cockpit map has no device called `{}`", crate::pilots::DEVICE)]
    NoDevice,
}

/// The log being written.
struct Log {
    writer: FlightWriter,
    detector: EventDetector,
    output: Output,
}

impl Stepped {
    /// Begins where the scenario begins.
    ///
    /// # Errors
    /// When there is no steady flight to begin in, or the cockpit map has no virtual device.
    pub fn begin(aircraft: Arc<Aircraft>, setup: Setup, start: &Start) -> Result<Self, StepError> {
        let state = analysis::start::state_at(start, &aircraft)?;
        Self::going_on(aircraft, setup, state, start.world.world())
    }

    /// Goes on from a state, in a world: that of a log, as a rule.
    ///
    /// # Errors
    /// When the cockpit map has no virtual device.
    pub fn going_on(
        aircraft: Arc<Aircraft>,
        setup: Setup,
        state: State,
        world: World,
    ) -> Result<Self, StepError> {
        let outputs = observe(&aircraft, &state, &world);
        let (sent, movements) = (Vec::new(), Vec::new());
        Self::resume(aircraft, setup, Moment { state, outputs, world, sent, movements })
    }

    /// Goes on as another flight would have gone on.
    ///
    /// # Errors
    /// When the cockpit map has no virtual device.
    pub fn resume(
        aircraft: Arc<Aircraft>,
        setup: Setup,
        moment: Moment,
    ) -> Result<Self, StepError> {
        let Moment { state, outputs, world, sent, movements } = moment;
        let device = VirtualDevice::of(&aircraft.cockpit).ok_or(StepError::NoDevice)?.after(sent);
        let events = Vec::new();
        Ok(Self { aircraft, setup, state, outputs, world, device, movements, events, log: None })
    }

    /// What a second flight goes on from, to the bit.
    pub fn moment(&self) -> Moment {
        Moment {
            state: self.state,
            outputs: self.outputs,
            world: self.world,
            sent: self.device.sent().to_vec(),
            movements: self.movements.clone(),
        }
    }

    /// A second flight from here on, without a log.
    #[must_use]
    pub fn fork(&self) -> Self {
        Self {
            aircraft: Arc::clone(&self.aircraft),
            setup: self.setup.clone(),
            device: self.device.clone(),
            movements: self.movements.clone(),
            events: Vec::new(),
            log: None,
            state: self.state,
            outputs: self.outputs,
            world: self.world,
        }
    }

    /// The controls that can be moved.
    pub fn axes(&self) -> impl Iterator<Item = AxisControl> {
        self.device.axes()
    }

    /// Moves a control with the next step: −1 to 1, or 0 to 1 for lever and brakes.
    pub fn set(&mut self, control: AxisControl, position_norm: f64) {
        self.movements.push(Movement::Axis(control, position_norm));
    }

    /// Presses or releases a button with the next step.
    pub fn press(&mut self, control: ButtonControl, pressed: bool) {
        self.movements.push(Movement::Button(control, pressed));
    }

    /// Records from here on.
    ///
    /// # Errors
    /// When the log cannot be begun.
    pub fn record(
        &mut self,
        path: &Path,
        force: bool,
        identity: Identity,
        robot_description: &str,
    ) -> Result<(), LogError> {
        let identity = identity.with(Identity::STARTED, wall_ns().to_string());
        let mut output = Output::flight(path, force)?;
        let mut writer = FlightWriter::create(
            output.file()?,
            &self.setup,
            &identity,
            &self.aircraft,
            robot_description,
            &self.state,
        )?;
        if self.state.tick == 0 {
            writer.view(&self.outputs, self.state.plant.attitude)?;
        }
        output.begun()?;
        let detector = EventDetector::new(&self.state, &self.aircraft.envelope.airframe);
        self.log = Some(Log { writer, detector, output });
        Ok(())
    }

    /// Whether it is being recorded.
    pub fn is_recording(&self) -> bool {
        self.log.is_some()
    }

    /// Flies a tick.
    ///
    /// # Errors
    /// When the log cannot be written any further: it ends there, never closed. The tick is flown all the
    /// same, and those after it without a log.
    pub fn step(&mut self) -> Result<(), LogError> {
        let tick = self.state.tick;
        self.take_movements(tick);
        let recorded =
            self.log.as_mut().map_or(Ok(()), |log| log.inputs(tick, &self.events, self.world));
        let inputs = Inputs { events: &self.events, world: self.world };
        (self.state, self.outputs) = step(&self.aircraft, &self.state, &inputs);
        let recorded = recorded.and_then(|()| {
            self.log.as_mut().map_or(Ok(()), |log| log.state(&self.state, &self.outputs))
        });
        if recorded.is_err() {
            // One that lacks a tick must not be closed later, when there is room again.
            self.log = None;
        }
        recorded
    }

    /// What was moved since the last step, as raw events.
    fn take_movements(&mut self, tick: u64) {
        self.events.clear();
        let (mut phase, mut done, mut save) = ((0, ""), false, false);
        let (mut restart, mut gave_up) = (None, None);
        let mut context = TickContext {
            tick,
            events: &mut self.events,
            world: &mut self.world,
            phase: &mut phase,
            done: &mut done,
            restart: &mut restart,
            save: &mut save,
            gave_up: &mut gave_up,
        };
        for movement in self.movements.drain(..) {
            match movement {
                Movement::Axis(control, at_norm) => self.device.set(&mut context, control, at_norm),
                Movement::Button(control, pressed) => {
                    self.device.press(&mut context, control, pressed);
                }
            }
        }
    }

    /// Closes the log, as ended by whom; `None` when there was none.
    ///
    /// # Errors
    /// When it cannot be closed.
    pub fn close(&mut self, end: End) -> Result<Option<Closed>, LogError> {
        let Some(Log { mut writer, output, .. }) = self.log.take() else { return Ok(None) };
        writer.flight_event(
            self.state.tick,
            FlightEvent::Landed,
            end.number(),
            [0.0; 2],
            &end.to_string(),
        )?;
        let closed = writer.finish()?;
        output.finish()?;
        Ok(Some(closed))
    }
}

impl Log {
    fn inputs(&mut self, tick: u64, events: &[DeviceEvent], world: World) -> Result<(), LogError> {
        for event in events {
            self.writer.event(event)?;
            self.detector.event(&mut self.writer, event)?;
        }
        let inputs = InputsRecord { tick, events: events.len() as u64, world };
        self.writer.inputs(&inputs)?;
        self.detector.inputs(&mut self.writer, &inputs)
    }

    fn state(&mut self, state: &State, outputs: &Outputs) -> Result<(), LogError> {
        self.writer.state(state)?;
        self.detector.state(&mut self.writer, state, &Observed::of(outputs))?;
        self.writer.view(outputs, state.plant.attitude)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::Flight;
    use crate::progress::Progress;
    use crate::script::Script;

    fn setup(cockpit_toml: &str) -> Setup {
        Setup {
            aircraft_toml: aircraft::XV15.into(),
            cockpit_toml: cockpit_toml.into(),
            scenario_toml: aircraft::DEFAULT_SCENARIO.into(),
        }
    }

    /// Two seconds of movements by a program, and the same by a script: the same digest, which is that
    /// of every input and state.
    #[test]
    fn the_same_movements_give_the_log_that_a_script_gives() {
        let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
        let xv15 =
            aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap().with_cockpit(map.clone());
        let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
        let folder = std::env::temp_dir().join(format!("tiltrotor-stepped-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();

        let mut stepped = Stepped::begin(Arc::new(xv15.clone()), setup("map"), &start).unwrap();
        stepped.record(&folder.join("stepped"), false, Identity::new(), "").unwrap();
        for tick in 0..500 {
            if tick == 125 {
                // A script's buttons come before its axes, and those by their names.
                stepped.press(ButtonControl::Marker, true);
                stepped.press(ButtonControl::Marker, false);
                stepped.set(AxisControl::Collective, 0.7);
                stepped.set(AxisControl::StickAft, 0.1);
            }
            if tick == 250 {
                stepped.world.failures.insert(engine::inputs::Failures::SCAS_YAW);
            }
            stepped.step().unwrap();
        }
        let closed = stepped.close(End::Done).unwrap().unwrap();
        assert!(stepped.close(End::Done).unwrap().is_none(), "closed once");

        let text = "[[event]]\nat_s = 0.5\naxis = { collective = 0.7, stick_aft = 0.1 }\npress = [\"marker\"]\n\
                    [[event]]\nat_s = 1.0\nfail = [\"scas_yaw\"]\n";
        let script = Script::parse("script.toml", text, &map).unwrap();
        let flight = Flight {
            aircraft: xv15,
            start,
            setup: setup("map"),
            identity: Identity::new(),
            robot_description: String::new(),
            controllers: vec![Box::new(script)],
            #[cfg(feature = "sticks")]
            sticks: None,
            out: folder.join("flown"),
            force: false,
            real_time: None,
            situation: None,
            ticks_max: Some(500),
            link: None,
            self_check: false,
        };
        let flown = crate::fly(flight, &Progress::default()).unwrap();
        assert_eq!(closed.digest, flown.log.unwrap().digest);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    /// What lacks a tick is not closed later, as if it were whole.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_log_that_cannot_be_written_is_given_up_and_the_flight_goes_on() {
        use std::io::Read;
        use std::os::fd::AsRawFd;
        use std::sync::atomic::{AtomicBool, Ordering};

        let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap().with_cockpit(map);
        let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
        let mut flown = Stepped::begin(Arc::new(xv15), setup("map"), &start).unwrap();
        let mut alone = flown.fork();
        // A pipe whose reader leaves once the flight is under way.
        let (mut reader, writer) = std::io::pipe().unwrap();
        let path = format!("/proc/self/fd/{}", writer.as_raw_fd());
        let leave = &AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(move || {
                let mut read = [0; 4096];
                while !leave.load(Ordering::Relaxed) && reader.read(&mut read).unwrap() > 0 {}
            });
            flown.record(Path::new(&path), true, Identity::new(), "").unwrap();
            drop(writer);
            leave.store(true, Ordering::Relaxed);
            assert!((0..5000).any(|_| flown.step().is_err()), "nothing refused");
        });
        assert!(!flown.is_recording());
        assert!(flown.close(End::Done).unwrap().is_none());
        (0..10).for_each(|_| flown.step().unwrap());
        while alone.state.tick < flown.state.tick {
            alone.step().unwrap();
        }
        assert_eq!(alone.state, flown.state);
    }

    #[test]
    fn a_copy_that_is_moved_in_the_same_way_flies_the_same_bits() {
        let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).unwrap();
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap().with_cockpit(map);
        let start = aircraft::start("default.toml", aircraft::DEFAULT_SCENARIO).unwrap();
        let mut flown = Stepped::begin(Arc::new(xv15), setup("map"), &start).unwrap();
        let fly = |flight: &mut Stepped, lever_norm: f64| {
            flight.set(AxisControl::Collective, lever_norm);
            (0..50).for_each(|_| flight.step().unwrap());
        };
        fly(&mut flown, 0.6);
        // What is still to be moved belongs to the copy too.
        flown.set(AxisControl::StickAft, 0.3);
        let mut forked = flown.fork();
        let (aircraft, setup) = (Arc::clone(&flown.aircraft), flown.setup.clone());
        let mut resumed = Stepped::resume(aircraft, setup, flown.moment()).unwrap();
        for flight in [&mut flown, &mut forked, &mut resumed] {
            fly(flight, 0.8);
        }
        assert_eq!((forked.state, forked.outputs), (flown.state, flown.outputs));
        assert_eq!((resumed.state, resumed.outputs), (flown.state, flown.outputs));
        assert_eq!(resumed.moment().sent, flown.moment().sent);
        fly(&mut forked, 0.1);
        assert_ne!(forked.state, flown.state);
    }
}
