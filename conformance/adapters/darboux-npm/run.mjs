import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { run } from '../../readers/case.mjs';

const require = createRequire(join(process.env.DARBOUX_NPM, 'package.json'));
const { generateTangents, ready } = await import(pathToFileURL(require.resolve('darboux/tangents')));
await ready;

await run(({ positions, normals, uvs, faces, indices, threshold }) =>
  indices.length ? generateTangents(positions, normals, uvs, indices, { mode: 'reference', threshold, faces }) : new Float32Array(0),
);
