// `darboux/mikktspace` in place of the npm package mikktspace.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import mikktspace from 'mikktspace';
import * as ours from 'darboux/mikktspace';
import { corpus } from './corpus.mjs';
import { mirrored } from './meshes.mjs';

await ours.ready;

/** The arrays per corner. */
function expanded([positions, normals, uvs, indices]) {
  const of = (array, width) => Float32Array.from([...indices].flatMap((vertex) => [...array.subarray(width * vertex, width * vertex + width)]));
  return [of(positions, 3), of(normals, 3), of(uvs, 2)];
}

test('the same call has the same result, signs included, except for unusable tangents', () => {
  let compared = 0;
  for (const { name, arrays, options } of corpus) {
    if (options.mode !== 'reference' || options.threshold !== 180 || !options.faces.every((size) => size === 3)) continue;
    const mesh = arrays[3].length ? expanded(arrays) : arrays.slice(0, 3);
    const theirs = attempt(() => mikktspace.generateTangents(...mesh));
    if (!theirs) continue;
    const found = ours.generateTangents(...mesh);
    for (let at = 0; at < theirs.length; at += 4) {
      const [x, y, z] = theirs.subarray(at, at + 3);
      if (!(Math.abs(Math.hypot(x, y, z) - 1) < 1e-3)) continue;
      if (along(mesh[1].subarray((3 * at) / 4), [x, y, z])) continue;
      assert.deepEqual(found.slice(at, at + 4), theirs.slice(at, at + 4), `${name}, corner ${at / 4}`);
      compared++;
    }
  }
  assert.ok(compared > 100, `${compared}`);
});

/** The package throws where all triangles are degenerate. */
function attempt(call) {
  try {
    return call();
  } catch {
    return null;
  }
}

const along = ([nx, ny, nz], [x, y, z]) => Math.abs(nx * x + ny * y + nz * z) >= 0.999 * Math.hypot(nx, ny, nz);

test('the sign is MikkTSpace\'s for the UVs as given', () => {
  const tangents = ours.generateTangents(...expanded(mirrored()));
  assert.deepEqual(Array.from(tangents).filter((_, at) => at % 4 === 3), [...Array(6).fill(-1), ...Array(6).fill(1)]);
  assert.equal(ours.isReady, true);
});
