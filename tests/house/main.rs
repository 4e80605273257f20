//! The tree itself and its documents: what needs what, which packages are there, what the pages say.

mod documents;
mod layering;
mod layering_of_files;
mod listings;
mod locks;
mod packages;
mod tree;
