//! Fuel aboard.

use engine::math::FRAC_PI_2;
use engine::step;

use crate::flying::{TICKS_PER_S, aloft, calm, parked, xv15};

/// Enough for a few seconds of both engines.
const LAST_FUEL_KG: f64 = 0.2;

#[test]
fn tanks_that_run_empty_stay_empty() {
    let xv15 = xv15();
    let mut state = aloft(&parked(&xv15), FRAC_PI_2, 90.0);
    state.plant.fuel_kg = LAST_FUEL_KG;
    let mut emptied = None;
    for tick in 0..20 * TICKS_PER_S {
        let before_kg = state.plant.fuel_kg;
        state = step(&xv15, &state, &calm()).0;
        let fuel_kg = state.plant.fuel_kg;
        assert!(fuel_kg <= before_kg, "tick {tick}: from {before_kg:e} to {fuel_kg:e} kg");
        if before_kg <= 0.0 {
            assert_eq!(fuel_kg.to_bits(), 0, "tick {tick}");
            emptied.get_or_insert(tick);
        }
    }
    assert!(emptied.is_some_and(|tick| tick > 100), "{emptied:?}");
}
