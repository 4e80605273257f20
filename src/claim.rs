//! Two flights that send their pictures to one FlightGear: it would jump between them.

use std::env;
use std::fs::{File, TryLockError};

/// Where pictures are sent, claimed for as long as this lives.
pub struct Claim {
    /// Locked, or the other flight's.
    _file: Option<File>,
    taken: bool,
}

impl Claim {
    /// Claims a destination, and warns when another flight on this machine sends there.
    pub fn of(destination: &str) -> Self {
        let claim = Self::quietly(destination);
        if claim.taken {
            complain!(
                "WARNING: another flight or replay sends to {destination}: FlightGear will jump between \
                 both; --flightgear HOST:PORT names another one"
            );
        }
        claim
    }

    /// By a locked file: the system lets go of it however the flight ends.
    fn quietly(destination: &str) -> Self {
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '.' { c } else { '-' };
        let name: String = destination.chars().map(plain).collect();
        let path = env::temp_dir().join(format!("tiltrotor-flightgear-{name}.lock"));
        // Where no such file can be made, nothing is known, and nothing is said.
        let file = File::create(path).ok();
        let lock = file.as_ref().map(File::try_lock);
        Self { _file: file, taken: matches!(lock, Some(Err(TryLockError::WouldBlock))) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_of_two_is_told_and_one_after_the_other_is_not() {
        let destination = format!("test:{}", std::process::id());
        let first = Claim::quietly(&destination);
        assert!(!first.taken);
        assert!(Claim::quietly(&destination).taken);
        assert!(!Claim::quietly(&format!("{destination}0")).taken);
        drop(first);
        assert!(!Claim::quietly(&destination).taken);
    }
}
