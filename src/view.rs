//! `tiltrotor view`.

mod args;
#[cfg(feature = "rerun")]
mod draw;
#[cfg(feature = "rerun")]
mod moment;
#[cfg(feature = "rerun")]
mod open;
#[cfg(feature = "rerun")]
mod viewer;

pub use args::Args;
#[cfg(feature = "rerun")]
pub use draw::{layout, save_default};
#[cfg(feature = "rerun")]
pub use open::run;
#[cfg(feature = "rerun")]
pub use viewer::Viewer;

/// Says what is missing.
#[cfg(not(feature = "rerun"))]
pub fn run(args: &Args) -> anyhow::Result<crate::status::Status> {
    let Args {
        log,
        against: _,
        align: _,
        layout: _,
        at: _,
        save: _,
        force: _,
        viewer: _,
        window: _,
    } = args;
    anyhow::bail!(
        "{}: this program was built without `rerun`; build it with the default features, or open the \
         log itself: `rerun {0}`",
        log.display()
    )
}
