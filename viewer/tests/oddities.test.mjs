// Broken and odd models say why in the page, and slips that users met.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { parts } from './glb.mjs';
import { browser, root, serve, Viewer } from './page.mjs';
import { gltf, QUAD } from './quads.mjs';

let server, chromium, viewer;

before(async () => {
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { viewport: { width: 1280, height: 800 } });
});

after(async () => {
  await chromium?.close();
  server?.close();
  assert.deepEqual(viewer?.faults, []);
});

async function open(name, text) {
  await viewer.page.setInputFiles('#files', { name, mimeType: 'text/plain', buffer: Buffer.from(text) });
  await viewer.settled();
}

/** The quad with other positions: `change` gets each coordinate and its number. */
const moved = (change) => gltf({ attributes: { ...QUAD, POSITION: [QUAD.POSITION[0].map(change), 3] } }).replaceAll('null', '0');

test('positions that are not finite are said', async () => {
  await open('none.gltf', moved(() => Infinity));
  assert.match(await viewer.text('status'), /; nothing is shown, because every triangle has a position that is NaN or infinite; export the model again$/);
  assert.deepEqual((await viewer.findings()).map(({ code }) => code), ['position-not-finite']);
  await open('one.gltf', moved((x, at) => (at === 0 ? NaN : x)));
  assert.match(await viewer.text('status'), /; 2 triangles are not shown, because positions are NaN or infinite$/);
  assert.equal(await viewer.text('error'), '');
});

test('coordinates that nothing can draw are said', async () => {
  await open('large.gltf', moved((x) => x * 1e30));
  assert.match(await viewer.text('status'), /; coordinates reach 1\.0e\+30, which is too large to be drawn; scale the model$/);
  await open('small.gltf', moved((x) => x * 1e-30));
  assert.match(await viewer.text('status'), /; all positions are nearly the same, so that there is nothing to see; scale the model$/);
});

test('an OBJ without normals is flat until normals are made', async () => {
  const rows = [0, 1, 2].flatMap((y) => [0, 1, 2].map((x) => `v ${x} ${y} ${x * y}\nvt ${x / 2} ${y / 2}`));
  const quads = [1, 2, 4, 5].map((a) => `f ${[a, a + 1, a + 4, a + 3].map((at) => `${at}/${at}`).join(' ')}`);
  await open('flat.obj', [...rows, ...quads].join('\n'));
  assert.match(await viewer.text('status'), /^8 triangles in 1 part/);
  await viewer.click('#save-model');
  assert.match(await viewer.text('error'), /^No part of flat\.obj can have tangents, so nothing is saved; /);
  await viewer.click('#make-normals');
  const { bytes } = await viewer.download('#save-repaired');
  const { json } = parts(bytes);
  const [{ attributes, indices }] = json.meshes[0].primitives;
  assert.deepEqual([json.accessors[attributes.NORMAL].count, json.accessors[indices].count], [9, 24]);
});

test('nothing is saved where there is nothing to write', async () => {
  const { POSITION, NORMAL } = QUAD;
  await open('bare.gltf', gltf({ attributes: { POSITION, NORMAL } }));
  await viewer.click('#save-model');
  assert.match(await viewer.text('error'), /^No part of bare\.gltf can have tangents, so nothing is saved; /);
  assert.equal(await viewer.page.isVisible('#repair'), false, 'there is nothing to repair');
});

test('normals are made when that is asked for, and saved', async () => {
  await viewer.give('files', [join(root, 'assets/Fox/Fox.glb')]);
  assert.equal(await viewer.page.isVisible('#repair'), false, 'flat shading may be wanted');
  await viewer.slide('split', 100);
  const flat = await viewer.picture();
  await viewer.slide('split', 0);
  await viewer.click('#make-normals');
  assert.equal(await viewer.page.inputValue('#right'), 'repaired');
  assert.ok((await viewer.picture()).differs(flat) > 0.01, 'it is smooth now');
  assert.equal(await viewer.page.isVisible('#make-normals'), false);
  const { name, bytes } = await viewer.download('#save-repaired');
  assert.equal(name, 'Fox.repaired.glb');
  await viewer.page.setInputFiles('#files', { name, mimeType: 'model/gltf-binary', buffer: bytes });
  await viewer.settled();
  assert.ok(!(await viewer.codes()).includes('normal-missing'));
  await viewer.slide('split', 50);
});

test('what saves a model is in sight', async () => {
  await viewer.click('#open-sample');
  const bottom = viewer.page.viewportSize().height;
  for (const id of ['save-model', 'save-picture']) {
    const { y, height } = await viewer.page.locator(`#${id}`).boundingBox();
    assert.ok(y >= 0 && y + height <= bottom, `${id} lies from ${y} to ${y + height} of ${bottom}`);
  }
});

test('before the first model the page says that it loads', async () => {
  const page = await chromium.newPage();
  await page.route('**/*.js', (route) => route.abort());
  await page.goto(server.address);
  assert.equal(await page.textContent('#caption-left'), 'Loading …');
  assert.equal(await page.isVisible('#caption-right'), false);
  await page.close();
});
