// The tangents of shaders without vertex tangents. They use screen-space derivatives of position and UV, which are the differences along
// the triangle's edges in another basis. As in three.js (getTangentFrame), after Christian Schueler, "Normal mapping without precomputed
// tangents", ShaderX5, 2006.

import type { Surface } from './surface';
import { cross, dot, edges, type Vector } from './vectors';

/** The tangent of every corner. Its xyz is zero where all UVs of the triangle are equal. */
export function derivativeTangents(surface: Surface): Float32Array<ArrayBuffer> {
  const { indices, normals, uvs } = surface;
  const out = new Float32Array(indices.length * 4);
  for (let face = 0; face + 2 < indices.length; face += 3) {
    const [p1, p2] = edges(surface.positions, 3, indices, face);
    const [uv1, uv2] = edges(uvs, 2, indices, face);
    for (let corner = face; corner < face + 3; corner++) {
      const at = indices[corner] * 3;
      const normal: Vector = [normals[at], normals[at + 1], normals[at + 2]];
      const [a, b] = [cross(p2, normal), cross(normal, p1)];
      const along = (i: number): Vector => [0, 1, 2].map((k) => a[k] * uv1[i] + b[k] * uv2[i]) as Vector;
      const [tangent, bitangent] = [along(0), along(1)];
      const length = Math.hypot(...tangent);
      if (length > 0) out.set(tangent.map((x) => x / length), corner * 4);
      const isRight = dot(cross(normal, tangent), bitangent) >= 0;
      out[corner * 4 + 3] = isRight ? -1 : 1;
    }
  }
  return out;
}
