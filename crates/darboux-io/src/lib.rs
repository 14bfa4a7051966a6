//! Reads 3D model files, gives their vertex data as arrays, adds tangents and normals, and writes the files
//! back.
//!
//! - [`gltf`]: glTF 2.0 and GLB. [`gltf::Document`] is a file that can be edited; everything that is not
//!   edited is kept. Functions add [tangents](gltf::add_tangents) and [normals](gltf::add_normals),
//!   [convert](gltf::convert_vertices) conventions, [inspect](gltf::inspect) and
//!   [compare](gltf::pair_tangents) files.
//! - [`image`]: normal maps in PNG; textures in PNG, JPEG, WebP and TGA (feature `textures`).
//! - [`source`]: models of other formats, which become documents: OBJ, PLY, STL and FBX, each with a feature
//!   of its name. [`gltf::Document::open`] reads all of them; the content of a file decides.
//!
//! Files come from anywhere, so every number in them is checked, and a [`MemoryLimit`] bounds what a small
//! file can ask for.
//!
//! ```
//! use std::path::Path;
//!
//! use darboux_io::{LoadOptions, SaveOptions};
//! use darboux_io::gltf::{Document, AddTangentsOptions, add_tangents};
//!
//! # let input = Path::new("../../assets/NormalTangentTest/NormalTangentTest.glb");
//! # let output = &std::env::temp_dir().join("darboux-io.example.glb");
//! let mut document = Document::open(input, &LoadOptions::default())?;
//! let summary = add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {})?;
//! println!("{} primitives got tangents", summary.totals.written);
//! document.save(output, &SaveOptions::default().with_force(true))?;
//! # Ok::<(), darboux_io::Error>(())
//! ```

mod code_page;
mod error;
#[cfg(feature = "fbx")]
mod fbx;
mod files;
mod git_lfs;
pub mod gltf;
pub mod image;
pub mod json;
mod load_options;
mod memory_limit;
pub mod obj;
mod paths;
#[cfg(feature = "ply")]
mod ply;
mod process_memory;
mod readers;
#[cfg_attr(
    not(any(feature = "fbx", feature = "obj", feature = "ply", feature = "stl")),
    allow(dead_code, unused_imports, reason = "only readers of other formats than glTF use it")
)]
pub mod source;
mod staging;
#[cfg(feature = "stl")]
mod stl;
mod temporary;
/// The words of other crates' sentences. No promise of stability.
#[doc(hidden)]
pub mod words;

pub use error::{Error, system_reason};
pub use files::Files;
pub use load_options::{LoadOptions, OptionNames};
pub use memory_limit::MemoryLimit;
pub use paths::{FileKind, read_regular, resolve_input, wrong_output};
pub use process_memory::memory_of_process;
pub use staging::{Outputs, RunId, SaveOptions};
pub use temporary::{Discarded, discard_unfinished_outputs};

/// The examples of docs/io.md compile and run.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/io.md")]
struct IoPage;

/// The example of README.md compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
