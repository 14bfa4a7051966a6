//! Memory for the tangents of a mesh's corners. Where they are many, the system is asked for huge pages: it
//! takes longer to provide pages of 4 KiB than to compute what is written there (docs/notes/io.md).

use std::ops::{Deref, DerefMut};

/// One tangent per corner.
#[derive(Debug)]
pub enum CornerMemory {
    Vector(Vec<[f32; 4]>),
    #[cfg(target_os = "linux")]
    Mapped(memmap2::MmapMut),
}

/// Fewer bytes are allocated as everywhere.
#[cfg(target_os = "linux")]
const MAPPED_FROM: usize = if cfg!(small_limits) { 1 } else { 16 << 20 };

impl CornerMemory {
    /// Tangents of `count` corners, all zero.
    pub fn new(count: usize) -> Self {
        #[cfg(target_os = "linux")]
        if let Some(mapped) = map(count * size_of::<[f32; 4]>()) {
            return Self::Mapped(mapped);
        }
        Self::Vector(vec![[0.0; 4]; count])
    }
}

/// Memory in huge pages; none if it is little, or the system refuses. A system without huge pages takes small
/// ones.
#[cfg(target_os = "linux")]
fn map(bytes: usize) -> Option<memmap2::MmapMut> {
    if bytes < MAPPED_FROM {
        return None;
    }
    let mapped = memmap2::MmapMut::map_anon(bytes).ok()?;
    _ = mapped.advise(memmap2::Advice::HugePage);
    Some(mapped)
}

impl Deref for CornerMemory {
    type Target = [[f32; 4]];

    fn deref(&self) -> &[[f32; 4]] {
        match self {
            Self::Vector(tangents) => tangents,
            #[cfg(target_os = "linux")]
            Self::Mapped(bytes) => bytemuck::cast_slice(bytes),
        }
    }
}

impl DerefMut for CornerMemory {
    fn deref_mut(&mut self) -> &mut [[f32; 4]] {
        match self {
            Self::Vector(tangents) => tangents,
            #[cfg(target_os = "linux")]
            Self::Mapped(bytes) => bytemuck::cast_slice_mut(bytes),
        }
    }
}
