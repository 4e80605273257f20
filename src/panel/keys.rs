//! What a key means: to the aircraft, or to the panel.

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use engine::inputs::{FailureFacts, Failures};
use recorder::keyboard::{KeyAction, Order};

/// What a key means.
#[derive(Clone, Copy, Debug, PartialEq)]
// An order may be a situation; keys are few.
#[allow(clippy::large_enum_variant)]
pub enum Key {
    /// The flight is to do something.
    Flies(Order),
    /// Goes on from the start position of this place in their list.
    Reposition(usize),
    /// Shows the next page.
    NextPage,
    /// Ends the flight.
    End,
}

/// The key under which the first start position is.
const FIRST_START: u8 = 5;

/// What a key means; nothing to us where it is `None`.
pub fn meaning(event: &KeyEvent) -> Option<Key> {
    let released = event.kind == KeyEventKind::Release;
    let control = event.modifiers.contains(KeyModifiers::CONTROL);
    let name = match event.code {
        KeyCode::Char('c') if control => return (!released).then_some(Key::End),
        KeyCode::Char(_) if control => return None,
        KeyCode::Char(letter) => String::from(letter),
        KeyCode::Up => "Up".into(),
        KeyCode::Down => "Down".into(),
        KeyCode::Left => "Left".into(),
        KeyCode::Right => "Right".into(),
        KeyCode::PageUp => "PageUp".into(),
        KeyCode::PageDown => "PageDown".into(),
        KeyCode::Tab | KeyCode::F(1) => "?".into(),
        KeyCode::F(number @ FIRST_START..=12) => {
            let place = usize::from(number - FIRST_START);
            return (!released).then_some(Key::Reposition(place));
        }
        _ => return None,
    };
    if let Some(&action) = KeyAction::ALL.iter().find(|action| action.facts().on == name) {
        let order = if released { Order::Release(action) } else { Order::Press(action) };
        return Some(Key::Flies(order));
    }
    if released {
        return None;
    }
    match name.as_str() {
        "?" => Some(Key::NextPage),
        "Q" => Some(Key::End),
        _ => {
            let place = name.parse::<usize>().ok()?.checked_sub(1)?;
            let FailureFacts { flag, .. } = Failures::FACTS.get(place)?;
            Some(Key::Flies(Order::Fail(*flag)))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(code: KeyCode) -> KeyEvent {
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    #[test]
    fn every_action_has_a_key_that_means_it() {
        for &action in KeyAction::ALL {
            let code = match action.facts().on {
                "Up" => KeyCode::Up,
                "Down" => KeyCode::Down,
                "Left" => KeyCode::Left,
                "Right" => KeyCode::Right,
                "PageUp" => KeyCode::PageUp,
                "PageDown" => KeyCode::PageDown,
                letter => KeyCode::Char(letter.chars().next().unwrap()),
            };
            assert_eq!(meaning(&key(code)), Some(Key::Flies(Order::Press(action))));
        }
    }

    #[test]
    fn digits_fail_systems_and_other_keys_mean_nothing() {
        let fail = |code| meaning(&key(KeyCode::Char(code)));
        assert_eq!(fail('1'), Some(Key::Flies(Order::Fail(Failures::ENGINE_LEFT))));
        assert_eq!(fail('9'), None);
        assert_eq!(fail('Q'), Some(Key::End));
        let end = KeyEvent::new(KeyCode::Char('c'), KeyModifiers::CONTROL);
        assert_eq!(meaning(&end), Some(Key::End));
        assert_eq!(meaning(&key(KeyCode::F(6))), Some(Key::Reposition(1)));
        assert_eq!(meaning(&key(KeyCode::Esc)), None);
    }
}
