//! [`Models`]: the low model and the high models of a bake, with their surfaces.

use std::fmt;

use darboux::choice;
use darboux_io::Error;
use darboux_io::gltf::{Document, PrimitiveCorners};
use darboux_io::words::counted_if_any;

use super::misfit;
use super::{HighModel, HighModelOptions, LowModel, LowModelOptions, group_by_name};
use crate::vector::box_corners;
use crate::{BakeError, HighSurface, LowSurface};

/// Which high parts the rays of a low part can hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PartMatch {
    /// All of them.
    #[default]
    Nearest,
    /// Those of the same name.
    Name,
}

choice! { PartMatch, "match",
    Nearest => "nearest", "All of them: the first that a ray meets";
    Name => "name", "Those of the same name: crate_low gets the detail of crate_high and crate_high_bolts \
         (_lowpoly and _lp mean _low, _highpoly and _hp mean _high). The names of nodes count, or else of meshes";
}

/// The low model and the high models of a bake.
#[derive(Debug)]
pub struct Models<'a> {
    /// Receives the detail.
    pub low: LowModel<'a>,
    /// Have the detail.
    pub highs: Vec<HighModel<'a>>,
}

/// The surfaces of [`Models`].
#[derive(Debug)]
pub struct ModelSurfaces<'a> {
    /// Of the low model.
    pub low: Vec<LowSurface<'a>>,
    /// Of all high models.
    pub highs: Vec<HighSurface<'a>>,
    /// What [`PartMatch::Name`] leaves without a partner, one sentence each.
    pub warnings: Vec<String>,
}

/// Why models were not baked.
#[derive(Debug)]
#[non_exhaustive]
pub enum ModelsError {
    /// A file cannot be read, or its data is invalid.
    File(Error),
    /// No part of the high models has the name of a part of the low model: one sentence.
    NoPartners(String),
    /// The bake itself failed.
    Bake(BakeError),
}

impl<'a> Models<'a> {
    /// Reads the models: documents, each with its [`Document::corners`]. Errors: as of [`LowModel::read`] and
    /// [`HighModel::read`].
    pub fn read(
        low: (&'a Document, &'a [PrimitiveCorners<'a>]),
        highs: (&'a [Document], &'a [Vec<PrimitiveCorners<'a>>]),
        low_options: &LowModelOptions,
        high_options: &HighModelOptions,
    ) -> Result<Self, Error> {
        let low = LowModel::read(low.0, low.1, low_options)?;
        Ok(Self { low, highs: HighModel::read_all(highs.0, highs.1, high_options)? })
    }

    /// The surfaces, in groups where names decide. Errors: an index out of range; no names match.
    pub fn surfaces(&self, part_match: PartMatch) -> Result<ModelSurfaces<'_>, ModelsError> {
        let mut low = self.low.surfaces()?;
        let mut highs = HighModel::surfaces_of_all(&self.highs)?;
        let mut warnings = Vec::new();
        if part_match == PartMatch::Name {
            warnings = group_by_name((&self.low, &mut low), (&self.highs, &mut highs)).warnings();
            if highs.is_empty() {
                return Err(ModelsError::NoPartners(warnings.join("; ")));
            }
        }
        Ok(ModelSurfaces { low, highs, warnings })
    }

    /// Why rays of the low model may miss the high ones, judged by the boxes around them, and what to do: a
    /// clause; none where the boxes fit.
    pub fn misfit(&self) -> Option<String> {
        let high = self.highs.iter().flat_map(HighModel::positions);
        misfit::of_boxes(box_corners(self.low.positions()), box_corners(high))
    }

    /// What was left out of the models, what they share, and what is flat, one sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let Self { low, highs } = self;
        let file = low.file();
        let of_low = [
            counted_if_any(
                low.repeated_meshes,
                "mesh is in the scene more than once; its first place is baked",
                "meshes are in the scene more than once; their first places are baked",
            ),
            counted_if_any(
                low.without_uvs,
                "primitive has no UVs of the chosen set and is not baked",
                "primitives have no UVs of the chosen set and are not baked",
            ),
            counted_if_any(
                Some(low.materials.len()).filter(|count| *count > 1).unwrap_or_default(),
                "material",
                "materials share this map, which is right only where their charts lie beside each other; \
                 choose one with the option material where each has a map of its own",
            ),
            counted_if_any(
                low.mirrored_count(),
                "part lies below a node that mirrors it, where some renderers turn the bitangent and others, \
                 such as three.js, do not, so that its normal map is right in some of them only; apply the \
                 scale of the node to the mesh",
                "parts lie below nodes that mirror them, where some renderers turn the bitangent and others, \
                 such as three.js, do not, so that their normal maps are right in some of them only; apply the \
                 scales of the nodes to the meshes",
            ),
        ];
        let of_low = of_low.into_iter().flatten().map(|sentence| format!("{file}: {sentence}"));
        let flat: usize = highs.iter().map(HighModel::flat_count).sum();
        let of_high = counted_if_any(
            flat,
            "primitive of the high models has no normals, so every triangle is flat, as glTF requires; \
             darboux normals makes smooth ones",
            "primitives of the high models have no normals, so every triangle is flat, as glTF requires; \
             darboux normals makes smooth ones",
        );
        of_low.chain(of_high).chain(highs.iter().flat_map(HighModel::warnings).cloned()).collect()
    }
}

impl From<Error> for ModelsError {
    fn from(error: Error) -> Self {
        Self::File(error)
    }
}

impl From<BakeError> for ModelsError {
    fn from(error: BakeError) -> Self {
        Self::Bake(error)
    }
}

impl fmt::Display for ModelsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => error.fmt(f),
            Self::NoPartners(sentence) => f.write_str(sentence),
            Self::Bake(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ModelsError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::File(error) => Some(error),
            Self::NoPartners(_) => None,
            Self::Bake(error) => Some(error),
        }
    }
}
