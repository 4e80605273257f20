//! A log being shown: where it stands, how fast it goes, and what there is to be seen in between.
//!
//! Whoever shows it asks for a frame every 4 ms of its own time, the interval of live flight; how far the
//! flight goes on in a frame is the speed. Below real time a frame lies between two ticks, and shows what
//! lies between them: for display only, the flight itself knows ticks.

use std::path::{Path, PathBuf};

use engine::inputs::World;
use engine::{Outputs, observe};
use logs::LogError;

use crate::refly::{Reflight, Reflown, ReflyOptions, ReplayError, Window};

/// What is asked of a log being shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Command {
    /// Stand still, or go on.
    Pause(bool),
    /// So many ticks forward, or back, and stand still there.
    Step(i64),
    /// To that tick, going on or standing still as before.
    Seek(u64),
    /// So many times real time.
    Speed(f64),
}

/// What there was to be seen after a tick.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment {
    /// Of the aircraft.
    pub outputs: Outputs,
    /// The world of that tick.
    pub world: World,
}

/// What a frame shows.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// The tick before it.
    pub before: &'a Moment,
    /// The tick at it, or after it.
    pub after: &'a Moment,
    /// How far it is from the one to the other; 1 at the tick itself.
    pub part: f64,
}

/// A log being shown.
pub struct Playback {
    /// The log being reflown.
    pub flight: Reflight,
    path: PathBuf,
    options: ReflyOptions,
    before: Moment,
    after: Moment,
    /// Tick at which speed or place were changed last.
    base_tick: f64,
    /// Frames since then.
    frames: u64,
    speed: f64,
    paused: bool,
    /// The log, or the window, is over.
    ended: bool,
    jumped: bool,
}

impl Playback {
    /// Opens a log where the window begins.
    ///
    /// # Errors
    /// As [`Reflight::open`].
    pub fn open(path: &Path, options: &ReflyOptions, speed: f64) -> Result<Self, ReplayError> {
        let flight = Reflight::open(path, options)?;
        Ok(Self {
            base_tick: flight.state.tick as f64,
            flight,
            path: path.to_path_buf(),
            options: *options,
            before: Moment::default(),
            after: Moment::default(),
            frames: 0,
            speed,
            paused: false,
            ended: false,
            jumped: false,
        })
    }

    /// Where it stands, in ticks.
    pub fn tick(&self) -> f64 {
        self.base_tick + self.speed * self.frames as f64
    }

    /// Whether it stands still.
    pub fn is_paused(&self) -> bool {
        self.paused
    }

    /// Times real time.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Whether the log or the window is over.
    pub fn has_ended(&self) -> bool {
        self.ended
    }

    /// Whether every tick was reflown once, to the end of the log or of the window: only then what was
    /// reflown tells what the log is.
    pub fn is_whole(&self) -> bool {
        self.ended && !self.jumped
    }

    /// Does what is asked; `watch` is shown every tick that is reflown for it.
    ///
    /// # Errors
    /// When the log's messages do not make a flight.
    pub fn obey(
        &mut self,
        command: Command,
        watch: &mut impl FnMut(&Reflown<'_>),
    ) -> Result<(), ReplayError> {
        let shown = self.after.outputs.tick.max(self.flight.state.tick);
        match command {
            Command::Pause(paused) => {
                self.anchor(self.tick());
                self.paused = paused;
            }
            Command::Speed(speed) => {
                self.anchor(self.tick());
                self.speed = speed;
            }
            Command::Step(ticks) => {
                self.paused = true;
                // From between two ticks the nearest ones are those on either side.
                let from = if ticks < 0 { self.tick().ceil() } else { self.tick().floor() };
                self.go_to((from as u64).saturating_add_signed(ticks), shown, watch)?;
            }
            Command::Seek(tick) => self.go_to(tick, shown, watch)?,
        }
        Ok(())
    }

    /// The next frame; `None` when the log or the window is over. `watch` is shown every tick that is
    /// reflown for it.
    ///
    /// # Errors
    /// When the log's messages do not make a flight.
    pub fn frame(
        &mut self,
        watch: &mut impl FnMut(&Reflown<'_>),
    ) -> Result<Option<Frame<'_>>, ReplayError> {
        if self.ended {
            return Ok(None);
        }
        if !self.paused {
            self.frames += 1;
        }
        let tick = self.tick();
        while (self.after.outputs.tick as f64) < tick {
            if self.fly(watch)?.is_none() {
                // What was flown past the last frame is still to be shown.
                let last = self.flight.state.tick as f64;
                self.anchor(last);
                self.ended = true;
                let shown = tick - self.speed >= last;
                return Ok((!shown && last > 0.0).then(|| self.shown()));
            }
        }
        Ok(Some(self.shown()))
    }

    /// What is to be seen at a tick that another log being shown has come to, pauses, jumps and speed
    /// included; before its beginning and after its end, what there was to be seen there.
    ///
    /// # Errors
    /// When the log's messages do not make a flight.
    pub fn follow(
        &mut self,
        tick: f64,
        watch: &mut impl FnMut(&Reflown<'_>),
    ) -> Result<Frame<'_>, ReplayError> {
        // There is nothing to be seen before the first tick.
        let first = self.options.window.from_tick.unwrap_or(0).saturating_add(1);
        let (shown, whole) = (self.after.outputs.tick, (tick.ceil() as u64).max(first));
        if whole < shown || (whole > shown + 250 && !self.ended) {
            self.go_to(whole, shown, watch)?;
        }
        while !self.ended && self.after.outputs.tick < whole {
            self.ended = self.fly(watch)?.is_none();
        }
        self.anchor(engine::math::min(tick, self.after.outputs.tick as f64));
        Ok(self.shown())
    }

    /// What is to be seen now.
    pub fn shown(&self) -> Frame<'_> {
        let part = self.tick() - (self.after.outputs.tick as f64 - 1.0);
        // Before the first tick, and where it was stopped: what there is.
        let part = if (0.0..1.0).contains(&part) { part } else { 1.0 };
        Frame { before: &self.before, after: &self.after, part }
    }

    /// Counts frames from here on.
    fn anchor(&mut self, tick: f64) {
        self.base_tick = tick;
        self.frames = 0;
    }

    /// Goes to a tick, as far as the window goes: forward by flying there, back by opening the log anew.
    fn go_to(
        &mut self,
        tick: u64,
        shown: u64,
        watch: &mut impl FnMut(&Reflown<'_>),
    ) -> Result<(), ReplayError> {
        let first = self.options.window.from_tick.unwrap_or(0).saturating_add(1);
        let tick = tick.max(first);
        // A second of flight is sooner flown than looked up.
        if tick < shown || tick > shown + 250 {
            let from_tick = Some(tick - 1);
            let window = Window { from_tick, clamped: true, ..self.options.window };
            match Reflight::open(&self.path, &ReflyOptions { window, ..self.options }) {
                Ok(flight) => {
                    self.flight = flight;
                    (self.before, self.after) = Default::default();
                    self.jumped = true;
                }
                // Beyond the end of a log that does not say where that is: as far as it goes.
                Err(ReplayError::Log(LogError::Outside { .. })) if tick > shown => {}
                Err(error) => return Err(error),
            }
        }
        self.ended = false;
        while self.after.outputs.tick < tick {
            if self.fly(watch)?.is_none() {
                break;
            }
        }
        self.anchor(self.after.outputs.tick as f64);
        Ok(())
    }

    /// Flies a tick; `None` at the end.
    fn fly(&mut self, watch: &mut impl FnMut(&Reflown<'_>)) -> Result<Option<()>, ReplayError> {
        let first = self.after.outputs.tick == 0;
        let state = self.flight.state;
        let Some(reflown) = self.flight.next_tick()? else { return Ok(None) };
        let world = reflown.recorded.inputs.world;
        let moment = Moment { outputs: *reflown.outputs, world };
        watch(&reflown);
        self.flight.reader.forget();
        self.before = self.after;
        if first {
            self.before = Moment { outputs: observe(&self.flight.aircraft, &state, &world), world };
        }
        self.after = moment;
        Ok(Some(()))
    }
}

#[cfg(test)]
mod tests {
    use std::fs::File;

    use engine::{Inputs, State, step};
    use logs::records::InputsRecord;
    use logs::{FlightWriter, Identity, Setup};

    use super::*;

    /// Ticks of the log.
    const TICKS: u64 = 12;

    /// A flight in which nobody touches anything.
    fn flown(log: &Path) {
        let setup = Setup {
            aircraft_toml: aircraft::XV15.into(),
            cockpit_toml: aircraft::PILOT_MAP.into(),
            scenario_toml: aircraft::DEFAULT_SCENARIO.into(),
        };
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
        let (file, identity) = (File::create_new(log).expect("a file"), Identity::new());
        let mut state = State::default();
        let mut writer =
            FlightWriter::create(file, &setup, &identity, &xv15, "", &state).expect("a log");
        for tick in 0..TICKS {
            writer.inputs(&InputsRecord { tick, ..InputsRecord::default() }).expect("written");
            let inputs = Inputs { events: &[], world: World::default() };
            state = step(&xv15, &state, &inputs).0;
            writer.state(&state).expect("written");
        }
        writer.finish().expect("closed");
    }

    fn obey(playback: &mut Playback, command: Command) {
        playback.obey(command, &mut |_| ()).expect("it can be reflown");
    }

    /// Shows so many frames; returns where it stands then.
    fn frames(playback: &mut Playback, count: u32) -> f64 {
        for _ in 0..count {
            playback.frame(&mut |_| ()).expect("it can be reflown");
        }
        playback.tick()
    }

    fn assert_near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-9, "{found} and not {expected}");
    }

    #[test]
    fn a_log_being_shown_says_whether_it_goes_on_how_fast_and_where_it_stands() {
        let folder = tempfile::tempdir().expect("a folder");
        let log = folder.path().join("flight.mcap");
        flown(&log);
        let mut playback = Playback::open(&log, &ReflyOptions::default(), 0.5).expect("a log");
        assert!(!playback.is_paused() && !playback.has_ended() && !playback.is_whole());
        assert_near(playback.speed(), 0.5);
        assert_near(frames(&mut playback, 4), 2.0);
        obey(&mut playback, Command::Pause(true));
        assert!(playback.is_paused());
        assert_near(frames(&mut playback, 4), 2.0);
        obey(&mut playback, Command::Pause(false));
        assert!(!playback.is_paused());
        assert_near(frames(&mut playback, 1), 2.5);
        // From between two ticks a step goes to the next one, and it stands still there.
        obey(&mut playback, Command::Step(1));
        assert!(playback.is_paused());
        assert_near(playback.tick(), 3.0);
        // To a place it goes as before, standing still or not.
        obey(&mut playback, Command::Seek(5));
        assert!(playback.is_paused());
        assert_near(playback.tick(), 5.0);
        obey(&mut playback, Command::Pause(false));
        obey(&mut playback, Command::Seek(6));
        assert!(!playback.is_paused());
        obey(&mut playback, Command::Speed(2.0));
        assert_near(playback.speed(), 2.0);
        assert_near(frames(&mut playback, 2), 10.0);
        // Whether it is over is known when there is no further tick.
        assert_near(frames(&mut playback, 1), 12.0);
        assert!(!playback.has_ended());
        assert_near(frames(&mut playback, 1), 12.0);
        assert!(playback.has_ended() && playback.is_whole(), "every tick was flown once");
        obey(&mut playback, Command::Seek(4));
        assert!(!playback.has_ended() && !playback.is_whole());
        frames(&mut playback, 10);
        assert!(playback.has_ended() && !playback.is_whole(), "some were flown twice");
    }
}
