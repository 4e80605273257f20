//! What a what-if changes of the world: weather set, failures set and mended.

use engine::inputs::{Failures, World};

/// A change that cannot be made: which, and what was expected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unchangeable(String);

/// A number of the world that can be set.
pub struct Key {
    /// Its name, as in the log.
    pub name: &'static str,
    /// What it is.
    pub description: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Least and greatest.
    pub range: (f64, f64),
    of: fn(&mut World) -> &mut f64,
}

impl Key {
    /// What it is in a world.
    pub fn value(&self, mut world: World) -> f64 {
        *(self.of)(&mut world)
    }
}

const fn key(
    name: &'static str,
    unit: &'static str,
    description: &'static str,
    range: (f64, f64),
    of: fn(&mut World) -> &mut f64,
) -> Key {
    Key { name, description, unit, range, of }
}

const WIND: (f64, f64) = (-100.0, 100.0);
const GUST: (f64, f64) = (-50.0, 50.0);

/// The ranges are those of scripts, or what the engine clamps to.
pub const KEYS: [Key; 11] = [
    key("wind_mps.x", "m/s", "motion of the air northwards", WIND, |w| &mut w.wind_mps.x),
    key("wind_mps.y", "m/s", "motion of the air eastwards", WIND, |w| &mut w.wind_mps.y),
    key("wind_mps.z", "m/s", "motion of the air downwards", WIND, |w| &mut w.wind_mps.z),
    key("wind_roughness_m", "m", "roughness length of the ground; 0: no shear", (0.0, 10.0), |w| {
        &mut w.wind_roughness_m
    }),
    key("gust_mps.x", "m/s", "gust northwards", GUST, |w| &mut w.gust_mps.x),
    key("gust_mps.y", "m/s", "gust eastwards", GUST, |w| &mut w.gust_mps.y),
    key("gust_mps.z", "m/s", "gust downwards", GUST, |w| &mut w.gust_mps.z),
    key("gust_s", "s", "duration of the gust; 0: no gust", (0.0, 60.0), |w| &mut w.gust_s),
    key("turbulence_mps", "m/s", "vertical intensity; 0: still", (0.0, 15.0), |w| {
        &mut w.turbulence_mps
    }),
    key("temperature_offset_k", "K", "warmer than the standard by", (-80.0, 80.0), |w| {
        &mut w.temperature_offset_k
    }),
    key("pressure_offset_pa", "Pa", "above the standard by", (-20e3, 20e3), |w| {
        &mut w.pressure_offset_pa
    }),
];

/// What is changed in every tick's world.
#[derive(Default)]
pub struct Changes {
    numbers: Vec<(&'static Key, f64)>,
    /// When a gust that is set begins.
    gust_start_tick: Option<u64>,
    fail: Failures,
    mend: Failures,
    /// In words.
    pub words: Vec<String>,
}

impl Changes {
    /// Reads them, settings of numbers as `KEY=VALUE`; `from_tick` is the first tick they are for.
    ///
    /// # Errors
    /// When there is no such key, or its value cannot be.
    pub fn read(
        world: &[String],
        fail: &[String],
        mend: &[String],
        from_tick: u64,
    ) -> Result<Self, Unchangeable> {
        let mut changes = Self::default();
        for setting in world {
            changes.number(setting, from_tick)?;
        }
        for key in fail {
            changes.fail |= failure("--fail", key)?;
            changes.words.push(format!("fail {key}"));
        }
        for key in mend {
            changes.mend |= failure("--mend", key)?;
            changes.words.push(format!("mend {key}"));
        }
        if changes.fail.intersects(changes.mend) {
            return Err(Unchangeable(format!(
                "--fail and --mend name the same: {}",
                changes.fail & changes.mend
            )));
        }
        Ok(changes)
    }

    fn number(&mut self, setting: &str, from_tick: u64) -> Result<(), Unchangeable> {
        let Some((name, value)) = setting.split_once('=').map(|(k, v)| (k.trim(), v.trim())) else {
            return Err(Unchangeable(format!("--world {setting}: expected KEY=VALUE")));
        };
        let Some(key) = KEYS.iter().find(|key| key.name == name) else {
            let names: Vec<&str> = KEYS.iter().map(|key| key.name).collect();
            return Err(Unchangeable(format!(
                "--world {setting}: unknown key {name}{}",
                meant(name, &names)
            )));
        };
        let (least, greatest) = key.range;
        let value: f64 = match value.parse() {
            Ok(value) if (least..=greatest).contains(&value) => value,
            _ => {
                return Err(Unchangeable(format!(
                    "--world {setting}: expected {least} to {greatest} {}",
                    key.unit
                )));
            }
        };
        if name.starts_with("gust") {
            self.gust_start_tick = Some(from_tick);
        }
        // What scripts would have recorded has no negative zero.
        self.numbers.push((key, value + 0.0));
        self.words.push(format!("world {name} = {value}"));
        Ok(())
    }

    /// The world as changed.
    pub fn apply(&self, mut world: World) -> World {
        for (key, value) in &self.numbers {
            *(key.of)(&mut world) = *value;
        }
        if let Some(tick) = self.gust_start_tick {
            world.gust_start_tick = tick;
        }
        world.failures.insert(self.fail);
        world.failures.remove(self.mend);
        world
    }
}

fn failure(option: &str, key: &str) -> Result<Failures, Unchangeable> {
    match Failures::from_key(key) {
        Some(failure) => Ok(failure),
        None => {
            Err(Unchangeable(format!("{option} {key}: unknown key{}", meant(key, Failures::KEYS))))
        }
    }
}

/// The nearest of the keys, or else all of them.
fn meant(key: &str, keys: &[&str]) -> String {
    match aircraft::near(key, keys) {
        near if near.is_empty() => format!("; expected one of {}", keys.join(", ")),
        near => format!("; did you mean {}?", near.join(", or ")),
    }
}

#[cfg(test)]
mod tests {
    use engine::math::{max, min};

    use super::*;

    fn read(world: &[&str], fail: &[&str], mend: &[&str]) -> Result<Changes, Unchangeable> {
        let owned = |list: &[&str]| list.iter().map(ToString::to_string).collect::<Vec<_>>();
        Changes::read(&owned(world), &owned(fail), &owned(mend), 250)
    }

    #[test]
    fn a_setting_changes_its_number_and_no_other() {
        for key in &KEYS {
            let (least, greatest) = key.range;
            let value = 0.25 * min(greatest, 1.0) + 0.1 * max(least, 0.0);
            let changes = read(&[&format!("{}={value}", key.name)], &[], &[]).expect("a setting");
            let mut world = changes.apply(World::default());
            assert_eq!((key.of)(&mut world).to_bits(), value.to_bits(), "{}", key.name);
            *(key.of)(&mut world) = 0.0;
            assert_eq!(world.gust_start_tick, if key.name.starts_with("gust") { 250 } else { 0 });
            world.gust_start_tick = 0;
            assert_eq!(world, World::default(), "{}", key.name);
        }
    }

    #[test]
    fn failures_are_set_and_mended_and_others_stay() {
        let changes = read(&[], &["scas_yaw"], &["governor"]).expect("failures");
        let failures = Failures::GOVERNOR | Failures::ENGINE_LEFT;
        let world = World { failures, ..World::default() };
        let failures = changes.apply(world).failures;
        assert_eq!(failures, Failures::SCAS_YAW | Failures::ENGINE_LEFT);
    }

    #[test]
    fn what_is_not_there_suggests_what_is() {
        let refused = |world: &[&str], fail: &[&str], mend: &[&str]| match read(world, fail, mend) {
            Err(error) => error.to_string(),
            Ok(_) => panic!("{world:?} {fail:?} {mend:?}"),
        };
        assert!(refused(&["wind_mps=3"], &[], &[]).contains("did you mean wind_mps."));
        assert!(refused(&[], &["scas_jaw"], &[]).contains("did you mean scas_yaw"));
        assert!(refused(&[], &[], &["quux"]).contains("expected one of engine_left, "));
        assert!(refused(&["turbulence_mps"], &[], &[]).contains("KEY=VALUE"));
        for value in ["-1", "nan", "inf", "1e9", "", "fast"] {
            let refused = refused(&[&format!("turbulence_mps={value}")], &[], &[]);
            assert!(refused.contains("expected 0 to 15 m/s"), "{refused}");
        }
        assert!(refused(&[], &["governor"], &["governor"]).contains("the same: governor"));
    }
}
