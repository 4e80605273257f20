//! What the panel's pictures are made of, and how it is marked.

use std::collections::VecDeque;

use engine::STEP_S;
use logs::view::Level;
use ratatui::style::{Color, Modifier, Style};
use recorder::{Shown, Snapshot, Told};

use super::cockpit::Cockpit;

/// How long a tick lasts.
pub const TICK_MS: f64 = STEP_S * 1e3;

/// What is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// The flight.
    Flight,
    /// The active controls and keys, from this line on.
    Controls(usize),
}

impl Page {
    /// The page after it, on a terminal of this size.
    pub fn next(self, lines: usize, columns: u16, rows: u16) -> Self {
        let (columns, rows) = lists(columns.saturating_sub(2), rows.saturating_sub(AROUND_ROWS));
        match self {
            Self::Flight => Self::Controls(0),
            Self::Controls(from) if from + columns * rows < lines => {
                Self::Controls(from + columns * rows)
            }
            Self::Controls(_) => Self::Flight,
        }
    }
}

/// Rows of the screen around a list of controls.
const AROUND_ROWS: u16 = 10;
/// Columns that a line of it needs.
const LIST_COLUMNS: u16 = 58;

/// Lists side by side, and the lines of each.
pub fn lists(columns: u16, rows: u16) -> (usize, usize) {
    (usize::from((columns / LIST_COLUMNS).max(1)), usize::from(rows.max(1)))
}

/// Everything that a picture is made of.
pub struct Look<'a> {
    /// What does not change.
    pub cockpit: &'a Cockpit,
    /// Which picture.
    pub page: Page,
    /// The flight.
    pub shown: &'a Shown,
    /// How it goes beside the aircraft.
    pub now: &'a Snapshot,
    /// What was told, the newest last.
    pub told: &'a VecDeque<Told>,
    /// Whether there are colours.
    pub colours: bool,
}

impl Look<'_> {
    fn style(&self, colour: Color) -> Style {
        if self.colours { Style::new().fg(colour) } else { Style::new() }
    }

    /// Of what is as it is to be.
    pub fn good(&self) -> Style {
        self.style(Color::Green)
    }

    /// Of what is to be looked at.
    pub fn caution(&self) -> Style {
        self.style(Color::Yellow).add_modifier(Modifier::BOLD)
    }

    /// Of what is to be acted on.
    pub fn warning(&self) -> Style {
        self.style(Color::Red).add_modifier(Modifier::BOLD | Modifier::REVERSED)
    }

    /// Of an event of that level.
    pub fn of(&self, level: Level) -> Style {
        match level {
            Level::Info => Style::new(),
            Level::Warn => self.caution(),
            Level::Error => self.warning(),
        }
    }
}
