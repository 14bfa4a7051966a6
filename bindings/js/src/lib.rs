//! The WebAssembly side of the npm package: the caller writes a mesh into memory that this side owns, calls, and reads what came out.
//!
//! Numbers alone cross the border. What is wrong with a call the JavaScript side finds out and says (`lib/`).

#![allow(unsafe_code, reason = "functions are exported under the names that JavaScript calls")]

#[cfg(feature = "full")]
mod elsewhere;
#[cfg(feature = "full")]
mod encode;
#[cfg(feature = "full")]
mod frames;
#[cfg(feature = "full")]
mod measure;
#[cfg(feature = "full")]
mod normals;
#[cfg(feature = "full")]
mod plan;
#[cfg(feature = "full")]
mod report;
mod room;
#[cfg(feature = "full")]
mod split;
mod tangents;
#[cfg(feature = "full")]
mod topology;
#[cfg(feature = "full")]
mod values;
