//! Inside a crate no file needs another that needs it, and in the engine no block knows another block.
//!
//! A circle of files is one file in several places: none of them can be read, tested or changed alone.

use std::path::Path;

use crate::tree;
use crate::tree::source::{self, Graph, Module};

/// The engine's blocks, and the files that each is made of, modules below it included.
const BLOCKS: &[(&str, &[&str])] = &[
    ("actuators", &["actuators"]),
    ("cockpit", &["cockpit"]),
    ("engines", &["engines"]),
    ("environment", &["environment"]),
    ("eom", &["eom"]),
    ("fcc", &["fcc"]),
    ("fin_wake", &["aero::fin_wake"]),
    ("fuselage", &["aero::fuselage"]),
    ("horizontal_stabilizer", &["aero::horizontal_stabilizer"]),
    ("landing_gear", &["landing_gear"]),
    ("rotor_wake", &["aero::rotor_wake"]),
    ("rotors", &["rotors"]),
    ("vertical_stabilizers", &["aero::vertical_stabilizers"]),
    ("weight_balance", &["weight_balance"]),
    ("wing_pylon", &["aero::wing_pylon", "aero::half_wing", "aero::wake_footprint"]),
];

/// What a block may need beside its own files: constants of the crate, mathematics, types that blocks
/// share, and what comes from outside.
const SHARED: &[&str] = &[
    "",
    "aero",
    "aero::polar",
    "aero::wake_course",
    "controls",
    "frames",
    "inertia",
    "inputs",
    "isa",
    "lanes",
    "listing",
    "mast",
    "math",
    "motion",
    "pair",
    "struts",
    "table",
    "table::axis",
    "table::read",
    "units",
];

/// What a block is asked by: a sampled one by `update`, one that gives loads or rates by `evaluate`.
const VERBS: [&str; 2] = ["evaluate", "update"];

fn spelled(module: &Module) -> String {
    if module.is_empty() { "the crate's root".into() } else { module.join("::") }
}

fn engine() -> Graph {
    Graph::of(&tree::root().join("engine/src/lib.rs"))
}

/// The block that a file is a part of.
fn block_of(module: &Module) -> Option<&'static str> {
    let name = module.join("::");
    let holds = |part: &&str| name == **part || name.starts_with(&format!("{part}::"));
    BLOCKS.iter().find(|(_, parts)| parts.iter().any(holds)).map(|(block, _)| *block)
}

#[test]
fn no_file_needs_another_that_needs_it() {
    let mut wrong = Vec::new();
    for (name, (folder, manifest)) in tree::packages() {
        for root in source::roots(&folder, &manifest) {
            let graph = Graph::of(&root);
            for knot in graph.knots() {
                let circle = graph.circle(knot.first().expect("a file"));
                let circle: Vec<_> = circle.iter().map(spelled).collect();
                let files: Vec<_> = knot.iter().map(spelled).collect();
                wrong.push(format!(
                    "{name}: {} (in a knot of {}: {})",
                    circle.join(" → "),
                    files.len(),
                    files.join(", ")
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn no_block_of_the_engine_knows_another() {
    let engine = engine();
    let mut wrong = Vec::new();
    for (file, needs) in &engine.needs {
        let Some(block) = block_of(file) else { continue };
        for needed in needs {
            let own = block_of(needed) == Some(block);
            if !own && !SHARED.contains(&needed.join("::").as_str()) {
                wrong.push(format!("{block}: {} needs {}", spelled(file), spelled(needed)));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn what_blocks_share_needs_no_block() {
    let engine = engine();
    for shared in SHARED {
        let module: Module =
            shared.split("::").filter(|n| !n.is_empty()).map(String::from).collect();
        let needs = engine.needs.get(&module).unwrap_or_else(|| panic!("{shared}: no such file"));
        for needed in needs {
            let name = needed.join("::");
            assert!(SHARED.contains(&name.as_str()), "{}: needs {name}", spelled(&module));
        }
    }
}

#[test]
fn every_block_has_its_verb_and_everything_with_the_verb_is_a_block() {
    let engine = engine();
    let asked = |module: &Module| engine.functions(module).iter().any(|name| VERBS.contains(name));
    for (block, parts) in BLOCKS {
        let module: Module = parts[0].split("::").map(String::from).collect();
        assert!(engine.needs.contains_key(&module), "{block}: no file {}", parts[0]);
        assert!(asked(&module), "{block}: neither `evaluate` nor `update`");
    }
    for module in engine.needs.keys().filter(|module| asked(module)) {
        assert!(block_of(module).is_some(), "{}: which block is it?", spelled(module));
    }
}

#[test]
fn circles_are_found_through_re_exports_and_not_in_tests() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("circles");
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(path, text).expect("a file");
    };
    write("lib.rs", "pub mod a;\nmod b;\nmod c;\nmod d;\npub use b::B;\npub const N: u64 = 1;\n");
    write(
        "a.rs",
        "use crate::B;\npub struct A(B);\n#[cfg(test)]\nmod tests { use crate::d::D; }\n",
    );
    write(
        "b.rs",
        "// crate::d::D\npub struct B;\nfn f() { let _ = (\"crate::d\", super::a::g('\\'')); }\n",
    );
    write("c/mod.rs", "mod e;\npub use e::E;\npub const M: u64 = crate::N;\n");
    write("c/e.rs", "pub struct E([u8; super::super::N]);\n");
    write("d.rs", "use crate::{a, c::{self, E}};\npub struct D(a::A, E);\nconst X: u64 = c::M;\n");
    let graph = Graph::of(&folder.join("lib.rs"));
    let module = |name: &str| name.split("::").map(String::from).collect::<Module>();
    let needs = |name| graph.needs[&module(name)].iter().map(spelled).collect::<Vec<_>>();
    assert_eq!(graph.needs[&Module::new()].len(), 0, "it only re-exports");
    assert_eq!(needs("a"), ["b"], "through the root's re-export");
    assert_eq!(needs("b"), ["a"], "by a path in a body");
    assert_eq!(needs("c"), ["the crate's root"]);
    assert_eq!(needs("c::e"), ["the crate's root"]);
    assert_eq!(needs("d"), ["a", "c", "c::e"]);
    let knots = graph.knots();
    assert_eq!(knots, [[module("a"), module("b")].into()]);
    assert_eq!(graph.circle(&module("a")), ["a", "b", "a"].map(module));
}
