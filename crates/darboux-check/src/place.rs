//! [`Place`]: where a finding is.

use std::fmt;

use darboux_io::gltf::PrimitiveName;

/// Where a finding is. Everything is absent for a map that was checked alone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Place {
    /// The primitive.
    pub primitive: Option<PrimitiveName>,
    /// The number of further primitives with the same data.
    pub same_as: usize,
    /// The index of the material.
    pub material: Option<usize>,
    /// The index of the image.
    pub image: Option<usize>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.primitive, self.image, self.material) {
            (Some(primitive), ..) => {
                primitive.fmt(f)?;
                if self.same_as > 0 { write!(f, " and {} with the same data", self.same_as) } else { Ok(()) }
            }
            (None, Some(image), Some(material)) => {
                write!(f, "images[{image}] (normalTexture of materials[{material}])")
            }
            (None, Some(image), None) => write!(f, "images[{image}]"),
            (None, None, Some(material)) => write!(f, "materials[{material}]"),
            (None, None, None) => f.write_str("the image"),
        }
    }
}
