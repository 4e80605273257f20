//! Left and right exchanged: the mirror image of states and inputs.
//!
//! A mirrored flight is the mirrored state, to the bit. North–down is the mirror plane of the world.

use crate::controls::{AxisPositions, Commands, ForceTrim, PickUp, PilotControls};
use crate::frames::Load;
use crate::inputs::{Failures, World};
use crate::landing_gear::TyreDeflection;
use crate::pair::Pair;
use crate::state::{Plant, PlantRate, State};
use crate::struts::Struts;
use crate::{actuators, engines, environment, eom, fcc};

/// Has a mirror image in the plane of symmetry.
pub trait Mirror {
    /// The image.
    #[must_use]
    fn mirrored(&self) -> Self;
}

impl Mirror for State {
    fn mirrored(&self) -> Self {
        Self {
            cockpit: self.cockpit.mirrored(),
            fcc: self.fcc.mirrored(),
            actuators: self.actuators.mirrored(),
            environment: self.environment.mirrored(),
            plant: self.plant.mirrored(),
            rate: self.rate.mirrored(),
            ..*self
        }
        .without_negative_zeros()
    }
}

impl Mirror for PilotControls {
    fn mirrored(&self) -> Self {
        Self {
            stick_right_norm: -self.stick_right_norm,
            pedal_right_norm: -self.pedal_right_norm,
            brake_norm: self.brake_norm.swapped(),
            pick_up: PickUp { hardware: self.pick_up.hardware.mirrored(), ..self.pick_up },
            force_trim: ForceTrim {
                stick_right_norm: -self.force_trim.stick_right_norm,
                pedal_right_norm: -self.force_trim.pedal_right_norm,
                ..self.force_trim
            },
            ..*self
        }
    }
}

impl Mirror for AxisPositions {
    fn mirrored(&self) -> Self {
        Self {
            stick_right_norm: -self.stick_right_norm,
            pedal_right_norm: -self.pedal_right_norm,
            brake_norm: self.brake_norm.swapped(),
            ..*self
        }
    }
}

impl Mirror for Commands {
    fn mirrored(&self) -> Self {
        Self {
            collective_rad: self.collective_rad.swapped(),
            cyclic_forward_rad: self.cyclic_forward_rad.swapped(),
            cyclic_outboard_rad: self.cyclic_outboard_rad.swapped(),
            flaperon_rad: self.flaperon_rad.swapped(),
            rudder_right_rad: -self.rudder_right_rad,
            brake_norm: self.brake_norm.swapped(),
            ..*self
        }
    }
}

impl Mirror for fcc::State {
    fn mirrored(&self) -> Self {
        Self {
            scas: fcc::scas::State {
                mean_right_m: -self.scas.mean_right_m,
                mean_pedal_right_m: -self.scas.mean_pedal_right_m,
                held_roll_rad: -self.scas.held_roll_rad,
                turned_rad: -self.scas.turned_rad,
                ..self.scas
            },
            ..*self
        }
    }
}

impl Mirror for actuators::State {
    fn mirrored(&self) -> Self {
        Self {
            collective_rad: self.collective_rad.swapped(),
            cyclic_forward_rad: self.cyclic_forward_rad.swapped(),
            cyclic_outboard_rad: self.cyclic_outboard_rad.swapped(),
            flaperon_rad: self.flaperon_rad.swapped(),
            rudder_right_rad: -self.rudder_right_rad,
            mast_tilt_rad: self.mast_tilt_rad.swapped(),
            mast_tilt_rate_radps: self.mast_tilt_rate_radps.swapped(),
            brake_norm: self.brake_norm.swapped(),
            ..*self
        }
    }
}

impl Mirror for environment::State {
    fn mirrored(&self) -> Self {
        Self {
            mirrored: 1 - self.mirrored,
            turbulence_mps: self.turbulence_mps.mirrored(),
            lateral_stage_mps: -self.lateral_stage_mps,
            ..*self
        }
    }
}

impl Mirror for Plant {
    fn mirrored(&self) -> Self {
        Self {
            position_m: self.position_m.mirrored(),
            velocity_mps: self.velocity_mps.mirrored(),
            attitude: self.attitude.mirrored(),
            angular_rate_radps: self.angular_rate_radps.mirrored_axial(),
            rotors: self.rotors.swapped(),
            engines: self.engines.swapped(),
            tyre_deflections: Struts {
                nose: mirrored_deflection(self.tyre_deflections.nose),
                main: self.tyre_deflections.main.swapped().map(mirrored_deflection),
            },
            ..*self
        }
    }
}

fn mirrored_deflection(deflection: TyreDeflection) -> TyreDeflection {
    TyreDeflection { right_m: -deflection.right_m, ..deflection }
}

impl Mirror for PlantRate {
    fn mirrored(&self) -> Self {
        Self {
            motion: eom::Rate {
                acceleration_mps2: self.motion.acceleration_mps2.mirrored(),
                angular_acceleration_radps2: self
                    .motion
                    .angular_acceleration_radps2
                    .mirrored_axial(),
            },
            horizontal_stabilizer: self.horizontal_stabilizer,
            engines: engines::Rate {
                power_w_per_s: self.engines.power_w_per_s.swapped(),
                ..self.engines
            },
        }
    }
}

impl Mirror for World {
    fn mirrored(&self) -> Self {
        let mut failures = self.failures.difference(Failures::ENGINES);
        failures.set(Failures::ENGINE_LEFT, self.failed(Failures::ENGINE_RIGHT));
        failures.set(Failures::ENGINE_RIGHT, self.failed(Failures::ENGINE_LEFT));
        Self {
            wind_mps: self.wind_mps.mirrored(),
            gust_mps: self.gust_mps.mirrored(),
            ground_height_m: Struts {
                main: self.ground_height_m.main.swapped(),
                ..self.ground_height_m
            },
            failures,
            commands: self.commands.mirrored(),
            ..*self
        }
    }
}

/// Loads of both sides from loads that were each computed as the right one's.
pub fn unmirrored(loads: Pair<Load>) -> Pair<Load> {
    Pair { left: loads.left.mirrored(), right: loads.right }
}
