//! Frames under node matrices and skins.

use std::mem::offset_of;

use darboux::Transform;

use crate::pointers::{self, Output, Rows, Versioned, copied, rows};
use crate::status::{Error, call, darboux_status};

type Normal = [f32; 3];
type Tangent = [f32; 4];

/// Where the normals and tangents of vertices are read and written. Strides are in bytes, 0 for packed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_frame_arrays {
    /// sizeof(darboux_frame_arrays), or 0, which stands for version 0.1's size.
    pub size: usize,
    /// The number of elements of every array.
    pub count: usize,
    /// `count` by 3, unit.
    pub normals: *const f32,
    /// Bytes from one normal to the next.
    pub normal_stride: usize,
    /// `count` by 4, unit xyz and the sign w.
    pub tangents: *const f32,
    /// Bytes from one tangent to the next.
    pub tangent_stride: usize,
    /// Room for `count` by 3, unit; it may be `normals`.
    pub out_normals: *mut f32,
    /// Bytes from one of these to the next.
    pub out_normal_stride: usize,
    /// Room for `count` by 4, unit and perpendicular to the normals; it may be `tangents`.
    pub out_tangents: *mut f32,
    /// Bytes from one of these to the next.
    pub out_tangent_stride: usize,
}

// SAFETY: `repr(C)`, the size first, numbers and null pointers.
unsafe impl Versioned for darboux_frame_arrays {
    const NAME: &str = "darboux_frame_arrays";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, out_tangent_stride));
}

/// A skin: matrices of bones, and which of them move each vertex.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_skin {
    /// sizeof(darboux_skin), or 0, which stands for version 0.1's size.
    pub size: usize,
    /// The matrix of each bone, from the pose of the arrays to where it is now, column by column.
    pub bones: *const f32,
    /// How many there are.
    pub bone_count: usize,
    /// Bytes from one matrix to the next. Default: 64, matrices of 4 by 4.
    pub bone_stride: usize,
    /// Bytes from one column of a matrix to the next. Default: 16, matrices of 4 by 4.
    pub column_stride: usize,
    /// How many bones each vertex has, as many as weights.
    pub influence_count: usize,
    /// `count` by `influence_count`: the bones of each vertex.
    pub joints: *const u16,
    /// Bytes from one vertex's bones to the next's. Default: packed.
    pub joint_stride: usize,
    /// `count` by `influence_count`: their weights.
    pub weights: *const f32,
    /// Bytes from one vertex's weights to the next's. Default: packed.
    pub weight_stride: usize,
}

// SAFETY: `repr(C)`, the size first, numbers and null pointers.
unsafe impl Versioned for darboux_skin {
    const NAME: &str = "darboux_skin";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, weight_stride));
}

/// Moves normals and tangents as a node's matrix moves their surface, mirrors and uneven scales included.
///
/// A normal that the matrix leaves no direction stays as it is; such a tangent becomes a perpendicular of the normal. `matrix`: column by
/// column; of 4 by 4 the first three of the first three columns count. `column_stride`: bytes from one column to the next, 16 for
/// matrices of 4 by 4, 0 for packed (3 by 3). `arrays`: normals and tangents. `orientation`: receives -1 where the matrix mirrors, which
/// turns the winding of faces, else +1; or null. Errors: null, a stride that is too small.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_transform_frames(
    matrix: *const f32,
    column_stride: usize,
    arrays: *const darboux_frame_arrays,
    orientation: *mut f32,
) -> darboux_status {
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let mut columns = copied::<[f32; 3]>("matrix", matrix.cast(), 3, column_stride)?;
        let transform = Transform::new([(); 3].map(|()| columns.next().unwrap_or_default()));
        let arrays = Arrays::new(arrays)?;
        let orientation = (!orientation.is_null())
            .then(|| Output::new("orientation", orientation.cast(), 1, 0))
            .transpose()?;
        arrays.write(|_, normal, tangent| transform.frame(normal, tangent));
        if let Some(orientation) = orientation {
            orientation.copy(&[transform.orientation()]);
        }
        Ok(())
    })
}

/// Moves normals and tangents as a skin's bones move their surface: each by the weighted mean of its bones' matrices.
///
/// That weights vary over the surface is left out, as everywhere: normals of strongly bent skins are approximate. `skin`: its arrays have
/// an element per normal. `arrays`: normals and tangents. Errors: null, a stride that is too small; a joint that is none of the bones.
/// Source: B. Merry et al., "Normal Transformations for Articulated Models", SIGGRAPH Sketches 2006.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_skin_frames(
    skin: *const darboux_skin,
    arrays: *const darboux_frame_arrays,
) -> darboux_status {
    // SAFETY: every pointer is as the documentation above says.
    call(|| unsafe {
        let arrays = Arrays::new(arrays)?;
        let skin = Skin::new(skin, arrays.count)?;
        arrays.write(|vertex, normal, tangent| skin.transform(vertex).frame(normal, tangent));
        Ok(())
    })
}

type Columns = [[f32; 3]; 3];

/// What a [`darboux_frame_arrays`] describes.
struct Arrays<Normals, Tangents> {
    count: usize,
    normals: Normals,
    tangents: Tangents,
    out_normals: Output<Normal>,
    out_tangents: Output<Tangent>,
}

impl Arrays<(), ()> {
    /// # Safety
    ///
    /// `arrays` and the pointers in it are as [`darboux_frame_arrays`] says.
    unsafe fn new(
        arrays: *const darboux_frame_arrays,
    ) -> Result<Arrays<impl Iterator<Item = Normal>, impl Iterator<Item = Tangent>>, Error> {
        // SAFETY: as of this function.
        unsafe {
            let arrays = pointers::read(arrays)?;
            let (normals, tangents) = (arrays.out_normals.cast(), arrays.out_tangents.cast());
            let count = arrays.count;
            Ok(Arrays {
                count,
                normals: copied("normals", arrays.normals.cast(), count, arrays.normal_stride)?,
                tangents: copied("tangents", arrays.tangents.cast(), count, arrays.tangent_stride)?,
                out_normals: Output::new("out_normals", normals, count, arrays.out_normal_stride)?,
                out_tangents: Output::new("out_tangents", tangents, count, arrays.out_tangent_stride)?,
            })
        }
    }
}

impl<Normals: Iterator<Item = Normal>, Tangents: Iterator<Item = Tangent>> Arrays<Normals, Tangents> {
    /// Writes every frame as `moved` turns it. Each element is read before any of its number is written.
    fn write(self, moved: impl Fn(usize, Normal, Tangent) -> (Normal, Tangent)) {
        for (vertex, (normal, tangent)) in self.normals.zip(self.tangents).enumerate() {
            let (normal, tangent) = moved(vertex, normal, tangent);
            self.out_normals.set(vertex, normal);
            self.out_tangents.set(vertex, tangent);
        }
    }
}

/// What a [`darboux_skin`] describes.
struct Skin {
    bones: Vec<Columns>,
    joints: Rows<u16>,
    weights: Rows<f32>,
}

impl Skin {
    /// # Safety
    ///
    /// `skin` and the pointers in it are as [`darboux_skin`] says, of `count` vertices, until the skin is gone.
    unsafe fn new(skin: *const darboux_skin, count: usize) -> Result<Self, Error> {
        // SAFETY: as of this function.
        let skin = unsafe {
            let skin = pointers::read(skin)?;
            let width = skin.influence_count;
            Self {
                bones: bones(&skin)?,
                joints: rows("joints", skin.joints, count, width, skin.joint_stride)?,
                weights: rows("weights", skin.weights, count, width, skin.weight_stride)?,
            }
        };
        let bones = skin.bones.len();
        if let Some(joint) = skin.joints.elements().find(|&joint| usize::from(joint) >= bones) {
            let message = format!("there is a joint {joint} but only {bones} bones");
            return Err(Error::new(darboux_status::Index, message));
        }
        Ok(skin)
    }

    fn transform(&self, vertex: usize) -> Transform {
        let bones = self.joints.row(vertex).map(|joint| self.bones[usize::from(joint)]);
        Transform::blended(bones.zip(self.weights.row(vertex)))
    }
}

/// # Safety
///
/// As of [`Skin::new`].
unsafe fn bones(skin: &darboux_skin) -> Result<Vec<Columns>, Error> {
    let or = |stride, default| if stride == 0 { default } else { stride };
    let (to_next_bone, to_next_column) = (or(skin.bone_stride, 64), or(skin.column_stride, 16));
    let size = to_next_column.saturating_mul(2).saturating_add(size_of::<Normal>());
    if to_next_column < size_of::<Normal>() || to_next_bone < size || size == usize::MAX {
        let message = format!(
            "matrices of bones lie {to_next_bone} bytes apart and their columns {to_next_column}; a matrix \
             needs {size}, a column 12"
        );
        return Err(Error::new(darboux_status::Stride, message));
    }
    let first = skin.bones.cast::<u8>();
    // SAFETY: as of this function; a null pointer is refused before it is added to.
    unsafe {
        let x = copied::<Normal>("bones", first, skin.bone_count, to_next_bone)?;
        let y = copied("bones", first.wrapping_add(to_next_column), skin.bone_count, to_next_bone)?;
        let z = copied("bones", first.wrapping_add(2 * to_next_column), skin.bone_count, to_next_bone)?;
        Ok(x.zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect())
    }
}
