//! `darboux bake`: what it writes, what it advises and what it refuses.

#[path = "../common/mod.rs"]
mod common;
mod conflicts;
mod interrupts;
mod jobs;
mod maps;
mod materials;
mod models;
mod page;
mod pair;
mod rays;
mod spaces;
