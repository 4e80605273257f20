//! What was shown, sent and exported of a flight: the outputs that were recorded beside those computed now.

use std::collections::BTreeMap;
use std::fmt;

use engine::Outputs;
use logs::channels::{Channel, ChannelId, Written};
use logs::fields::Value;
use logs::records::OUTPUTS;
use logs::text::at;
use logs::units::with_unit;
use logs::{FlightReader, LogError, Remade, cdr};

use crate::compare::Names;

/// Outputs kept until they are found in the log: they are never written so many ticks apart.
const KEPT: usize = 512;

/// Recorded outputs that are not those computed now from the same state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputsDifference {
    /// When; `None` where only a digest over the whole log was kept.
    pub tick: Option<u64>,
    /// The first field that differs, where it is known.
    pub field: Option<String>,
    /// Both values, or how it is known.
    words: String,
}

impl OutputsDifference {
    /// What reading a compacted log has shown: its outputs are made again, and met a digest.
    pub(crate) fn of_compacted(reader: &FlightReader) -> Option<Self> {
        let (tick, words) = match reader.remade() {
            Remade::AsRecorded => return None,
            Remade::OutputsDiffer { tick } => {
                (Some(tick), "what is computed again has not the digest that was kept")
            }
            Remade::Differs => (
                None,
                "what is computed again of this compacted log for viewers and tables has not the \
                 digest that was kept",
            ),
        };
        Some(Self { tick, field: None, words: words.into() })
    }
}

impl fmt::Display for OutputsDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.tick, &self.field) {
            (Some(tick), Some(field)) => write!(f, "at {}: {field}, {}", at(tick), self.words),
            (Some(tick), None) => write!(f, "at {}: {}", at(tick), self.words),
            (None, _) => write!(f, "somewhere: {}", self.words),
        }
    }
}

/// Compares what was recorded with what is computed, whichever comes first.
pub(crate) struct OutputsCheck {
    names: Names,
    /// Ticks between two of which outputs are recorded.
    pub(crate) every_ticks: u64,
    computed: BTreeMap<u64, Outputs>,
    pub(crate) first: Option<OutputsDifference>,
}

impl OutputsCheck {
    pub(crate) fn new() -> Result<Self, LogError> {
        let channel: &Channel = ChannelId::Outputs.into();
        let every_ticks = match channel.written {
            Written::FromOutputs { ticks, .. } => ticks,
            _ => 1,
        };
        let names = Names::of::<Outputs>()?;
        Ok(Self { names, every_ticks, computed: BTreeMap::new(), first: None })
    }

    /// What was computed of a state that is the recorded one.
    pub(crate) fn computed(&mut self, outputs: &Outputs) {
        if outputs.tick.is_multiple_of(self.every_ticks) {
            if self.computed.len() == KEPT {
                self.computed.pop_first();
            }
            self.computed.insert(outputs.tick, *outputs);
        }
    }

    /// What was recorded; what has not been computed yet is to be given again.
    pub(crate) fn recorded(&mut self, recorded: &[Outputs]) -> Result<(), LogError> {
        for recorded in recorded {
            let Some(computed) = self.computed.remove(&recorded.tick) else { continue };
            if self.first.is_some() {
                continue;
            }
            let (a, b) = (cdr::encode(recorded)?, cdr::encode(&computed)?);
            self.first = self.names.differences(&a, &b).next().map(|difference| {
                let told = |value: Value| with_unit(value, &difference.name.unit);
                OutputsDifference {
                    tick: Some(recorded.tick),
                    field: Some(difference.name.path.clone()),
                    words: format!(
                        "recorded {}, computed now {}",
                        told(difference.a),
                        told(difference.b)
                    ),
                }
            });
        }
        Ok(())
    }
}

/// Whether the log's outputs have the fields that they have today: otherwise they cannot be compared.
pub(crate) fn are_todays(reader: &FlightReader) -> bool {
    reader.differences().iter().all(|(topic, _)| *topic != OUTPUTS)
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::path::Path;

    use super::*;

    /// Of a tick, with this fuel.
    fn outputs(tick: u64, fuel_kg: f64) -> Outputs {
        Outputs { tick, fuel_kg, ..Outputs::default() }
    }

    #[test]
    fn other_fields_of_other_channels_say_nothing_of_the_outputs() {
        // A log of a version whose channels had other fields, the outputs too.
        let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/corpus/model-3.mcap");
        for keep_outputs in [false, true] {
            let mut reader =
                FlightReader::read(File::open(&log).expect("the corpus")).expect("a log");
            assert!(are_todays(&reader), "nothing was read");
            reader.keep_outputs = keep_outputs;
            while reader.next_tick().expect("whole ticks").is_some() {}
            assert!(!reader.has_todays_state());
            // Those that nobody read are not known to differ.
            assert_eq!(are_todays(&reader), !keep_outputs);
        }
    }

    #[test]
    fn the_first_recorded_outputs_that_are_not_those_computed_are_told_with_both_values() {
        let mut check = OutputsCheck::new().expect("recordable");
        // They are recorded every tenth tick.
        assert_eq!(check.every_ticks, 10);
        check.computed(&outputs(5, 1.0));
        check.computed(&outputs(10, 1.0));
        check.recorded(&[outputs(5, 2.0), outputs(10, 1.0)]).expect("compared");
        assert_eq!(check.first, None, "the one is not looked at, and the other is the same");
        // What has not been computed yet waits.
        check.recorded(&[outputs(20, 3.0)]).expect("compared");
        assert_eq!(check.first, None);
        check.computed(&outputs(20, 1.0));
        check.computed(&outputs(30, 1.0));
        check.recorded(&[outputs(20, 3.0), outputs(30, 4.0)]).expect("compared");
        let told = check.first.expect("found");
        assert_eq!((told.tick, told.field.as_deref()), (Some(20), Some("fuel_kg")));
        let words = told.to_string();
        // Tick 20 is 20 times 4 ms.
        assert!(words.starts_with("at tick 20 (0.080 s): fuel_kg, recorded 3"), "{words}");
        assert!(words.contains(" kg, computed now 1") && words.ends_with(" kg"), "{words}");
    }

    #[test]
    fn of_outputs_that_are_never_found_in_the_log_the_oldest_are_let_go_of() {
        let mut check = OutputsCheck::new().expect("recordable");
        for row in 1..=KEPT as u64 + 1 {
            check.computed(&outputs(10 * row, 1.0));
        }
        assert_eq!(check.computed.len(), KEPT);
        check.recorded(&[outputs(10, 2.0)]).expect("compared");
        assert_eq!(check.first, None, "it is too long ago");
        check.recorded(&[outputs(20, 2.0)]).expect("compared");
        assert_eq!(check.first.and_then(|told| told.tick), Some(20));
    }
}
