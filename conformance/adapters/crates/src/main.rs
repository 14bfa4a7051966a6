//! The crates that compute MikkTSpace.

#[path = "../../../readers/case.rs"]
mod case;

use case::{Case, Found, run};

/// A case and the tangents that an implementation has set.
struct Callbacks<'a>(&'a Case, Vec<[f32; 4]>);

macro_rules! read {
    ($faces:ident, $corners:ident, $position:ident, $normal:ident, $uv:ident) => {
        fn $faces(&self) -> usize {
            self.0.faces.len()
        }

        fn $corners(&self, face: usize) -> usize {
            self.0.faces[face]
        }

        fn $position(&self, face: usize, corner: usize) -> [f32; 3] {
            self.0.positions[self.0.vertex(face, corner)]
        }

        fn $normal(&self, face: usize, corner: usize) -> [f32; 3] {
            self.0.normals[self.0.vertex(face, corner)]
        }

        fn $uv(&self, face: usize, corner: usize) -> [f32; 2] {
            self.0.uvs[self.0.vertex(face, corner)]
        }
    };
}

impl mikktspace_sys::MikkTSpaceInterface for Callbacks<'_> {
    read!(get_num_faces, get_num_vertices_of_face, get_position, get_normal, get_tex_coord);

    fn set_tspace_basic(&mut self, [x, y, z]: [f32; 3], sign: f32, face: usize, corner: usize) {
        self.1[self.0.first_corners[face] + corner] = [x, y, z, sign];
    }
}

impl mikktspace::Geometry for Callbacks<'_> {
    read!(num_faces, num_vertices_of_face, position, normal, tex_coord);

    fn set_tangent_encoded(&mut self, tangent: [f32; 4], face: usize, corner: usize) {
        self.1[self.0.first_corners[face] + corner] = tangent;
    }
}

impl bevy_mikktspace::Geometry for Callbacks<'_> {
    read!(num_faces, num_vertices_of_face, position, normal, tex_coord);

    fn set_tangent(&mut self, space: Option<bevy_mikktspace::TangentSpace>, face: usize, corner: usize) {
        self.1[self.0.first_corners[face] + corner] = space.unwrap_or_default().tangent_encoded();
    }
}

/// Runs an implementation that reads callbacks.
fn with_callbacks(case: &Case, compute: impl FnOnce(&mut Callbacks)) -> Result<Found, String> {
    let mut callbacks = Callbacks(case, case.defaults());
    compute(&mut callbacks);
    Ok(Found::PerCorner(callbacks.1))
}

fn meshopt(case: &Case, options: meshopt::TangentOptions) -> Result<Found, String> {
    if !case.is_triangles() {
        return Err("triangles only".into());
    }
    only_180(case)?;
    let found =
        meshopt::generate_tangents(Some(&case.indices), &case.positions, &case.normals, &case.uvs, options);
    Ok(Found::PerCorner(found))
}

fn only_180(case: &Case) -> Result<(), String> {
    if case.threshold == 180.0 { Ok(()) } else { Err("no angular threshold".into()) }
}

fn main() {
    run(|case| match std::env::args().nth(1).unwrap_or_default().as_str() {
        "mikktspace.c" => with_callbacks(case, |callbacks| {
            mikktspace_sys::gen_tang_space(callbacks, case.threshold);
        }),
        "mikktspace" => only_180(case).and_then(|()| {
            with_callbacks(case, |callbacks| {
                mikktspace::generate_tangents(callbacks);
            })
        }),
        "bevy_mikktspace" => only_180(case).and_then(|()| {
            with_callbacks(case, |callbacks| {
                let _ = bevy_mikktspace::generate_tangents(callbacks);
            })
        }),
        "meshopt" => meshopt(case, meshopt::TangentOptions::None),
        "meshopt-compatible" => meshopt(case, meshopt::TangentOptions::Compatible),
        other => panic!("{other} is not an implementation"),
    });
}
