//! Healthy models, the mistakes that are made on them, and the table of what the check and the repair make of
//! them.

#![allow(dead_code, reason = "each test file and the example use their part")]

pub mod baked;
pub mod container;
pub mod damaged;
pub mod flips;
pub mod maps;
pub mod mistakes;
pub mod models;
pub mod page;
pub mod pairs;
pub mod shown;
pub mod table;
pub mod texels;
