//! The WebAssembly side of the npm package `darboux`.
//!
//! JavaScript writes a mesh into memory that this side owns, calls a function, and reads the result (see
//! `arena`). Only numbers cross the border. The TypeScript side (`lib/`) checks arguments and words errors.

#![allow(unsafe_code, reason = "functions are exported under the names that JavaScript calls")]

mod allocator;
mod arena;
mod inputs;
mod mesh_arrays;
mod options;
mod tangents;

#[cfg(feature = "bake")]
mod bake;
#[cfg(feature = "bake")]
mod bake_arrays;
#[cfg(feature = "bake")]
mod bake_maps;
#[cfg(feature = "bake")]
mod bake_meshes;
#[cfg(feature = "bake")]
mod bake_settings;
#[cfg(feature = "check")]
mod check;
#[cfg(feature = "check")]
mod check_arrays;
#[cfg(feature = "full")]
mod convert;
#[cfg(feature = "check")]
mod convert_file;
#[cfg(feature = "full")]
mod encode;
#[cfg(feature = "full")]
mod extras;
#[cfg(feature = "full")]
mod frames;
#[cfg(feature = "full")]
mod gpu_plan;
#[cfg(feature = "full")]
mod gpu_resume;
#[cfg(feature = "full")]
mod measure;
#[cfg(feature = "full")]
mod normals;
#[cfg(feature = "full")]
mod plan;
#[cfg(feature = "bake")]
mod prepared_models;
#[cfg(any(feature = "bake", feature = "check"))]
mod reading;
#[cfg(feature = "full")]
mod report;
#[cfg(feature = "full")]
mod split;
#[cfg(feature = "full")]
mod transform;
