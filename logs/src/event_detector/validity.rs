//! Where the model's validity was left and entered again, flag by flag.

use engine::outputs::Validity;

use super::chatter::Chatter;

/// The flags as told.
#[derive(Default)]
pub(super) struct Told {
    /// Those that were told to be set.
    pub(super) flags: Validity,
    chatter: Chatter<{ Validity::FACTS.len() }>,
}

impl Told {
    /// What is to be told of the flags after a tick, in words.
    pub(super) fn look(&mut self, tick: u64, now: Validity) -> Option<String> {
        let set = std::array::from_fn(|i| {
            let facts = &Validity::FACTS[i];
            (facts.words, now.contains(facts.flag))
        });
        let news = self.chatter.look(tick, set);
        for (i, facts) in Validity::FACTS.iter().enumerate() {
            self.flags.set(facts.flag, self.chatter.told(i));
        }
        news.words("outside the model's validity: ", "within it again: ")
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
