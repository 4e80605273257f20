//! The aircraft: the parameters of every block, and what is derived from them once.

use core::ops::Deref;

use serde::Deserialize;

use crate::aero::{fuselage, horizontal_stabilizer, rotor_wake, vertical_stabilizers, wing_pylon};
use crate::rotors::blade;
use crate::{
    actuators, cockpit, display, engines, envelope, fcc, landing_gear, pilot, rotors,
    weight_balance,
};

/// A tilt-rotor that can be flown: its parameters, and what is derived from them.
///
/// The parameters are read through this type and changed by [`Aircraft::with`], which derives the rest
/// anew: a derived value that no longer follows from its parameters cannot be written.
#[derive(Clone, Debug)]
pub struct Aircraft {
    params: Params,
    /// Both rotors' blade, by elements.
    pub(crate) blade: blade::Blade,
    /// How far the actuators go in a tick.
    pub(crate) actuator_parts: actuators::Parts,
}

impl Aircraft {
    /// The aircraft of these parameters.
    pub fn new(params: Params) -> Self {
        Self { blade: params.rotors.blade(), actuator_parts: params.actuators.parts(), params }
    }

    /// The same aircraft with parameters changed.
    #[must_use]
    pub fn with(self, change: impl FnOnce(&mut Params)) -> Self {
        let mut params = self.params;
        change(&mut params);
        Self::new(params)
    }

    /// The same aircraft with another cockpit map.
    #[must_use]
    pub fn with_cockpit(self, cockpit: cockpit::Params) -> Self {
        self.with(|params| params.cockpit = cockpit)
    }
}

impl Deref for Aircraft {
    type Target = Params;

    fn deref(&self) -> &Params {
        &self.params
    }
}

impl PartialEq for Aircraft {
    fn eq(&self, other: &Self) -> bool {
        self.params == other.params
    }
}

/// All that a tilt-rotor is. Another tilt-rotor is other numbers, not another program.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Params {
    /// What it is called.
    pub name: alloc::string::String,
    /// Devices and what they move. Comes from its own file.
    #[serde(skip)]
    pub cockpit: cockpit::Params,
    /// Flight control computer.
    pub fcc: fcc::Params,
    /// Actuators.
    pub actuators: actuators::Params,
    /// Mass, balance, inertia.
    pub weight_balance: weight_balance::Params,
    /// Both rotors.
    pub rotors: rotors::Params,
    /// The rotors' wake at the airframe.
    pub rotor_wake: rotor_wake::Params,
    /// Wing and pylons.
    pub wing_pylon: wing_pylon::Params,
    /// Fuselage.
    pub fuselage: fuselage::Params,
    /// Horizontal stabiliser.
    pub horizontal_stabilizer: horizontal_stabilizer::Params,
    /// Fins.
    pub vertical_stabilizers: vertical_stabilizers::Params,
    /// Engines and drive.
    pub engines: engines::Params,
    /// Landing gear.
    pub landing_gear: landing_gear::Params,
    /// Where it is flown, and where the model holds.
    pub envelope: envelope::Params,
    /// What a pilot knows of it.
    pub pilot: pilot::Params,
    /// What it looks like.
    pub display: display::Params,
}

impl Params {
    /// Where a table cannot be used, and why, if so.
    pub fn fault(&self) -> Option<(&'static str, &'static str)> {
        let mixer = &self.fcc.mixer;
        let pitch_trim = &self.fcc.scas.pitch_trim;
        let tables = [
            ("fcc.scas.pitch_trim.attitude_by_tilt", pitch_trim.attitude_by_tilt_norm.fault()),
            ("fcc.scas.pitch_trim.stick_by_tilt", pitch_trim.stick_by_tilt_m_per_rad.fault()),
            ("fcc.scas.pitch_trim.speed_by_tilt", pitch_trim.speed_by_tilt_mps_per_rad.fault()),
            ("fcc.mixer.collective_per_lever", mixer.collective_per_lever_rad_per_m.fault()),
            (
                "fcc.mixer.collective_per_lateral_stick",
                mixer.collective_per_lateral_stick_rad_per_m.fault(),
            ),
            (
                "fcc.mixer.cyclic_per_longitudinal_stick",
                mixer.cyclic_per_longitudinal_stick_rad_per_m.fault(),
            ),
            ("fcc.mixer.cyclic_per_pedal", mixer.cyclic_per_pedal_rad_per_m.fault()),
            ("fcc.mixer.lateral_cyclic_rad", mixer.lateral_cyclic_rad.fault()),
            ("fcc.mixer.lateral_cyclic_norm", mixer.lateral_cyclic_norm.fault()),
            ("rotors.blade", self.rotors.blade.fault()),
            ("rotors.bending", self.rotors.bending.fault()),
            ("rotors.inflow.download_near_ground", self.rotors.inflow.download_near_ground.fault()),
            ("fcc.governor.proportional", self.fcc.governor.proportional_rad_per_radps.fault()),
            ("fcc.governor.integral", self.fcc.governor.integral_rad_per_rad.fault()),
            ("fcc.governor.lever_bottom", self.fcc.governor.lever_bottom_rad.fault()),
            ("actuators.nacelle", self.actuators.nacelle_radps.fault()),
            ("engines.power_by_lever", self.engines.power_by_lever_norm.fault()),
        ];
        tables
            .into_iter()
            .find_map(|(name, fault)| fault.map(|fault| (name, fault)))
            .or_else(|| self.rotors.other_rotor.fault())
            .or_else(|| self.rotor_wake.fault())
            .or_else(|| self.wing_pylon.fault())
            .or_else(|| self.fuselage.fault())
            .or_else(|| self.horizontal_stabilizer.fault())
            .or_else(|| self.vertical_stabilizers.fault())
            .or_else(|| self.envelope.fault())
            .or_else(|| self.pilot.fault())
            .or_else(|| self.display.fault())
    }
}
