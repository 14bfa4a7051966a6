//! [`CheckOptions`]: what is checked.

use darboux::{BitangentDirection, choice};
use darboux_io::MemoryLimit;
use darboux_io::gltf::Document;

/// What is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct CheckOptions {
    /// Where the green of normal maps should point. Default: up, as glTF and OpenGL want it.
    pub green: BitangentDirection,
    /// Whether the images of normal maps are decoded and judged. Default: true.
    pub maps: bool,
    /// What the normal maps are taken to be where their texels and the faces leave it open. Default: none.
    pub assumed_map: Option<AssumedMap>,
    /// The most memory that decoding a map may take. The maps of a document have the document's own limit.
    /// Default: the default of [`MemoryLimit`].
    pub memory_limit: MemoryLimit,
}

/// The channels of normal maps, as the user knows them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum AssumedMap {
    /// Red to the right, green up.
    OpenGl,
    /// Red to the right, green down.
    DirectX,
    /// Red to the left, green up.
    RedInverted,
    /// Red to the left, green down: bumps and dents are exchanged.
    BothInverted,
}

choice! { AssumedMap, "assume",
    OpenGl => "opengl", "Red points to the right, and green up";
    DirectX => "directx", "Green points down";
    RedInverted => "red-inverted", "Red points to the left";
    BothInverted => "both-inverted", "Red points to the left and green down, so that bumps are dents";
}

/// The two conventions of normal maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum MapConvention {
    /// Green up.
    #[default]
    OpenGl,
    /// Green down.
    DirectX,
}

choice! { MapConvention, "convention",
    OpenGl => "opengl", "Green up: glTF, OpenGL, Blender, Unity, Godot";
    DirectX => "directx", "Green down: DirectX, Unreal";
}

impl MapConvention {
    /// Where green points.
    pub fn green(self) -> BitangentDirection {
        match self {
            Self::OpenGl => BitangentDirection::Up,
            Self::DirectX => BitangentDirection::Down,
        }
    }
}

impl Default for CheckOptions {
    fn default() -> Self {
        Self {
            green: BitangentDirection::Up,
            maps: true,
            assumed_map: None,
            memory_limit: MemoryLimit::default(),
        }
    }
}

impl CheckOptions {
    /// These options with another direction of green.
    #[must_use]
    pub fn with_green(self, green: BitangentDirection) -> Self {
        Self { green, ..self }
    }

    /// These options with an assumption about maps.
    #[must_use]
    pub fn with_assumed_map(self, assumed_map: Option<AssumedMap>) -> Self {
        Self { assumed_map, ..self }
    }

    /// These options with another memory limit.
    #[must_use]
    pub fn with_memory_limit(self, memory_limit: MemoryLimit) -> Self {
        Self { memory_limit, ..self }
    }

    /// These options, with the memory limit of a document.
    pub(crate) fn in_document(self, document: &Document) -> Self {
        self.with_memory_limit(document.load_options().memory_limit)
    }

    /// These options with or without maps.
    #[must_use]
    pub fn with_maps(self, maps: bool) -> Self {
        Self { maps, ..self }
    }
}
