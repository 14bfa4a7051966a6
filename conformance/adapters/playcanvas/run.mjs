import { calculateTangents } from 'playcanvas';
import { run, Skip } from '../../readers/case.mjs';

await run(({ positions, normals, uvs, faces, indices, threshold }) => {
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  return { tangents: Float32Array.from(calculateTangents(positions, normals, uvs, indices)), indices };
});
