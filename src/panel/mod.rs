//! The panel in the terminal: what a cockpit shows, drawn beside the flight, and the keys.
//!
//! It looks at the flight some twenty times a second from the main thread; the loop never waits for it.

mod cockpit;
mod draw;
mod instruments;
mod keys;
mod look;
mod screen;

use std::collections::VecDeque;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use crossterm::event::{Event, KeyEventKind, poll, read};
use logs::records::FlightEvent;
use logs::view::Level;
use recorder::keyboard::{KeyAction, Order, Orders};
use recorder::{Progress, Restart, Situation, Told};

pub use cockpit::Cockpit;
use keys::{Key, meaning};
use look::{Look, Page};
use screen::Screen;

/// Between two pictures.
const PICTURE: Duration = Duration::from_millis(50);
/// What was told last, kept for the panel.
const TOLD_KEPT: usize = 50;

/// Whether colours are wanted: <https://no-color.org>.
fn colours() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// What was told so far.
#[derive(Default)]
struct Heard {
    /// The last of it, for the panel.
    told: VecDeque<Told>,
    /// What is more than a piece of news, for after the screen is gone.
    grave: Vec<Told>,
    /// A situation was saved in this flight.
    saved: bool,
}

impl Heard {
    fn take(&mut self, events: Vec<Told>) {
        for event in events {
            self.saved |= event.what == FlightEvent::SituationSaved && event.level == Level::Info;
            if event.level != Level::Info {
                self.grave.push(event.clone());
            }
            self.told.push_back(event);
            if self.told.len() > TOLD_KEPT {
                self.told.pop_front();
            }
        }
    }
}

/// The panel of a flight.
pub struct Panel {
    /// What it shows.
    pub cockpit: Cockpit,
    /// Where the keys go, when they fly.
    pub orders: Option<Orders>,
    /// What a situation is loaded from when none was saved in this flight.
    pub situation: Option<Situation>,
    /// Makes the state of a start position, by its place in their list.
    pub start: Box<dyn Fn(usize) -> Option<Result<Restart>>>,
}

impl Panel {
    /// Shows the flight until it is over; `flying` says whether it is not. Told what was said meanwhile,
    /// for whoever wants it in plain lines after the screen is gone.
    ///
    /// # Errors
    /// When there is no terminal.
    pub fn show(mut self, progress: &Progress, flying: impl Fn() -> bool) -> Result<Vec<Told>> {
        let mut screen = Screen::take().context("cannot draw the panel: no terminal")?;
        let mut heard = Heard::default();
        let mut page = Page::Flight;
        let colours = colours();
        let mut drawn: Option<Instant> = None;
        let mut shown = recorder::Shown::default();
        while flying() {
            heard.take(progress.told());
            shown = progress.shown().unwrap_or(shown);
            if drawn.is_none_or(|drawn| drawn.elapsed() >= PICTURE) {
                drawn = Some(Instant::now());
                let look = Look {
                    cockpit: &self.cockpit,
                    page,
                    shown: &shown,
                    now: &progress.now(),
                    told: &heard.told,
                    colours,
                };
                screen.terminal.draw(|frame| draw::draw(frame, &look))?;
            }
            // Comes back as soon as there is a key.
            if !poll(PICTURE)? {
                continue;
            }
            let Event::Key(event) = read()? else { continue };
            if event.kind == KeyEventKind::Release && !screen.tells_releases {
                continue;
            }
            match meaning(&event) {
                Some(Key::End) => progress.stop.store(true, Ordering::Relaxed),
                Some(Key::NextPage) => {
                    let size = screen.terminal.size()?;
                    let lines = self.cockpit.controls.len();
                    page = page.next(lines, size.width, size.height);
                }
                Some(Key::Reposition(place)) => {
                    if let Some(restart) = (self.start)(place) {
                        self.give(Order::Restart(restart?));
                    }
                }
                Some(Key::Flies(Order::Press(KeyAction::LoadSituation))) if !heard.saved => {
                    if let Some(situation) = self.situation {
                        self.give(Order::Restart(Restart::Situation(situation)));
                    }
                }
                Some(Key::Flies(order)) => self.give(order),
                None => {}
            }
        }
        heard.take(progress.told());
        Ok(heard.grave)
    }

    /// Orders that find no room are lost: two hundred keys wait already.
    fn give(&mut self, order: Order) {
        if let Some(orders) = &mut self.orders {
            let _ = orders.give(order);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(tick: u64, what: FlightEvent, level: Level) -> Told {
        Told { tick, what, level, words: String::new() }
    }

    #[test]
    fn warnings_outlast_the_screen_and_the_panel_keeps_the_last_that_was_told() {
        let mut heard = Heard::default();
        heard.take(vec![
            told(0, FlightEvent::Phase, Level::Info),
            told(1, FlightEvent::Slip, Level::Warn),
        ]);
        heard.take(vec![told(2, FlightEvent::Impact, Level::Error)]);
        heard.take((3..=50).map(|tick| told(tick, FlightEvent::Marker, Level::Info)).collect());
        let ticks =
            |of: &mut dyn Iterator<Item = &Told>| of.map(|told| told.tick).collect::<Vec<_>>();
        assert_eq!(ticks(&mut heard.grave.iter()), [1, 2]);
        // Fifty of fifty-one.
        assert_eq!(ticks(&mut heard.told.iter()), (1..=50).collect::<Vec<_>>());
    }

    #[test]
    fn a_situation_that_could_not_be_saved_is_none_to_load() {
        let mut heard = Heard::default();
        heard.take(vec![told(1, FlightEvent::SituationSaved, Level::Warn)]);
        heard.take(vec![told(2, FlightEvent::Marker, Level::Info)]);
        assert!(!heard.saved);
        heard.take(vec![told(3, FlightEvent::SituationSaved, Level::Info)]);
        heard.take(vec![told(4, FlightEvent::SituationSaved, Level::Warn)]);
        assert!(heard.saved, "the first one is there");
    }
}
