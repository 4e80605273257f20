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
        let mut told = VecDeque::new();
        let mut grave = Vec::new();
        let mut page = Page::Flight;
        let colours = colours();
        let mut drawn: Option<Instant> = None;
        let mut shown = recorder::Shown::default();
        let mut saved = false;
        while flying() {
            for event in progress.told() {
                saved |= event.what == FlightEvent::SituationSaved && event.level == Level::Info;
                if event.level != Level::Info {
                    grave.push(event.clone());
                }
                told.push_back(event);
                if told.len() > TOLD_KEPT {
                    told.pop_front();
                }
            }
            shown = progress.shown().unwrap_or(shown);
            if drawn.is_none_or(|drawn| drawn.elapsed() >= PICTURE) {
                drawn = Some(Instant::now());
                let look = Look {
                    cockpit: &self.cockpit,
                    page,
                    shown: &shown,
                    now: &progress.now(),
                    told: &told,
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
                Some(Key::Flies(Order::Press(KeyAction::LoadSituation))) if !saved => {
                    if let Some(situation) = self.situation {
                        self.give(Order::Restart(Restart::Situation(situation)));
                    }
                }
                Some(Key::Flies(order)) => self.give(order),
                None => {}
            }
        }
        grave.extend(progress.told().into_iter().filter(|told| told.level != Level::Info));
        Ok(grave)
    }

    /// Orders that find no room are lost: two hundred keys wait already.
    fn give(&mut self, order: Order) {
        if let Some(orders) = &mut self.orders {
            let _ = orders.give(order);
        }
    }
}
