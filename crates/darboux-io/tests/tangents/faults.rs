//! Data that is refused, and many primitives on many threads.

use darboux::{Context, Mesh, MikkTSpaceOptions, Mode, TangentOptions, generate_tangents_with};
use darboux_io::LoadOptions;
use darboux_io::gltf::{AddTangentsOptions, Document, Generate, Progress, add_tangents, add_tangents_with};
use serde_json::json;

use crate::support::*;

#[test]
fn strict_refuses_data_that_the_default_repairs() {
    let strict = AddTangentsOptions::default().with_strict(true);
    let build = |vertices: &Vertices| {
        let mut builder = Builder::new();
        let attributes = vertices.attributes(&mut builder);
        let indices = builder.indices(&SQUARE);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        builder.build()
    };
    let error = |vertices: &Vertices| {
        run(&mut build(vertices));
        add_tangents(&mut build(vertices), &strict, &mut |_| {}).err().map(|error| error.to_string())
    };
    assert_eq!(error(&square()), None);
    let mut infinite = square();
    infinite.uvs[1] = [f32::INFINITY, 0.0];
    let sentence = "test.gltf: meshes[0].primitives[0]: 1 corners have a position, normal or UV that is not finite; \
                    repair the model, or run without strict";
    assert_eq!(error(&infinite).as_deref(), Some(sentence));
    let mut collapsed = square();
    collapsed.normals = vec![[1.0, 0.0, 0.0]; 4];
    collapsed.uvs = vec![[0.5, 0.5]; 4];
    assert!(error(&collapsed).unwrap().contains("no usable tangent"));
}

/// Of primitives that get no tangents, too.
#[test]
fn strict_refuses_data_of_skipped_primitives() {
    let strict = AddTangentsOptions::default().with_strict(true);
    let error = |change: &dyn Fn(&mut Vertices)| {
        let mut vertices = square();
        change(&mut vertices);
        let mut builder = Builder::new();
        let mut attributes = json!(vertices.attributes(&mut builder));
        attributes.as_object_mut().unwrap().remove("NORMAL");
        let indices = builder.indices(&SQUARE);
        builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
        let mut document = builder.build();
        add_tangents(&mut document, &strict, &mut |_| {}).err().map(|error| error.to_string())
    };
    assert_eq!(error(&|_| {}), None);
    let sentence = "test.gltf: meshes[0].primitives[0]: has 1 value that is not finite in TEXCOORD_0; \
                    repair the model, or run without strict";
    assert_eq!(error(&|vertices| vertices.uvs[1] = [f32::NAN, 0.0]).as_deref(), Some(sentence));
    assert!(error(&|vertices| vertices.positions[0][2] = f32::INFINITY).is_some());
}

#[test]
fn unusable_tangents_of_the_reference_are_named() {
    let mut vertices = square();
    vertices.normals = vec![[1.0, 0.0, 0.0]; 4];
    vertices.uvs = vec![[0.5, 0.5]; 4];
    let mut builder = Builder::new();
    let attributes = vertices.attributes(&mut builder);
    let indices = builder.indices(&SQUARE);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let tangents = TangentOptions::from(MikkTSpaceOptions::new().with_mode(Mode::Reference));
    let summary = run_with(&mut builder.build(), &AddTangentsOptions::default().with_tangents(tangents));
    assert!(summary.warnings[0].contains("unusable tangent"), "{:?}", summary.warnings);
}

#[test]
fn broken_primitives_are_errors_that_name_them() {
    let error = |change: fn(&mut Builder, &mut serde_json::Value)| {
        let mut builder = Builder::new();
        let attributes = square().attributes(&mut builder);
        let mut primitive = json!({"attributes": attributes, "indices": builder.indices(&SQUARE)});
        change(&mut builder, &mut primitive);
        builder.mesh(&[primitive]);
        let result = builder.read(&LoadOptions::default()).and_then(|mut document| {
            add_tangents(&mut document, &AddTangentsOptions::default(), &mut |_| {})
        });
        result.unwrap_err().to_string()
    };
    let out_of_range = error(|builder, primitive| primitive["indices"] = builder.indices(&[0, 1, 4]).into());
    assert!(
        out_of_range.starts_with("test.gltf: meshes[0].primitives[0]: index 4 at place 2"),
        "{out_of_range}"
    );
    let short = error(|builder, primitive| {
        primitive["attributes"]["NORMAL"] = builder.vectors(&[[0.0, 0.0, 1.0]; 3]).into();
    });
    assert!(
        short.starts_with("test.gltf: meshes[0].primitives[0].attributes.NORMAL: has 3 elements"),
        "{short}"
    );
    let missing = error(|_, primitive| primitive["indices"] = 99.into());
    let sentence = "test.gltf: meshes[0].primitives[0].indices: accessor 99 does not exist: there are 4";
    assert!(missing.starts_with(sentence), "{missing}");
    let material = error(|_, primitive| primitive["material"] = 7.into());
    assert!(
        material.contains("primitives[0].material: material 7 does not exist: there are 0"),
        "{material}"
    );
    let mode = error(|_, primitive| primitive["mode"] = 9.into());
    assert!(mode.starts_with("test.gltf: meshes[0].primitives[0].mode: 9 is not a mode"), "{mode}");
    let wrong = error(|_, primitive| {
        primitive["attributes"]["TEXCOORD_0"] = primitive["attributes"]["NORMAL"].clone()
    });
    assert!(wrong.contains("accessors[1].type"), "{wrong}");
}

#[test]
fn attributes_of_another_length_are_errors() {
    let mut builder = Builder::new();
    let mut attributes = butterfly().attributes(&mut builder);
    attributes["COLOR_0"] = builder.vectors(&[[1.0; 3]; 5]).into();
    let indices = builder.indices(&BOTH);
    builder.mesh(&[json!({"attributes": attributes, "indices": indices})]);
    let error = builder.read(&LoadOptions::default()).unwrap_err();
    let sentence =
        "test.gltf: meshes[0].primitives[0].attributes.COLOR_0: has 5 elements but there are 6 positions";
    assert!(error.to_string().starts_with(sentence), "{error}");
}

#[test]
fn progress_counts_the_triangles_of_every_job() {
    let mut builder = Builder::new();
    let attributes = butterfly().attributes(&mut builder);
    let (left, both) = (builder.indices(&LEFT), builder.indices(&BOTH));
    builder.mesh(&[
        json!({"attributes": attributes, "indices": left}),
        json!({"attributes": attributes, "indices": both}),
        json!({"attributes": attributes, "indices": left}),
    ]);
    let mut steps = Vec::new();
    add_tangents(&mut builder.build(), &AddTangentsOptions::default(), &mut |step| steps.push(step)).unwrap();
    assert_eq!(steps, [Progress { done: 2, total: 6 }, Progress { done: 6, total: 6 }]);
}

/// A document of small primitives, a large one, and one with a morph target. `damaged`: primitives with a
/// normal that is not finite.
fn scene(damaged: &[usize]) -> Document {
    let mut builder = Builder::new();
    let large: Vec<u16> = BOTH.iter().copied().cycle().take(12 * 5_000).collect();
    for place in 0..40 {
        let mut vertices = butterfly();
        vertices.positions.iter_mut().for_each(|position| position[2] = position[0] * place as f32);
        vertices.normals[0][0] = if damaged.contains(&place) { f32::NAN } else { 0.0 };
        let attributes = vertices.attributes(&mut builder);
        let indices = builder.indices(if place == 17 { &large } else { &BOTH });
        let mut primitive = json!({"attributes": attributes, "indices": indices});
        if place == 23 {
            let offsets = vertices.positions.iter().map(|p| [0.0, p[0] * p[0], 0.0]).collect::<Vec<_>>();
            primitive["targets"] = json!([{"POSITION": builder.vectors(&offsets)}]);
        }
        builder.mesh(&[primitive]);
    }
    builder.build()
}

#[test]
fn small_primitives_on_many_threads_give_the_same_file() {
    let add = |context: &mut Context| {
        let (mut document, mut steps) = (scene(&[]), Vec::new());
        let mut progress = |step: Progress| steps.push(step);
        let options = AddTangentsOptions::default();
        let summary = add_tangents_with(&mut document, &options, context, Generate::OnCpu, &mut progress);
        let summary = summary.expect("valid data");
        assert_eq!(steps.last().map(|step| step.done), Some(39 * 4 + 20_000));
        (document.to_glb().expect("a document can be saved"), format!("{summary:?}"))
    };
    let alone = add(&mut Context::new().with_max_threads(1));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a thread pool");
    assert!(pool.install(|| add(&mut Context::new())) == alone);
    let one_by_one = {
        let (mut document, mut on_cpu) =
            (scene(&[]), |mesh: &Mesh<'_>, options: &TangentOptions, context: &mut Context| {
                generate_tangents_with(mesh, options, context).map_err(|error| error.to_string())
            });
        let generate = Generate::With(&mut on_cpu);
        let (options, context) = (AddTangentsOptions::default(), &mut Context::new());
        let summary = add_tangents_with(&mut document, &options, context, generate, &mut |_| {});
        (document.to_glb().expect("a document can be saved"), format!("{:?}", summary.expect("valid data")))
    };
    assert!(one_by_one == alone);
}

#[test]
fn the_first_of_several_faulty_primitives_is_the_error() {
    let error = |context: &mut Context| {
        let options = AddTangentsOptions::default().with_strict(true);
        let mut document = scene(&[30, 9, 12]);
        let added = add_tangents_with(&mut document, &options, context, Generate::OnCpu, &mut |_| {});
        added.expect_err("a normal is not finite").to_string()
    };
    let alone = error(&mut Context::new().with_max_threads(1));
    assert!(alone.contains("meshes[9]"), "{alone}");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().expect("a thread pool");
    assert_eq!(pool.install(|| error(&mut Context::new())), alone);
}
