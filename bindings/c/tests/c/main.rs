//! Tests of the C and C++ interfaces: programs that are compiled and linked as users do it, and comparisons
//! with the core.

#![allow(unsafe_code, reason = "C functions are called")]

mod agreement;
mod bad_input;
mod conventions;
mod drop_in;
mod header;
mod programs;
mod recognise;
mod speed;
mod support;
