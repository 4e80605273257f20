//! What a pilot would notice of the difference between two flights.
//!
//! What is noticed is what instruments show or the seat tells: a metre of place or height, a knot, a degree of attitude,
//! five revolutions a minute of the rotors. These are judgement, not measurement.

use engine::units::{KNOT_MPS, RPM_RADPS, degrees};
use logs::text::at;

use crate::diff::{Diff, Extent};

/// One thing that is noticed: fields of the state, and how large a difference is.
struct Sense {
    words: &'static str,
    unit: &'static str,
    /// Of which fields.
    prefix: &'static str,
    /// Of the field's difference in the unit.
    scale: f64,
    /// In the unit.
    noticed: f64,
}

const SENSES: [Sense; 5] = [
    Sense { words: "place", unit: "m", prefix: "plant.position_m.", scale: 1.0, noticed: 1.0 },
    Sense { words: "height", unit: "m", prefix: HEIGHT, scale: 1.0, noticed: 1.0 },
    Sense {
        words: "speed",
        unit: "kt",
        prefix: "plant.velocity_mps.",
        scale: 1.0 / KNOT_MPS,
        noticed: 1.0,
    },
    // A part of the quaternion changes by half the angle at most.
    Sense { words: "attitude", unit: "°", prefix: "plant.attitude.", scale: 2.0, noticed: 1.0 },
    Sense {
        words: "rotor speed",
        unit: "rpm",
        prefix: "plant.rotor_speed_radps",
        scale: 1.0 / RPM_RADPS,
        noticed: 5.0,
    },
];

const HEIGHT: &str = "plant.position_m.z";

impl Sense {
    /// The largest difference, in its unit, and when it was.
    fn largest(&self, state: &[Extent]) -> Option<(f64, u64)> {
        let mine = |extent: &&Extent| {
            extent.path.starts_with(self.prefix) && (self.prefix == HEIGHT || extent.path != HEIGHT)
        };
        let largest = state.iter().filter(mine).max_by(|a, b| a.largest.total_cmp(&b.largest))?;
        let size = self.scale * largest.largest;
        let size = if self.unit == "°" { degrees(size) } else { size };
        Some((size, largest.largest_tick))
    }
}

impl Diff {
    /// In a sentence; nothing where the states are the same.
    pub fn noticed(&self) -> Option<String> {
        self.first.as_ref()?;
        let found = SENSES.iter().filter_map(|sense| Some((sense, sense.largest(&self.state)?)));
        let (noticed, beneath): (Vec<_>, Vec<_>) =
            found.partition(|(sense, (size, _))| *size >= sense.noticed || size.is_nan());
        if noticed.is_empty() {
            let most: Vec<String> = beneath
                .iter()
                .map(|(sense, (size, _))| format!("{} {size:.1e} {}", sense.words, sense.unit))
                .collect();
            let most = if most.is_empty() {
                "neither place nor speed nor attitude differ".into()
            } else {
                format!("the largest differences are in {}", most.join(", "))
            };
            return Some(format!("a pilot would notice nothing: {most}"));
        }
        let told: Vec<String> = noticed
            .iter()
            .map(|(sense, (size, tick))| {
                format!("{} up to {size:.1} {} apart, at {}", sense.words, sense.unit, at(*tick))
            })
            .collect();
        Some(format!("a pilot would notice: {}", told.join("; ")))
    }
}
