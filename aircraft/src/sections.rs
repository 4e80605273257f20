//! Blades of fewer than four sections.
//!
//! The engine's blade has four regions, each with a section of its own and elements of its own. A file may
//! have fewer: the widest of its regions is divided in the middle, with the same section on either side, until
//! there are four. Each part then holds its table at the Mach number of its own middle, as the engine does.

use engine::table::axis::RadialStation;
use engine::table::{Axis, VALUE};

use crate::tree::{Node, Value};

/// Regions that the engine has.
const REGIONS: usize = 4;
/// The tables that go by region.
const TABLES: [&str; 2] = ["lift_coefficient", "drag_coefficient"];

fn member<'a>(node: &'a mut Node, name: &str) -> Option<&'a mut Node> {
    match &mut node.value {
        Value::Table(nodes) | Value::Tabulated(nodes) => {
            nodes.iter_mut().find(|(key, _)| key == name).map(|(_, node)| node)
        }
        _ => None,
    }
}

fn numbers(node: Option<&mut Node>) -> Option<Vec<f64>> {
    match &node?.value {
        Value::Array(nodes) => nodes.iter().map(|node| node.value.number()).collect(),
        _ => None,
    }
}

/// Divides regions until there are four. What is not as expected stays: reading it says why.
pub(crate) fn divide(tree: &mut Node) {
    let Some(blade) = member(tree, "rotors").and_then(|rotors| member(rotors, "blade")) else {
        return;
    };
    let root_norm = member(blade, "root_norm").and_then(|root| root.value.number());
    let Some(section) = member(blade, "section") else { return };
    let mut ends = TABLES.map(|table| {
        numbers(member(section, table).and_then(|table| member(table, RadialStation::KEY)))
    });
    let [Some(of_lift), Some(of_drag)] = &mut ends else { return };
    let (Some(root_norm), true) = (root_norm, *of_lift == *of_drag) else { return };
    while (1..REGIONS).contains(&of_lift.len()) {
        let begins = |i: usize| if i > 0 { of_lift[i - 1] } else { root_norm };
        let width = |i: &usize| of_lift[*i] - begins(*i);
        let Some(widest) =
            (0..of_lift.len()).reduce(|a, b| if width(&b) > width(&a) { b } else { a })
        else {
            return;
        };
        let middle = 0.5 * (begins(widest) + of_lift[widest]);
        of_lift.insert(widest, middle);
        for table in TABLES {
            let Some(table) = member(section, table) else { return };
            for (part, new) in [(RadialStation::KEY, Some(middle)), (VALUE, None)] {
                if let Some(Value::Array(nodes)) = member(table, part).map(|node| &mut node.value)
                    && let Some(same) = nodes.get(widest).cloned()
                {
                    let value = new.map_or(same.value.clone(), Value::Float);
                    nodes.insert(widest, Node { value, ..same });
                }
            }
        }
    }
}
