//! The largest difference of each line between two flights, as a page.

use std::fmt::Write;

use engine::STEP_S;
use logs::text::at;

use super::heading::escaped;
use super::plots::GRAPHS;

/// Below this, in the unit of its plot, a difference is one of rounding.
const ROUNDING: f64 = 1e-9;

/// What was found so far, line by line.
#[derive(Default)]
pub struct Largest {
    lines: Vec<(f64, u64)>,
}

impl Largest {
    /// Takes the differences of a tick, in the order of the graphs and their lines.
    pub fn add(&mut self, tick: u64, differences: &[f64]) {
        self.lines.resize(differences.len(), (0.0, tick));
        for (line, difference) in self.lines.iter_mut().zip(differences) {
            if difference.abs() > line.0.abs() {
                *line = (*difference, tick);
            }
        }
    }

    /// In Markdown: where they part, and a table of what differs, in the order of the graphs.
    pub fn page(
        &self,
        [first, second]: [&str; 2],
        first_difference: Option<&(u64, String)>,
    ) -> String {
        let mut page = String::new();
        match first_difference {
            Some((tick, what)) => {
                let what = escaped(what);
                let _ = write!(page, "**States first differ at {}**: {what}.\n\n", at(*tick));
            }
            None => page.push_str("No difference: the same states to the bit.\n\n"),
        }
        let names =
            GRAPHS.iter().flat_map(|graph| graph.lines.iter().map(move |line| (graph, line.name)));
        let (rounding, differing): (Vec<_>, Vec<_>) = names
            .zip(&self.lines)
            .filter(|(_, (difference, _))| *difference != 0.0)
            .partition(|(_, (difference, _))| difference.abs() < ROUNDING);
        if differing.is_empty() {
            return page;
        }
        let (first, second) = (escaped(first), escaped(second));
        let _ = writeln!(page, "| {second} less {first}: largest of | | unit | at, s |");
        page.push_str("|---|---:|---|---:|\n");
        for ((graph, name), (difference, tick)) in differing {
            let at_s = *tick as f64 * STEP_S;
            let (what, unit) = graph.named();
            let name = if graph.lines.len() > 1 { format!("{what}: {name}") } else { what.into() };
            let _ = writeln!(page, "| {name} | {} | {unit} | {at_s:.2} |", told(*difference));
        }
        if !rounding.is_empty() {
            let _ =
                writeln!(page, "\n{} more, each below {ROUNDING:e} of its unit.", rounding.len());
        }
        page
    }
}

/// A number that may be of any size.
fn told(number: f64) -> String {
    match number.abs() {
        size if (1e-3..1e6).contains(&size) => format!("{number:+.3}"),
        _ => format!("{number:+.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_of_each_line_is_told_with_its_time_and_what_is_the_same_is_not() {
        let mut largest = Largest::default();
        let lines: usize = GRAPHS.iter().map(|graph| graph.lines.len()).sum();
        let mut row = vec![0.0; lines];
        row[0] = 1.5;
        largest.add(250, &row);
        row[0] = -2.25;
        row[1] = f64::NAN;
        row[2] = -1e-12;
        largest.add(500, &row);
        row[0] = 2.0;
        largest.add(750, &row);
        let page = largest.page(["a", "b"], Some(&(250, "x (forces)".into())));
        assert!(page.contains("| b less a: largest of |"), "{page}");
        assert!(page.contains("at tick 250 (1.000 s)**: x \\(forces\\)."), "{page}");
        assert!(page.contains("Height: above ground | -2.250 | m | 2.00 |"), "{page}");
        assert_eq!(page.lines().filter(|line| line.starts_with("| ")).count(), 2, "{page}");
        assert!(page.contains("1 more, each below 1e-9"), "{page}");
        assert!(Largest::default().page(["a", "b"], None).contains("No difference"));
    }
}
