//! What can be wrong with what a caller hands over.

use darboux::internal::gpu_plan::PlanRefusal;

/// Why something cannot run on a GPU. Degenerate or non-finite geometry is no error.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter.
    #[error("no GPU adapter was found: install a Vulkan, Metal or Direct3D 12 driver, or compute on the CPU")]
    NoAdapter,
    /// An adapter without a device.
    #[error("the adapter {adapter:?} gives no device: {reason}")]
    NoDevice {
        /// Its name.
        adapter: String,
        /// What the adapter says.
        reason: String,
    },
    /// The device has stopped: its driver was reset, or it was taken away.
    #[error("the GPU was lost: its driver was reset or it was removed; run again, or compute on the CPU")]
    Lost,
    /// The device has no memory left.
    #[error("the GPU has not enough memory for this mesh: compute it on the CPU")]
    OutOfMemory,
    /// The device refused something.
    #[error("the GPU refused to work: {reason}")]
    Refused {
        /// What it says.
        reason: String,
    },
    /// A mesh and what was computed from another.
    #[error(transparent)]
    Mesh(#[from] darboux::MeshError),
    /// A stride or offset that is not whole words.
    #[error("{bytes} bytes, the stride or offset of the {what}, are not a multiple of 4")]
    Unaligned {
        /// Of what.
        what: &'static str,
        /// Its value.
        bytes: u32,
    },
    /// Two things of one vertex in one place, or one that reaches into the next vertex.
    #[error(
        "the {what} at byte {offset} of every {stride} would overwrite something else: give it a place of its own"
    )]
    Overlap {
        /// What would be written.
        what: &'static str,
        /// Its offset.
        offset: u32,
        /// The stride of its buffer.
        stride: u32,
    },
    /// A buffer that ends too early.
    #[error("the {what} need a buffer of {needed} bytes, this one has {found}")]
    PastBuffer {
        /// Which ones.
        what: &'static str,
        /// The bytes that they reach.
        needed: u64,
        /// The bytes of the buffer.
        found: u64,
    },
    /// A buffer past a limit of the device.
    #[error(
        "the buffer of {what} has {bytes} bytes, the device binds {limit} at most: cut the mesh into pieces"
    )]
    PastLimit {
        /// Which one.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// The device's limit.
        limit: u64,
    },
    /// A buffer that shaders may not use.
    #[error("the buffer of {what} was made without BufferUsages::STORAGE")]
    NotStorage {
        /// Which one.
        what: &'static str,
    },
    /// A buffer that would be read and written at once.
    #[error("the buffer of {what} is also that of {other}: {cure}")]
    SharedBuffer {
        /// One use.
        what: &'static str,
        /// The other.
        other: &'static str,
        /// What to do.
        cure: &'static str,
    },
    /// Indices that are not whole triangles.
    #[error("{indices} indices are not whole triangles")]
    PartialTriangle {
        /// Their number.
        indices: u32,
    },
    /// More than the shaders count to.
    #[error("{corners} corners are more than the {limit} that fit: cut the mesh into pieces")]
    TooManyCorners {
        /// The corners given.
        corners: u32,
        /// The largest number.
        limit: u32,
    },
    /// A check of a plan of faces other than triangles.
    #[error(
        "a plan's check on a GPU is of triangles: which diagonals cut quads may change as they move; ask the CPU's Plan (count_regrouped)"
    )]
    NotTriangles,
    /// A plan of quads whose halves disagree.
    #[error(
        "{corners} corners of quads have the average of two tangents, or the other half's as one is degenerate: plan the triangles that are \
         drawn, or use the CPU's Plan"
    )]
    HalvesDisagree {
        /// Their number.
        corners: usize,
    },
    /// A plan of another method.
    #[error("a plan on a GPU is of MikkTSpace: other methods have nothing to plan")]
    OtherMethod,
    /// Vertices whose corners have several tangents, where each vertex is to have one.
    #[error("{vertices} vertices have several tangents: split them first (split_vertices)")]
    Unsplit {
        /// Their number.
        vertices: usize,
    },
    /// More members of sums than a thread or a buffer takes.
    #[error("{members} triangles or more to add up are more than the {limit} that fit: use the CPU's Plan")]
    TooManyMembers {
        /// At least so many.
        members: usize,
        /// The largest number.
        limit: usize,
    },
    /// Buffers that are of another mesh than a plan.
    #[error("the plan is of {expected} vertices, these buffers of {found}")]
    OtherMesh {
        /// The plan's.
        expected: u32,
        /// The buffers'.
        found: u32,
    },
}

impl From<PlanRefusal> for GpuError {
    fn from(why: PlanRefusal) -> Self {
        match why {
            PlanRefusal::HalvesDisagree { corners } => Self::HalvesDisagree { corners },
            PlanRefusal::OtherMethod => Self::OtherMethod,
            PlanRefusal::TooManyMembers { members, limit } => Self::TooManyMembers { members, limit },
        }
    }
}
