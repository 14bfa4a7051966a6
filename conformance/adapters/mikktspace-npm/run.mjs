import { createRequire } from 'node:module';
import { run, Skip } from '../../readers/case.mjs';

const require = createRequire(import.meta.url);
let mikktspace = require('mikktspace');

/** After an error inside WebAssembly its memory cannot be trusted, so the next case gets a new instance. */
function reload() {
  for (const key of Object.keys(require.cache)) delete require.cache[key];
  mikktspace = require('mikktspace');
}

await run(({ positions, normals, uvs, faces, indices, threshold }) => {
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  const unindexed = (array, size) => Float32Array.from({ length: size * indices.length }, (_, at) => array[size * indices[Math.floor(at / size)] + (at % size)]);
  try {
    return mikktspace.generateTangents(unindexed(positions, 3), unindexed(normals, 3), unindexed(uvs, 2));
  } catch (error) {
    // A case without a result fails: one number per corner that is not a tangent.
    console.error(`mikktspace: ${error}`);
    reload();
    return new Float32Array(4 * indices.length).fill(NaN);
  }
});
