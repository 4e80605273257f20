//! Stages of a step, in the order of its wiring: in which one does a difference arise?
//!
//! A stage reads the state before the tick, the inputs, and what the stages before it gave. When the
//! state before was the same, the first stage whose result differs is the one that has changed (or
//! its parameters, or the record of its result): all that it reads is the same.

/// A stage of `engine::step`, in the order of its wiring (`engine/src/step.rs`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stage {
    /// Raw device events to where the pilot holds everything.
    Cockpit,
    /// Air, wind, turbulence.
    Environment,
    /// Flight control computer: stability augmentation, governor, mixer.
    Fcc,
    /// Surfaces, nacelles, gear, levers.
    Actuators,
    /// Mass, centre of gravity, inertia.
    WeightBalance,
    /// Rotors, with inflow and flapping.
    Rotors,
    /// Engines, drive, fuel flow, jets.
    Engines,
    /// Struts, tyres, brakes.
    LandingGear,
    /// Horizontal stabiliser, with the downwash on its way to it.
    HorizontalStabilizer,
    /// Half wings with their pylons.
    WingPylon,
    /// Fuselage.
    Fuselage,
    /// Fins.
    VerticalStabilizers,
    /// Equations of motion.
    Eom,
    /// What integrates the rates, and the structure's contact with the ground.
    Integration,
    /// What can be observed, made of the rest.
    Outputs,
    /// The step as a whole: its count, and what it does when a number stops being finite.
    Step,
}

impl Stage {
    /// Every stage, in the order of the wiring.
    pub const ALL: [Self; 16] = [
        Self::Cockpit,
        Self::Environment,
        Self::Fcc,
        Self::Actuators,
        Self::WeightBalance,
        Self::Rotors,
        Self::Engines,
        Self::LandingGear,
        Self::HorizontalStabilizer,
        Self::WingPylon,
        Self::Fuselage,
        Self::VerticalStabilizers,
        Self::Eom,
        Self::Integration,
        Self::Outputs,
        Self::Step,
    ];

    /// The stage whose result a field of the state is; `None` for a part that has no stage here yet.
    pub fn of_state(path: &str) -> Option<Self> {
        const PLACES: &[(&str, Stage)] = &[
            ("tick", Stage::Step),
            ("frozen", Stage::Step),
            ("cockpit.", Stage::Cockpit),
            ("environment.", Stage::Environment),
            ("fcc.", Stage::Fcc),
            ("actuators.", Stage::Actuators),
            ("plant.rotors.", Stage::Rotors),
            ("plant.tyre_deflections.", Stage::LandingGear),
            ("plant.weight_on_wheels", Stage::LandingGear),
            ("plant.", Stage::Integration),
            ("rate.motion.", Stage::Eom),
            ("rate.horizontal_stabilizer.", Stage::HorizontalStabilizer),
            ("rate.engines.", Stage::Engines),
        ];
        find(PLACES, path)
    }

    /// The stage whose result a field of the outputs is.
    pub fn of_outputs(path: &str) -> Self {
        const PLACES: &[(&str, Stage)] = &[
            ("cockpit.", Stage::Cockpit),
            ("air.", Stage::Environment),
            ("commands.", Stage::Fcc),
            ("actuators.", Stage::Actuators),
            ("balance.", Stage::WeightBalance),
            ("rotors.", Stage::Rotors),
            ("loads.rotors.", Stage::Rotors),
            ("engines.", Stage::Engines),
            ("loads.jets.", Stage::Engines),
            ("landing_gear.", Stage::LandingGear),
            ("loads.landing_gear.", Stage::LandingGear),
            ("loads.horizontal_stabilizer.", Stage::HorizontalStabilizer),
            ("loads.wing_pylon.", Stage::WingPylon),
            ("loads.fuselage.", Stage::Fuselage),
            ("loads.vertical_stabilizers.", Stage::VerticalStabilizers),
            ("total.", Stage::Eom),
        ];
        find(PLACES, path).unwrap_or(Self::Outputs)
    }

    /// As in the block diagram.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cockpit => "cockpit",
            Self::Environment => "environment",
            Self::Fcc => "fcc",
            Self::Actuators => "actuators",
            Self::WeightBalance => "weight_balance",
            Self::Rotors => "rotors",
            Self::Engines => "engines",
            Self::LandingGear => "landing_gear",
            Self::HorizontalStabilizer => "horizontal_stabilizer",
            Self::WingPylon => "wing_pylon",
            Self::Fuselage => "fuselage",
            Self::VerticalStabilizers => "vertical_stabilizers",
            Self::Eom => "eom",
            Self::Integration => "integration",
            Self::Outputs => "outputs",
            Self::Step => "step",
        }
    }

    /// What else a first difference here may come from: blocks before it that keep nothing in the
    /// state, so that theirs shows only here.
    pub fn or_before(self) -> Option<&'static str> {
        match self {
            Self::Rotors => Some("weight_balance"),
            Self::HorizontalStabilizer => Some("the rotors' wake"),
            Self::Eom => Some(
                "a load: rotors, wing_pylon, fuselage, horizontal_stabilizer, \
                 vertical_stabilizers, jets, landing_gear",
            ),
            _ => None,
        }
    }
}

fn find(places: &[(&str, Stage)], path: &str) -> Option<Stage> {
    places.iter().find(|(start, _)| path.starts_with(start)).map(|(_, stage)| *stage)
}

#[cfg(test)]
mod tests {
    use super::*;
    use logs::fields::fields;

    #[test]
    fn every_field_of_the_state_has_a_stage() {
        for field in fields(&engine::State::default()).expect("recordable") {
            let stage = Stage::of_state(&field.path);
            assert!(stage.is_some(), "{}: say in `of_state` which stage gives it", field.path);
        }
    }

    #[test]
    fn every_load_has_the_stage_of_its_block() {
        for field in fields(&engine::Outputs::default()).expect("recordable") {
            let load = field.path.starts_with("loads.") || field.path.starts_with("total.");
            let stage = Stage::of_outputs(&field.path);
            assert!(!load || stage != Stage::Outputs, "{}", field.path);
        }
    }

    #[test]
    fn all_is_in_the_order_of_the_wiring() {
        assert!(Stage::ALL.is_sorted());
    }
}
