// Plans: their memory, and GPU plans.

import assert from 'node:assert/strict';
import { setFlagsFromString } from 'node:v8';
import { test } from 'node:test';
import { runInNewContext } from 'node:vm';
import { mirrored, square } from './meshes.mjs';

/** The memory of every instance. */
const memories = [];
const { Instance } = WebAssembly;
WebAssembly.Instance = function (module) {
  const instance = new Instance(module);
  memories.push(instance.exports.memory);
  return instance;
};
const { Plan, planTopology, ready } = await import('darboux');
await ready;

const mesh = [9, 9, 6].map((length) => new Float32Array(30 * length));
const [positions, normals] = mesh;
const plan = () => {
  const made = new Plan(...mesh);
  assert.equal(made.evaluate(positions, normals).length, 360);
  return made;
};

test('10,000 plans that are disposed of leave no memory behind', () => {
  plan().dispose();
  const before = memories[0].buffer.byteLength;
  for (let at = 0; at < 10_000; at++) plan().dispose();
  assert.equal(memories[0].buffer.byteLength, before);
  assert.equal(memories.length, 1);
});

test('plans that are garbage-collected leave no memory behind', async () => {
  setFlagsFromString('--expose-gc');
  const collect = runInNewContext('gc');
  const some = async () => {
    for (let at = 0; at < 1000; at++) plan();
    collect();
    await new Promise((resolve) => setTimeout(resolve, 20));
  };
  await some();
  await some();
  const before = memories[0].buffer.byteLength;
  for (let at = 0; at < 5; at++) await some();
  // The time of garbage collection varies. 5,000 plans that stay would take over 5 MB.
  assert.ok(memories[0].buffer.byteLength - before < 1 << 20);
});

test('plans are independent of each other', () => {
  const first = plan();
  const second = new Plan(positions.map((_, at) => at), normals.fill(1), mesh[2].map((_, at) => at * at), Uint16Array.of(0, 1, 2));
  const before = second.evaluate(positions.map((_, at) => 2 * at), normals);
  first.dispose();
  first.dispose();
  const third = plan();
  assert.deepEqual(second.evaluate(positions.map((_, at) => 2 * at), normals), before);
  assert.deepEqual([third.base.length, second.base.length], [360, 12]);
  assert.throws(() => first.evaluate(positions, normals), /^Error: the plan has been disposed of; make another$/);
});

test('after a mesh too large for WebAssembly the next plan is made', { timeout: 60_000 }, () => {
  const kept = plan();
  const vertices = new Float32Array(3 * 120_000_000);
  assert.throws(() => new Plan(vertices, vertices, new Float32Array(2 * 120_000_000)), { name: 'RangeError', message: /^the mesh needs more memory / });
  assert.throws(() => kept.evaluate(positions, normals), { name: 'RangeError', message: /^the mesh needs more memory / });
  kept.dispose();
  plan();
});

test('the GPU plan of a mesh has its topology', () => {
  const topology = planTopology(...square());
  assert.deepEqual([topology.vertexCount, topology.cornerCount, topology.triangleCount, topology.sumCount, topology.splitVertices], [4, 6, 2, 4, 0]);
  assert.deepEqual(Array.from(topology.sumOfCorner), Array.from(square()[3], (vertex) => topology.sumOfVertex[vertex]));
  assert.equal(planTopology(...mirrored()).splitVertices, 2);
  assert.throws(() => planTopology(...square(), { method: 'area' }), /the shaders cannot plan the method 'area'/);
  assert.throws(() => planTopology(...square().slice(0, 3), Uint16Array.of(0, 1, 2, 3), { faces: 4 }), /the shaders take triangles/);
  assert.throws(() => planTopology(...square().slice(0, 3), Uint16Array.of(0, 1, 9)), /index 9/);
});
