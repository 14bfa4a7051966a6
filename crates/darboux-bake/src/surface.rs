//! The surfaces that are baked: borrowed meshes in one space.

use darboux::{Error, Faces, Indices, Mesh, Strided};

use crate::common_box::CommonBox;
use crate::frame::ShadingFrame;
use crate::material::{Property, SurfaceMaterial};
use crate::vector::{Vector, box_diagonal, weighted};
use crate::{AlphaMode, BakeError, ColorTexture, MaterialProperty, NormalTexture, SkewCorrection};

/// A surface that receives the detail: triangles with normals, UVs and tangents.
#[derive(Clone, Copy, Debug)]
pub struct LowSurface<'a> {
    pub(crate) mesh: Mesh<'a>,
    pub(crate) tangents: &'a [[f32; 4]],
    pub(crate) cage: Option<Strided<'a, 3>>,
    pub(crate) skew: Option<SkewCorrection<'a>>,
    pub(crate) group: usize,
    pub(crate) space: CommonBox,
}

impl<'a> LowSurface<'a> {
    /// A surface of group 0 without a cage.
    ///
    /// `tangents`: one per corner, as [`darboux::generate_tangents`] gives them for the mesh, or as a
    /// renderer will read them from the file, converted to
    /// [`Convention::generated`](darboux::Convention::generated) of the surface's convention. Errors: faces
    /// that are not triangles; another number of tangents than corners.
    pub fn new(mesh: Mesh<'a>, tangents: &'a [[f32; 4]]) -> Result<Self, BakeError> {
        if !matches!(mesh.faces(), Faces::Triangles) {
            return Err(BakeError::NotTriangles);
        }
        if tangents.len() != mesh.corner_count() {
            let (expected, found) = (mesh.corner_count(), tangents.len());
            return Err(Error::InputLength { what: "tangents", expected, found }.into());
        }
        Ok(Self { mesh, tangents, cage: None, skew: None, group: 0, space: CommonBox::default() })
    }

    /// This surface with a cage, from which rays begin: the mesh with its vertices moved.
    ///
    /// `positions`: one per vertex of the mesh. [`inflated_cage`](crate::inflated_cage) and
    /// [`auto_cage`](crate::auto_cage()) make one. Errors: another number of positions.
    pub fn with_cage(self, positions: impl Into<Strided<'a, 3>>) -> Result<Self, BakeError> {
        let positions = positions.into();
        if positions.len() != self.mesh.vertex_count() {
            return Err(BakeError::Cage { vertices: self.mesh.vertex_count(), found: positions.len() });
        }
        Ok(Self { cage: Some(positions), ..self })
    }

    /// This surface with rays that turn from the smooth direction towards the normals of triangles. Errors:
    /// amounts that do not fit the surface, or do not lie from 0 to 1.
    pub fn with_skew_correction(self, skew: SkewCorrection<'a>) -> Result<Self, BakeError> {
        skew.check(self.triangle_count())?;
        Ok(Self { skew: Some(skew), ..self })
    }

    /// This surface in another group: its rays hit high surfaces of the same group only.
    #[must_use]
    pub fn with_group(self, group: usize) -> Self {
        Self { group, ..self }
    }

    /// This surface with its places in a common box.
    pub(crate) fn in_space(self, space: CommonBox) -> Self {
        Self { space, ..self }
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh<'a> {
        &self.mesh
    }

    /// The diagonal of the box around all vertices, in units of the positions: a measure for the distances of
    /// rays.
    ///
    /// Coordinates that are not finite do not count; without any, it is 0.
    pub fn diagonal(&self) -> f64 {
        let vertices = 0..self.mesh.vertex_count();
        box_diagonal(vertices.map(|vertex| self.mesh.positions().get(vertex)))
    }

    pub(crate) fn triangle_count(&self) -> usize {
        self.mesh.face_count()
    }
}

/// A surface that has the detail: triangles, with or without normals.
#[derive(Clone, Copy, Debug)]
pub struct HighSurface<'a> {
    /// Without UVs; normals are zeros where there are none.
    pub(crate) mesh: Mesh<'a>,
    pub(crate) group: usize,
    pub(crate) space: CommonBox,
    pub(crate) labels: SurfaceLabels,
    /// Red, green, blue and alpha of the vertices.
    pub(crate) colors: Option<Strided<'a, 4>>,
    pub(crate) material: SurfaceMaterial<'a>,
    normal_map: Option<SurfaceMap<'a>>,
}

/// The numbers of what a high surface belongs to, for [`MapKind::Id`](crate::MapKind::Id) and for
/// [`BakeOptions::own_part_only`](crate::BakeOptions::own_part_only). By default all are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SurfaceLabels {
    /// The number of the material, below 2^24.
    pub material: u32,
    /// The number of the mesh, below 2^24.
    pub mesh: u32,
    /// The number of the part, below 2^24.
    pub part: u32,
}

/// A normal map on a high surface.
#[derive(Clone, Copy, Debug)]
struct SurfaceMap<'a> {
    texture: &'a NormalTexture,
    uvs: Strided<'a, 2>,
    tangents: &'a [[f32; 4]],
}

impl<'a> HighSurface<'a> {
    /// A surface of group 0.
    ///
    /// `positions`: V by 3; `normals`: V by 3, or none, which makes every triangle flat; `indices`: 3 per
    /// triangle, counter-clockwise as seen from the front. Errors: lengths that differ, an index out of
    /// range, corners that are not whole triangles.
    pub fn new(
        positions: impl Into<Strided<'a, 3>>,
        normals: Option<Strided<'a, 3>>,
        indices: impl Into<Indices<'a>>,
    ) -> Result<Self, BakeError> {
        let positions = positions.into();
        let normals = normals.unwrap_or_else(|| Strided::repeated(&[0.0; 3], positions.len()));
        let uvs = Strided::repeated(&[0.0; 2], positions.len());
        let mesh = Mesh::triangles(positions, normals, uvs, indices)?;
        Ok(Self {
            mesh,
            group: 0,
            space: CommonBox::default(),
            labels: SurfaceLabels::default(),
            colors: None,
            material: SurfaceMaterial::default(),
            normal_map: None,
        })
    }

    /// This surface with a normal map of its own: its normals are those that a renderer shows, with the
    /// bitangent per pixel.
    ///
    /// `uvs`: one per vertex, where the texture is read; `tangents`: one per corner, as of
    /// [`LowSurface::new`]. Errors: other lengths.
    pub fn with_normal_map(
        self,
        texture: &'a NormalTexture,
        uvs: impl Into<Strided<'a, 2>>,
        tangents: &'a [[f32; 4]],
    ) -> Result<Self, BakeError> {
        let uvs = uvs.into();
        let (vertices, corners) = (self.mesh.vertex_count(), self.mesh.corner_count());
        if uvs.len() != vertices {
            return Err(BakeError::Uvs { vertices, found: uvs.len() });
        }
        if tangents.len() != corners {
            let found = tangents.len();
            return Err(Error::InputLength { what: "tangents", expected: corners, found }.into());
        }
        Ok(Self { normal_map: Some(SurfaceMap { texture, uvs, tangents }), ..self })
    }

    /// This surface with colours: red, green, blue and alpha of each vertex, in linear light. Errors: another
    /// number of colours than vertices.
    pub fn with_colors(self, colors: impl Into<Strided<'a, 4>>) -> Result<Self, BakeError> {
        let colors = colors.into();
        let expected = self.mesh.vertex_count();
        if colors.len() != expected {
            return Err(Error::InputLength { what: "colors", expected, found: colors.len() }.into());
        }
        Ok(Self { colors: Some(colors), ..self })
    }

    /// This surface with a property of its material: a factor, times a texture and the UVs, one per vertex,
    /// where it is read.
    ///
    /// `factor`: red, green, blue and alpha in linear light. Errors: another number of UVs than vertices.
    pub fn with_property(
        self,
        property: MaterialProperty,
        factor: [f32; 4],
        texture: Option<(&'a ColorTexture, Strided<'a, 2>)>,
    ) -> Result<Self, BakeError> {
        let vertices = self.mesh.vertex_count();
        if let Some(found) = texture.map(|(_, uvs)| uvs.len()).filter(|&found| found != vertices) {
            return Err(BakeError::Uvs { vertices, found });
        }
        let mut surface = self;
        surface.material.set(property, Property { factor, texture });
        Ok(surface)
    }

    /// The most red, green or blue that a map of a property may have of this surface: the largest factor, and
    /// of the base colour times the largest colour of a vertex. Textures have at most 1.
    pub fn most_light(&self, property: MaterialProperty) -> f32 {
        let most = |[red, green, blue, _]: [f32; 4]| red.max(green).max(blue);
        let of_vertices = match (property, self.colors) {
            (MaterialProperty::BaseColor, Some(colors)) => {
                (0..colors.len()).map(|vertex| most(colors.get(vertex))).fold(0.0, f32::max)
            }
            _ => 1.0,
        };
        most(self.material.factor(property)) * of_vertices
    }

    /// This surface with a meaning of its material's alpha. By default, it is the opacity.
    ///
    /// `cutoff`: the least alpha of a mask that is opaque.
    #[must_use]
    pub fn with_alpha_mode(self, mode: AlphaMode, cutoff: f32) -> Self {
        let mut surface = self;
        surface.material.set_alpha_mode(mode, cutoff);
        surface
    }

    /// This surface with the numbers of its material, mesh and part.
    #[must_use]
    pub fn with_labels(self, labels: SurfaceLabels) -> Self {
        Self { labels, ..self }
    }

    /// The numbers of its material, mesh and part.
    pub fn labels(&self) -> SurfaceLabels {
        self.labels
    }

    /// The unit normal that the normal map shows at a point of a triangle whose interpolated normal is
    /// `normal`; `None` without a map, and where the frame gives no direction.
    pub(crate) fn mapped_normal(&self, triangle: usize, weights: [f64; 3], normal: Vector) -> Option<Vector> {
        let map = self.normal_map?;
        let corners = [0, 1, 2].map(|corner| 3 * triangle + corner);
        let uv = weighted(weights, corners.map(|corner| map.uvs.get(self.mesh.vertex_of_corner(corner))));
        let [x, y, z, sign] = weighted(weights, corners.map(|corner| map.tangents[corner]));
        let frame = ShadingFrame::per_pixel(normal, [x, y, z], sign);
        frame.shade(map.texture.at_uv(uv))
    }

    /// This surface in another group.
    #[must_use]
    pub fn with_group(self, group: usize) -> Self {
        Self { group, ..self }
    }

    /// This surface with its places in a common box.
    pub(crate) fn in_space(self, space: CommonBox) -> Self {
        Self { space, ..self }
    }

    pub(crate) fn triangle_count(&self) -> usize {
        self.mesh.face_count()
    }

    /// The mesh. Its UVs are zeros, and so are its normals where there are none.
    pub fn mesh(&self) -> &Mesh<'a> {
        &self.mesh
    }

    /// The places of a triangle's vertices in the common box.
    pub(crate) fn corners(&self, vertices: [usize; 3]) -> [[f32; 3]; 3] {
        vertices.map(|vertex| self.space.position(self.mesh.positions().get(vertex)))
    }

    /// The vertices of a triangle.
    pub(crate) fn vertices(&self, triangle: usize) -> [usize; 3] {
        [0, 1, 2].map(|corner| self.mesh.vertex_of_corner(3 * triangle + corner))
    }

    pub(crate) fn normals(&self, vertices: [usize; 3]) -> [[f32; 3]; 3] {
        vertices.map(|vertex| self.mesh.normals().get(vertex))
    }
}
