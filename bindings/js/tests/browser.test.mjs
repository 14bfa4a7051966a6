// The package in headless Chromium.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { open, skip } from './browser/open.mjs';
import { corpus, native } from './corpus.mjs';

let browser;
let page;
const faults = [];

before(async () => {
  if (skip) return;
  ({ browser, page } = await open(fileURLToPath(new URL('browser/page.mjs', import.meta.url))));
  page.on('pageerror', (error) => faults.push(error.message));
  await page.evaluate(() => tested.ready);
});

after(() => browser?.close());

test('the corpus has the bits of the native library', { skip }, async () => {
  const meshes = corpus.map(({ arrays, options }) => [arrays.map((array) => Array.from(new Uint32Array(array.buffer))), { ...options, faces: Array.from(options.faces) }]);
  const found = await page.evaluate((meshes) => meshes.map(([[positions, normals, uvs, indices], options]) => {
    const floats = [positions, normals, uvs].map((words) => new Float32Array(Uint32Array.from(words).buffer));
    const tangents = tested.generateTangents(...floats, Uint32Array.from(indices), { ...options, faces: Uint32Array.from(options.faces) });
    return Array.from(new Uint32Array(tangents.buffer));
  }), meshes);
  for (const [at, { name, answer }] of corpus.entries()) {
    assert.deepEqual(native(found[at]), native(answer.tangents), name);
  }
});

test('mirrored squares have the same shading with the tangents of every adapter and with derivatives', { skip }, async () => {
  const names = await page.evaluate(() => Object.keys(tested.mirroredSquares));
  assert.equal(names.length, 7);
  for (const name of names) {
    const { left, right, takesTangents } = await page.evaluate((name) => tested.mirroredSquares[name](), name);
    // The texel's normal is 0.6 along u, which is mirrored, and 0.48 up the image.
    const up = name.endsWith('v up') ? 0.48 : -0.48;
    const isClose = (found, expected) => found.every((x, at) => Math.abs(x - expected[at]) < 0.02);
    assert.ok(isClose(left, [-0.6, up, 0.64]), `${name}, left: ${left}`);
    assert.ok(isClose(right, [0.6, up, 0.64]), `${name}, right: ${right}`);
    assert.equal(takesTangents, !name.startsWith('derivatives'), name);
  }
});

test('MeshStandardMaterial uses the tangents, not derivatives', { skip }, async () => {
  const found = await page.evaluate(() => tested.standardMaterial());
  assert.deepEqual(found.takesTangents, [false, true, true]);
  assert.ok(found.fromDerivatives > found.drawn / 10, JSON.stringify(found));
  assert.ok(found.fromTurned > found.drawn / 2, JSON.stringify(found));
});

test('tangents on WebGPU are those of the CPU', { skip }, async (context) => {
  for (const [method, format] of [['average', 'uint32'], ['average', 'uint16'], ['lengyel', 'uint32']]) {
    const found = await page.evaluate(([method, format]) => tested.averages(method, format), [method, format]);
    if (!found) return context.skip('this Chromium has no WebGPU adapter');
    assert.deepEqual(found.errors, []);
    assert.deepEqual(found.counts, [1, 0, 0]);
    const { corners, signFlips, withoutAngle, max } = found.difference;
    assert.deepEqual([corners, signFlips, withoutAngle], [42_000, 0, 0]);
    assert.ok(max < 1e-4, `${method}: ${max} degrees`);
  }
});

test('plans on WebGPU have the bits of those on the CPU', { skip }, async (context) => {
  const cases = [['vertex', 'waves', {}], ['corner', 'waves', { threshold: 20 }], ['corner', 'seams', { mode: 'reference' }], ['corner', 'seams', {}]];
  for (const [per, mesh, options] of cases) {
    const found = await page.evaluate(([per, options, mesh]) => tested.plans(per, options, mesh), [per, options, mesh]);
    if (!found) return context.skip('this Chromium has no WebGPU adapter');
    assert.deepEqual([found.errors, found.corners, found.differing, found.counts], [[], 14_400, 0, [0, 0, 0]], `${mesh} ${per} ${JSON.stringify(options)}`);
  }
});

test('plans on WebGPU count the tangents that the CPU must compute', { skip }, async (context) => {
  const found = await page.evaluate(() => tested.plans('corner', {}, 'waves', 2 ** -70)); // too small for floats to be exact
  if (!found) return context.skip('this Chromium has no WebGPU adapter');
  assert.deepEqual(found.errors, []);
  assert.equal(found.counts[0], 4800);
});

test('plans on WebGPU refuse buffers that do not fit', { skip }, async (context) => {
  const found = await page.evaluate(() => tested.refusals());
  if (!found) return context.skip('this Chromium has no WebGPU adapter');
  assert.deepEqual(found, [
    'RangeError: 2 vertices have several tangents; split them first (splitVertices)',
    'RangeError: the stride and the offset of the positions must be multiples of 4',
    'RangeError: the tangents need 464 bytes but their buffer has 240',
    'RangeError: the tangents need 480 bytes but their buffer has 240',
    [],
  ]);
});

test('200 plans live side by side', { skip }, async () => {
  const length = await page.evaluate(() => {
    const mesh = [9, 9, 6].map((length) => new Float32Array(length));
    const plans = Array.from({ length: 200 }, () => new tested.Plan(...mesh));
    return plans.reduce((sum, plan) => sum + plan.evaluate(mesh[0], mesh[1]).length, 0);
  });
  assert.equal(length, 2400);
});

test('the page logged no error', { skip }, () => assert.deepEqual(faults, []));
