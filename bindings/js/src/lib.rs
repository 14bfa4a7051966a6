//! The WebAssembly side of the npm package: the caller writes a mesh into memory that this side owns, calls, and reads what came out.
//!
//! Numbers alone cross the border. What is wrong with a call the JavaScript side finds out and says (`lib/`).

#![allow(unsafe_code, reason = "functions are exported under the names that JavaScript calls")]

mod room;
mod tangents;
