//! The libraries as C and C++ programs meet them, and the functions of `darboux.h` against the core.

#![allow(unsafe_code, reason = "C functions are called")]

mod agreement;
mod bad_input;
mod conventions;
mod drop_in;
mod header;
mod programs;
mod speed;
mod support;
