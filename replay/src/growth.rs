//! How the difference between two flights grows from where it begins.

use engine::math::ln;
use engine::{STEP_S, State};
use logs::LogError;

use crate::compare::{Names, group_of};

/// When it is looked at, in seconds after the first difference.
pub const CHECKPOINTS_S: [u64; 5] = [0, 1, 2, 5, 10];
/// Ticks a second.
const RATE: u64 = 250;
/// Ticks from the first difference to the last look.
pub const WINDOW_TICKS: u64 = CHECKPOINTS_S[CHECKPOINTS_S.len() - 1] * RATE;
/// Ticks between the samples that the growth is fitted to.
const SAMPLE_TICKS: u64 = 25;
/// Fewer samples than this say nothing about growth: a second.
const SAMPLES_MIN: usize = 10;
/// What is sampled.
const SAMPLED: &str = "plant.velocity_mps";

/// The differences in one quantity at one checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupDifference {
    /// Path without axes and sides.
    pub group: String,
    /// Its unit.
    pub unit: String,
    /// Largest of its numbers' differences, in its unit.
    pub absolute: f64,
    /// The same in representable numbers.
    pub ulps: u64,
}

/// Everything at one checkpoint.
#[derive(Clone, Debug, PartialEq)]
pub struct Checkpoint {
    /// After the first difference.
    pub after_s: u64,
    /// When.
    pub tick: u64,
    /// How many numbers differ.
    pub fields: usize,
    /// The quantities that differ.
    pub groups: Vec<GroupDifference>,
}

impl Checkpoint {
    /// A quantity, if it differs.
    pub fn group(&self, group: &str) -> Option<&GroupDifference> {
        self.groups.iter().find(|known| known.group == group)
    }
}

/// How it grows.
#[derive(Clone, Debug)]
pub struct Growth {
    names: Names,
    /// The first difference.
    pub first_tick: u64,
    /// The quantity in which it is.
    pub first_group: String,
    /// The last tick compared.
    pub last_tick: u64,
    /// How many ticks differ, of those compared.
    pub differing_ticks: u64,
    /// From where on everything is the same again, if it is.
    pub same_from: Option<u64>,
    /// Looks at it.
    pub checkpoints: Vec<Checkpoint>,
    /// Seconds after the first difference, and logarithm to base 2 of the velocities' difference.
    samples: Vec<(f64, f64)>,
}

impl Growth {
    /// Of flights that are the same until `first_tick`, where the field at `path` is the first that
    /// differs; their states are added from there on.
    ///
    /// # Errors
    /// Never: a state is recordable.
    pub fn new(first_tick: u64, path: &str) -> Result<Self, LogError> {
        Ok(Self {
            names: Names::of::<State>()?,
            first_tick,
            first_group: group_of(path),
            last_tick: first_tick,
            differing_ticks: 0,
            same_from: None,
            checkpoints: Vec::new(),
            samples: Vec::new(),
        })
    }

    /// The states after `tick`, as messages.
    pub fn add(&mut self, tick: u64, a: &[u8], b: &[u8]) {
        self.last_tick = tick;
        if a == b {
            self.same_from.get_or_insert(tick);
        } else {
            self.differing_ticks += 1;
            self.same_from = None;
        }
        let after = tick.saturating_sub(self.first_tick);
        if after <= WINDOW_TICKS && after.is_multiple_of(SAMPLE_TICKS) {
            self.sample(after, a, b);
        }
        if let Some(&after_s) = CHECKPOINTS_S.iter().find(|after_s| *after_s * RATE == after) {
            let checkpoint = self.look(after_s, tick, a, b);
            self.checkpoints.push(checkpoint);
        }
    }

    fn look(&self, after_s: u64, tick: u64, a: &[u8], b: &[u8]) -> Checkpoint {
        let mut groups: Vec<Option<GroupDifference>> = vec![None; self.names.groups.len()];
        let mut fields = 0;
        for difference in self.names.differences(a, b) {
            fields += 1;
            let group = &mut groups[difference.name.group];
            let group = group.get_or_insert_with(|| GroupDifference {
                group: self.names.groups[difference.name.group].clone(),
                unit: difference.name.unit.clone(),
                absolute: 0.0,
                ulps: 0,
            });
            group.absolute = engine::math::max(group.absolute, difference.absolute());
            group.ulps = group.ulps.max(difference.ulps());
        }
        Checkpoint { after_s, tick, fields, groups: groups.into_iter().flatten().collect() }
    }

    fn sample(&mut self, after: u64, a: &[u8], b: &[u8]) {
        let apart = self
            .names
            .differences(a, b)
            .filter(|difference| self.names.groups[difference.name.group] == SAMPLED)
            .map(|difference| difference.absolute())
            .fold(0.0, engine::math::max);
        if apart > 0.0 && apart.is_finite() {
            self.samples.push((after as f64 * STEP_S, ln(apart) / std::f64::consts::LN_2));
        }
    }

    /// In what time the velocities' difference doubles, s: a straight line through its logarithm over
    /// the window. `None` when it does not grow, or there is too little of it.
    pub fn doubling_s(&self) -> Option<f64> {
        if self.samples.len() < SAMPLES_MIN {
            return None;
        }
        let count = self.samples.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| self.samples.iter().map(of).sum::<f64>() / count;
        let (mean_s, mean_log) = (mean(|sample| sample.0), mean(|sample| sample.1));
        let (mut over, mut under) = (0.0, 0.0);
        for (time_s, log) in &self.samples {
            over += (time_s - mean_s) * (log - mean_log);
            under += (time_s - mean_s) * (time_s - mean_s);
        }
        let doublings_per_s = over / under;
        (doublings_per_s > 0.0).then(|| 1.0 / doublings_per_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use logs::cdr;

    /// Velocities that part with a doubling time of half a second.
    fn parting(ticks: u64) -> Growth {
        let mut growth = Growth::new(100, "plant.velocity_mps.y").expect("recordable");
        let a = cdr::encode(&State::default()).expect("bytes");
        for tick in 100..100 + ticks {
            let mut state = State::default();
            let time_s = (tick - 100) as f64 * STEP_S;
            state.plant.velocity_mps.y =
                1e-9 * engine::math::exp(2.0 * std::f64::consts::LN_2 * time_s);
            growth.add(tick, &a, &cdr::encode(&state).expect("bytes"));
        }
        growth
    }

    #[test]
    fn the_doubling_time_is_found() {
        let doubling_s = parting(2501).doubling_s().expect("it grows");
        assert!((doubling_s - 0.5).abs() < 1e-6, "{doubling_s}");
        assert!(parting(100).doubling_s().is_none(), "too short to say");
    }

    #[test]
    fn it_is_looked_at_after_whole_seconds() {
        let growth = parting(2501);
        let seen: Vec<u64> =
            growth.checkpoints.iter().map(|checkpoint| checkpoint.after_s).collect();
        assert_eq!(seen, CHECKPOINTS_S);
        let after_one = &growth.checkpoints[1];
        assert_eq!((after_one.tick, after_one.fields), (350, 1));
        assert!((after_one.groups[0].absolute - 4e-9).abs() < 1e-15, "{after_one:?}");
        assert_eq!(after_one.groups[0].unit, "m/s");
    }

    #[test]
    fn flights_that_meet_again_are_said_to() {
        let mut growth = parting(3);
        let same = cdr::encode(&State::default()).expect("bytes");
        (103..110).for_each(|tick| growth.add(tick, &same, &same));
        assert_eq!((growth.differing_ticks, growth.same_from), (3, Some(103)));
        assert!(growth.doubling_s().is_none());
    }
}
