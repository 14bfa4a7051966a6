// The report: a model for every kind of finding, and the place that a click leads to.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { browser, serve, Viewer } from './page.mjs';
import { gltf, INDICES, QUAD, TANGENTS } from './quads.mjs';

let server, chromium, viewer, folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'viewer-'));
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { viewport: { width: 700, height: 400 } });
});

after(async () => {
  await chromium?.close();
  server?.close();
  rmSync(folder, { recursive: true });
  assert.deepEqual(viewer?.faults, []);
});

/** The vertices of the quad at the upper left, upper middle, lower left and lower middle. */
const [UP_LEFT, UP_MIDDLE, LOW_LEFT, LOW_MIDDLE] = ['(-1, 0.5, 0)', '(0, 0.5, 0)', '(-1, -0.5, 0)', '(0, -0.5, 0)'];

/** A copy of an attribute with another value at one vertex. */
const changed = ([array, width], vertex, values) => [array.map((x, at) => (Math.floor(at / width) === vertex ? values[at % width] : x)), width];

/** The quad with separate vertices for both halves, so that all signs are right. */
const APART = (() => {
  const order = [0, 1, 3, 4, 1, 2, 4, 5];
  const taken = ([array, width]) => [Float32Array.from(order.flatMap((vertex) => [...array.subarray(vertex * width, (vertex + 1) * width)])), width];
  const attributes = Object.fromEntries(Object.entries(QUAD).map(([name, array]) => [name, taken(array)]));
  const tangents = [Float32Array.from(order.flatMap((_, at) => (at < 4 ? [-1, 0, 0, -1] : [1, 0, 0, 1]))), 4];
  return { attributes: { ...attributes, TANGENT: tangents }, indices: Uint16Array.of(0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6) };
})();

/** The quad with another tangent at the upper left. */
const tilted = (values) => ({ ...APART, attributes: { ...APART.attributes, TANGENT: changed(APART.attributes.TANGENT, 2, values) } });

/** The quad with equal UVs on the left half. */
const FLAT = (() => {
  const TEXCOORD_0 = [0, 1, 2, 3].reduce((array, vertex) => changed(array, vertex, [0.5, 0.5]), APART.attributes.TEXCOORD_0);
  return { ...APART, attributes: { ...APART.attributes, TEXCOORD_0 } };
})();

/** The quad with normals along x, which is also the direction of MikkTSpace's tangents without UVs. */
const USELESS = { ...FLAT, attributes: { ...FLAT.attributes, NORMAL: [0, 1, 2, 3].reduce((array, vertex) => changed(array, vertex, [1, 0, 0]), APART.attributes.NORMAL) } };

/** For each kind of finding: a model, the text of the report, and the place. */
const FAULTS = [
  ['zero', tilted([0, 0, 0, -1]), /^1 corner with a zero tangent: /, [UP_LEFT]],
  ['not-finite', tilted([NaN, 0, 0, -1]), /^1 corner with a tangent that is not finite: /, [UP_LEFT]],
  ['not-unit', tilted([-1.01, 0, 0, -1]), /^1 corner whose tangent is not of unit length: /, [UP_LEFT]],
  ['bad-sign', tilted([-1, 0, 0, -0.5]), /^1 corner whose w is neither 1 nor -1: /, [UP_LEFT]],
  ['differs', tilted([-Math.cos(0.1), Math.sin(0.1), 0, -1]), /^1 corner differs from a fresh run, by up to 5\.7°: /, [UP_LEFT]],
  ['flipped', tilted([-1, 0, 0, 1]), /^1 corner with the opposite sign of a fresh run: /, [UP_LEFT]],
  ['mixed', { attributes: { ...QUAD, TANGENT: TANGENTS } }, /^2 triangles with both signs: /, [LOW_LEFT]],
  ['seams', APART, /^1 mirrored edge: /, [LOW_MIDDLE, UP_MIDDLE]],
  ['degenerate', { indices: Uint16Array.of(3, 3, 4, ...INDICES) }, /^1 degenerate triangle: /, [UP_LEFT]],
  ['uv-degenerate', FLAT, /^2 triangles without area in the UVs: /, [LOW_LEFT]],
  ['repaired', USELESS, /^6 corners that need repair: /, [LOW_LEFT, UP_LEFT]],
];

const isMagenta = (r, g, b) => r > 200 && b > 150 && g < 140;

for (const [kind, model, sentence, places] of FAULTS) {
  test(`${kind} is found, and a click leads to it`, async () => {
    writeFileSync(join(folder, 'quad.gltf'), gltf(model));
    await viewer.give('files', [join(folder, 'quad.gltf')]);
    const line = (await viewer.report())[kind];
    assert.match(line ?? 'not found', sentence);
    const before = await viewer.picture();
    await viewer.click(`#report [data-kind=${kind}] button`);
    const status = await viewer.text('status');
    assert.ok(status.startsWith(`${line}, place 1 of `), status);
    assert.ok(places.some((place) => status.endsWith(`, at ${place}`)), `${status}, not at ${places}`);
    const there = await viewer.picture();
    assert.ok(there.differs(before) > 0.1, 'the camera went there');
    assert.ok(there.share(isMagenta, 0.47, 0.53) > 0.001, 'the place is in the middle, and marked');
    assert.equal(there.share(isMagenta, 0, 0.45), 0);
  });
}

test('the report of a model without faults is empty', async () => {
  writeFileSync(join(folder, 'quad.gltf'), gltf(APART));
  await viewer.give('files', [join(folder, 'quad.gltf')]);
  assert.deepEqual(Object.keys(await viewer.report()), ['seams']);
  assert.equal(await viewer.text('report-none'), 'No faults found.');
});
