//! The terminal while the panel has it, and given back whatever happens.

use std::io::{self, IsTerminal, Stderr, stderr};
use std::sync::Once;

use crossterm::cursor::{Hide, Show};
use crossterm::event::{
    KeyboardEnhancementFlags, PopKeyboardEnhancementFlags, PushKeyboardEnhancementFlags,
};
use crossterm::execute;
use crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
    supports_keyboard_enhancement,
};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;

/// The terminal on standard error: standard output may go elsewhere.
pub struct Screen {
    /// What is drawn on.
    pub terminal: Terminal<CrosstermBackend<Stderr>>,
    /// Whether it tells when a key is released.
    pub tells_releases: bool,
}

impl Screen {
    /// Takes the terminal: keys come one by one, and the screen is the panel's.
    ///
    /// # Errors
    /// When it is none, or does not answer.
    pub fn take() -> io::Result<Self> {
        restore_after_a_panic();
        enable_raw_mode()?;
        // From here on it is given back, whatever fails.
        let guard = Guard;
        execute!(stderr(), EnterAlternateScreen, Hide)?;
        // The question goes to standard output.
        let asked = io::stdout().is_terminal();
        let tells_releases = asked && supports_keyboard_enhancement().unwrap_or(false);
        if tells_releases {
            let flags = KeyboardEnhancementFlags::DISAMBIGUATE_ESCAPE_CODES
                | KeyboardEnhancementFlags::REPORT_EVENT_TYPES;
            execute!(stderr(), PushKeyboardEnhancementFlags(flags))?;
        }
        let terminal = Terminal::new(CrosstermBackend::new(stderr()))?;
        std::mem::forget(guard);
        Ok(Self { terminal, tells_releases })
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        if self.tells_releases {
            let _ = execute!(stderr(), PopKeyboardEnhancementFlags);
        }
        give_back();
    }
}

/// Gives the terminal back while it is being taken.
struct Guard;

impl Drop for Guard {
    fn drop(&mut self) {
        give_back();
    }
}

/// Nothing more can be done where this fails.
fn give_back() {
    let _ = execute!(stderr(), LeaveAlternateScreen, Show);
    let _ = disable_raw_mode();
}

/// A message of a panic belongs on a screen that is one.
fn restore_after_a_panic() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let told = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            let _ = execute!(stderr(), PopKeyboardEnhancementFlags);
            give_back();
            told(panic);
        }));
    });
}

#[cfg(all(test, unix))]
mod tests {
    use std::process::Command;

    use super::*;

    /// Set for the process that panics.
    const PANICS: &str = "TILTROTOR_TEST_PANICS";

    /// In a process of its own: the hook is the whole program's.
    #[test]
    fn a_panic_gives_the_screen_back_before_it_is_told() {
        if std::env::var_os(PANICS).is_some() {
            restore_after_a_panic();
            // The next panel of the same program: once is enough.
            restore_after_a_panic();
            panic!("told on a screen");
        }
        let this = "panel::screen::tests::a_panic_gives_the_screen_back_before_it_is_told";
        let program = std::env::current_exe().unwrap();
        let panicked = Command::new(program)
            .args([this, "--exact", "--nocapture"])
            .env(PANICS, "1")
            .output()
            .unwrap();
        assert!(!panicked.status.success());
        let said = String::from_utf8_lossy(&panicked.stderr);
        let told = said.find("told on a screen").expect("the panic's message");
        // Out of the alternate screen, the cursor shown again (DEC's private modes 1049 and 25).
        for given_back in ["\x1b[?1049l", "\x1b[?25h"] {
            assert!(said.find(given_back).is_some_and(|at| at < told), "{said:?}");
            assert_eq!(said.matches(given_back).count(), 1, "{said:?}");
        }
    }
}
