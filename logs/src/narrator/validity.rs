//! Where the model's validity was left and entered again, flag by flag, without chatter.
//!
//! A flag that comes and goes, as one at its limit does, is told once when it comes and once when it
//! has stayed away for a second. The recorded bits are what they are.

use engine::outputs::Validity;
use engine::{STEP_NS, STEP_S};

use crate::records::Happening;
use crate::{FlightWriter, LogError};

/// A flag that has been away for this long is gone.
const QUIET_TICKS: u64 = 1_000_000_000 / STEP_NS;

/// The flags as told.
#[derive(Default)]
pub(super) struct Told {
    flags: Validity,
    /// Of each flag that is told: when it came, and when it was last there.
    ticks: [(u64, u64); Validity::FACTS.len()],
}

impl Told {
    /// The flags after a tick.
    pub(super) fn look(
        &mut self,
        writer: &mut FlightWriter,
        tick: u64,
        now: Validity,
    ) -> Result<(), LogError> {
        let (mut left, mut back) = (Vec::new(), Vec::new());
        for (facts, ticks) in Validity::FACTS.iter().zip(&mut self.ticks) {
            let told = self.flags.contains(facts.flag);
            if now.contains(facts.flag) {
                if !told {
                    left.push(facts.words.to_string());
                    self.flags |= facts.flag;
                    ticks.0 = tick;
                }
                ticks.1 = tick;
            } else if told && tick >= ticks.1 + QUIET_TICKS {
                let for_s = (ticks.1 + 1 - ticks.0) as f64 * STEP_S;
                let until_s = (ticks.1 + 1) as f64 * STEP_S;
                back.push(format!("{} (for {for_s:.3} s, until {until_s:.3} s)", facts.words));
                self.flags -= facts.flag;
            }
        }
        if left.is_empty() && back.is_empty() {
            return Ok(());
        }
        let told = [("outside the model's validity: ", left), ("within it again: ", back)];
        let words: Vec<String> = told
            .into_iter()
            .filter(|(_, flags)| !flags.is_empty())
            .map(|(what, flags)| format!("{what}{}", flags.join(", ")))
            .collect();
        let (what, flags) = (Happening::Validity, self.flags.bits());
        writer.happened(tick, what, flags, [0.0; 2], &words.join("; "))
    }
}
