//! Touchdown, lift-off, and what was too hard.

use engine::State;
use engine::envelope::Airframe;
use engine::outputs::Validity;

use super::observed::Observed;
use crate::records::FlightEvent;
use crate::{FlightWriter, LogError};

/// What was told last.
pub(super) struct Told {
    weight_on_wheels: u64,
    /// After the tick before.
    before: Observed,
    /// Sink and speed when a wheel last came to the ground.
    contact: [f64; 2],
    /// The hull has touched the ground: what the wheels do after it is no touchdown.
    wrecked: bool,
    sink_mps_max: f64,
    reserve_sink_mps_max: f64,
}

impl Told {
    pub(super) fn new(initial: &State, airframe: &Airframe) -> Self {
        let weight_on_wheels = initial.plant.weight_on_wheels;
        Self {
            weight_on_wheels,
            before: Observed { on_ground: weight_on_wheels != 0, ..Observed::default() },
            contact: [0.0; 2],
            wrecked: false,
            sink_mps_max: airframe.touchdown_sink_mps_max,
            reserve_sink_mps_max: airframe.reserve_sink_mps_max,
        }
    }

    /// Another state took the place of the one that was flown.
    pub(super) fn restart(&mut self, state: &State) {
        self.weight_on_wheels = state.plant.weight_on_wheels;
        self.before = Observed { on_ground: self.weight_on_wheels != 0, ..Observed::default() };
        self.wrecked = false;
    }

    /// What the wheels and the hull did in a tick.
    pub(super) fn look(
        &mut self,
        writer: &mut FlightWriter,
        state: &State,
        seen: &Observed,
    ) -> Result<(), LogError> {
        let before = std::mem::replace(&mut self.before, *seen);
        if seen.on_ground && !before.on_ground && !self.wrecked {
            self.contact = before.measured();
            self.landing(writer, state.tick)?;
        }
        // A wreck that bounces falls no second time.
        if !self.wrecked && (seen.validity - before.validity).contains(Validity::HULL) {
            impact(writer, state.tick, 2, before.measured(), "structural contact: the hull")?;
            self.wrecked = true;
        }
        if self.wrecked || state.plant.weight_on_wheels == self.weight_on_wheels {
            return Ok(());
        }
        self.weight_on_wheels = state.plant.weight_on_wheels;
        let (name, measured) = match self.weight_on_wheels {
            0 => ("lift-off", seen.measured()),
            _ => ("touchdown", self.contact),
        };
        let words = format!("{name}{}", said(measured));
        let (what, on) = (FlightEvent::WeightOnWheels, self.weight_on_wheels);
        writer.flight_event(state.tick, what, on, measured, &words)
    }

    /// A wheel came to the ground: what the gear is not designed for is told.
    fn landing(&self, writer: &mut FlightWriter, tick: u64) -> Result<(), LogError> {
        let limit_mps = self.sink_mps_max;
        if self.contact[0] <= limit_mps {
            return Ok(());
        }
        let beyond = self.contact[0] > self.reserve_sink_mps_max;
        let what = if beyond {
            format!(
                "hard landing beyond the gear's reserve of {:.2} m/s",
                self.reserve_sink_mps_max
            )
        } else {
            format!("hard landing, the gear is designed for {limit_mps:.2} m/s")
        };
        impact(writer, tick, u64::from(beyond), self.contact, &what)
    }
}

fn impact(
    writer: &mut FlightWriter,
    tick: u64,
    value: u64,
    measured: [f64; 2],
    what: &str,
) -> Result<(), LogError> {
    let words = format!("impact{}: {what}", said(measured));
    writer.flight_event(tick, FlightEvent::Impact, value, measured, &words)
}

/// `, sinking 0.30 m/s at 1.2 m/s over the ground`.
fn said([sink_mps, speed_mps]: [f64; 2]) -> String {
    let (way, sink_mps) =
        if sink_mps < 0.0 { ("climbing", -sink_mps) } else { ("sinking", sink_mps) };
    format!(", {way} {sink_mps:.2} m/s at {speed_mps:.2} m/s over the ground")
}
