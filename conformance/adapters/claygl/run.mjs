import { createRequire } from 'node:module';
import { run, Skip } from '../../readers/case.mjs';

const { Geometry } = createRequire(import.meta.url)('claygl');

await run(({ positions, normals, uvs, faces, indices, threshold }) => {
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  if (indices.length === 0) throw new Skip('no meshes without triangles');
  const geometry = new Geometry();
  geometry.attributes.position.value = positions;
  geometry.attributes.normal.value = normals;
  geometry.attributes.texcoord0.value = uvs;
  geometry.indices = indices;
  geometry.generateTangents();
  return { tangents: Float32Array.from(geometry.attributes.tangent.value), indices };
});
