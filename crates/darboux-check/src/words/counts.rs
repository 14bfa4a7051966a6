//! Counts with their nouns, and probabilities.

pub use darboux_io::words::{Count, Sure, counted};
