//! Two messages of the same kind, number by number.

use std::collections::BTreeMap;

use engine::math::max;
use logs::LogError;
use logs::cdr::HEADER;
use logs::fields::Value;
use logs::layout::{Kind, Layout, Number};
use logs::units::unit_of;
use serde::Serialize;

/// One number of a recorded struct.
#[derive(Clone, Debug)]
pub struct Name {
    /// Where, as `logs::fields` has it.
    pub path: String,
    /// Its unit; empty for a count, a flag, a ratio.
    pub unit: String,
    /// Its place in [`Names::groups`].
    pub group: usize,
    kind: Kind,
}

/// The numbers of a recorded struct, in the order of its bytes.
#[derive(Clone, Debug)]
pub struct Names {
    /// Each number.
    pub list: Vec<Name>,
    /// What belongs together: paths without axes and sides, the same quantity in one unit.
    pub groups: Vec<String>,
}

/// A number that is not the same in both.
#[derive(Clone, Copy, Debug)]
pub struct Difference<'a> {
    /// Which.
    pub name: &'a Name,
    /// Its place in [`Names::list`].
    pub index: usize,
    /// In the first message.
    pub a: Value,
    /// In the second.
    pub b: Value,
}

impl Names {
    /// Of a recorded struct.
    ///
    /// # Errors
    /// When it is not recordable.
    pub fn of<T: Serialize + Default>() -> Result<Self, LogError> {
        let mut places = BTreeMap::new();
        let mut groups = Vec::new();
        let name = |Number { path, kind }: &Number| {
            let group = *places.entry(group_of(path)).or_insert_with_key(|group| {
                groups.push(group.clone());
                groups.len() - 1
            });
            Name { unit: unit_of(path), path: path.clone(), group, kind: *kind }
        };
        let list = Layout::of::<T>()?.numbers().iter().map(name).collect();
        Ok(Self { list, groups })
    }

    /// The numbers that are not the same to the bit. Both messages are of the struct named here.
    pub fn differences<'a>(
        &'a self,
        a: &'a [u8],
        b: &'a [u8],
    ) -> impl Iterator<Item = Difference<'a>> {
        let words = |message: &'a [u8]| message[HEADER.len()..].as_chunks::<8>().0;
        let differing = words(a).iter().zip(words(b)).enumerate().filter(|(_, (a, b))| a != b);
        differing.filter_map(|(index, (a, b))| {
            let name = self.list.get(index)?;
            let value = |word: &[u8; 8]| name.kind.value(u64::from_le_bytes(*word));
            Some(Difference { name, index, a: value(a), b: value(b) })
        })
    }
}

impl Difference<'_> {
    /// b − a without its sign; infinite where one of them is no number.
    pub fn absolute(&self) -> f64 {
        let apart = (number(self.b) - number(self.a)).abs();
        if apart.is_nan() { f64::INFINITY } else { apart }
    }

    /// The larger of both without its sign.
    pub fn scale(&self) -> f64 {
        max(number(self.a).abs(), number(self.b).abs())
    }

    /// How many representable numbers lie between.
    pub fn ulps(&self) -> u64 {
        self.a.ulps_to(self.b).unwrap_or(u64::MAX)
    }
}

fn number(value: Value) -> f64 {
    match value {
        Value::F64(value) => value,
        Value::U64(value) => value as f64,
        Value::I64(value) => value as f64,
    }
}

/// A path without axes and sides.
pub(crate) fn group_of(path: &str) -> String {
    const PARTS: [&str; 8] = ["x", "y", "z", "w", "left", "right", "nose", "main"];
    path.split('.').filter(|part| !PARTS.contains(part)).collect::<Vec<_>>().join(".")
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::State;
    use logs::cdr;

    #[test]
    fn what_differs_is_named_with_both_values_and_the_distance() {
        let names = Names::of::<State>().expect("recordable");
        let a = State::default();
        let mut b = a;
        b.plant.rotors.left.flapping.coning_rad = 0.25;
        b.plant.weight_on_wheels = 3;
        let (a, b) = (cdr::encode(&a).expect("bytes"), cdr::encode(&b).expect("bytes"));
        let found: Vec<_> = names.differences(&a, &b).collect();
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].name.path, "plant.rotors.left.flapping.coning_rad");
        assert_eq!(found[0].name.unit, "rad");
        assert_eq!(names.groups[found[0].name.group], "plant.rotors.flapping.coning_rad");
        assert_eq!(found[0].absolute().to_bits(), 0.25f64.to_bits());
        assert_eq!((found[1].a, found[1].b), (Value::U64(0), Value::U64(3)));
        assert_eq!(found[1].ulps(), 3);
    }

    #[test]
    fn what_is_no_number_is_infinitely_far_away() {
        let names = Names::of::<State>().expect("recordable");
        let mut b = State::default();
        b.plant.fuel_kg = f64::NAN;
        let a = cdr::encode(&State::default()).expect("bytes");
        let b = cdr::encode(&b).expect("bytes");
        assert!(names.differences(&a, &b).all(|difference| difference.absolute().is_infinite()));
    }
}
