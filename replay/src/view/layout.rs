//! How the viewer arranges a flight.
//!
//! ```text
//! ┌────────────┬────────────────────────┐
//! │ which it is│ numbers at the cursor  │
//! ├────────────┴─────┬──────────────────┤
//! │ 3D, following    │ plots, in tabs   │
//! │ the aircraft     │                  │
//! ├──────────────────┤                  │
//! │ corridor,        ├──────────────────┤
//! │ overview, map    │ lanes, on the    │
//! ├──────────────────┤ plots' time axis │
//! │ events           │                  │
//! └──────────────────┴──────────────────┘
//! ```
//! Two flights have the same places; each plot has the difference beside it.

use super::field::Field;
use super::own::Own;
use super::parts::{Part, Plan, Shown};
use super::plots::{GRAPHS, TIMES};

/// An arrangement.
#[derive(Clone, Debug, PartialEq)]
pub enum Layout {
    /// What a crew asks after a flight.
    Pilot,
    /// Everything.
    Engineer,
    /// Rotors, blades, loads; the aircraft from near, with every arrow.
    Rotor,
    /// How it kept time.
    Latency,
    /// Two flights, and the difference.
    Compare,
    /// One's own.
    Own(Own),
}

impl Layout {
    /// Those that have a name.
    pub const NAMED: [(&'static str, Self); 5] = [
        ("pilot", Self::Pilot),
        ("engineer", Self::Engineer),
        ("rotor", Self::Rotor),
        ("latency", Self::Latency),
        ("compare", Self::Compare),
    ];

    /// The one of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMED.into_iter().find(|(known, _)| *known == name).map(|(_, layout)| layout)
    }

    /// Fields of the log that it shows, each with its place in its view.
    pub fn fields(&self) -> Vec<(usize, Field)> {
        match self {
            Self::Own(own) => own.fields(),
            _ => Vec::new(),
        }
    }

    /// The arrangement.
    pub fn tree(&self, plan: &Plan) -> Part {
        let below = match self {
            Self::Pilot => pilot(plan),
            Self::Engineer => engineer(plan),
            Self::Rotor => rotor(plan),
            Self::Latency => latency(plan),
            Self::Compare => compare(plan),
            Self::Own(own) => return own.tree(plan),
        };
        let share = if plan.is_comparison() { 4.6 } else { 5.6 };
        down("Review", &[1.0, share], vec![above(), below])
    }
}

/// Which flight it is, and numbers at the cursor.
fn above() -> Part {
    across("Above", &[1.0, 2.2], vec![view(Shown::Heading), view(Shown::Numbers)])
}

/// Tabs of graphs, each with its graphs from top to bottom; the entity [`RAW`](super::parts::RAW) is all axes.
type Tab = (&'static str, &'static [&'static str]);

// Not more than four below each other: lower ones have no room for the numbers of their axes.
const FLIGHT: Tab = ("Flight", &["height", "airspeed", "attitude"]);
const MOTION: Tab = ("Motion", &["nacelle", "heading", "climb", "load_factor"]);
const AIR: Tab = ("Air", &["rates", "flow", "wind", "stalled"]);
const CONTROLS: Tab = ("Control chain", &["raw", "pilot", "scas", "elevator"]);
const ACTUATORS: Tab = ("Actuators", &["flaperons", "collective", "cyclic"]);
const ROTORS: Tab = ("Rotors", &["thrust", "torque", "rotor_speed"]);
const INFLOW: Tab = ("Inflow", &["inflow", "blade_loading", "stalled"]);
const FLAPPING: Tab = ("Flapping", &["flapping_aft", "flapping_outboard", "coning"]);
const ENGINES: Tab = ("Engines", &["power", "fuel_flow", "fuel"]);
const FORCES: Tab = ("Forces", &["force_x", "force_z"]);
const MOMENTS: Tab = ("Moments", &["moment_roll", "moment_pitch", "moment_yaw"]);
const GEAR: Tab = ("Gear", &["gear_push", "gear_compression", "gear_extension"]);
const TIMES_OF_TICKS: Tab = ("Every tick", &["sent", "step", "latency"]);
const SLIPS: Tab = ("Slips and overruns", &["slip", "overrun"]);

/// Of the plots and the lanes below them: all lanes are seen in a window 900 points high.
const PLOTS_AND_LANES: [f32; 2] = [11.3, 12.2];

/// Behind the aircraft, to its left and above it.
const BEHIND_M: [f32; 3] = [-16.0, -12.5, -7.0];
/// From near, before the right wing.
const NEAR_M: [f32; 3] = [11.0, 9.0, -6.0];
/// What a pilot does not look at.
const NO_LOADS: &[&str] = &["aircraft/forces/airframe", "aircraft/forces/sum", "aircraft/moments"];
/// Moments hide forces.
const NO_MOMENTS: &[&str] = &["aircraft/moments"];

fn view(shown: Shown) -> Part {
    Part::View(shown)
}

fn across(name: &str, shares: &[f32], parts: Vec<Part>) -> Part {
    Part::Across(name.into(), shares.into(), parts)
}

fn down(name: &str, shares: &[f32], parts: Vec<Part>) -> Part {
    Part::Down(name.into(), shares.into(), parts)
}

fn aircraft(eye_m: [f32; 3], without: &'static [&'static str]) -> Part {
    view(Shown::Aircraft { eye_m, without })
}

fn places(first: &Shown) -> Part {
    let all = [Shown::Corridor, Shown::Overview, Shown::Map];
    let mut parts = vec![view(first.clone())];
    parts.extend(all.into_iter().filter(|shown| shown != first).map(view));
    Part::Tabs("Places".into(), parts)
}

fn lanes() -> Part {
    let modes = Shown::Lanes { name: "Lanes", of: "modes/**" };
    let validity = Shown::Lanes { name: "Limits of the model", of: "validity/**" };
    Part::Tabs("What was on".into(), vec![view(modes), view(validity)])
}

/// The graph of that short name: title, and entity below a root.
fn graph(name: &str) -> Option<(&'static str, &'static str)> {
    if name == super::parts::RAW {
        return Some(("Raw counts of every axis", "raw/**"));
    }
    let mut all = GRAPHS
        .iter()
        .map(|graph| (graph.title, graph.entity))
        .chain(TIMES.iter().map(|graph| (graph.title, graph.entity)));
    all.find(|(_, entity)| entity.rsplit('/').next() == Some(name))
}

/// A graph's plot, of every flight.
fn plot(plan: &Plan, name: &str) -> Option<Part> {
    let (title, entity) = graph(name)?;
    Some(view(Shown::Plot { title: title.into(), queries: plan.each(entity), legend: true }))
}

fn tab(plan: &Plan, (name, graphs): Tab) -> Part {
    down(name, &[], graphs.iter().filter_map(|graph| plot(plan, graph)).collect())
}

fn tabs(plan: &Plan, all: &[Tab]) -> Part {
    Part::Tabs("Plots".into(), all.iter().map(|one| tab(plan, *one)).collect())
}

/// The aircraft, where it was, and what happened.
fn left(aircraft: Part) -> Part {
    let parts = vec![aircraft, places(&Shown::Corridor), view(Shown::Events)];
    down("Where", &[4.0, 2.8, 2.6], parts)
}

fn right(plots: Part) -> Part {
    down("When", &PLOTS_AND_LANES, vec![plots, lanes()])
}

fn pilot(plan: &Plan) -> Part {
    let plots = tabs(plan, &[FLIGHT, MOTION, CONTROLS, ROTORS, ENGINES, GEAR, AIR]);
    across("Pilot", &[11.0, 10.0], vec![left(aircraft(BEHIND_M, NO_LOADS)), right(plots)])
}

fn engineer(plan: &Plan) -> Part {
    let groups = [
        tab(plan, FLIGHT),
        tab(plan, MOTION),
        tab(plan, AIR),
        tab(plan, CONTROLS),
        tab(plan, ACTUATORS),
        Part::Tabs("Rotors".into(), [ROTORS, INFLOW, FLAPPING].map(|one| tab(plan, one)).into()),
        tab(plan, ENGINES),
        Part::Tabs("Loads".into(), [FORCES, MOMENTS, GEAR].map(|one| tab(plan, one)).into()),
        Part::Tabs("Latency".into(), [TIMES_OF_TICKS, SLIPS].map(|one| tab(plan, one)).into()),
    ];
    let plots = Part::Tabs("Plots".into(), groups.into());
    across("Engineer", &[2.0, 3.0], vec![left(aircraft(BEHIND_M, NO_MOMENTS)), right(plots)])
}

fn rotor(plan: &Plan) -> Part {
    let plots = across(
        "Rotors",
        &[],
        vec![
            tabs(plan, &[ROTORS, INFLOW, ENGINES, GEAR]),
            tabs(plan, &[ACTUATORS, FLAPPING, FORCES, MOMENTS, CONTROLS]),
        ],
    );
    across("Rotor", &[1.0, 2.0], vec![left(aircraft(NEAR_M, &[])), right(plots)])
}

fn latency(plan: &Plan) -> Part {
    let beside = vec![aircraft(BEHIND_M, NO_LOADS), view(Shown::Events)];
    across(
        "Latency",
        &[5.0, 2.0],
        vec![right(tabs(plan, &[TIMES_OF_TICKS, SLIPS])), down("Where", &[1.0, 1.0], beside)],
    )
}

/// Graphs that are compared, with room for the legends of two; times of ticks are the machine's, not the flight's.
const COMPARED: [Tab; 13] = [
    FLIGHT,
    MOTION,
    ("Controls", &["pilot", "scas", "elevator"]),
    ACTUATORS,
    ROTORS,
    INFLOW,
    FLAPPING,
    ENGINES,
    FORCES,
    MOMENTS,
    GEAR,
    ("Air", &["rates", "flow", "wind"]),
    ("Raw counts", &["raw"]),
];

fn compare(plan: &Plan) -> Part {
    let pairs = COMPARED.iter().map(|(name, graphs)| {
        let delta =
            graphs.iter().filter_map(|name| graph(name)).filter(|(_, of)| !of.contains('*'));
        let deltas: Vec<Part> = delta
            .map(|(title, entity)| {
                let queries = vec![format!("/delta/{entity}")];
                view(Shown::Plot { title: format!("Δ {title}"), queries, legend: true })
            })
            .collect();
        let both = tab(plan, (name, graphs));
        // What devices said has no difference: they say it at times of their own.
        if deltas.is_empty() {
            return both;
        }
        across(name, &[], vec![both, down("Difference", &[], deltas)])
    });
    let mut plots: Vec<Part> = pairs.collect();
    plots.push(view(Shown::Plot {
        title: "Growth of the difference, logarithm to base 10".into(),
        queries: vec!["/delta/growth/**".into()],
        legend: true,
    }));
    let both = |name, of| view(Shown::Lanes { name, of });
    let lanes = Part::Tabs(
        "What was on".into(),
        vec![
            both("Events of both", "modes/events"),
            both("Nacelles of both", "modes/nacelles"),
            both("Gear of both", "modes/gear"),
            both("Flaps of both", "modes/flaps"),
            both("SCAS of both", "modes/scas"),
            both("Governor of both", "modes/governor"),
            both("Failures of both", "modes/failures"),
            both("Limits of the model", "validity/**"),
        ],
    );
    let largest = Shown::Document { name: "Largest differences", entity: "/delta/largest" };
    let left = vec![
        aircraft(BEHIND_M, NO_LOADS),
        places(&Shown::Overview),
        Part::Tabs("What differs".into(), vec![view(largest), view(Shown::Events)]),
    ];
    across(
        "Comparison",
        &[2.0, 3.0],
        vec![
            down("Where", &[4.0, 3.0, 3.0], left),
            down("When", &[17.0, 4.0], vec![Part::Tabs("Plots".into(), plots), lanes]),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(part: &Part, found: &mut Vec<Shown>) {
        match part {
            Part::View(one) => found.push(one.clone()),
            Part::Tabs(_, parts) | Part::Across(_, _, parts) | Part::Down(_, _, parts) => {
                assert!(!parts.is_empty(), "{part:?} is empty");
                parts.iter().for_each(|part| shown(part, found));
            }
        }
    }

    fn all_of(layout: &Layout, roots: &[&str]) -> Vec<Shown> {
        let plan = Plan::new(roots);
        let mut found = Vec::new();
        shown(&layout.tree(&plan), &mut found);
        found
    }

    #[test]
    fn every_graph_is_in_the_engineer_s_layout_and_every_name_is_a_graph() {
        let found = all_of(&Layout::Engineer, &[""]);
        for entity in GRAPHS.iter().map(|graph| graph.entity).chain(TIMES.iter().map(|g| g.entity))
        {
            let query = format!("/{entity}");
            let drawn = found
                .iter()
                .any(|one| matches!(one, Shown::Plot { queries, .. } if queries.contains(&query)));
            assert!(drawn, "{entity}");
        }
        for (tab, graphs) in COMPARED.iter().chain([&TIMES_OF_TICKS, &SLIPS]) {
            assert!(graphs.len() <= 4, "{tab} has too many for their height");
            for name in *graphs {
                assert!(graph(name).is_some(), "{tab}: {name}");
            }
        }
    }

    #[test]
    fn lanes_are_below_the_plots_of_every_layout() {
        for (name, layout) in Layout::NAMED {
            let roots: &[&str] = if layout == Layout::Compare { &["a/", "b/"] } else { &[""] };
            let found = all_of(&layout, roots);
            assert!(found.iter().any(|one| matches!(one, Shown::Lanes { .. })), "{name}");
            assert!(found.contains(&Shown::Events), "{name}");
        }
    }

    #[test]
    fn a_comparison_shows_both_and_the_difference() {
        let found = all_of(&Layout::Compare, &["calm/", "gusts/"]);
        let of = |wanted: &[&str]| {
            let wanted: Vec<String> = wanted.iter().map(|&one| one.into()).collect();
            found.iter().any(|one| matches!(one, Shown::Plot { queries, .. } if *queries == wanted))
        };
        assert!(of(&["/calm/plots/height", "/gusts/plots/height"]));
        assert!(of(&["/delta/plots/height"]));
    }
}
