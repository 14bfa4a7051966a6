// Hash keys are random per instance, so that nobody can make a mesh that a known key misleads.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { generateTangents as reference } from 'mikktspace';

/** The memory of the last instance. */
let memory;
const { instantiate } = WebAssembly;
WebAssembly.instantiate = async (...given) => {
  const instance = await instantiate(...given);
  memory = instance.exports.memory;
  return instance;
};

/** One triangle: positions, normals, UVs and indices. */
const triangle = () => [
  Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0), Float32Array.of(0, 0, 1, 0, 0, 1, 0, 0, 1), Float32Array.of(0, 0, 1, 0, 0, 1), Uint32Array.of(0, 1, 2),
];

let instances = 0;

/** The memory of a new instance after its first call. */
async function memoryAfterCall(entry) {
  const { generateTangents, ready } = await import(`${import.meta.resolve(entry)}?${instances++}`);
  await ready;
  generateTangents(...triangle());
  return Buffer.from(memory.buffer.slice(0));
}

for (const entry of ['darboux', 'darboux/tangents']) {
  test(`two instances of ${entry} differ in nothing but their random bits`, async () => {
    const random = crypto.getRandomValues;
    assert.ok(!(await memoryAfterCall(entry)).equals(await memoryAfterCall(entry)));
    crypto.getRandomValues = (array) => array.fill(12345);
    const [first, second] = [await memoryAfterCall(entry), await memoryAfterCall(entry)];
    crypto.getRandomValues = random;
    assert.ok(first.equals(second));
  });
}

// The keys were once the same in every instance. These are the numbers of the second and third vertices of 12 separate triangles around one
// vertex whose fingerprints cancel under those keys, found by lattice reduction, so that the triangles passed for one fan.
const MISLEADING = {
  darboux: [[6, 10, 24, 25, 28, 34, 45, 50, 56, 58, 63, 67], [1, 9, 23, 33, 38, 40, 41, 43, 47, 57, 62, 72]],
  'darboux/tangents': [[7, 9, 16, 30, 31, 35, 37, 49, 56, 61, 63, 68], [11, 17, 19, 27, 28, 28, 39, 41, 43, 67, 70, 72]],
};

/** The mesh of such numbers. All vertices come first in 25 other triangles, which gives them their numbers; the last is the centre. */
function misleading([seconds, thirds]) {
  const [count, centre] = [76, 75];
  const degrees = Array.from({ length: count }, (_, vertex) => 5.1 * vertex);
  seconds.forEach((vertex, at) => (degrees[vertex] = 300 + 2 * at));
  // In UV space, all triangles lie on one side of the direction +u, but for the last, which holds it.
  thirds.forEach((vertex, at) => (degrees[vertex] = at === thirds.length - 1 ? 370 : 340 + at));
  const [positions, normals, uvs] = [3, 3, 2].map((width) => new Float32Array(width * count));
  for (let vertex = 0; vertex < count; vertex++) {
    normals[3 * vertex + 2] = 1;
    if (vertex === centre) continue;
    const angle = (degrees[vertex] * Math.PI) / 180;
    const turned = angle + 0.3 * Math.sin(vertex);
    positions.set([Math.cos(turned) * (1 + vertex / 100), Math.sin(turned), 0], 3 * vertex);
    uvs.set([Math.cos(angle), Math.sin(angle)], 2 * vertex);
  }
  const indices = Uint32Array.from([...Array(centre).keys(), ...seconds.flatMap((second, at) => [centre, second, thirds[at]])]);
  return [positions, normals, uvs, indices];
}

for (const [entry, numbers] of Object.entries(MISLEADING)) {
  test(`a mesh that the old key of ${entry} misled is exact`, async () => {
    const { generateTangents, ready } = await import(`${import.meta.resolve(entry)}?${instances++}`);
    await ready;
    generateTangents(...triangle());
    const [positions, normals, uvs, indices] = misleading(numbers);
    const perCorner = (array, width) => Float32Array.from({ length: width * indices.length }, (_, at) => array[width * indices[Math.floor(at / width)] + (at % width)]);
    const expected = reference(perCorner(positions, 3), perCorner(normals, 3), perCorner(uvs, 2));
    assert.deepEqual(generateTangents(positions, normals, uvs, indices, { mode: 'reference' }), expected);
  });
}
