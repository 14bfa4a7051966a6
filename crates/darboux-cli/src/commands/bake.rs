//! `darboux bake`: maps of a low-poly model from the detail of high-poly ones.

pub mod arguments;
mod cage;
mod cage_file;
mod conflicts;
mod dither;
mod encode;
mod failure;
mod files;
pub mod job;
mod legend;
pub mod map_choice;
mod model;
mod open;
mod outputs;
mod page;
mod pictures;
mod ranges;
mod report;
mod run;
mod seconds;
mod single;
mod skew;
mod thumbnail;
mod tile_names;
mod tiles;
mod verified;
mod write;

pub use run::run;
