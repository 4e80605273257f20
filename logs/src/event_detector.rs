//! Tells in events what the numbers say: markers, failures, weather, devices, fuel, validity, SCAS, wheels.

mod chatter;
mod observed;
mod saturation;
mod validity;
mod wheels;

use engine::State;
use engine::envelope::Airframe;
use engine::inputs::{DeviceEvent, EventKind, Failures, World};
use engine::math::atan2;
use engine::units::{compass_deg, knots};

pub use observed::Observed;

use crate::records::{FlightEvent, InputsRecord, RestartCause, RestartRecord};
use crate::{FlightWriter, LogError};

/// What was told last.
pub struct EventDetector {
    markers: u64,
    world: World,
    /// Whether the gust of that world has been told.
    gust_told: bool,
    has_fuel: bool,
    validity: validity::Told,
    saturation: saturation::Told,
    wheels: wheels::Told,
}

impl EventDetector {
    /// Nothing has happened yet.
    pub fn new(initial: &State, airframe: &Airframe) -> Self {
        Self {
            markers: initial.cockpit.markers,
            world: World::default(),
            gust_told: false,
            has_fuel: initial.plant.fuel_kg > 0.0,
            validity: validity::Told::default(),
            saturation: saturation::Told::default(),
            wheels: wheels::Told::new(initial, airframe),
        }
    }

    /// What took the place of the state, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn restart(
        &mut self,
        writer: &mut FlightWriter,
        restart: &RestartRecord,
    ) -> Result<(), LogError> {
        let RestartRecord { cause, state } = restart;
        // What is so from here on did not happen.
        self.has_fuel = state.plant.fuel_kg > 0.0;
        self.markers = state.cockpit.markers;
        self.wheels.restart(state);
        let known = RestartCause::from_u64(*cause);
        let words = known.map_or("another state", |cause| cause.facts().words);
        writer.flight_event(state.tick, FlightEvent::Restarted, *cause, [0.0; 2], words)
    }

    /// A device event, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn event(&self, writer: &mut FlightWriter, event: &DeviceEvent) -> Result<(), LogError> {
        let Some(kind) = EventKind::from_u64(event.kind) else { return Ok(()) };
        let words = format!("device {} {}", event.device, kind.facts().key);
        let (what, words) = match kind {
            EventKind::Connected => (FlightEvent::DeviceConnected, words),
            EventKind::Disconnected => (FlightEvent::DeviceDisconnected, words),
            EventKind::Dropped => {
                let words = format!("device {}: the kernel lost events", event.device);
                (FlightEvent::EventsLost, words)
            }
            EventKind::Axis
            | EventKind::Button
            | EventKind::AxisPosition
            | EventKind::ButtonPosition => return Ok(()),
        };
        writer.flight_event(event.tick, what, event.device, [0.0; 2], &words)
    }

    /// The world of a tick, after it was written.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn inputs(
        &mut self,
        writer: &mut FlightWriter,
        inputs: &InputsRecord,
    ) -> Result<(), LogError> {
        let (was, now, tick) = (self.world, inputs.world, inputs.tick);
        self.world = now;
        if now.failures != was.failures {
            let words = failures(was.failures, now.failures);
            writer.flight_event(
                tick,
                FlightEvent::Failures,
                now.failures.bits(),
                [0.0; 2],
                &words,
            )?;
        }
        if now.paused != was.paused {
            let words = if now.paused != 0 { "paused" } else { "goes on" };
            writer.flight_event(tick, FlightEvent::Paused, now.paused, [0.0; 2], words)?;
        }
        let outside = |world: &World| world.outside_commands().is_some();
        if outside(&now) != outside(&was) {
            let words = if outside(&now) {
                "actuators: commanded from outside"
            } else {
                "actuators: commanded by the flight control computer"
            };
            let level = u64::from(outside(&now));
            writer.flight_event(tick, FlightEvent::InputLevel, level, [0.0; 2], words)?;
        }
        self.weather(writer, tick, &was)
    }

    /// Wind, gust and turbulence.
    fn weather(
        &mut self,
        writer: &mut FlightWriter,
        tick: u64,
        was: &World,
    ) -> Result<(), LogError> {
        let now = self.world;
        if (now.wind_mps, now.wind_roughness_m) != (was.wind_mps, was.wind_roughness_m) {
            let (wind, words) = wind(&now);
            let blows = u64::from(wind[0] > 0.0);
            writer.flight_event(tick, FlightEvent::Wind, blows, wind, &words)?;
        }
        let same_gust = (now.gust_mps, now.gust_s, now.gust_start_tick)
            == (was.gust_mps, was.gust_s, was.gust_start_tick);
        self.gust_told &= same_gust;
        let begun = now.gust_s > 0.0 && now.gust_mps.norm() > 0.0 && tick >= now.gust_start_tick;
        if begun && !self.gust_told {
            self.gust_told = true;
            let v = now.gust_mps;
            let words = format!(
                "gust begins: {:.1} m/s north, {:.1} m/s east, {:.1} m/s up, over {:.1} s",
                v.x, v.y, -v.z, now.gust_s
            );
            let measured = [v.norm(), now.gust_s];
            writer.flight_event(tick, FlightEvent::Gust, now.gust_start_tick, measured, &words)?;
        }
        if now.turbulence_mps.to_bits() != was.turbulence_mps.to_bits() {
            let words = format!("turbulence: {:.1} m/s, vertical intensity", now.turbulence_mps);
            let rough = u64::from(now.turbulence_mps > 0.0);
            let measured = [now.turbulence_mps, 0.0];
            writer.flight_event(tick, FlightEvent::Turbulence, rough, measured, &words)?;
        }
        Ok(())
    }

    /// The state after a tick, after it was written, and what was seen of it.
    ///
    /// # Errors
    /// When the file cannot be written.
    pub fn state(
        &mut self,
        writer: &mut FlightWriter,
        state: &State,
        seen: &Observed,
    ) -> Result<(), LogError> {
        if state.cockpit.markers != self.markers {
            self.markers = state.cockpit.markers;
            let words = format!("marker {}", self.markers);
            writer.flight_event(state.tick, FlightEvent::Marker, self.markers, [0.0; 2], &words)?;
        }
        let has_fuel = state.plant.fuel_kg > 0.0;
        if !has_fuel && self.has_fuel {
            let out = Failures::ENGINES - self.world.failures;
            let words = format!("fuel exhausted; out by it: {out}");
            writer.flight_event(state.tick, FlightEvent::Fuel, out.bits(), [0.0; 2], &words)?;
        }
        // Nobody fills the tanks in flight; a drop that comes back by rounding is none.
        self.has_fuel &= has_fuel;
        self.wheels.look(writer, state, seen)?;
        if let Some(words) = self.saturation.look(state.tick, seen.saturated) {
            let flags = self.saturation.flags.bits();
            writer.flight_event(state.tick, FlightEvent::Saturation, flags, [0.0; 2], &words)?;
        }
        let Some(words) = self.validity.look(state.tick, seen.validity) else { return Ok(()) };
        let flags = self.validity.flags.bits();
        writer.flight_event(state.tick, FlightEvent::Validity, flags, [0.0; 2], &words)
    }
}

/// What failed and what was mended.
fn failures(was: Failures, now: Failures) -> String {
    let (failed, mended) = (now - was, was - now);
    let mut words = Vec::new();
    if !failed.is_empty() {
        words.push(format!("failed: {failed}"));
    }
    if !mended.is_empty() {
        words.push(format!("mended: {mended}"));
    }
    let still = now & was;
    if !still.is_empty() {
        words.push(format!("still failed: {still}"));
    }
    words.join("; ")
}

/// Speed of the wind in m/s and where it comes from in degrees, and both in words.
fn wind(world: &World) -> ([f64; 2], String) {
    let v = world.wind_mps;
    let speed_mps = engine::math::sqrt(v.x * v.x + v.y * v.y);
    let from_deg = compass_deg(atan2(-v.y, -v.x));
    if v.norm() <= 0.0 {
        return ([0.0; 2], "wind: calm".into());
    }
    let mut words = format!("wind: from {from_deg:03.0} deg, {:.1} kt", knots(speed_mps));
    if v.z != 0.0 {
        words.push_str(&format!(", {:.1} m/s up", -v.z));
    }
    ([v.norm(), from_deg], words)
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use engine::Outputs;
    use engine::fcc::scas::Saturation;
    use engine::frames::Vec3;
    use engine::outputs::Validity;

    use super::*;
    use crate::{Identity, Setup};

    /// What is told of these worlds, one a tick from tick 0 on.
    fn told(worlds: &[World]) -> Vec<(u64, FlightEvent, String)> {
        let aircraft = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("the XV-15");
        let file = tempfile::tempfile().expect("a file");
        let (setup, identity) = (Setup::default(), Identity::new());
        let initial = State::default();
        let mut writer =
            FlightWriter::create(file, &setup, &identity, &aircraft, "", &initial).expect("a log");
        let heard: Arc<Mutex<Vec<_>>> = Arc::default();
        let hears = heard.clone();
        writer.tell(Box::new(move |tick, what, _, words| {
            hears.lock().expect("one thread").push((tick, what, words.to_string()));
        }));
        let mut detector = EventDetector::new(&initial, &aircraft.envelope.airframe);
        for (tick, world) in (0..).zip(worlds) {
            let inputs = InputsRecord { tick, world: *world, ..InputsRecord::default() };
            detector.inputs(&mut writer, &inputs).expect("written");
        }
        std::mem::take(&mut *heard.lock().expect("one thread"))
    }

    #[test]
    fn a_gust_is_told_once_when_its_time_has_come() {
        let gust = World {
            gust_mps: Vec3::new(1.0, -2.0, -6.0),
            gust_s: 2.0,
            gust_start_tick: 3,
            ..World::default()
        };
        let words = "gust begins: 1.0 m/s north, -2.0 m/s east, 6.0 m/s up, over 2.0 s".to_string();
        let begins = |tick| (tick, FlightEvent::Gust, words.clone());
        assert_eq!(told(&[gust; 8]), [begins(3)]);
        // The same one again is another one; one whose time has come before it was known begins at once.
        let again = World { gust_start_tick: 5, ..gust };
        let worlds = [[gust; 5], [again; 5]].concat();
        assert_eq!(told(&worlds), [begins(3), begins(5)]);
        let known_late = [[World::default(); 6], [gust; 6]].concat();
        assert_eq!(told(&known_late), [begins(6)]);
        // A gust of no time, or of no speed, is none.
        assert_eq!(told(&[World { gust_s: 0.0, ..gust }; 8]), []);
        assert_eq!(told(&[World { gust_mps: Vec3::default(), ..gust }; 8]), []);
    }

    #[test]
    fn wind_and_turbulence_are_told_when_they_change() {
        let calm = World::default();
        // 10 m/s are 36 km an hour, 19.4 nautical miles of 1852 m; a wind is called by where it is from.
        let west = World { wind_mps: Vec3::new(0.0, 10.0, 0.0), ..calm };
        let rising = World { wind_mps: Vec3::new(10.0, 0.0, -1.5), ..calm };
        let rough = World { turbulence_mps: 1.5, ..rising };
        let said = told(&[calm, west, west, rising, rough, rough, calm]);
        let expected = [
            (1, FlightEvent::Wind, "wind: from 270 deg, 19.4 kt"),
            (3, FlightEvent::Wind, "wind: from 180 deg, 19.4 kt, 1.5 m/s up"),
            (4, FlightEvent::Turbulence, "turbulence: 1.5 m/s, vertical intensity"),
            (6, FlightEvent::Wind, "wind: calm"),
            (6, FlightEvent::Turbulence, "turbulence: 0.0 m/s, vertical intensity"),
        ];
        assert_eq!(said, expected.map(|(tick, what, words)| (tick, what, words.to_string())));
    }

    #[test]
    fn what_failed_what_was_mended_and_what_still_fails_is_told_where_there_is_any() {
        let (yaw, governor, none) = (Failures::SCAS_YAW, Failures::GOVERNOR, Failures::empty());
        assert_eq!(failures(none, yaw | governor), "failed: SCAS yaw, governor");
        assert_eq!(failures(yaw | governor, none), "mended: SCAS yaw, governor");
        assert_eq!(failures(yaw, yaw | governor), "failed: governor; still failed: SCAS yaw");
        assert_eq!(failures(yaw | governor, yaw), "mended: governor; still failed: SCAS yaw");
        assert_eq!(failures(yaw, governor), "failed: governor; mended: SCAS yaw");
        assert_eq!(failures(yaw, yaw), "still failed: SCAS yaw");
    }

    #[test]
    fn what_is_observed_of_a_touchdown_is_the_sink_downwards_and_the_speed_over_the_ground() {
        let mut outputs = Outputs { validity: Validity::HULL, ..Outputs::default() };
        // Three, four, five.
        let v = &mut outputs.velocity_mps;
        (v.x, v.y, v.z) = (3.0, -4.0, 0.75);
        outputs.scas.saturated = Saturation::YAW;
        let in_the_air = Observed::of(&outputs);
        assert!((in_the_air.sink_mps - 0.75).abs() < 1e-12);
        assert!((in_the_air.ground_speed_mps - 5.0).abs() < 1e-12);
        // An event has the sink first.
        let [sink_mps, speed_mps] = in_the_air.measured();
        assert!((sink_mps - 0.75).abs() < 1e-12 && (speed_mps - 5.0).abs() < 1e-12);
        assert_eq!((in_the_air.validity, in_the_air.saturated), (Validity::HULL, Saturation::YAW));
        assert!(!in_the_air.on_ground);
        // One wheel is enough.
        let wheels: [fn(&mut Outputs) -> &mut f64; 3] = [
            |outputs| &mut outputs.landing_gear.nose.push_n,
            |outputs| &mut outputs.landing_gear.main.left.push_n,
            |outputs| &mut outputs.landing_gear.main.right.push_n,
        ];
        for push_n in wheels {
            let mut landed = outputs;
            *push_n(&mut landed) = 0.1;
            assert!(Observed::of(&landed).on_ground);
        }
    }
}
