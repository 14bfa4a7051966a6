//! The rows of docs/functions.md.

/// One function, with its names in each language. Empty: the language does not have it.
pub struct Row {
    pub what: &'static str,
    pub rust: &'static [&'static str],
    pub c: &'static [&'static str],
    pub cpp: &'static [&'static str],
    pub python: &'static [&'static str],
    pub js: &'static [&'static str],
    pub command: &'static [&'static str],
}

impl Row {
    /// The names, in the order of the columns.
    pub fn cells(&self) -> [&'static [&'static str]; 6] {
        [self.rust, self.c, self.cpp, self.python, self.js, self.command]
    }
}

/// Rows with their columns in order: `what: rust; c; cpp; python; js; command`.
macro_rules! rows {
    ($($what:literal: $rust:expr; $c:expr; $cpp:expr; $python:expr; $js:expr; $command:expr,)*) => {
        &[$(Row { what: $what, rust: &$rust, c: &$c, cpp: &$cpp, python: &$python, js: &$js, command: &$command },)*]
    };
}

/// All rows by heading.
pub const GROUPS: &[(&str, &[Row])] = &[
    (
        "Meshes",
        rows![
            "tangents of corners":
                ["generate_tangents", "write_tangents"]; ["darboux_generate_tangents"]; ["generate_tangents"];
                ["generate_tangents"]; ["generateTangents", "tangents:generateTangents"]; ["darboux tangents"],
            "frames of corners, with bitangents and magnitudes":
                ["generate_frames", "write_frames"]; ["darboux_generate_frames"]; ["generate_frames"];
                ["generate_tangents"]; ["generateFrames"]; [],
            "split vertices by tangents":
                ["split_vertices", "Splitter::finish"]; ["darboux_split_vertices"]; ["split_vertices"];
                ["split_vertices"]; ["splitVertices"]; ["darboux tangents"],
            "tangents into the caller's vertices, split":
                []; []; ["add_tangents"]; []; []; [],
            "normals of corners":
                ["generate_normals"]; ["darboux_generate_normals"]; ["generate_normals"];
                ["generate_normals"]; ["generateNormals"]; ["darboux normals"],
            "split vertices by normals":
                ["split_normals"]; ["darboux_split_normals"]; ["split_normals"];
                ["split_normals"]; ["splitNormals"]; ["darboux normals"],
            "plan of a mesh that moves":
                ["Plan::new"]; ["darboux_plan_create"]; ["plan"]; ["Plan"]; ["Plan"]; [],
            "tangents of the mesh that moved":
                ["Plan::evaluate"]; ["darboux_plan_evaluate"]; ["evaluate"]; ["Plan.evaluate"]; ["Plan.evaluate"]; [],
            "tangents of the plan's own mesh":
                ["Plan::base"]; ["darboux_plan_base"]; ["base"]; ["Plan.base"]; ["Plan.base"]; [],
            "count vertices whose groups a movement changes":
                ["Plan::count_regrouped"]; ["darboux_plan_count_regrouped"]; ["count_regrouped"];
                ["Plan.count_regrouped"]; ["Plan.countRegrouped"]; [],
        ],
    ),
    (
        "Matrices and conventions",
        rows![
            "frames under a matrix":
                ["Transform::frame"]; ["darboux_transform_frames"]; ["transform_frames"];
                ["transform_frames"]; ["transformFrames"]; [],
            "frames under a skin":
                ["Transform::blended"]; ["darboux_skin_frames"]; ["skin_frames"]; ["skin_frames"]; ["skinFrames"]; [],
            "convention of a program, or with changes":
                ["Convention::from_str", "Convention::PRESETS"]; ["darboux_convention_of"]; ["convention_of"];
                ["CONVENTIONS"]; ["CONVENTIONS"]; ["darboux convert"],
            "convention of generated tangents":
                ["Convention::generated"]; ["darboux_convention_generated"]; ["generated"]; ["convert"]; ["convert"]; [],
            "convert positions, normals and offsets":
                ["Conversion::vector"]; ["darboux_convert_vectors"]; ["vectors"]; ["convert"]; ["convert"]; [],
            "convert tangents":
                ["Conversion::tangent"]; ["darboux_convert_tangents"]; ["tangents"]; ["convert"]; ["convert"]; [],
            "convert UVs":
                ["Conversion::uv"]; ["darboux_convert_uvs"]; ["uvs"]; ["convert"]; ["convert"]; [],
            "convert the winding of faces":
                ["Conversion::face"]; ["darboux_convert_faces"]; ["faces"]; ["convert"]; ["convert"]; [],
            "channels of normal maps to invert":
                ["Conversion::inverts_red", "Conversion::inverts_green"]; ["darboux_convert_channels"]; ["channels"];
                ["convert"]; ["convert"]; [],
            "convert the texels of a normal map":
                ["Conversion::texels"]; []; []; ["convert_texels"]; ["convertTexels"]; ["darboux convert"],
            "convert a file":
                ["darboux_io::gltf::convert_vertices", "darboux_io::image::convert_normal_map"]; []; [];
                ["Document.convert"]; ["check:convertFile"]; ["darboux convert"],
        ],
    ),
    (
        "Encodings",
        rows![
            "encode tangents":
                ["encode::tangent_to_snorm8", "encode::tangent_to_snorm10", "encode::tangent_to_snorm16",
                    "encode::tangent_to_octahedral", "encode::tangent_to_diamond"];
                ["darboux_encode_tangents"]; ["encode_tangents"];
                ["encode.tangent_to_snorm8", "encode.tangent_to_snorm10", "encode.tangent_to_snorm16",
                    "encode.tangent_to_octahedral", "encode.tangent_to_diamond"];
                ["encodeTangents"]; ["darboux tangents"],
            "decode tangents":
                ["encode::tangent_from_snorm8", "encode::tangent_from_snorm10", "encode::tangent_from_snorm16",
                    "encode::tangent_from_octahedral", "encode::tangent_from_diamond"];
                ["darboux_decode_tangents"]; ["decode_tangents"];
                ["encode.tangent_from_snorm8", "encode.tangent_from_snorm10", "encode.tangent_from_snorm16",
                    "encode.tangent_from_octahedral", "encode.tangent_from_diamond"];
                ["decodeTangents"]; [],
            "encode and decode normals":
                ["encode::normal_to_octahedral", "encode::normal_from_octahedral"];
                ["darboux_encode_normals", "darboux_decode_normals"]; ["encode_normals", "decode_normals"];
                ["encode.normal_to_octahedral", "encode.normal_from_octahedral"]; []; [],
            "encode and decode whole frames":
                ["encode::frame_to_quaternion", "encode::frame_from_quaternion"];
                ["darboux_encode_frames", "darboux_decode_frames"]; ["encode_frames", "decode_frames"];
                ["encode.frame_to_quaternion", "encode.frame_from_quaternion"]; []; [],
        ],
    ),
    (
        "Measures and judgements",
        rows![
            "compare tangents":
                ["measure_tangents"]; ["darboux_measure_tangents"]; ["measure_tangents"];
                ["measure_tangents"]; ["measureTangents"]; ["darboux compare"],
            "compare tangents with the UVs":
                ["measure_uv_fidelity"]; ["darboux_measure_uv_fidelity"]; ["measure_uv_fidelity"];
                ["measure_uv_fidelity"]; ["measureUvFidelity"]; [],
            "recognise how tangents were computed":
                ["recognise_recipe"]; ["darboux_recognise_recipe"]; ["recognise_recipe"];
                ["recognise_recipe"]; ["check:recogniseRecipe"]; ["darboux compare"],
            "judge a normal map":
                ["judge_normal_map"]; ["darboux_judge_normal_map"]; ["judge_normal_map"];
                ["judge_normal_map"]; ["check:judgeNormalMap"]; ["darboux check"],
            "find what is wrong in a file":
                ["darboux_check::check_document", "darboux_check::check_map"]; []; []; ["check"]; ["check:check"];
                ["darboux check"],
            "repair a file":
                ["darboux_check::fix_document", "darboux_check::fix_map"]; []; []; ["fix"]; ["check:fix"]; ["darboux check"],
        ],
    ),
    (
        "Files",
        rows![
            "read": ["darboux_io::gltf::Document::open"]; []; []; ["load", "loads"]; []; [],
            "write": ["darboux_io::gltf::Document::save"]; []; []; ["save", "dumps"]; []; [],
            "add tangents": ["darboux_io::gltf::add_tangents"]; []; []; ["Document.add_tangents"];
                ["gltf-transform:tangents"]; ["darboux tangents"],
            "add normals": ["darboux_io::gltf::add_normals"]; []; []; ["Document.add_normals"]; []; ["darboux normals"],
            "describe": ["darboux_io::gltf::inspect"]; []; []; ["Document.inspect"]; []; ["darboux inspect"],
            "many files": []; []; []; ["batch", "process", "bake_job"]; []; ["darboux tangents"],
            "bake surfaces": ["darboux_bake::bake"]; []; []; ["bake"]; ["bake:bake"]; [],
            "bake models": ["darboux_bake::Models::surfaces"]; []; []; ["bake_models"];
                ["bake:bakeModels"]; ["darboux bake"],
            "several bakes of the same models": ["darboux_bake::PreparedSurfaces::new"]; []; []; [];
                ["bake:PreparedModels"]; [],
            "errors of a baked map in degrees": ["darboux_bake::verify"]; []; []; ["verify"];
                ["bake:verify", "bake:verifyModels"]; ["darboux bake"],
            "a cage that is made": ["darboux_bake::auto_cage", "darboux_bake::RayOrigin::cages"]; []; []; ["auto_cage", "bake_models"]; ["bake:bakeModels"]; ["darboux bake"],
            "UDIM tiles": ["darboux_bake::udims_of"]; []; []; ["udim_tiles"];
                ["bake:udimTiles", "bake:udimTilesOfModel"]; ["darboux bake"],
            "object-space maps to tangent space, and back": ["darboux_bake::convert_space"]; []; [];
                ["convert_space"]; ["bake:convertSpace", "bake:convertSpaceOfModel"];
                ["darboux convert"],
            "draw": ["darboux_render::render"]; []; []; []; []; ["darboux render"],
        ],
    ),
    (
        "GPU",
        rows![
            "tangents of corners": ["darboux_gpu::MikkTSpace::generate_tangents"]; []; []; [];
                ["webgpu:generateTangents"]; ["darboux tangents"],
            "mean or sum of the tangents of the triangles around a vertex": ["darboux_gpu::Average::of_mesh"]; []; []; [];
                ["webgpu:Average.ofMesh"]; [],
            "plan of a mesh that moves": ["darboux_gpu::Planner::plan"]; []; []; []; ["planTopology", "webgpu:Planner"]; [],
            "split vertices": ["darboux_gpu::Splitter::split_vertices"]; []; []; []; []; [],
        ],
    ),
    (
        "Calls",
        rows![
            "reused memory, threads": ["Context"]; ["darboux_context_create", "darboux_context_free"]; ["context"]; []; []; [],
            "cancel a call": ["Cancel::cancel"]; ["darboux_context_cancel", "darboux_context_resume"]; ["cancel", "resume"];
                []; []; [],
            "the library is loaded": []; []; []; []; ["ready", "bake:ready", "check:ready", "tangents:ready"]; [],
            "the last error": []; ["darboux_last_error"]; ["error"]; []; []; [],
            "the library's memory and version": []; ["darboux_set_allocator", "darboux_version"]; []; []; []; [],
            "free results": [];
                ["darboux_plan_free", "darboux_vertex_split_free", "darboux_normal_split_free"]; []; []; []; [],
            "adapters of other packages": []; []; []; [];
                ["three:computeTangents", "mikktspace:generateTangents", "gltf-transform:tangents"]; [],
        ],
    ),
];

/// Public names that no row needs: parts of other functions.
pub const OUTSIDE: &[&str] = &[
    "gpuResume",
    "three:isReady",
    "three:dispose",
    "three:ready",
    "three:generateTangents",
    "mikktspace:isReady",
    "mikktspace:dispose",
    "mikktspace:ready",
    "webgpu:shaders",
    "webgpu:openDevice",
    "webgpu:AverageOfMesh",
    "webgpu:Average",
    "webgpu:GpuPlan",
    "webgpu:BoundPlan",
    "Document",
    "bake:TEXEL_STATES",
];
