//! The lanes of one flight: what they show now, and for a viewer that comes late, what they showed.

use rerun::StateChange;

use super::canvas::{Canvas, times};
use super::look::Look;
use super::modes::{MODES, Seen, alarm};

/// So many changes of a lane are told to a viewer that comes late.
const CHANGES_MAX: usize = 1000;

/// What all lanes show.
pub struct Lanes {
    now: Vec<Option<&'static str>>,
    /// Changes so far, while it is flown.
    before: Option<Vec<Vec<(u64, &'static str)>>>,
}

impl Lanes {
    /// Nothing yet; with `kept` changes are kept for whoever comes late.
    pub fn new(kept: bool) -> Self {
        Self { now: vec![None; MODES.len()], before: kept.then(|| vec![Vec::new(); MODES.len()]) }
    }

    /// Notes what is so; which lanes changed, and to what.
    pub fn see(&mut self, seen: Seen) -> Vec<(usize, &'static str)> {
        let mut changed = Vec::new();
        for (index, mode) in MODES.iter().enumerate() {
            let value = mode.of(seen);
            if self.now[index] == Some(value) {
                continue;
            }
            self.now[index] = Some(value);
            changed.push((index, value));
            if let Some(before) = &mut self.before {
                if before[index].len() >= CHANGES_MAX {
                    before[index].remove(0);
                }
                before[index].push((seen.outputs.tick, value));
            }
        }
        changed
    }

    /// Writes changes of one tick.
    pub fn write(canvas: &mut Canvas, look: &Look, tick: u64, changed: &[(usize, &'static str)]) {
        for (index, value) in changed {
            let columns = StateChange::single(*value).columns_of_unit_batches().map(Vec::from_iter);
            canvas.send(&look.entity(&MODES[*index].path), &times(&[tick]), columns);
        }
    }

    /// Writes all changes that were kept; the alarms among them, with their ticks.
    pub fn write_all(&self, canvas: &mut Canvas, look: &Look) -> Vec<(u64, String)> {
        let mut alarms = Vec::new();
        for (mode, changes) in MODES.iter().zip(self.before.iter().flatten()) {
            if changes.is_empty() {
                continue;
            }
            let (ticks, values): (Vec<u64>, Vec<&str>) = changes.iter().copied().unzip();
            let columns = StateChange::new().with_state(values).columns_of_unit_batches();
            canvas.send(&look.entity(&mode.path), &times(&ticks), columns.map(Vec::from_iter));
            let told =
                changes.iter().filter_map(|(tick, value)| Some((*tick, alarm(mode, value)?)));
            alarms.extend(told);
        }
        alarms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Outputs;
    use engine::inputs::World;

    #[test]
    fn changes_are_kept_for_whoever_comes_late_and_not_for_a_file() {
        let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15)
            .unwrap_or_else(|error| panic!("{error}"));
        let world = World::default();
        let mut late = Lanes::new(true);
        let mut file = Lanes::new(false);
        for tick in 1..=2000 {
            let mut outputs = Outputs { tick, ..Outputs::default() };
            outputs.cockpit.scas_on = tick % 2;
            let seen = Seen { outputs: &outputs, world: &world, aircraft: &xv15 };
            let changed = late.see(seen);
            assert_eq!(changed, file.see(seen));
            assert_eq!(changed.len(), if tick == 1 { MODES.len() } else { 1 }, "{tick}");
        }
        let kept = late.before.expect("kept");
        let scas = MODES.iter().position(|mode| mode.path == "modes/scas").expect("a lane");
        assert_eq!(kept[scas].len(), CHANGES_MAX);
        assert_eq!(kept[scas].last(), Some(&(2000, "off")));
        assert!(kept.iter().enumerate().all(|(lane, kept)| lane == scas || kept.len() == 1));
        assert!(file.before.is_none());
    }
}
