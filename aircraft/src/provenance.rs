//! Where a number comes from, and how far to trust it.

use std::fmt;

/// How far a number is to be trusted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Trust {
    /// `V`: read in the document itself.
    Verified,
    /// `V-fig`: read off its figure.
    VerifiedFigure,
    /// `V-sec`: read in a transcription by others.
    VerifiedSecondHand,
    /// `R+`: recalled with confidence.
    Recalled,
    /// `R?`: recalled.
    RecalledDoubtful,
    /// `E`: an engineering estimate, never published.
    Estimate,
}

impl Trust {
    /// The labels, from the most trusted.
    pub const LABELS: [&str; 6] = ["V", "V-fig", "V-sec", "R+", "R?", "E"];

    const ALL: [Self; 6] = [
        Self::Verified,
        Self::VerifiedFigure,
        Self::VerifiedSecondHand,
        Self::Recalled,
        Self::RecalledDoubtful,
        Self::Estimate,
    ];

    /// As the file writes it.
    pub fn label(self) -> &'static str {
        Self::LABELS[self as usize]
    }

    pub(crate) fn from_label(label: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|trust| trust.label() == label)
    }
}

impl fmt::Display for Trust {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.label())
    }
}

/// Where a number (or vector, or table) comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Provenance {
    /// Its key with the tables it is in, as written.
    pub key: String,
    /// The document, or "estimate".
    pub source: String,
    /// How far to trust it.
    pub trust: Trust,
    /// Derivation or doubt.
    pub note: Option<String>,
}
