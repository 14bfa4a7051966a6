// Faults of darboux are told from missing memory; the test `memory` has an allocation that fails.

import assert from 'node:assert/strict';
import { test } from 'node:test';

/** What the next call does instead; the exports of the instance that it runs in. */
let instead = null;
const { instantiate, Instance } = WebAssembly;
WebAssembly.instantiate = async (...given) => watched(await instantiate(...given));
WebAssembly.Instance = function (...given) {
  return watched(new Instance(...given));
};

function watched(instance) {
  const begin = () => (instead ? instead(instance.exports) : instance.exports.begin());
  return { exports: { ...instance.exports, begin } };
}

const { generateTangents, ready } = await import('darboux/tangents');
await ready;

const small = () => generateTangents(new Float32Array(9), new Float32Array(9), new Float32Array(6));

/** The error of a call, and that the next call is served. */
function errorOf(fault) {
  instead = fault;
  let error;
  assert.throws(small, (thrown) => Boolean((error = thrown)));
  instead = null;
  assert.equal(small().length, 12);
  return error;
}

const TOO_LARGE = 'the mesh needs more memory than WebAssembly can have; split it';

test('an array that is longer than WebAssembly can address is missing memory', () => {
  const error = errorOf((exports) => exports.positions(0x2fffffff));
  assert.deepEqual([error.name, error.message], ['RangeError', TOO_LARGE]);
});

test('another trap is a fault', () => {
  // No mode has this code.
  const error = errorOf((exports) => exports.generate_tangents(99, 0, 0));
  assert.equal(error.name, 'Error');
  assert.match(error.message, /^darboux failed \(.*unreachable.*\): this is a fault of darboux; please report it with the input$/i);
});
