//! Ten seconds from a start position by the inputs of `tests/fmu.py`, flown by `recorder::Stepped` and nothing of
//! this crate: the outputs at the start and after every tick as they are recorded, end to end on standard output.
//!
//! `native START`

use std::io::Write;
use std::sync::Arc;

use engine::cockpit::{AxisControl, ButtonControl};
use engine::inputs::Failures;
use logs::{Setup, cdr};
use recorder::Stepped;

const TICKS: u64 = 2500;

/// An input beside where the control stands at the start, through ticks.
const MOVES: [(AxisControl, u64, u64, f64); 3] = [
    (AxisControl::Collective, 500, 2500, 0.05),
    (AxisControl::PedalRight, 750, 1000, -0.2),
    (AxisControl::StickAft, 125, 250, 0.1),
];

fn main() {
    let name = std::env::args().nth(1).expect("a start position");
    let scenario = aircraft::STARTS.iter().find(|(known, ..)| *known == name).expect("known").2;
    let map = aircraft::cockpit("pilot.toml", aircraft::PILOT_MAP).expect("our own file");
    let xv15 = aircraft::aircraft("xv15.toml", aircraft::XV15).expect("our own file");
    let start = aircraft::start("scenario.toml", scenario).expect("our own file");
    let xv15 = Arc::new(xv15.with_cockpit(map));
    let mut flight = Stepped::begin(xv15, Setup::default(), &start).expect("a steady flight");
    let stands = MOVES.map(|(axis, ..)| (axis.facts().get)(&flight.state.cockpit));
    let mut out = std::io::stdout().lock();
    let mut write = |flight: &Stepped| {
        let message = cdr::encode(&flight.outputs).expect("numbers");
        out.write_all(&message[cdr::HEADER.len()..]).expect("standard output");
    };
    write(&flight);
    for tick in 0..TICKS {
        match tick {
            1250 => flight.press(ButtonControl::NacelleForward, true),
            1500 => flight.press(ButtonControl::NacelleForward, false),
            2000 => flight.world.failures.insert(Failures::SCAS_YAW),
            _ => {}
        }
        for ((axis, from, until, by_norm), stands_norm) in MOVES.iter().zip(stands) {
            if tick == *from {
                flight.set(*axis, stands_norm + by_norm);
            }
            if tick == *until {
                flight.set(*axis, stands_norm);
            }
        }
        flight.step().expect("no log that could fail");
        write(&flight);
    }
}
