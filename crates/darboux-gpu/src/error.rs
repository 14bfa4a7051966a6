//! The errors of this crate: missing adapters, limits of devices, and wrong descriptions of buffers.

use darboux::internal::gpu_plan::PlanRefusal;

/// Why a computation cannot run on a GPU. Degenerate and non-finite geometry is not an error.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter.
    #[error("no GPU adapter was found: install a Vulkan, Metal or Direct3D 12 driver, or compute on the CPU")]
    NoAdapter,
    /// The adapter cannot create a device.
    #[error(
        "the adapter {adapter:?} cannot create a device ({reason}): update its driver, or compute on the CPU"
    )]
    NoDevice {
        /// The name of the adapter.
        adapter: String,
        /// The message of the adapter.
        reason: String,
    },
    /// The device is lost: its driver was reset, or the GPU was removed.
    #[error("the GPU was lost: its driver was reset or it was removed; run again, or compute on the CPU")]
    Lost,
    /// The device is out of memory.
    #[error("the GPU does not have enough memory for this mesh: compute on the CPU")]
    OutOfMemory,
    /// The device reported an error.
    #[error("the GPU reported an error ({reason}): update its driver, or compute on the CPU")]
    DeviceError {
        /// The message of the device.
        reason: String,
    },
    /// The token of the call's context was cancelled.
    #[error("the call was cancelled")]
    Cancelled,
    /// Arguments that do not fit the mesh.
    #[error(transparent)]
    Mesh(darboux::Error),
    /// A stride or offset is not a multiple of 4.
    #[error("the stride or offset of the {what} is {bytes} bytes: use a multiple of 4")]
    UnalignedLayout {
        /// The attribute.
        what: &'static str,
        /// The stride or offset.
        bytes: u32,
    },
    /// A written attribute overlaps another attribute of its vertex, or the next vertex.
    #[error(
        "the {what} at byte {offset} of every {stride} overlap another attribute or the next element: use \
         another offset or a larger stride"
    )]
    Overlap {
        /// The written attribute.
        what: &'static str,
        /// Its offset.
        offset: u32,
        /// The stride of its buffer.
        stride: u32,
    },
    /// A buffer is too small.
    #[error("the {what} need a buffer of {needed} bytes, but this one has {found}")]
    BufferTooSmall {
        /// The contents of the buffer.
        what: &'static str,
        /// The required byte length.
        needed: u64,
        /// The byte length of the buffer.
        found: u64,
    },
    /// A buffer is larger than the device can bind.
    #[error("the buffer of {what} has {bytes} bytes, but the device binds at most {limit}: split the mesh")]
    BufferTooLarge {
        /// The contents of the buffer.
        what: &'static str,
        /// The byte length of the buffer.
        bytes: u64,
        /// The limit of the device.
        limit: u64,
    },
    /// A buffer lacks the usage `STORAGE`.
    #[error("the buffer of {what} was created without BufferUsages::STORAGE: add that usage")]
    MissingStorageUsage {
        /// The contents of the buffer.
        what: &'static str,
    },
    /// One buffer has two uses that exclude each other.
    #[error("the {what} and the {other} are in one buffer: {remedy}")]
    SharedBuffer {
        /// The contents of one use.
        what: &'static str,
        /// The contents of the other use.
        other: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// The number of indices is not a multiple of 3.
    #[error("{indices} indices are not a multiple of 3: pass three per triangle")]
    PartialTriangle {
        /// The number of indices.
        indices: u32,
    },
    /// There are too many corners.
    #[error("{corners} corners are more than the limit of {limit}: split the mesh")]
    TooManyCorners {
        /// The number of corners.
        corners: u32,
        /// The limit.
        limit: u32,
    },
    /// A check of a plan whose mesh has faces other than triangles.
    #[error(
        "a plan of quads cannot be checked on a GPU, because the diagonals of quads may change as they move: \
         use count_regrouped of darboux::Plan"
    )]
    NotTriangles,
    /// A plan of quads whose two triangles have different tangents at one corner.
    #[error(
        "{corners} corners of quads average the tangents of two triangles, or take the tangent of the other \
         triangle because one is degenerate: plan the triangles that are drawn, or use darboux::Plan"
    )]
    QuadHalvesDiffer {
        /// The number of such corners.
        corners: usize,
    },
    /// The method of a plan is not MikkTSpace.
    #[error("a plan on a GPU computes MikkTSpace: choose that method, or generate the tangents anew")]
    UnsupportedMethod,
    /// Tangents per vertex were requested, but the corners of some vertices have different tangents.
    #[error("{vertices} vertices have several tangents: split them first (split_vertices)")]
    UnsplitVertices {
        /// The number of such vertices.
        vertices: usize,
    },
    /// A sum has more terms than one thread or one buffer can hold.
    #[error("a sum of at least {members} triangles is above the limit of {limit}: use darboux::Plan")]
    TooManyMembers {
        /// A lower bound of the number of terms.
        members: usize,
        /// The limit.
        limit: usize,
    },
    /// The buffers have another number of vertices than the plan.
    #[error("the plan has {expected} vertices, but these buffers have {found}: plan this mesh")]
    VertexCountMismatch {
        /// The number of vertices of the plan.
        expected: u32,
        /// The number of vertices of the buffers.
        found: u32,
    },
}

impl GpuError {
    /// The error for a mesh that the core does not plan for a GPU.
    pub(crate) fn of_refusal(reason: PlanRefusal) -> Self {
        match reason {
            PlanRefusal::QuadHalvesDiffer { corners } => Self::QuadHalvesDiffer { corners },
            PlanRefusal::OtherMethod => Self::UnsupportedMethod,
            PlanRefusal::TooManyMembers { members, limit } => Self::TooManyMembers { members, limit },
            PlanRefusal::Failed(error) => error.into(),
        }
    }
}

impl From<darboux::Error> for GpuError {
    fn from(error: darboux::Error) -> Self {
        match error {
            darboux::Error::Cancelled => Self::Cancelled,
            other => Self::Mesh(other),
        }
    }
}
