//! The mistakes that are made in geometry and materials.

use std::collections::BTreeSet;

use darboux::Method;
use darboux_check::Code;

use super::models::Model;
use super::texels::texels_inside;

/// A mistake in a model.
pub struct Mistake {
    pub code: Code,
    /// How it was made.
    pub how: &'static str,
    /// Changes a healthy model; returns false where the mistake cannot be made on it.
    pub make: fn(&mut Model) -> bool,
}

/// All mistakes in geometry and materials.
pub const MISTAKES: &[Mistake] = &[
    Mistake {
        code: Code::TangentNotFinite,
        how: "one x set to NaN",
        make: |model| {
            model.tangents()[1][0] = f32::NAN;
            true
        },
    },
    Mistake {
        code: Code::TangentZero,
        how: "one tangent set to 0, 0, 0",
        make: |model| {
            model.tangents()[1] = [0.0, 0.0, 0.0, 1.0];
            true
        },
    },
    Mistake {
        code: Code::TangentNotUnit,
        how: "tangents scaled by 1.5",
        make: |model| {
            model.tangents().iter_mut().for_each(|tangent| (0..3).for_each(|i| tangent[i] *= 1.5));
            true
        },
    },
    Mistake {
        code: Code::TangentNotPerpendicular,
        how: "tangents leaned by 37 degrees",
        make: |model| {
            let normals = model.normals.clone().unwrap_or_default();
            for (tangent, normal) in model.tangents().iter_mut().zip(normals) {
                (0..3).for_each(|i| tangent[i] = 0.8 * tangent[i] + 0.6 * normal[i]);
            }
            true
        },
    },
    Mistake {
        code: Code::TangentSignNotOne,
        how: "w halved",
        make: |model| {
            model.tangents().iter_mut().for_each(|tangent| tangent[3] *= 0.5);
            true
        },
    },
    Mistake {
        code: Code::TangentSignMixed,
        how: "w of one vertex flipped",
        make: |model| {
            let middle = model.indices[model.indices.len() / 2] as usize;
            let tangent = &mut model.tangents()[middle];
            tangent[3] = -tangent[3];
            // On a smaller model one vertex is too large a part.
            model.positions.len() > 100
        },
    },
    Mistake {
        code: Code::TangentSharedAcrossMirror,
        how: "tangents of corners written through the unsplit index list",
        make: |model| {
            let Some((positions, normals, uvs, tangents, indices)) = model.unsplit.clone() else {
                return false;
            };
            (model.positions, model.normals, model.uvs) = (positions, Some(normals), uvs);
            (model.tangents, model.indices) = (Some(tangents), indices);
            true
        },
    },
    Mistake {
        code: Code::TangentSignFlipped,
        how: "w negated",
        make: |model| {
            model.negate_signs();
            true
        },
    },
    Mistake {
        code: Code::TangentSignFlippedWhereMirrored,
        how: "w set to 1",
        make: |model| {
            model.tangents().iter_mut().for_each(|tangent| tangent[3] = 1.0);
            model.unsplit.is_some()
        },
    },
    Mistake {
        code: Code::TangentSignPartlyFlipped,
        how: "w negated in the first 44 % of the triangles",
        make: |model| {
            let corners = model.indices.len() / 3 * 44 / 100 * 3;
            let damaged: BTreeSet<u32> = model.indices[..corners].iter().copied().collect();
            let tangents = model.tangents();
            damaged.into_iter().for_each(|vertex| tangents[vertex as usize][3] *= -1.0);
            // On a mirrored model the first triangles may be all that are mirrored.
            model.unsplit.is_none()
        },
    },
    Mistake {
        code: Code::TangentRotated,
        how: "bitangents stored",
        make: |model| {
            let normals = model.normals.clone().unwrap_or_default();
            for (tangent, [a, b, c]) in model.tangents().iter_mut().zip(normals) {
                let [x, y, z, w] = *tangent;
                *tangent = [w * (b * z - c * y), w * (c * x - a * z), w * (a * y - b * x), w];
            }
            true
        },
    },
    Mistake {
        code: Code::TangentNegated,
        how: "tangents negated",
        make: |model| {
            model.tangents().iter_mut().for_each(|tangent| (0..3).for_each(|i| tangent[i] = -tangent[i]));
            true
        },
    },
    Mistake {
        code: Code::TangentNegated,
        how: "one tangent negated",
        make: |model| {
            let middle = model.indices[model.indices.len() / 2] as usize;
            let tangent = &mut model.tangents()[middle];
            (0..3).for_each(|i| tangent[i] = -tangent[i]);
            true
        },
    },
    Mistake {
        code: Code::TangentOtherUvSet,
        how: "tangents of TEXCOORD_0, where the texture uses another set",
        make: |model| {
            if model.uv_set == 0 {
                return false;
            }
            let computed = model.computed(Method::default(), 0);
            for (tangent, [x, y, z, _]) in model.tangents().iter_mut().zip(computed) {
                *tangent = [x, y, z, tangent[3]];
            }
            true
        },
    },
    Mistake {
        code: Code::TangentOtherRecipe,
        how: "averages weighted by area",
        make: |model| {
            let computed = model.computed(Method::Area, model.uv_set);
            let of_mikktspace = model.tangents.clone().unwrap_or_default();
            let angle = |(a, b): (&[f32; 4], &[f32; 4])| (0..3).map(|i| a[i] * b[i]).sum::<f32>();
            let cosine = computed.iter().zip(&of_mikktspace).map(angle).fold(1.0, f32::min);
            model.tangents = Some(computed);
            // Half a degree is a difference that can be seen.
            cosine < 0.75f32.to_radians().cos()
        },
    },
    Mistake {
        code: Code::TangentMissing,
        how: "tangents removed",
        make: |model| {
            model.tangents = None;
            true
        },
    },
    Mistake {
        code: Code::TangentUnused,
        how: "normal map removed",
        make: |model| {
            model.has_normal_map = false;
            true
        },
    },
    Mistake {
        code: Code::PositionNotFinite,
        how: "one x set to NaN",
        make: |model| {
            model.positions[1][0] = f32::NAN;
            true
        },
    },
    Mistake {
        code: Code::NormalMissing,
        how: "normals removed",
        make: |model| {
            model.normals = None;
            true
        },
    },
    Mistake {
        code: Code::NormalNotFinite,
        how: "one z set to infinity",
        make: |model| {
            model.normals.iter_mut().for_each(|normals| normals[1][2] = f32::INFINITY);
            true
        },
    },
    Mistake {
        code: Code::NormalNotUnit,
        how: "normals halved",
        make: |model| {
            model.normals.iter_mut().flatten().for_each(|normal| *normal = normal.map(|x| 0.5 * x));
            true
        },
    },
    Mistake {
        code: Code::NormalAgainstWinding,
        how: "two corners of every face exchanged on a closed model",
        make: |model| {
            model.turn_faces();
            model.is_closed()
        },
    },
    Mistake {
        code: Code::NormalAgainstWinding,
        how: "normals negated on a closed model",
        make: |model| {
            model.negate_normals();
            model.is_closed()
        },
    },
    Mistake {
        code: Code::NormalAgainstWinding,
        how: "normals negated on an open model",
        make: |model| {
            model.negate_normals();
            !model.is_closed()
        },
    },
    Mistake {
        code: Code::NormalOtherAxes,
        how: "normals stored as x, -z, y on a curved model",
        make: |model| {
            model.normals.iter_mut().flatten().for_each(|[_, y, z]| (*y, *z) = (-*z, *y));
            ["wavy", "sphere"].iter().any(|curved| model.name.contains(curved))
        },
    },
    Mistake {
        code: Code::NormalOtherAxes,
        how: "y and z of the normals exchanged on a curved model",
        make: |model| {
            model.normals.iter_mut().flatten().for_each(|[_, y, z]| std::mem::swap(y, z));
            ["wavy", "sphere"].iter().any(|curved| model.name.contains(curved))
        },
    },
    Mistake {
        code: Code::NormalOtherAxes,
        how: "x of the normals negated on a closed model",
        make: |model| {
            model.normals.iter_mut().flatten().for_each(|[x, ..]| *x = -*x);
            model.is_closed()
        },
    },
    Mistake {
        code: Code::UvMissing,
        how: "texCoord set to 3",
        make: |model| {
            model.uv_set = 3;
            true
        },
    },
    Mistake {
        code: Code::UvNotFinite,
        how: "one u set to infinity",
        make: |model| {
            model.uvs[model.uv_set][1][0] = f32::INFINITY;
            true
        },
    },
    Mistake {
        code: Code::UvDegenerate,
        how: "UVs of one face made equal",
        make: |model| {
            let vertices = model.detach_first_face();
            let uvs = &mut model.uvs[model.uv_set];
            let uv = uvs[vertices[0]];
            vertices.into_iter().for_each(|vertex| uvs[vertex] = uv);
            true
        },
    },
    Mistake {
        code: Code::UvStretched,
        how: "a quarter of the u range pressed together to an eighth",
        make: |model| {
            let uvs = &mut model.uvs[model.uv_set];
            let [low, high] = [f32::min, f32::max]
                .map(|choose| uvs.iter().map(|uv| uv[0]).reduce(choose).expect("vertices"));
            let limit = low + 0.3 * (high - low);
            for uv in uvs {
                uv[0] = if uv[0] < limit { 0.08 * (uv[0] - limit) } else { uv[0] - limit };
            }
            model.tangents = Some(model.computed(Method::default(), model.uv_set));
            // On a coarse model too few faces lie within that part.
            model.positions.len() > 150
        },
    },
    Mistake {
        code: Code::UvCoarse,
        how: "UVs bent by the fourth power of complex numbers, which stretches nothing",
        make: |model| {
            let uvs = &mut model.uvs[model.uv_set];
            let [low, high] = range(uvs);
            let size = (high[0] - low[0]).max(high[1] - low[1]);
            let square = |[x, y]: [f32; 2]| [x * x - y * y, 2.0 * x * y];
            for uv in uvs {
                *uv = square(square([0, 1].map(|i| 0.3 + (uv[i] - low[i]) / size)));
            }
            model.tangents = Some(model.computed(Method::default(), model.uv_set));
            // Sheared UVs reach farther than their range, so that less of them lies where texels are long.
            model.positions.len() > 150 && !model.name.contains("sheared sphere")
        },
    },
    Mistake {
        code: Code::UvRounded,
        how: "UVs bent by squares of complex numbers, and rounded to steps of a sixth of an edge",
        make: |model| {
            let uvs = &mut model.uvs[model.uv_set];
            let [low, high] = range(uvs);
            let size = (high[0] - low[0]).max(high[1] - low[1]);
            for uv in uvs.iter_mut() {
                let [x, y] = [0, 1].map(|i| 0.5 + (uv[i] - low[i]) / size);
                *uv = [(x * x - y * y) / 3.0, 2.0 * x * y / 3.0];
            }
            let length = |&[a, b, _]: &[u32; 3]| {
                let [a, b] = [a, b].map(|vertex| uvs[vertex as usize]);
                (a[0] - b[0]).hypot(a[1] - b[1])
            };
            let mut lengths: Vec<f32> = model.indices.as_chunks::<3>().0.iter().map(length).collect();
            lengths.sort_by(f32::total_cmp);
            let step = lengths[lengths.len() / 2] / 6.0;
            uvs.iter_mut().for_each(|uv| *uv = uv.map(|x| (x / step).round() * step));
            model.tangents = Some(model.computed(Method::default(), model.uv_set));
            model.name.contains("grid") && model.positions.len() > 100
        },
    },
    Mistake {
        code: Code::UvHardEdge,
        how: "faces made flat on a model that is coarse or made steep",
        make: |model| {
            let at: Vec<usize> = model.indices.iter().map(|&vertex| vertex as usize).collect();
            let steep = if model.name.contains("wavy grid") { 8.0 } else { 1.0 };
            model.positions = at.iter().map(|&vertex| model.positions[vertex]).collect();
            model.positions.iter_mut().for_each(|position| position[2] *= steep);
            for uvs in &mut model.uvs {
                *uvs = at.iter().map(|&vertex| uvs[vertex]).collect();
            }
            model.indices = (0..at.len() as u32).collect();
            let normal = |corners: &[[f32; 3]; 3]| {
                let [a, b, c] = *corners;
                let [e, f] = [b, c].map(|end| [end[0] - a[0], end[1] - a[1], end[2] - a[2]]);
                let normal =
                    [e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]];
                let length = normal.iter().map(|x| x * x).sum::<f32>().sqrt();
                [normal.map(|x| x / length); 3]
            };
            model.normals = Some(model.positions.as_chunks::<3>().0.iter().flat_map(normal).collect());
            model.tangents = Some(vec![[1.0, 0.0, 0.0, 1.0]; at.len()]);
            model.tangents = Some(model.computed(Method::default(), model.uv_set));
            steep > 1.0 || model.name == "coarse sphere"
        },
    },
    Mistake {
        code: Code::MapPadding,
        how: "UVs moved away from the edges of the map, and black around the charts",
        make: |model| {
            let side = model.map.texels.len().isqrt();
            let uvs = &mut model.uvs[model.uv_set];
            let [low, high] = range(uvs);
            let size = (high[0] - low[0]).max(high[1] - low[1]);
            let scale = (side as f32 - 14.0) / size;
            for uv in uvs.iter_mut() {
                *uv = [0, 1].map(|i| (7.0 + scale * (uv[i] - low[i])) / side as f32);
            }
            let mut texels = vec![[0; 3]; side * side];
            for triangle in model.indices.as_chunks::<3>().0 {
                let corners = triangle.map(|vertex| uvs[vertex as usize].map(|x| x * side as f32 - 0.5));
                for (x, y, _) in texels_inside(corners) {
                    let at = y as usize * side + x as usize;
                    texels[at] = model.map.texels[at];
                }
            }
            model.map = model.map.with_texels(texels);
            // A strip is thinner than a block.
            model.name != "strip"
        },
    },
    Mistake {
        code: Code::MapScaleNegative,
        how: "normalTexture.scale of -1",
        make: |model| {
            model.normal_scale = -1.0;
            true
        },
    },
    Mistake {
        code: Code::MapScaleZero,
        how: "normalTexture.scale of 0",
        make: |model| {
            model.normal_scale = 0.0;
            true
        },
    },
    Mistake {
        code: Code::MapScaleExtreme,
        how: "normalTexture.scale of 20",
        make: |model| {
            model.normal_scale = 20.0;
            true
        },
    },
    Mistake {
        code: Code::TransformMirrors,
        how: "KHR_texture_transform with scale 1, -1",
        make: |model| {
            model.transform = Some([1.0, -1.0]);
            true
        },
    },
];

/// The smallest and the largest u and v.
fn range(uvs: &[[f32; 2]]) -> [[f32; 2]; 2] {
    [f32::min, f32::max].map(|choose| {
        let all = uvs.iter().copied();
        all.reduce(|a, b| [choose(a[0], b[0]), choose(a[1], b[1])]).expect("vertices")
    })
}
