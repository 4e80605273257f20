//! The flight model as a whole: the same bits, exact motions, signs, wheels, fuel, and what is observed, computed
//! once more by other formulas.

#[path = "../flying/mod.rs"]
mod flying;

mod determinism;
mod fuel;
mod inputs;
mod observed;
mod signs;
mod small_physics;
mod standing;
mod strut;
mod twins;
