//! Where the SCAS comes to the end of what it may add, and has room again, axis by axis.

use engine::fcc::scas::Saturation;

use super::chatter::Chatter;

/// The axes as told.
#[derive(Default)]
pub(super) struct Told {
    /// Those that were told to be at their ends.
    pub(super) flags: Saturation,
    chatter: Chatter<{ Saturation::FACTS.len() }>,
}

impl Told {
    /// What is to be told of the axes after a tick, in words.
    pub(super) fn look(&mut self, tick: u64, now: Saturation) -> Option<String> {
        let set = std::array::from_fn(|i| {
            let facts = &Saturation::FACTS[i];
            (facts.words, now.contains(facts.flag))
        });
        let news = self.chatter.look(tick, set);
        for (i, facts) in Saturation::FACTS.iter().enumerate() {
            self.flags.set(facts.flag, self.chatter.told(i));
        }
        news.words("SCAS at its limit: ", "SCAS within its limits again: ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_is_told_when_it_comes_to_its_limit_and_when_it_has_stayed_away() {
        let mut told = Told::default();
        let news: Vec<_> = (1..=1000)
            .filter_map(|tick| {
                let yaw =
                    if (100..200).contains(&tick) { Saturation::YAW } else { Saturation::empty() };
                Some((tick, told.look(tick, yaw)?))
            })
            .collect();
        let words = [
            (100, "SCAS at its limit: yaw"),
            (449, "SCAS within its limits again: yaw (for 0.400 s, until 0.800 s)"),
        ];
        assert_eq!(news, words.map(|(tick, words)| (tick, words.to_string())));
        assert_eq!(told.flags, Saturation::empty());
    }
}
