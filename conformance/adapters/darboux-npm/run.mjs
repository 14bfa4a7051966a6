import { createRequire } from 'node:module';
import { join } from 'node:path';
import { run, Skip } from '../../readers/case.mjs';

const { generateTangents, ready } = createRequire(join(process.env.DARBOUX_NPM, 'package.json'))('darboux/tangents');
await ready;

await run(({ positions, normals, uvs, faces, indices, threshold }) => {
  if (!Number.isFinite(threshold)) throw new Skip('the package refuses thresholds that are not finite');
  return indices.length ? generateTangents(positions, normals, uvs, indices, { mode: 'reference', threshold, faces }) : new Float32Array(0);
});
