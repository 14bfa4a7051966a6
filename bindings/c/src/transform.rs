//! Transformation of normals and tangents in C: by a node's matrix, or by the bones of a skin.

use std::mem::offset_of;

use darboux::Transform;

use crate::pointers::{self, Output, Rows, Versioned, copied, rows};
use crate::status::{Error, call, darboux_status};

type Normal = [f32; 3];
type Tangent = [f32; 4];

/// Input and output arrays of normals and tangents, one element per vertex. Strides are in bytes; 0 for
/// packed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_frame_arrays {
    /// sizeof(darboux_frame_arrays). 0: the size in version 0.1.
    pub size: usize,
    /// The number of elements of every array.
    pub count: usize,
    /// `count` by 3 floats, unit length.
    pub normals: *const f32,
    /// Bytes from one normal to the next.
    pub normal_stride: usize,
    /// `count` by 4 floats, unit xyz and the sign w.
    pub tangents: *const f32,
    /// Bytes from one tangent to the next.
    pub tangent_stride: usize,
    /// Receives `count` by 3 floats, unit length. May equal `normals`.
    pub out_normals: *mut f32,
    /// Bytes from one output normal to the next.
    pub out_normal_stride: usize,
    /// Receives `count` by 4 floats, unit length and perpendicular to the output normals. May equal
    /// `tangents`.
    pub out_tangents: *mut f32,
    /// Bytes from one output tangent to the next.
    pub out_tangent_stride: usize,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are integers or raw pointers.
unsafe impl Versioned for darboux_frame_arrays {
    const NAME: &str = "darboux_frame_arrays";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, out_tangent_stride));
}

/// A skin: the matrices of its bones, and the bones and weights of each vertex.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct darboux_skin {
    /// sizeof(darboux_skin). 0: the size in version 0.1.
    pub size: usize,
    /// The matrix of each bone, from the pose of the input arrays to the current pose, column-major.
    pub bones: *const f32,
    /// The number of bones.
    pub bone_count: usize,
    /// Bytes from one matrix to the next. 0 stands for 64: 4 by 4 floats.
    pub bone_stride: usize,
    /// Bytes from one column of a matrix to the next. 0 stands for 16: 4 floats.
    pub column_stride: usize,
    /// The number of bones, and of weights, per vertex.
    pub influence_count: usize,
    /// `count` by `influence_count`: the bones of each vertex, as indices below `bone_count`.
    pub joints: *const u16,
    /// Bytes from the joints of one vertex to those of the next. 0 for packed.
    pub joint_stride: usize,
    /// `count` by `influence_count` floats: the weight of each joint.
    pub weights: *const f32,
    /// Bytes from the weights of one vertex to those of the next. 0 for packed.
    pub weight_stride: usize,
}

// SAFETY: `repr(C)`, the size is the first field, all fields are integers or raw pointers.
unsafe impl Versioned for darboux_skin {
    const NAME: &str = "darboux_skin";
    const FIRST_SIZE: usize = pointers::size_through::<Self, usize>(offset_of!(Self, weight_stride));
}

/// Transforms normals and tangents by a node's matrix, which may mirror or scale non-uniformly.
///
/// A normal that the matrix maps to zero is not changed. A tangent that the matrix maps to zero becomes a
/// perpendicular of the normal. `matrix`: column-major; of a 4 by 4 matrix only the upper left 3 by 3 is
/// read. `column_stride`: bytes from one column to the next: 16 for 4 by 4; 0 for packed, 3 by 3. `arrays`:
/// the normals and tangents. `orientation`: receives -1 where the matrix mirrors, which reverses the winding
/// of faces, else +1; may be NULL. Errors: a null pointer, a stride smaller than an element.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_transform_frames(
    matrix: *const f32,
    column_stride: usize,
    arrays: *const darboux_frame_arrays,
    orientation: *mut f32,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
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

/// Transforms normals and tangents by a skin: each by the weighted mean of its bones' matrices.
///
/// The change of the weights over the surface is ignored, as is common practice, so normals of strongly bent
/// skins are approximate. `skin`: bones, and joints and weights of `count` vertices. `arrays`: the normals
/// and tangents. Errors: a null pointer, a stride smaller than an element, a joint out of range. Source: B.
/// Merry et al., "Normal Transformations for Articulated Models", SIGGRAPH Sketches 2006.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn darboux_skin_frames(
    skin: *const darboux_skin,
    arrays: *const darboux_frame_arrays,
) -> darboux_status {
    // SAFETY: the pointers are as documented above.
    call(|| unsafe {
        let arrays = Arrays::new(arrays)?;
        let skin = Skin::new(skin, arrays.count)?;
        arrays.write(|vertex, normal, tangent| skin.transform(vertex).frame(normal, tangent));
        Ok(())
    })
}

type Columns = [[f32; 3]; 3];

/// The checked form of [`darboux_frame_arrays`].
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
    /// `arrays` points to a valid [`darboux_frame_arrays`].
    unsafe fn new(
        arrays: *const darboux_frame_arrays,
    ) -> Result<Arrays<impl Iterator<Item = Normal>, impl Iterator<Item = Tangent>>, Error> {
        // SAFETY: the caller's promise.
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
    /// Writes `moved(vertex, normal, tangent)` for every vertex. Each input element is read before its output
    /// element is written, so that outputs may equal inputs.
    fn write(self, moved: impl Fn(usize, Normal, Tangent) -> (Normal, Tangent)) {
        for (vertex, (normal, tangent)) in self.normals.zip(self.tangents).enumerate() {
            let (normal, tangent) = moved(vertex, normal, tangent);
            self.out_normals.set(vertex, normal);
            self.out_tangents.set(vertex, tangent);
        }
    }
}

/// The checked form of [`darboux_skin`].
struct Skin {
    bones: Vec<Columns>,
    joints: Rows<u16>,
    weights: Rows<f32>,
}

impl Skin {
    /// # Safety
    ///
    /// `skin` points to a valid [`darboux_skin`] for `count` vertices, which outlives the result.
    unsafe fn new(skin: *const darboux_skin, count: usize) -> Result<Self, Error> {
        // SAFETY: the caller's promise.
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

/// Copies the upper left 3 by 3 of every bone's matrix.
///
/// # Safety
///
/// As for [`Skin::new`].
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
    // SAFETY: the caller's promise; `copied` rejects a null pointer before the offset is dereferenced.
    unsafe {
        let x = copied::<Normal>("bones", first, skin.bone_count, to_next_bone)?;
        let y = copied("bones", first.wrapping_add(to_next_column), skin.bone_count, to_next_bone)?;
        let z = copied("bones", first.wrapping_add(2 * to_next_column), skin.bone_count, to_next_bone)?;
        Ok(x.zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect())
    }
}
