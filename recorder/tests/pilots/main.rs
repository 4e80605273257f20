//! The pilot models: what they are to do, how quiet their hands are, and how they come down without engines.

mod autorotation;
mod hover;
mod tasks;
