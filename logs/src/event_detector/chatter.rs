//! Flags that come and go, without chatter.
//!
//! A flag that comes and goes, as one at its limit does, is told once when it comes and once when it
//! has stayed away for a second. The recorded bits are what they are.

use engine::{STEP_NS, STEP_S};

/// A flag that has been away for this long is gone.
const QUIET_TICKS: u64 = 1_000_000_000 / STEP_NS;

/// Flags as told.
pub(super) struct Chatter<const N: usize> {
    /// Of each flag: whether it was told to be set, when it came, and when it was last there.
    flags: [(bool, u64, u64); N],
}

/// What is to be told of flags after a tick, in words.
#[derive(Default)]
pub(super) struct News {
    /// Those that have come.
    pub came: Vec<String>,
    /// Those that have gone, for how long they were there, and until when.
    pub gone: Vec<String>,
}

impl<const N: usize> Default for Chatter<N> {
    fn default() -> Self {
        Self { flags: [(false, 0, 0); N] }
    }
}

impl<const N: usize> Chatter<N> {
    /// Whether the flag at this place was told to be set.
    pub fn told(&self, place: usize) -> bool {
        self.flags[place].0
    }

    /// What is to be told; `now` is each flag's words, and whether it is set.
    pub fn look(&mut self, tick: u64, now: [(&str, bool); N]) -> News {
        let mut news = News::default();
        for ((told, from, last), (words, set)) in self.flags.iter_mut().zip(now) {
            if set {
                if !*told {
                    news.came.push(words.to_owned());
                    (*told, *from) = (true, tick);
                }
                *last = tick;
            } else if *told && tick >= *last + QUIET_TICKS {
                let for_s = (*last + 1 - *from) as f64 * STEP_S;
                let until_s = (*last + 1) as f64 * STEP_S;
                news.gone.push(format!("{words} (for {for_s:.3} s, until {until_s:.3} s)"));
                *told = false;
            }
        }
        news
    }
}

impl News {
    /// In words: what is said of those that came, and of those that went.
    pub fn words(self, came: &str, gone: &str) -> Option<String> {
        let told = [(came, self.came), (gone, self.gone)];
        let words: Vec<String> = told
            .into_iter()
            .filter(|(_, flags)| !flags.is_empty())
            .map(|(what, flags)| format!("{what}{}", flags.join(", ")))
            .collect();
        (!words.is_empty()).then(|| words.join("; "))
    }
}
