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
