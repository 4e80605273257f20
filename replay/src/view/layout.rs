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

    /// How long before the flight its time axes begin, as a part of it: there legends lie.
    pub fn before_norm(&self, plan: &Plan) -> f64 {
        match self {
            // Of two flights lines have longer names, in narrower plots.
            _ if plan.is_comparison() => 0.62,
            // Two plots beside each other.
            Self::Engineer => 0.5,
            _ => 0.26,
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
        let share = if plan.is_comparison() { 4.6 } else { 5.25 };
        let numbers = match self {
            Self::Rotor if !plan.is_comparison() => {
                let both = vec![view(Shown::NumbersOfRotors), view(Shown::Numbers)];
                Part::Tabs("Numbers".into(), both)
            }
            _ => view(Shown::Numbers),
        };
        let above = across("Above", &[1.0, 2.2], vec![view(Shown::Heading), numbers]);
        down("Review", &[1.0, share], vec![above, below])
    }
}

/// Tabs of graphs, each with its graphs from top to bottom; the entity [`RAW`](super::parts::RAW) is all axes.
type Tab = (&'static str, &'static [&'static str]);

// What stands below each other has room for its legend: see `legends_have_room`.
const FLIGHT: Tab = ("Flight", &["height", "airspeed", "attitude"]);
const MOTION: Tab = ("Motion", &["nacelle", "heading", "climb"]);
const RATES: Tab = ("Rates", &["rates", "flow", "load_factor"]);
const AIR: Tab = ("Air", &["wind", "stalled"]);
const CONTROLS: Tab = ("Controls", &["pilot", "scas"]);
const SURFACES: Tab = ("Surfaces", &["elevator", "flaperons"]);
const BLADES: Tab = ("Blade pitch", &["collective", "cyclic"]);
const ROTORS: Tab = ("Rotors", &["thrust", "torque", "rotor_speed"]);
const INFLOW: Tab = ("Inflow", &["inflow", "blade_loading", "stalled"]);
const FLAPPING: Tab = ("Flapping", &["flapping_aft", "flapping_outboard", "coning"]);
const ENGINES: Tab = ("Engines", &["power", "fuel_flow", "fuel"]);
const GEAR: Tab = ("Gear", &["gear_push", "gear_compression", "gear_extension"]);
const LOADS: [Tab; 5] = [
    ("Force forward", &["force_x"]),
    ("Force up", &["force_z"]),
    ("Rolling", &["moment_roll"]),
    ("Pitching", &["moment_pitch"]),
    ("Yawing", &["moment_yaw"]),
];
const TIMES_OF_TICKS: Tab = ("Every tick", &["sent", "step", "latency"]);
const SLIPS: Tab = ("Slips and overruns", &["slip", "overrun"]);

/// So many letters of a title have room where two plots share three fifths of a window.
const NARROW: usize = 54;

/// Of the plots and the lanes below them: all lanes are seen in a window 900 points high.
const PLOTS_AND_LANES: [f32; 2] = [11.4, 12.2];

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

/// A graph's plot, of every flight; so many letters of a title have room.
fn plot(plan: &Plan, name: &str, room: usize) -> Option<Part> {
    let (title, entity) = graph(name)?;
    let title = plan.titled(title, entity, room);
    Some(view(Shown::Plot { title, queries: plan.each(entity), legend: true }))
}

fn tab(plan: &Plan, tab: Tab) -> Part {
    // In a third of a window 1400 points wide.
    tab_with_room(plan, tab, if plan.is_comparison() { NARROW } else { 66 })
}

fn tab_with_room(plan: &Plan, (name, graphs): Tab, room: usize) -> Part {
    down(name, &[], graphs.iter().filter_map(|graph| plot(plan, graph, room)).collect())
}

fn tabs(plan: &Plan, name: &str, all: &[Tab]) -> Part {
    Part::Tabs(name.into(), all.iter().map(|one| tab(plan, *one)).collect())
}

/// From what devices said over what the pilot asked for and the SCAS added to what the surfaces did.
fn control_chain(plan: &Plan) -> Part {
    let asked = tab_with_room(plan, ("Asked", &["raw", "pilot"]), NARROW);
    let done = tab_with_room(plan, ("Done", &["scas", "elevator"]), NARROW);
    across("Control chain", &[], vec![asked, done])
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
    let all = [FLIGHT, MOTION, CONTROLS, ROTORS, ENGINES, GEAR, RATES, AIR];
    let plots = tabs(plan, "Plots", &all);
    across("Pilot", &[11.0, 10.0], vec![left(aircraft(BEHIND_M, NO_LOADS)), right(plots)])
}

fn engineer(plan: &Plan) -> Part {
    let groups = vec![
        // What was asked for and what became of it: the flight itself is what pilots look at.
        control_chain(plan),
        tabs(plan, "Actuators", &[SURFACES, BLADES]),
        tab(plan, FLIGHT),
        tabs(plan, "Motion", &[MOTION, RATES, AIR]),
        tabs(plan, "Rotors", &[ROTORS, INFLOW, FLAPPING]),
        tab(plan, ENGINES),
        tabs(plan, "Loads", &[LOADS[0], LOADS[1], LOADS[2], LOADS[3], LOADS[4], GEAR]),
        tabs(plan, "Latency", &[TIMES_OF_TICKS, SLIPS]),
    ];
    let plots = Part::Tabs("Plots".into(), groups);
    across("Engineer", &[2.0, 3.0], vec![left(aircraft(BEHIND_M, NO_MOMENTS)), right(plots)])
}

fn rotor(plan: &Plan) -> Part {
    let beside = [
        tab(plan, FLAPPING),
        tab(plan, BLADES),
        tabs(plan, "Loads", &LOADS),
        tab(plan, CONTROLS),
        tab(plan, SURFACES),
    ];
    let plots = across(
        "Rotors",
        &[],
        vec![
            tabs(plan, "Plots", &[ROTORS, INFLOW, ENGINES, GEAR]),
            Part::Tabs("Plots beside".into(), beside.into()),
        ],
    );
    across("Rotor", &[1.0, 2.0], vec![left(aircraft(NEAR_M, &[])), right(plots)])
}

fn latency(plan: &Plan) -> Part {
    let beside = vec![aircraft(BEHIND_M, NO_LOADS), view(Shown::Events)];
    across(
        "Latency",
        &[5.0, 2.0],
        vec![
            right(tabs(plan, "Plots", &[TIMES_OF_TICKS, SLIPS])),
            down("Where", &[1.0, 1.0], beside),
        ],
    )
}

/// Graphs that are compared, with room for the legends of two; times of ticks are the machine's, not the flight's.
const COMPARED: [Tab; 18] = [
    FLIGHT,
    MOTION,
    CONTROLS,
    SURFACES,
    BLADES,
    ROTORS,
    INFLOW,
    FLAPPING,
    ("Engines", &["power", "fuel_flow"]),
    LOADS[0],
    LOADS[1],
    LOADS[2],
    LOADS[3],
    LOADS[4],
    ("Gear", &["gear_push", "gear_compression"]),
    ("Rates", &["rates", "flow"]),
    AIR,
    ("Raw counts", &["raw"]),
];

fn compare(plan: &Plan) -> Part {
    let pairs = COMPARED.iter().map(|(name, graphs)| {
        let delta =
            graphs.iter().filter_map(|name| graph(name)).filter(|(_, of)| !of.contains('*'));
        let deltas: Vec<Part> = delta
            .map(|(title, entity)| {
                let entity = format!("delta/{entity}");
                let title = plan.titled(&format!("Δ {title}"), &entity, NARROW);
                view(Shown::Plot { title, queries: vec![format!("/{entity}")], legend: true })
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
            down("Where", &[3.6, 1.6, 4.8], left),
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
    }

    /// In a window 900 points high plots that are below each other share 310 points, and 545 where two flights
    /// are compared. The title takes 26 of each; the viewer gives a legend what is left but for 40, or 66, and a line
    /// takes 22 of it.
    #[test]
    fn legends_have_room() {
        let chain = [("Asked", &["raw", "pilot"][..]), ("Done", &["scas", "elevator"])];
        for (tab, names) in COMPARED.into_iter().chain([TIMES_OF_TICKS, SLIPS]).chain(chain) {
            for name in names {
                assert!(graph(name).is_some(), "{tab}: {name}");
                let lines_of =
                    |of: &str, lines: usize| of.ends_with(&format!("/{name}")) as usize * lines;
                let lines: usize = GRAPHS.iter().map(|g| lines_of(g.entity, g.lines.len())).sum();
                let of_times: usize = TIMES.iter().map(|g| lines_of(g.entity, g.lines.len())).sum();
                let lines = lines + of_times;
                let room = |points: usize| (points / names.len() - 66).max(66);
                assert!(22 * lines <= room(310), "{tab}: {name}");
                let of_two = COMPARED.iter().any(|(compared, _)| *compared == tab);
                assert!(!of_two || 44 * lines <= room(545), "{tab}: {name}, of two flights");
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
