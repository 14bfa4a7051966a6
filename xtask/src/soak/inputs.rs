//! The files that cases are made of.

pub mod corpus;
pub mod images;
pub mod model;
pub mod mutate;
pub mod seeds;
