//! Keys of a replay on a terminal: pause, step, seek, speed.

use std::io::{IsTerminal, stderr, stdin};
use std::time::Duration;

use crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, poll, read};
use crossterm::terminal::{disable_raw_mode, enable_raw_mode};
use engine::STEP_NS;
use replay::Playback;
use replay::playback::Command;

/// What there is to press, in a line.
pub const HELP: &str = "keys: Space pause, Left and Right a tick, PageUp and PageDown ten seconds back and \
                        forward, Home to the beginning, - and + half and double speed, Q ends";

/// Ticks of PageUp and PageDown: ten seconds.
const SKIP_TICKS: i64 = 10_000_000_000 / STEP_NS as i64;
/// Times real time, at least and at most.
const SPEEDS: (f64, f64) = (0.01, 1000.0);

/// What a key means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Key {
    /// Stand still, or go on.
    Pause,
    /// So many ticks forward, and stand still there.
    Step(i64),
    /// So many ticks forward, going on or standing still as before.
    Skip(i64),
    /// To where the replay began.
    Beginning,
    /// So many times faster.
    Faster(f64),
    /// No more of it.
    End,
}

impl Key {
    /// What is asked of a log that is shown from tick `start` on; `None` to end it.
    pub fn command(self, playback: &Playback, start: u64) -> Option<Command> {
        Some(match self {
            Self::Pause => Command::Pause(!playback.is_paused()),
            Self::Step(ticks) => Command::Step(ticks),
            Self::Skip(ticks) => {
                Command::Seek((playback.tick() as u64).saturating_add_signed(ticks).max(start))
            }
            Self::Beginning => Command::Seek(start),
            Self::Faster(times) => {
                Command::Speed(engine::math::clamp(playback.speed() * times, SPEEDS.0, SPEEDS.1))
            }
            Self::End => return None,
        })
    }
}

/// The keys of a terminal, one by one; given back when it is dropped.
pub struct Keys;

impl Keys {
    /// Takes them; `None` where nobody sits at a terminal.
    pub fn take() -> Option<Self> {
        (stdin().is_terminal() && stderr().is_terminal() && enable_raw_mode().is_ok())
            .then_some(Self)
    }

    /// The next one that was pressed, without waiting.
    pub fn next(&self) -> Option<Key> {
        while poll(Duration::ZERO).unwrap_or(false) {
            if let Ok(Event::Key(event)) = read()
                && let Some(key) = meaning(&event)
            {
                return Some(key);
            }
        }
        None
    }
}

impl Drop for Keys {
    fn drop(&mut self) {
        let _ = disable_raw_mode();
    }
}

fn meaning(event: &KeyEvent) -> Option<Key> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let control = event.modifiers.contains(KeyModifiers::CONTROL);
    Some(match event.code {
        KeyCode::Char('c') if control => Key::End,
        KeyCode::Char('q' | 'Q') | KeyCode::Esc => Key::End,
        KeyCode::Char(' ') => Key::Pause,
        KeyCode::Left => Key::Step(-1),
        KeyCode::Right => Key::Step(1),
        KeyCode::PageUp => Key::Skip(-SKIP_TICKS),
        KeyCode::PageDown => Key::Skip(SKIP_TICKS),
        KeyCode::Home => Key::Beginning,
        KeyCode::Char('+' | '=') => Key::Faster(2.0),
        KeyCode::Char('-') => Key::Faster(0.5),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_help_means_something() {
        let pressed = |code| meaning(&KeyEvent::new(code, KeyModifiers::NONE));
        for (code, key) in [
            (KeyCode::Char(' '), Key::Pause),
            (KeyCode::Left, Key::Step(-1)),
            (KeyCode::Right, Key::Step(1)),
            (KeyCode::PageUp, Key::Skip(-2500)),
            (KeyCode::PageDown, Key::Skip(2500)),
            (KeyCode::Home, Key::Beginning),
            (KeyCode::Char('-'), Key::Faster(0.5)),
            (KeyCode::Char('+'), Key::Faster(2.0)),
            (KeyCode::Char('Q'), Key::End),
        ] {
            assert_eq!(pressed(code), Some(key));
        }
        assert_eq!(pressed(KeyCode::Char('x')), None);
        let interrupt = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
        assert_eq!(meaning(&interrupt), Some(Key::End));
    }
}
