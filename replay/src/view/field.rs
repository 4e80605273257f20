//! A number of the log by the name that `log fields` lists.

use engine::Outputs;
use logs::cdr;
use logs::fields::Value;
use logs::layout::{Kind, Layout};
use logs::records::TimingRecord;
use logs::units::unit_of;

/// Entities of all are below it.
pub const OWN: &str = "fields";

/// Where a number is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// What can be observed.
    Outputs,
    /// How a tick kept time.
    Timing,
}

/// A number of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Of which channel.
    pub channel: Channel,
    /// Its name there.
    pub path: String,
    /// Its place in the message.
    index: usize,
    kind: Kind,
}

impl Field {
    /// The one of that name: `rotors.left.thrust_n`, or with its channel, `timing/late_ns`.
    ///
    /// # Errors
    /// In words, when there is none.
    pub fn named(name: &str) -> Result<Self, String> {
        let (channel, path) = match name.split_once('/') {
            None => (Channel::Outputs, name),
            Some(("outputs", path)) => (Channel::Outputs, path),
            Some(("timing", path)) => (Channel::Timing, path),
            Some((other, _)) => {
                return Err(format!(
                    "`{name}`: fields of the channels outputs and timing are drawn, not of {other}"
                ));
            }
        };
        let layout = match channel {
            Channel::Outputs => Layout::of::<Outputs>(),
            Channel::Timing => Layout::of::<TimingRecord>(),
        }
        .map_err(|error| error.to_string())?;
        let found = layout.numbers().iter().enumerate().find(|(_, number)| number.path == path);
        let Some((index, number)) = found else {
            return Err(format!("`{name}`: no such field; `tiltrotor log fields LOG` lists them"));
        };
        Ok(Self { channel, path: path.into(), index, kind: number.kind })
    }

    /// Its unit.
    pub fn unit(&self) -> String {
        unit_of(&self.path)
    }

    /// Its entity.
    pub fn entity(&self) -> String {
        let channel = match self.channel {
            Channel::Outputs => "outputs",
            Channel::Timing => "timing",
        };
        let path = self.path.replace(['.', '['], "/").replace(']', "");
        format!("{OWN}/{channel}/{path}")
    }

    /// Its value in a message of its channel.
    pub fn of(&self, message: &[u8]) -> f64 {
        let place = cdr::HEADER.len() + 8 * self.index;
        let word = message.get(place..place + 8).and_then(|word| word.try_into().ok());
        match word.map(|word| self.kind.value(u64::from_le_bytes(word))) {
            Some(Value::F64(value)) => value,
            Some(Value::U64(value)) => value as f64,
            Some(Value::I64(value)) => value as f64,
            None => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_found_by_its_name_and_read_from_a_message() {
        let mut outputs = Outputs::default();
        outputs.rotors.left.thrust_n = 28_000.0;
        let message = cdr::encode(&outputs).expect("bytes");
        let field = Field::named("rotors.left.thrust_n").expect("a field");
        assert_eq!(field.of(&message).to_bits(), 28_000.0_f64.to_bits());
        assert_eq!(
            (field.unit().as_str(), field.entity().as_str()),
            ("N", "fields/outputs/rotors/left/thrust_n")
        );
        assert_eq!(Field::named("outputs/rotors.left.thrust_n"), Ok(field));
        let timing = TimingRecord { late_ns: 7, ..TimingRecord::default() };
        let message = cdr::encode(&timing).expect("bytes");
        let field = Field::named("timing/late_ns").expect("a field");
        assert_eq!(field.of(&message).to_bits(), 7.0_f64.to_bits());
        for (wrong, says) in
            [("rotors.thrust", "log fields"), ("state/plant", "outputs and timing")]
        {
            assert!(Field::named(wrong).is_err_and(|told| told.contains(says)), "{wrong}");
        }
    }
}
