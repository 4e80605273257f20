//! Where the model's validity was left and entered again, flag by flag, without chatter.
//!
//! A flag that comes and goes, as one at its limit does, is told once when it comes and once when it
//! has stayed away for a second. The recorded bits are what they are.

use engine::outputs::Validity;
use engine::{STEP_NS, STEP_S};

/// A flag that has been away for this long is gone.
const QUIET_TICKS: u64 = 1_000_000_000 / STEP_NS;

/// The flags as told.
#[derive(Default)]
pub(super) struct Told {
    /// Those that were told to be set.
    pub(super) flags: Validity,
    /// Of each flag that is told: when it came, and when it was last there.
    ticks: [(u64, u64); Validity::FACTS.len()],
}

impl Told {
    /// What is to be told of the flags after a tick, in words.
    pub(super) fn look(&mut self, tick: u64, now: Validity) -> Option<String> {
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
        let told = [("outside the model's validity: ", left), ("within it again: ", back)];
        let words: Vec<String> = told
            .into_iter()
            .filter(|(_, flags)| !flags.is_empty())
            .map(|(what, flags)| format!("{what}{}", flags.join(", ")))
            .collect();
        (!words.is_empty()).then(|| words.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STALL: Validity = Validity::ROTOR_STALL;
    const SPEED: Validity = Validity::SPEED;

    /// What is told of flags that are a function of the tick.
    fn told(ticks: u64, flags: impl Fn(u64) -> Validity) -> Vec<(u64, String)> {
        let mut told = Told::default();
        (1..=ticks).filter_map(|tick| Some((tick, told.look(tick, flags(tick))?))).collect()
    }

    #[test]
    fn a_flag_that_toggles_each_tick_is_told_once() {
        let toggling = |tick: u64| if tick.is_multiple_of(2) { STALL } else { Validity::empty() };
        assert_eq!(
            told(5000, toggling),
            [(2, "outside the model's validity: rotor stall".to_string())]
        );
    }

    #[test]
    fn a_flag_that_has_gone_is_told_by_its_name_and_how_long_it_was_there() {
        let flags = |tick: u64| match tick {
            100..200 => STALL | SPEED,
            200..350 => SPEED,
            _ => Validity::empty(),
        };
        let words = [
            (100, "outside the model's validity: rotor stall, speed"),
            (449, "within it again: rotor stall (for 0.400 s, until 0.800 s)"),
            (599, "within it again: speed (for 1.000 s, until 1.400 s)"),
        ];
        assert_eq!(told(2000, flags), words.map(|(tick, words)| (tick, words.to_string())));
    }
}
