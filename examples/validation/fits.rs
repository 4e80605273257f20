//! What of the model was fitted, to what, and which numbers of the page are no proof because of it.

/// A parameter, or a choice, that was made with a published number of this page in view.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Fit {
    /// Induced losses of the isolated rotor.
    InducedPower,
    /// What hover over the wing costs.
    Recirculation,
    /// Two numbers of the engine's fuel flow.
    FuelFlow,
    /// Power of the engines at idle.
    IdlePower,
    /// Gains of the collective governor.
    Governor,
    /// Power by the lever.
    LeverLaw,
    /// Where the tail's pressure factor holds.
    TailPressure,
    /// Gains of the SCAS.
    Scas,
    /// The pilot model.
    Pilot,
}

impl Fit {
    /// All of them, in the order of the page.
    pub const ALL: [Self; 9] = [
        Self::InducedPower,
        Self::Recirculation,
        Self::FuelFlow,
        Self::IdlePower,
        Self::Governor,
        Self::LeverLaw,
        Self::TailPressure,
        Self::Scas,
        Self::Pilot,
    ];

    /// As the column calls it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::InducedPower => "induced power",
            Self::Recirculation => "recirculation",
            Self::FuelFlow => "fuel flow",
            Self::IdlePower => "idle power",
            Self::Governor => "governor",
            Self::LeverLaw => "lever's cubic law",
            Self::TailPressure => "K_HNU",
            Self::Scas => "SCAS gains",
            Self::Pilot => "pilot model",
        }
    }

    /// Keys of the aircraft file, value, and what it was fitted to.
    pub const fn story(self) -> &'static str {
        match self {
            Self::InducedPower => {
                "`rotors.inflow.induced_power_factor`, 1.05: power of the isolated rotor in the OARF test at \
                 C_T .004 to .0131, by least squares"
            }
            Self::Recirculation => {
                "`rotors.inflow.recirculation`, .07: the 6 % of hover's power by which the figure of \
                 merit in flight (CR-176970) is below the stand's; a ratio of two tests that is put in"
            }
            Self::FuelFlow => {
                "`engines.fuel_lb_per_hp_h` and `fuel_idle_lb_per_h`, .43 and 235: through two points of \
                 TM-81244 fig. 13, hover and slow aeroplane"
            }
            Self::IdlePower => {
                "`engines.idle_power_norm`, .16: that the rotors keep their speed on the ground"
            }
            Self::Governor => {
                "`fcc.governor.proportional_deg_per_rpm` and `integral_deg_per_rpm_s`: slowed down as a \
                 helicopter until the flown response of heave to the lever has no notch"
            }
            Self::LeverLaw => {
                "`engines.power_by_lever_norm`: that power goes with the cube of the lever's angle was \
                 chosen because heave follows the lever by half with power in proportion"
            }
            Self::TailPressure => {
                "`horizontal_stabilizer.pressure_factor`: the published .8 as an aeroplane only, since \
                 the tail loads printed at 40 to 100 kt are without it"
            }
            Self::Scas => {
                "`fcc.scas`: rate gains, feed-forward, washout and the yaw authority are solved back from \
                 the rows with SCAS of the table that case 10 compares"
            }
            Self::Pilot => {
                "`recorder::pilots`: holds height and wanted speed, and lets go of the nacelle switch \
                 8 kt inside the corridor"
            }
        }
    }
}
