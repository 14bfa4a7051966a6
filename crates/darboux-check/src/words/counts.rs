//! Counts with their nouns.

pub use darboux_io::words::{Count, counted};
