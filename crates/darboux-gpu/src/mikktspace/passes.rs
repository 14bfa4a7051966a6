//! The passes of MikkTSpace as data: the one list for [`crate::mikktspace::program`] and for the packages of other languages, which read it from
//! `shaders/passes.json` and the kernels' files from `shaders/mikktspace.json`.
//!
//! Who runs them brings the buffers `mesh` (the shaders' `Mesh`), `evaluation` (the words of the shaders' `Evaluation`), `vertices` (as
//! `mesh` describes them) and `indices` (three per triangle). All others are in [`BUFFERS`].

/// What there is a thread or a number of words for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Each {
    /// There is one.
    Mesh,
    Vertex,
    /// Of the hash table of vertices: a power of two, at least twice their number.
    Slot,
    Triangle,
    Corner,
}

/// A shader: files that are read one after the other.
#[derive(Debug)]
pub(crate) struct Kernel {
    pub name: &'static str,
    /// Of kernels of exact arithmetic their own ([`crate::device::precision::files`]).
    pub files: &'static [&'static str],
}

/// An entry point of a kernel with its buffers, by binding.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Run {
    pub kernel: &'static Kernel,
    pub entry: &'static str,
    pub each: Each,
    pub buffers: &'static [(u32, &'static str)],
}

/// What happens before the next may begin.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Pass {
    /// Makes a buffer's words zeros.
    Clear(&'static str),
    /// Makes every value the sum of those before it; of each there is one.
    Scan(&'static str, Each),
    Run(Run),
    /// A kernel of exact arithmetic, which lists what it is unsure of; that is done again in whole numbers, or left to the CPU as the second
    /// says. The list is bound at [`crate::device::precision::LIST`].
    Real(Run, Run),
}

/// Buffers that passes make: words for each.
pub(crate) const BUFFERS: &[(&str, Each, u32)] = &[
    // Vertices that only the CPU can weld.
    ("refused", Each::Mesh, 1),
    ("slots", Each::Slot, 1),
    // The first vertex that equals each.
    ("welded", Each::Vertex, 1),
    // 1 where the CPU has to decide. Passes add to them.
    ("is_left", Each::Vertex, 1),
    // Welded; all ones at degenerate triangles.
    ("vertex_of_corner", Each::Corner, 1),
    // Where the triangles of each vertex end in the next two.
    ("ends", Each::Vertex, 1),
    ("corner_of_entry", Each::Corner, 1),
    ("triangle_of_entry", Each::Corner, 1),
    // Across the edges 0-1, 1-2, 2-0; all ones without one.
    ("neighbours", Each::Corner, 1),
    // dP/du, dP/dv, their lengths.
    ("derivatives", Each::Triangle, 8),
    // 1 where a triangle keeps its orientation, 2 where it is UV-degenerate.
    ("marks", Each::Triangle, 1),
    // The first corner of each corner's group; all ones without one.
    ("seed_of_corner", Each::Corner, 1),
    ("wedges", Each::Corner, 8),
    // Tangent, bitangent, magnitudes.
    ("frames", Each::Corner, 8),
    // Tangent and sign; signs of zero where the CPU has to decide.
    ("tangent_of_corner", Each::Corner, 4),
];

const MESH: &str = include_str!("../../shaders/device/mesh.wgsl");
const WORDS: &str = include_str!("../../shaders/mikktspace/float_bits.wgsl");
const COMMON: &str = include_str!("../../shaders/mikktspace/common.wgsl");
const AROUND: &str = include_str!("../../shaders/mikktspace/adjacency_lookup.wgsl");
const WELDED: &str = include_str!("../../shaders/mikktspace/welded_mesh.wgsl");
const LEAVE: &str = include_str!("../../shaders/mikktspace/defer_to_cpu.wgsl");
const LISTED: &str = include_str!("../../shaders/precision/dispatch_listed.wgsl");

const WELD: Kernel = Kernel {
    name: "weld",
    files: &[MESH, WORDS, COMMON, include_str!("../../shaders/mikktspace/weld.wgsl")],
};
const TRIANGULATE: Kernel = Kernel {
    name: "triangulate",
    files: &[MESH, WORDS, COMMON, include_str!("../../shaders/mikktspace/weld_corners.wgsl")],
};
const ADJACENCY: Kernel =
    Kernel { name: "adjacency", files: &[MESH, include_str!("../../shaders/mikktspace/adjacency.wgsl")] };
const NEIGHBOURS: Kernel = Kernel {
    name: "neighbours",
    files: &[MESH, COMMON, AROUND, include_str!("../../shaders/mikktspace/neighbours.wgsl")],
};
const GROUPS: Kernel = Kernel {
    name: "groups",
    files: &[MESH, COMMON, AROUND, include_str!("../../shaders/mikktspace/groups.wgsl")],
};
const FINISH: Kernel = Kernel {
    name: "finish",
    files: &[MESH, COMMON, AROUND, include_str!("../../shaders/mikktspace/write_tangents.wgsl")],
};
pub(crate) const DERIVATIVES: Kernel = Kernel {
    name: "derivatives",
    files: &[
        MESH,
        WELDED,
        include_str!("../../shaders/mikktspace/derivative.wgsl"),
        include_str!("../../shaders/mikktspace/derivatives.wgsl"),
    ],
};
pub(crate) const WEDGES: Kernel = Kernel {
    name: "wedges",
    files: &[
        MESH,
        WELDED,
        include_str!("../../shaders/mikktspace/corner_angle.wgsl"),
        include_str!("../../shaders/mikktspace/corner_terms.wgsl"),
    ],
};
pub(crate) const EVALUATE: Kernel =
    Kernel { name: "evaluate", files: &[include_str!("../../shaders/mikktspace/evaluate.wgsl")] };
const LEAVE_TRIANGLES: Kernel =
    Kernel { name: "leave_triangles", files: &[MESH, "const CORNERS_OF_ITEM: u32 = 3u;", LEAVE, LISTED] };
const LEAVE_CORNERS: Kernel =
    Kernel { name: "leave_corners", files: &[MESH, "const CORNERS_OF_ITEM: u32 = 1u;", LEAVE, LISTED] };

const fn run(
    kernel: &'static Kernel,
    entry: &'static str,
    each: Each,
    buffers: &'static [(u32, &'static str)],
) -> Run {
    Run { kernel, entry, each, buffers }
}

/// Which vertices are one. `mesh` need not know of triangles.
pub(crate) const OF_VERTICES: &[Pass] = &[
    Pass::Clear("refused"),
    Pass::Clear("slots"),
    Pass::Run(run(
        &WELD,
        "weld",
        Each::Vertex,
        &[(0, "mesh"), (2, "vertices"), (3, "slots"), (5, "refused")],
    )),
    Pass::Run(run(
        &WELD,
        "look_up",
        Each::Vertex,
        &[(0, "mesh"), (2, "vertices"), (3, "slots"), (4, "welded"), (5, "refused")],
    )),
];

const SET_ASIDE: &[Pass] = &[Pass::Run(run(
    &TRIANGULATE,
    "triangulate",
    Each::Triangle,
    &[(0, "mesh"), (1, "indices"), (2, "vertices"), (3, "welded"), (4, "vertex_of_corner")],
))];

/// The triangles at each vertex, ascending: counted, a prefix sum, scattered, ranked.
pub(crate) const OF_ADJACENCY: &[Pass] = &[
    Pass::Clear("ends"),
    Pass::Run(run(&ADJACENCY, "count", Each::Corner, &[(0, "mesh"), (1, "vertex_of_corner"), (2, "ends")])),
    Pass::Scan("ends", Each::Vertex),
    Pass::Run(run(
        &ADJACENCY,
        "scatter",
        Each::Corner,
        &[(0, "mesh"), (1, "vertex_of_corner"), (2, "ends"), (3, "corner_of_entry")],
    )),
    Pass::Run(run(
        &ADJACENCY,
        "rank",
        Each::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (2, "ends"),
            (3, "corner_of_entry"),
            (4, "triangle_of_entry"),
        ],
    )),
];

const OF_EDGES: &[Pass] = &[Pass::Run(run(
    &NEIGHBOURS,
    "find_neighbours",
    Each::Corner,
    &[
        (0, "mesh"),
        (1, "vertex_of_corner"),
        (2, "ends"),
        (3, "triangle_of_entry"),
        (4, "neighbours"),
        (5, "is_left"),
    ],
))];

/// The buffers of both kernels that leave what is listed.
const LEAVING: &[(u32, &str)] = &[(0, "mesh"), (1, "vertex_of_corner"), (2, "is_left")];
const UNSURE_TRIANGLES: Run = run(&LEAVE_TRIANGLES, "every_item", Each::Triangle, LEAVING);
const UNSURE_CORNERS: Run = run(&LEAVE_CORNERS, "every_item", Each::Corner, LEAVING);

/// The derivatives of every triangle, and its marks.
pub(crate) const OF_DERIVATIVES: &[Pass] = &[Pass::Real(
    run(
        &DERIVATIVES,
        "every_item",
        Each::Triangle,
        &[(0, "mesh"), (1, "vertex_of_corner"), (2, "vertices"), (3, "derivatives"), (4, "marks")],
    ),
    UNSURE_TRIANGLES,
)];

const OF_GROUPS: &[Pass] = &[
    Pass::Run(run(
        &GROUPS,
        "leave_vertices",
        Each::Corner,
        &[(0, "mesh"), (1, "vertex_of_corner"), (3, "marks"), (6, "is_left")],
    )),
    Pass::Run(run(
        &GROUPS,
        "find_groups",
        Each::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (2, "ends"),
            (3, "marks"),
            (4, "neighbours"),
            (5, "seed_of_corner"),
            (6, "is_left"),
        ],
    )),
];

/// The frame of every corner.
pub(crate) const OF_FRAMES: &[Pass] = &[
    Pass::Real(
        run(
            &WEDGES,
            "every_item",
            Each::Triangle,
            &[
                (0, "mesh"),
                (1, "vertex_of_corner"),
                (2, "vertices"),
                (3, "derivatives"),
                (4, "marks"),
                (5, "wedges"),
            ],
        ),
        UNSURE_TRIANGLES,
    ),
    Pass::Real(
        run(
            &EVALUATE,
            "every_item",
            Each::Corner,
            &[
                (0, "evaluation"),
                (1, "triangle_of_entry"),
                (2, "ends"),
                (3, "vertex_of_corner"),
                (4, "seed_of_corner"),
                (5, "derivatives"),
                (6, "wedges"),
                (7, "frames"),
            ],
        ),
        UNSURE_CORNERS,
    ),
];

const OF_TANGENTS: &[Pass] = &[
    Pass::Run(run(
        &FINISH,
        "check_frames",
        Each::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (2, "ends"),
            (3, "frames"),
            (4, "vertices"),
            (5, "triangle_of_entry"),
            (7, "is_left"),
        ],
    )),
    Pass::Run(run(
        &FINISH,
        "store_tangents",
        Each::Corner,
        &[
            (0, "mesh"),
            (1, "vertex_of_corner"),
            (3, "frames"),
            (6, "marks"),
            (7, "is_left"),
            (8, "tangent_of_corner"),
        ],
    )),
];

/// From welded vertices to the tangents of corners.
pub(crate) fn of_triangles() -> Vec<Pass> {
    [SET_ASIDE, OF_ADJACENCY, OF_EDGES, OF_DERIVATIVES, OF_GROUPS, OF_FRAMES, OF_TANGENTS].concat()
}
