//! Layouts of one's own, from a file.
//!
//! ```toml
//! [[tab]]
//! name = "Left rotor"
//!
//! [[tab.view]]
//! title = "Thrust, N"
//! fields = ["rotors.left.thrust_n", "loads.rotors.left.force_n.z"]
//!
//! [[tab.view]]
//! show = "corridor"
//! ```

use serde::Deserialize;

use super::field::Field;
use super::parts::{Part, Plan, Shown};

/// The names by which a view of a file shows something that is no plot.
const NAMES: [&str; 8] =
    ["aircraft", "overview", "map", "corridor", "events", "lanes", "heading", "numbers"];

/// Tabs and their views.
#[derive(Clone, Debug, PartialEq)]
pub struct Own {
    tabs: Vec<(String, Vec<View>)>,
}

/// One view.
#[derive(Clone, Debug, PartialEq)]
enum View {
    Shown(Shown),
    Fields(String, Vec<Field>),
}

/// Why a file is no layout.
#[derive(Debug, thiserror::Error)]
pub enum OwnError {
    /// It is no TOML, or has other keys.
    #[error("{0}")]
    Toml(#[from] toml::de::Error),
    /// It has nothing to show.
    #[error("expected at least one [[tab]] with one [[tab.view]] in each")]
    Empty,
    /// A view shows nothing, or too much.
    #[error("view {view} of the tab `{tab}`: {reason}")]
    View {
        /// The tab's name.
        tab: String,
        /// Counted from 1.
        view: usize,
        /// What is wrong, and what was expected.
        reason: String,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    tab: Vec<FileTab>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileTab {
    name: String,
    #[serde(default)]
    view: Vec<FileView>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileView {
    title: Option<String>,
    fields: Option<Vec<String>>,
    show: Option<String>,
}

impl FileView {
    fn read(&self) -> Result<View, String> {
        match (&self.show, &self.fields) {
            (Some(name), None) => shown(name)
                .map(View::Shown)
                .ok_or_else(|| format!("show = \"{name}\": expected one of {}", NAMES.join(", "))),
            (None, Some(names)) if !names.is_empty() => {
                let fields: Vec<Field> =
                    names.iter().map(|name| Field::named(name)).collect::<Result<_, _>>()?;
                let title = self.title.clone().unwrap_or_else(|| title(&fields));
                Ok(View::Fields(title, fields))
            }
            _ => Err("expected either fields, a list with at least one name, or show".into()),
        }
    }
}

fn shown(name: &str) -> Option<Shown> {
    Some(match name {
        "aircraft" => {
            Shown::Aircraft { eye_m: [-16.0, -12.5, -7.0], without: &["aircraft/moments"] }
        }
        "overview" => Shown::Overview,
        "map" => Shown::Map,
        "corridor" => Shown::Corridor,
        "events" => Shown::Events,
        "heading" => Shown::Heading,
        "numbers" => Shown::Numbers,
        "lanes" => Shown::Lanes { name: "Lanes", of: "modes/**" },
        _ => return None,
    })
}

/// The name of the first field, and the units of all.
fn title(fields: &[Field]) -> String {
    let mut units: Vec<String> = Vec::new();
    for unit in fields.iter().map(Field::unit).filter(|unit| !unit.is_empty()) {
        if !units.contains(&unit) {
            units.push(unit);
        }
    }
    let name = fields.first().map_or("", |field| field.path.as_str());
    if units.is_empty() { name.into() } else { format!("{name}, {}", units.join(" and ")) }
}

impl Own {
    /// Of a file's text.
    ///
    /// # Errors
    /// When it is none, with what was expected.
    pub fn parse(text: &str) -> Result<Self, OwnError> {
        let file: File = toml::from_str(text)?;
        if file.tab.is_empty() || file.tab.iter().any(|tab| tab.view.is_empty()) {
            return Err(OwnError::Empty);
        }
        let mut tabs = Vec::new();
        for tab in &file.tab {
            let mut views = Vec::new();
            for (place, view) in tab.view.iter().enumerate() {
                let named =
                    |reason| OwnError::View { tab: tab.name.clone(), view: place + 1, reason };
                views.push(view.read().map_err(named)?);
            }
            tabs.push((tab.name.clone(), views));
        }
        Ok(Self { tabs })
    }

    /// Every field once, with its place in the first view that has it.
    pub fn fields(&self) -> Vec<(usize, Field)> {
        let mut found: Vec<(usize, Field)> = Vec::new();
        for view in self.tabs.iter().flat_map(|(_, views)| views) {
            let View::Fields(_, fields) = view else { continue };
            for (place, field) in fields.iter().enumerate() {
                if !found.iter().any(|(_, known)| known == field) {
                    found.push((place, field.clone()));
                }
            }
        }
        found
    }

    /// The arrangement.
    pub fn tree(&self, plan: &Plan) -> Part {
        let view = |view: &View| {
            Part::View(match view {
                View::Shown(shown) => shown.clone(),
                View::Fields(title, fields) => {
                    let each = |field: &Field| plan.each(&field.entity());
                    let queries = fields.iter().flat_map(each).collect();
                    Shown::Plot { title: title.clone(), queries, legend: true }
                }
            })
        };
        let tab = |(name, views): &(String, Vec<View>)| {
            Part::Down(name.clone(), Vec::new(), views.iter().map(view).collect())
        };
        Part::Tabs("Own".into(), self.tabs.iter().map(tab).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_becomes_tabs_of_views() {
        let text = "[[tab]]\nname = \"Left\"\n[[tab.view]]\nfields = [\"rotors.left.thrust_n\", \
                    \"rotors.right.thrust_n\"]\n[[tab.view]]\nshow = \"corridor\"\n";
        let own = Own::parse(text).expect("a layout");
        let Part::Tabs(_, tabs) = own.tree(&Plan::new(&[""])) else {
            panic!("no tabs");
        };
        let Part::Down(name, _, views) = &tabs[0] else { panic!("no views") };
        assert_eq!((name.as_str(), views.len()), ("Left", 2));
        let queries =
            ["/fields/outputs/rotors/left/thrust_n", "/fields/outputs/rotors/right/thrust_n"];
        assert_eq!(
            views[0],
            Part::View(Shown::Plot {
                title: "rotors.left.thrust_n, N".into(),
                queries: queries.map(String::from).to_vec(),
                legend: true
            })
        );
        assert_eq!(views[1], Part::View(Shown::Corridor));
        assert_eq!(own.fields().len(), 2);
        assert!(NAMES.iter().all(|name| shown(name).is_some()));
    }

    #[test]
    fn what_is_no_layout_is_told_with_what_was_expected() {
        let wrong = [
            ("", "at least one [[tab]]"),
            ("[[tab]]\nname = \"A\"\n", "at least one [[tab]]"),
            ("[[tab]]\nname = \"A\"\n[[tab.view]]\n", "either fields"),
            ("[[tab]]\nname = \"A\"\n[[tab.view]]\nshow = \"pfd\"\n", "one of aircraft"),
            ("[[tab]]\nname = \"A\"\n[[tab.view]]\nfields = [\"thrust\"]\n", "log fields"),
            ("[[tab]]\nname = \"A\"\n[[tab.view]]\nplot = 1\n", "unknown field"),
        ];
        for (text, says) in wrong {
            let told = Own::parse(text).err().map(|error| error.to_string()).unwrap_or_default();
            assert!(told.contains(says), "{text}: {told}");
        }
    }
}
