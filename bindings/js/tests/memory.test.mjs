// The memory of WebAssembly: no leaks, freed after large meshes, and usable after running out.

import assert from 'node:assert/strict';
import { test } from 'node:test';

/** The memory of every instance. */
const memories = [];
const { instantiate, Instance } = WebAssembly;
WebAssembly.instantiate = async (...given) => kept(await instantiate(...given));
WebAssembly.Instance = function (...given) {
  return kept(new Instance(...given));
};

function kept(instance) {
  memories.push(instance.exports.memory);
  return instance;
}

const { generateTangents, ready } = await import('darboux/tangents');
await ready;

test('10,000 calls leave no memory behind', () => {
  assert.equal(memories.length, 1);
  const random = (length) => Float32Array.from({ length }, (_, at) => Math.sin(at * 12.9898));
  const call = (triangles) => generateTangents(random(9 * triangles), random(9 * triangles), random(6 * triangles));
  const wrong = () => generateTangents(random(90), random(90), random(60), Uint32Array.of(0, 1, 99));
  const calls = (count) => {
    for (let at = 0; at < count; at++) {
      call(1 + (at % 100));
      if (at % 10 === 0) assert.throws(wrong);
    }
  };
  calls(200);
  const before = memories[0].buffer.byteLength;
  calls(10_000);
  assert.equal(memories[0].buffer.byteLength, before);
});

test('memory of a large mesh is given back', () => {
  const small = () => generateTangents(new Float32Array(9), new Float32Array(9), new Float32Array(6));
  generateTangents(new Float32Array(3 * 3_000_000), new Float32Array(3 * 3_000_000), new Float32Array(2 * 3_000_000));
  assert.equal(small().length, 12);
  assert.equal(memories.length, 2);
  assert.ok(memories[1].buffer.byteLength < 2 ** 24);
});

test('a mesh too large for WebAssembly is refused, and the next call is served', { timeout: 60_000 }, () => {
  const vertices = new Float32Array(3 * 120_000_000);
  const uvs = new Float32Array(2 * 120_000_000);
  assert.throws(() => generateTangents(vertices, vertices, uvs), {
    name: 'RangeError',
    message: 'the mesh needs more memory than WebAssembly can have; split it',
  });
  assert.equal(generateTangents(new Float32Array(9), new Float32Array(9), new Float32Array(6)).length, 12);
});
