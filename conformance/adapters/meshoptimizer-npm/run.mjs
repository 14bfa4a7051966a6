import { MeshoptTangents } from 'meshoptimizer';
import { run, Skip } from '../../readers/case.mjs';

const weighting = process.argv.splice(2, 1)[0];
await MeshoptTangents.ready;

await run(({ positions, normals, uvs, faces, indices, threshold }) => {
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  if (indices.length === 0) return new Float32Array(0);
  return MeshoptTangents.generateTangents(indices, positions, 3, normals, 3, uvs, 2, weighting === 'default' ? [] : [weighting]);
});
