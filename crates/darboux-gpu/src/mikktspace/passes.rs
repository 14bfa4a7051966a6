//! The passes of MikkTSpace as data: kernels, their buffers by binding, and the number of threads.
//!
//! [`crate::mikktspace::program`] runs these lists. The npm package runs the same lists: it reads them from
//! `shaders/passes.json`, and the files of the kernels from `shaders/mikktspace.json`, which a test writes.
//!
//! The caller provides the buffers `mesh` (the uniform `Mesh`), `evaluation` (the uniform `Evaluation`),
//! `vertices` (as `mesh` describes them) and `indices` (three per triangle). All others are in [`BUFFERS`].

/// The element that there is one thread or a number of words for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Domain {
    /// One per mesh.
    Mesh,
    Vertex,
    /// A slot of the hash table of vertices: a power of two, at least twice their number.
    Slot,
    Triangle,
    Corner,
}

/// The files of a shader, which are concatenated.
#[derive(Debug)]
pub(crate) struct Kernel {
    pub name: &'static str,
    /// For kernels of exact arithmetic, their own files; see [`crate::device::precision::kernel_files`].
    pub files: &'static [&'static str],
}

/// An entry point of a kernel with its buffers, by binding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub kernel: &'static Kernel,
    pub entry: &'static str,
    pub domain: Domain,
    pub buffers: &'static [(u32, &'static str)],
}

/// One step. Every step sees what the steps before it wrote.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Pass {
    /// Fills a buffer with zeros.
    Clear(&'static str),
    /// Replaces every value by the sum of the values before it. The buffer has one value per element of the
    /// domain.
    Scan(&'static str, Domain),
    Run(Run),
    /// A kernel of exact arithmetic, which lists the items that it is unsure of. Either the same kernel
    /// computes these again with integers, or the second kernel defers them to the CPU. The list has the
    /// binding [`crate::device::precision::WORK_LIST_BINDING`].
    RunExact(Run, Run),
}

/// The buffers that a program creates: name, domain and words per element. `u32::MAX` stands for none.
pub(crate) const BUFFERS: &[(&str, Domain, u32)] = &[
    // The number of vertices that only the CPU can weld.
    ("failure_count", Domain::Mesh, 1),
    ("hash_slots", Domain::Slot, 1),
    // The first vertex that equals each vertex.
    ("welded_vertex", Domain::Vertex, 1),
    // 1 for vertices that the CPU has to compute. Several passes set it.
    ("is_deferred", Domain::Vertex, 1),
    // The welded vertex of each corner; none at degenerate triangles.
    ("vertex_of_corner", Domain::Corner, 1),
    // The end of each vertex's range in the next two.
    ("adjacency_ends", Domain::Vertex, 1),
    ("adjacent_corners", Domain::Corner, 1),
    ("adjacent_triangles", Domain::Corner, 1),
    // The triangles across the edges 0-1, 1-2, 2-0.
    ("neighbours", Domain::Corner, 1),
    // dP/du, dP/dv and their lengths.
    ("derivatives", Domain::Triangle, 8),
    // 1 if the UV map keeps the orientation of the triangle, 2 if the triangle is UV-degenerate.
    ("triangle_flags", Domain::Triangle, 1),
    // The first corner of each corner's group.
    ("seed_of_corner", Domain::Corner, 1),
    // What each corner adds to the sums of its vertex.
    ("corner_terms", Domain::Corner, 8),
    // Tangent, bitangent and magnitudes.
    ("frames", Domain::Corner, 8),
    // Tangent and sign. The sign is zero for deferred corners.
    ("tangent_of_corner", Domain::Corner, 4),
];

const MESH: &str = include_str!("../../shaders/device/mesh.wgsl");
const FLOAT_BITS: &str = include_str!("../../shaders/mikktspace/float_bits.wgsl");
const COMMON: &str = include_str!("../../shaders/mikktspace/common.wgsl");
const ADJACENCY_LOOKUP: &str = include_str!("../../shaders/mikktspace/adjacency_lookup.wgsl");
const WELDED_MESH: &str = include_str!("../../shaders/mikktspace/welded_mesh.wgsl");
const DEFER_TO_CPU: &str = include_str!("../../shaders/mikktspace/defer_to_cpu.wgsl");
const DISPATCH_LISTED: &str = include_str!("../../shaders/precision/dispatch_listed.wgsl");

const WELD: Kernel = Kernel {
    name: "weld",
    files: &[MESH, FLOAT_BITS, COMMON, include_str!("../../shaders/mikktspace/weld.wgsl")],
};
const WELD_CORNERS: Kernel = Kernel {
    name: "weld_corners",
    files: &[MESH, FLOAT_BITS, COMMON, include_str!("../../shaders/mikktspace/weld_corners.wgsl")],
};
const ADJACENCY: Kernel =
    Kernel { name: "adjacency", files: &[MESH, include_str!("../../shaders/mikktspace/adjacency.wgsl")] };
const NEIGHBOURS: Kernel = Kernel {
    name: "neighbours",
    files: &[MESH, COMMON, ADJACENCY_LOOKUP, include_str!("../../shaders/mikktspace/neighbours.wgsl")],
};
const GROUPS: Kernel = Kernel {
    name: "groups",
    files: &[MESH, COMMON, ADJACENCY_LOOKUP, include_str!("../../shaders/mikktspace/groups.wgsl")],
};
const WRITE_TANGENTS: Kernel = Kernel {
    name: "write_tangents",
    files: &[MESH, COMMON, ADJACENCY_LOOKUP, include_str!("../../shaders/mikktspace/write_tangents.wgsl")],
};
pub(crate) const DERIVATIVES: Kernel = Kernel {
    name: "derivatives",
    files: &[
        MESH,
        WELDED_MESH,
        include_str!("../../shaders/mikktspace/derivative.wgsl"),
        include_str!("../../shaders/mikktspace/derivatives.wgsl"),
    ],
};
pub(crate) const CORNER_TERMS: Kernel = Kernel {
    name: "corner_terms",
    files: &[
        MESH,
        WELDED_MESH,
        include_str!("../../shaders/mikktspace/corner_angle.wgsl"),
        include_str!("../../shaders/mikktspace/corner_terms.wgsl"),
    ],
};
pub(crate) const EVALUATE: Kernel =
    Kernel { name: "evaluate", files: &[include_str!("../../shaders/mikktspace/evaluate.wgsl")] };
const DEFER_TRIANGLES: Kernel = Kernel {
    name: "defer_triangles",
    files: &[MESH, "const CORNERS_PER_ITEM: u32 = 3u;", DEFER_TO_CPU, DISPATCH_LISTED],
};
const DEFER_CORNERS: Kernel = Kernel {
    name: "defer_corners",
    files: &[MESH, "const CORNERS_PER_ITEM: u32 = 1u;", DEFER_TO_CPU, DISPATCH_LISTED],
};

const fn run(
    kernel: &'static Kernel,
    entry: &'static str,
    domain: Domain,
    buffers: &'static [(u32, &'static str)],
) -> Run {
    Run { kernel, entry, domain, buffers }
}

/// Welds the vertices. The uniform `mesh` may have no triangles.
pub(crate) const VERTEX_PASSES: &[Pass] = &[
    Pass::Clear("failure_count"),
    Pass::Clear("hash_slots"),
    Pass::Run(run(
        &WELD,
        "weld",
        Domain::Vertex,
        &[(0, "mesh"), (2, "vertices"), (3, "hash_slots"), (5, "failure_count")],
    )),
    Pass::Run(run(
        &WELD,
        "look_up",
        Domain::Vertex,
        &[(0, "mesh"), (2, "vertices"), (3, "hash_slots"), (4, "welded_vertex"), (5, "failure_count")],
    )),
];

/// The welded vertices of corners, and which triangles are degenerate.
const CORNER_PASSES: &[Pass] = &[Pass::Run(run(
    &WELD_CORNERS,
    "weld_corners",
    Domain::Triangle,
    &[(0, "mesh"), (1, "indices"), (2, "vertices"), (3, "welded_vertex"), (4, "vertex_of_corner")],
))];

/// The triangles at each vertex, ascending: a counting sort, and then a sort of each range by rank.
pub(crate) const ADJACENCY_PASSES: &[Pass] = &[
    Pass::Clear("adjacency_ends"),
    Pass::Run(run(
        &ADJACENCY,
        "count",
        Domain::Corner,
        &[(0, "mesh"), (1, "vertex_of_corner"), (2, "adjacency_ends")],
    )),
    Pass::Scan("adjacency_ends", Domain::Vertex),
    Pass::Run(run(
        &ADJACENCY,
        "scatter",
        Domain::Corner,
        &[(0, "mesh"), (1, "vertex_of_corner"), (2, "adjacency_ends"), (3, "adjacent_corners")],
    )),
    Pass::Run(run(
        &ADJACENCY,
        "rank",
        Domain::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (2, "adjacency_ends"),
            (3, "adjacent_corners"),
            (4, "adjacent_triangles"),
        ],
    )),
];

/// The neighbours of every triangle.
const NEIGHBOUR_PASSES: &[Pass] = &[Pass::Run(run(
    &NEIGHBOURS,
    "find_neighbours",
    Domain::Corner,
    &[
        (0, "mesh"),
        (1, "vertex_of_corner"),
        (2, "adjacency_ends"),
        (3, "adjacent_triangles"),
        (4, "neighbours"),
        (5, "is_deferred"),
    ],
))];

/// The buffers of both kernels that defer listed items to the CPU.
const DEFER_BUFFERS: &[(u32, &str)] = &[(0, "mesh"), (1, "vertex_of_corner"), (2, "is_deferred")];
const UNSURE_TRIANGLES: Run = run(&DEFER_TRIANGLES, "every_item", Domain::Triangle, DEFER_BUFFERS);
const UNSURE_CORNERS: Run = run(&DEFER_CORNERS, "every_item", Domain::Corner, DEFER_BUFFERS);

/// The derivatives and the flags of every triangle.
pub(crate) const DERIVATIVE_PASSES: &[Pass] = &[Pass::RunExact(
    run(
        &DERIVATIVES,
        "every_item",
        Domain::Triangle,
        &[(0, "mesh"), (1, "vertex_of_corner"), (2, "vertices"), (3, "derivatives"), (4, "triangle_flags")],
    ),
    UNSURE_TRIANGLES,
)];

/// The groups of corners that share a tangent.
const GROUP_PASSES: &[Pass] = &[
    Pass::Run(run(
        &GROUPS,
        "defer_vertices",
        Domain::Corner,
        &[(0, "mesh"), (1, "vertex_of_corner"), (3, "triangle_flags"), (6, "is_deferred")],
    )),
    Pass::Run(run(
        &GROUPS,
        "find_groups",
        Domain::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (2, "adjacency_ends"),
            (3, "triangle_flags"),
            (4, "neighbours"),
            (5, "seed_of_corner"),
            (6, "is_deferred"),
        ],
    )),
];

/// The frame of every corner.
pub(crate) const FRAME_PASSES: &[Pass] = &[
    Pass::RunExact(
        run(
            &CORNER_TERMS,
            "every_item",
            Domain::Triangle,
            &[
                (0, "mesh"),
                (1, "vertex_of_corner"),
                (2, "vertices"),
                (3, "derivatives"),
                (4, "triangle_flags"),
                (5, "corner_terms"),
            ],
        ),
        UNSURE_TRIANGLES,
    ),
    Pass::RunExact(
        run(
            &EVALUATE,
            "every_item",
            Domain::Corner,
            &[
                (0, "evaluation"),
                (1, "adjacent_triangles"),
                (2, "adjacency_ends"),
                (3, "vertex_of_corner"),
                (4, "seed_of_corner"),
                (5, "derivatives"),
                (6, "corner_terms"),
                (7, "frames"),
            ],
        ),
        UNSURE_CORNERS,
    ),
];

/// The tangents of corners, without those of deferred vertices.
const TANGENT_PASSES: &[Pass] = &[
    Pass::Run(run(
        &WRITE_TANGENTS,
        "check_frames",
        Domain::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (2, "adjacency_ends"),
            (3, "frames"),
            (4, "vertices"),
            (5, "adjacent_triangles"),
            (7, "is_deferred"),
        ],
    )),
    Pass::Run(run(
        &WRITE_TANGENTS,
        "store_tangents",
        Domain::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (3, "frames"),
            (6, "triangle_flags"),
            (7, "is_deferred"),
            (8, "tangent_of_corner"),
        ],
    )),
];

/// All passes from welded vertices to the tangents of corners.
pub(crate) fn triangle_passes() -> Vec<Pass> {
    [
        CORNER_PASSES,
        ADJACENCY_PASSES,
        NEIGHBOUR_PASSES,
        DERIVATIVE_PASSES,
        GROUP_PASSES,
        FRAME_PASSES,
        TANGENT_PASSES,
    ]
    .concat()
}
