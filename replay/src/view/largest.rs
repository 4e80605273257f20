//! The largest difference of each line between two flights, as a page.

use std::fmt::Write;

use engine::STEP_S;
use logs::text::at;

use super::heading::escaped;
use super::plots::GRAPHS;

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
    pub fn page(&self, [first, second]: [&str; 2], first_difference: Option<u64>) -> String {
        let mut page = format!("# {} less {}\n\n", escaped(second), escaped(first));
        match first_difference {
            Some(tick) => page.push_str(&format!("First difference at {}.\n\n", at(tick))),
            None => page.push_str("No difference: the same states to the bit.\n\n"),
        }
        let names = GRAPHS
            .iter()
            .flat_map(|graph| graph.lines.iter().map(move |line| (graph.named(), line.name)));
        let differing: Vec<_> =
            names.zip(&self.lines).filter(|(_, (difference, _))| *difference != 0.0).collect();
        if differing.is_empty() {
            return page;
        }
        page.push_str("| what | largest | unit | at, s |\n|---|---:|---|---:|\n");
        for ((graph, name), (difference, tick)) in differing {
            let at_s = *tick as f64 * STEP_S;
            let (what, unit) = graph;
            let _ =
                writeln!(page, "| {what}: {name} | {} | {unit} | {at_s:.2} |", told(*difference));
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
        largest.add(500, &row);
        row[0] = 2.0;
        largest.add(750, &row);
        let page = largest.page(["a", "b"], Some(250));
        assert!(page.contains("# b less a"), "{page}");
        assert!(page.contains("Height: above ground | -2.250 | m | 2.00 |"), "{page}");
        assert_eq!(page.lines().filter(|line| line.starts_with("| ")).count(), 2, "{page}");
        assert!(Largest::default().page(["a", "b"], None).contains("No difference"));
    }
}
