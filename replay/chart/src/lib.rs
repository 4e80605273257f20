//! Charts as SVG and PNG: panels over one axis, curves in a plane, curves in space.
//!
//! Knows nothing of flights, and of the engine only its arithmetic. A chart is set on a [`Page`], a list of marks; [`svg()`] and [`png`] write the
//! same marks, so that both show the same picture. The same page gives the same bytes: no clock, no
//! random number, no font or library of the system's. Letters are measured with the font that is drawn into
//! the PNG; it has the widths of Arial and Helvetica, which stand in the SVG.
//!
//! From below: `font` measures, `page` holds marks, `scale` makes ticks, `frame` draws axes, `line` curves
//! and their legends; [`stack`], [`plane`] and [`space`] are charts.

mod font;
mod frame;
mod line;
pub mod moments;
pub mod page;
pub mod plane;
pub mod png;
mod scale;
pub mod space;
pub mod stack;
mod svg;

pub use line::{Curve, Guide, Look, TOLERANCE};
pub use page::{Colour, Dash, Page, Pen};
pub use scale::with_minus;
pub use svg::{escaped, svg};
