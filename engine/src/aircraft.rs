//! The aircraft: the parameters of every block, and what is derived from them once.

use core::ops::Deref;

use serde::Deserialize;

use crate::aero::{fuselage, horizontal_stabilizer, rotor_wake, vertical_stabilizers, wing_pylon};
use crate::rotors::blade;
use crate::table::{Invalid, all_valid};
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
    /// # Errors
    /// What cannot be used, and what is expected there.
    pub fn validate(&self) -> Result<(), Invalid> {
        let mixer = &self.fcc.mixer;
        let pitch_trim = &self.fcc.scas.pitch_trim;
        all_valid([
            ("fcc.scas.pitch_trim.attitude_by_tilt", pitch_trim.attitude_by_tilt_norm.validate()),
            ("fcc.scas.pitch_trim.stick_by_tilt", pitch_trim.stick_by_tilt_m_per_rad.validate()),
            ("fcc.scas.pitch_trim.speed_by_tilt", pitch_trim.speed_by_tilt_mps_per_rad.validate()),
            ("fcc.mixer.collective_per_lever", mixer.collective_per_lever_rad_per_m.validate()),
            (
                "fcc.mixer.collective_per_lateral_stick",
                mixer.collective_per_lateral_stick_rad_per_m.validate(),
            ),
            (
                "fcc.mixer.cyclic_per_longitudinal_stick",
                mixer.cyclic_per_longitudinal_stick_rad_per_m.validate(),
            ),
            ("fcc.mixer.cyclic_per_pedal", mixer.cyclic_per_pedal_rad_per_m.validate()),
            ("fcc.mixer.lateral_cyclic_rad", mixer.lateral_cyclic_rad.validate()),
            ("fcc.mixer.lateral_cyclic_norm", mixer.lateral_cyclic_norm.validate()),
            ("rotors.blade", self.rotors.blade.validate()),
            ("rotors.bending", self.rotors.bending.validate()),
            (
                "rotors.inflow.download_near_ground",
                self.rotors.inflow.download_near_ground.validate(),
            ),
            ("fcc.governor.proportional", self.fcc.governor.proportional_rad_per_radps.validate()),
            ("fcc.governor.integral", self.fcc.governor.integral_rad_per_rad.validate()),
            ("fcc.governor.lever_bottom", self.fcc.governor.lever_bottom_rad.validate()),
            ("actuators.nacelle", self.actuators.nacelle_radps.validate()),
            ("engines.power_by_lever", self.engines.power_by_lever_norm.validate()),
        ])
        .and_then(|()| self.rotors.other_rotor.validate())
        .and_then(|()| self.rotor_wake.validate())
        .and_then(|()| self.wing_pylon.validate())
        .and_then(|()| self.fuselage.validate())
        .and_then(|()| self.horizontal_stabilizer.validate())
        .and_then(|()| self.vertical_stabilizers.validate())
        .and_then(|()| self.envelope.validate())
        .and_then(|()| self.pilot.validate())
        .and_then(|()| self.display.validate())
    }
}
