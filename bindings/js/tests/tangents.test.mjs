// `darboux/tangents`: bits, arguments and errors.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as esm from 'darboux/tangents';
import { bits, corpus, native } from './corpus.mjs';
import { formsOf } from './forms.mjs';
import { square } from './meshes.mjs';

const forms = await formsOf('darboux/tangents');

for (const [name, { generateTangents }] of Object.entries(forms)) {
  test(`${name}: the corpus has the bits of the native library`, () => {
    assert.ok(new Set(corpus.map(({ answer }) => answer.name)).size > 30);
    for (const { name, arrays, options, answer } of corpus) {
      assert.deepEqual(bits(generateTangents(...arrays, options)), native(answer.tangents), name);
    }
  });

  test(`${name}: a square has the tangents of its UVs, whatever its indices are`, () => {
    const [positions, normals, uvs, indices] = square();
    const expected = Array.from({ length: 6 }, () => [1, 0, 0, 1]).flat();
    for (const list of [indices, Uint8Array.from(indices), Uint32Array.from(indices)]) {
      assert.deepEqual(Array.from(generateTangents(positions, normals, uvs, list)), expected);
    }
    const quad = generateTangents(positions, normals, uvs, null, { faces: 4 });
    assert.deepEqual(Array.from(quad), expected.slice(0, 16));
    const none = new Float32Array();
    assert.equal(generateTangents(none, none, none).length, 0);
  });
}

test('a result is the caller\'s own', () => {
  const first = esm.generateTangents(...square());
  const copy = first.slice();
  assert.equal(first.byteLength, first.buffer.byteLength);
  const [positions, ...others] = square();
  esm.generateTangents(positions.map((x, at) => x * at), ...others);
  assert.deepEqual(first, copy);
});

test('tangents go where they are told to', () => {
  const out = new Float32Array(24);
  assert.equal(esm.generateTangents(...square(), {}, out), out);
  assert.deepEqual(out, esm.generateTangents(...square()));
});

test('arrays of another realm and shared ones are as good', async () => {
  const { runInNewContext } = await import('node:vm');
  const arrays = square();
  const expected = esm.generateTangents(...arrays);
  const foreign = arrays.map((array) => runInNewContext(`new ${array.constructor.name}([${array}])`));
  const shared = arrays.map((array) => {
    const copy = new array.constructor(new SharedArrayBuffer(array.byteLength));
    copy.set(array);
    return copy;
  });
  assert.deepEqual(esm.generateTangents(...foreign), expected);
  assert.deepEqual(esm.generateTangents(...shared), expected);
});

const [positions, normals, uvs, indices] = square();
const wrong = [
  [[[0, 0, 0], normals, uvs], TypeError, 'positions must be a Float32Array, not Array'],
  [[positions, Float64Array.from(normals), uvs], TypeError, 'normals must be a Float32Array, not Float64Array'],
  [[positions, normals, null], TypeError, 'uvs must be a Float32Array, not Null'],
  [[positions, normals, uvs, [0, 1, 2]], TypeError, 'indices must be a Uint32Array or Uint16Array or Uint8Array, not Array'],
  [[positions.slice(1), normals, uvs], RangeError, 'positions has a length of 11, which is not a multiple of 3'],
  [[positions, normals.slice(3), uvs], RangeError, 'normals has 3 elements but there are 4 positions; give one per vertex'],
  [[positions, normals, uvs, Uint16Array.of(0, 1, 2, 0, 2, 4)], RangeError, 'index 4 at place 5 is out of range: there are 4 vertices'],
  [[positions, normals, uvs], RangeError, '4 corners are not a multiple of 3, the corners of a face'],
  [[positions, normals, uvs, indices, { faces: 4 }], RangeError, '6 corners are not a multiple of 4, the corners of a face'],
  [[positions, normals, uvs, indices, { faces: 5 }], RangeError, 'faces is 5; it must be 3, 4 or a Uint32Array of sizes'],
  [[positions, normals, uvs, indices, { faces: [3, 3] }], TypeError, 'faces must be a Uint32Array, not Array'],
  [[positions, normals, uvs, indices, { faces: Uint32Array.of(3, 4) }], RangeError, 'the face sizes add up to 7 but there are 6 corners'],
  [[positions, normals, uvs, indices, { mode: 'best' }], RangeError, "mode is 'best'; it must be one of 'repaired', 'reference', 'corrected'"],
  [[positions, normals, uvs, indices, {}, [0, 0]], TypeError, 'out must be a Float32Array, not Array'],
  [[positions, normals, uvs, indices, {}, new Float32Array(16)], RangeError, 'out has room for 4 tangents but there are 6 corners'],
  [[positions, normals, uvs, indices, 'corrected'], TypeError, 'options must be an object, not "corrected"'],
  [[positions, normals, uvs, indices, { threshold: NaN }], RangeError, 'threshold is NaN; it must be a number of degrees'],
];

for (const [call, kind, message] of wrong) {
  test(`refused: ${message}`, () => {
    assert.throws(() => esm.generateTangents(...call), (error) => error instanceof kind && error.message === message);
    assert.equal(esm.generateTangents(...square()).length, 24);
  });
}

test('null stands for a missing argument or option', () => {
  const expected = esm.generateTangents(positions, normals, uvs, indices);
  assert.deepEqual(esm.generateTangents(positions, normals, uvs, indices, null, null), expected);
  assert.deepEqual(esm.generateTangents(positions, normals, uvs, indices, { mode: null, threshold: null, faces: null }), expected);
});

test('calls before the module has loaded say so', async () => {
  const early = await import(`${import.meta.resolve('darboux/tangents')}?early`);
  assert.throws(() => early.generateTangents(...square()), /has not loaded yet; await ready/);
  await early.ready;
  assert.equal(early.generateTangents(...square()).length, 24);
});
