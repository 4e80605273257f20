//! Exit statuses: one table for every verb.

use std::fmt::Write as _;
use std::process::ExitCode;

use replay::{Judgement, Outcome};

/// How the command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// All is well.
    Done = 0,
    /// Something is not the same.
    Differs = 1,
    /// There is no result.
    Unusable = 2,
    /// A log is sound, but not whole.
    NeverClosed = 3,
    /// A flight is not whole.
    CutShort = 4,
    /// There is no such steady flight.
    NotConverged = 5,
    /// Two versions were compared.
    Compared = 6,
}

use Status::{Compared, CutShort, Differs, Done, NeverClosed, NotConverged, Unusable};

/// The statuses with which each verb ends.
const VERBS: &[(&str, &[Status])] = &[
    ("fly", &[Done, Unusable, CutShort]),
    ("flightgear", &[Done, Unusable]),
    ("devices", &[Done, Unusable]),
    ("demo", &[Done, Differs, Unusable, NeverClosed, CutShort]),
    ("replay", &[Done, Differs, Unusable, NeverClosed, Compared]),
    ("verify", &[Done, Differs, Unusable, NeverClosed, Compared]),
    ("diff", &[Done, Differs, Unusable, NeverClosed]),
    ("view", &[Done, Differs, Unusable, NeverClosed]),
    ("plot", &[Done, Differs, Unusable, NeverClosed]),
    ("report", &[Done, Differs, Unusable, NeverClosed]),
    ("whatif", &[Done, Unusable, NeverClosed]),
    ("log info", &[Done, Differs, Unusable, NeverClosed]),
    ("log summary", &[Done, Differs, Unusable, NeverClosed]),
    ("log cat", &[Done, Differs, Unusable, NeverClosed]),
    ("log find", &[Done, Differs, Unusable, NeverClosed]),
    ("log files", &[Done, Unusable, NeverClosed]),
    ("log fields", &[Done, Unusable, NeverClosed]),
    ("log export", &[Done, Differs, Unusable, NeverClosed]),
    ("log clip", &[Done, Unusable, NeverClosed]),
    ("log compact", &[Done, Unusable, NeverClosed]),
    ("log expand", &[Done, Unusable, NeverClosed]),
    ("log recover", &[Differs, Unusable, NeverClosed]),
    ("trim", &[Done, Unusable, NotConverged]),
    ("doctor", &[Done, Unusable]),
    ("linearize", &[Done, Unusable, NotConverged]),
    ("identify", &[Done, Differs, Unusable, NeverClosed]),
    ("fmu", &[Done, Unusable]),
    ("completions", &[Done, Unusable]),
    ("man", &[Done, Unusable]),
];

/// Verbs that take several logs.
const OF_SEVERAL_LOGS: [&str; 2] = ["verify", "log export"];

impl Status {
    /// Every one, by its number.
    pub const ALL: [Self; 7] =
        [Done, Differs, Unusable, NeverClosed, CutShort, NotConverged, Compared];

    /// Of several the first one of these decides.
    const GRAVEST_FIRST: [Self; 7] =
        [Unusable, Differs, CutShort, NotConverged, NeverClosed, Compared, Done];

    /// What the shell sees.
    pub fn number(self) -> u8 {
        self as u8
    }

    /// The one of that number; what is none is no result.
    pub fn of_number(number: u8) -> Self {
        Self::ALL.into_iter().find(|status| status.number() == number).unwrap_or(Unusable)
    }

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Done => "done",
            Differs => "differs",
            Unusable => "unusable",
            NeverClosed => "never closed",
            CutShort => "cut short",
            NotConverged => "not converged",
            Compared => "compared",
        }
    }

    /// What it says, whatever the verb.
    pub fn meaning(self) -> &'static str {
        match self {
            Done => "done, exact, or read without being reflown",
            Differs => "diverged or altered, or two logs differ",
            Unusable => "unusable, damaged, or the command could not be carried out",
            NeverClosed => "exact as far as it goes, but never closed, or recovered",
            CutShort => {
                "flown, but the log could not be written to its end, or a pilot model gave up"
            }
            NotConverged => "no steady flight, or not converged",
            Compared => "compared across versions",
        }
    }

    /// Of several logs, the status that decides; [`Status::Done`] of none.
    pub fn gravest(statuses: impl IntoIterator<Item = Self>) -> Self {
        let statuses: Vec<_> = statuses.into_iter().collect();
        Self::GRAVEST_FIRST.into_iter().find(|grave| statuses.contains(grave)).unwrap_or(Done)
    }
}

impl From<Outcome> for Status {
    fn from(outcome: Outcome) -> Self {
        Self::of_number(outcome.status())
    }
}

impl From<&Judgement> for Status {
    fn from(judgement: &Judgement) -> Self {
        judgement.outcome.into()
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(status.number())
    }
}

/// Adds its exit statuses to the help of every verb, and all of them to the command's own.
pub fn explained(command: clap::Command) -> clap::Command {
    explain(command, "").after_help(help(&Status::ALL))
}

fn explain(command: clap::Command, path: &str) -> clap::Command {
    let names: Vec<String> =
        command.get_subcommands().map(|verb| verb.get_name().to_string()).collect();
    if names.is_empty() {
        return match VERBS.iter().find(|(verb, _)| *verb == path) {
            Some((verb, statuses)) => command.after_help(help_of(verb, statuses)),
            None => command,
        };
    }
    names.into_iter().fold(command, |command, name| {
        let path = format!("{path} {name}");
        command.mut_subcommand(name, |verb| explain(verb, path.trim_start()))
    })
}

fn help_of(verb: &str, statuses: &[Status]) -> String {
    let mut help = help(statuses);
    if OF_SEVERAL_LOGS.contains(&verb) {
        let _ = write!(help, "\nOf several logs the gravest decides: {}", gravest_first(statuses));
    }
    help
}

fn help(statuses: &[Status]) -> String {
    let line = |status: &Status| format!("\n  {}  {}", status.number(), status.meaning());
    format!("Exit status:{}", statuses.iter().map(line).collect::<String>())
}

/// `2, 1, 3, 6, 0`.
fn gravest_first(of: &[Status]) -> String {
    let numbers: Vec<String> = Status::GRAVEST_FIRST
        .into_iter()
        .filter(|status| of.contains(status))
        .map(|status| status.number().to_string())
        .collect();
    numbers.join(", ")
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use clap::CommandFactory;

    use super::*;

    const PAGE: &str = include_str!("../docs/exit-statuses.md");

    /// The rows of a table of a page, by its first column's title.
    fn table(page: &str, title: &str) -> Vec<Vec<String>> {
        let cells = |line: &str| -> Vec<String> {
            line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect()
        };
        let lines = page.lines().skip_while(|line| !line.starts_with(&format!("| {title} |")));
        lines.skip(2).take_while(|line| line.starts_with('|')).map(cells).collect()
    }

    #[test]
    fn the_page_has_the_table_of_the_statuses() {
        let expected: Vec<Vec<String>> = Status::ALL
            .iter()
            .map(|status| {
                vec![status.number().to_string(), status.name().into(), status.meaning().into()]
            })
            .collect();
        assert_eq!(table(PAGE, "status"), expected);
    }

    #[test]
    fn the_page_has_the_table_of_the_verbs() {
        let numbers = |statuses: &[Status]| {
            let numbers: Vec<_> =
                statuses.iter().map(|status| status.number().to_string()).collect();
            numbers.join(", ")
        };
        let expected: Vec<Vec<String>> = VERBS
            .iter()
            .map(|(verb, statuses)| vec![format!("`{verb}`"), numbers(statuses)])
            .collect();
        assert_eq!(table(PAGE, "verb"), expected);
    }

    #[test]
    fn the_page_has_the_table_of_what_a_log_is() {
        let expected: Vec<Vec<String>> = Outcome::ALL
            .iter()
            .map(|outcome| {
                vec![format!("`{}`", outcome.name()), Status::from(*outcome).number().to_string()]
            })
            .collect();
        let found: Vec<Vec<String>> =
            table(PAGE, "outcome").iter().map(|row| row[..2].to_vec()).collect();
        assert_eq!(found, expected);
    }

    #[test]
    fn pages_name_the_gravest_in_the_order_of_the_table() {
        let of_logs: Vec<Status> = Outcome::ALL.into_iter().map(Status::from).collect();
        let order = gravest_first(&of_logs);
        assert_eq!(order, "2, 1, 3, 6, 0");
        for page in [PAGE, include_str!("../docs/reports.md")] {
            assert!(page.contains(&format!("the gravest decides: {order}")), "{page}");
        }
    }

    #[test]
    fn the_gravest_of_several_decides() {
        assert_eq!(Status::gravest([]), Done);
        assert_eq!(Status::gravest([Done, Done]), Done);
        assert_eq!(Status::gravest([Done, Compared]), Compared);
        assert_eq!(Status::gravest([Compared, NeverClosed, Done]), NeverClosed);
        assert_eq!(Status::gravest([NeverClosed, Differs, Done]), Differs);
        assert_eq!(Status::gravest([Differs, Unusable, NeverClosed]), Unusable);
        let mut all = Status::GRAVEST_FIRST.to_vec();
        all.sort_by_key(|status| status.number());
        assert_eq!(all, Status::ALL, "every status has its place");
    }

    #[test]
    fn the_help_of_every_verb_says_with_what_it_ends() {
        fn leaves(command: &clap::Command, path: &str, found: &mut BTreeSet<String>) {
            if !command.has_subcommands() {
                let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
                assert!(help.starts_with("Exit status:\n  "), "{path}: {help}");
                found.insert(path.trim_start().to_string());
            }
            for verb in command.get_subcommands() {
                leaves(verb, &format!("{path} {}", verb.get_name()), found);
            }
        }
        let mut found = BTreeSet::new();
        leaves(&explained(crate::Cli::command()), "", &mut found);
        let known: BTreeSet<String> = VERBS.iter().map(|(verb, _)| (*verb).to_string()).collect();
        assert_eq!(found, known);
    }
}
