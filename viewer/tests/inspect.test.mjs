// Looking closely: values under the pointer, edges, parts, poses, cameras, links, and the way back.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { browser, root, serve, Viewer } from './page.mjs';
import { gltf, QUAD, TANGENTS } from './quads.mjs';

let server, chromium, viewer;

before(async () => {
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { viewport: { width: 1000, height: 600 } });
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

/** The values on the page, by their names. */
const values = () => viewer.page.$$eval('#values-list dt', (all) => Object.fromEntries(all.map((dt) => [dt.textContent, dt.nextSibling.textContent])));

/** A place of the picture, from 0 to 1 each way. */
async function place(x, y) {
  const box = await viewer.page.locator('#view').boundingBox();
  return [box.x + x * box.width, box.y + y * box.height];
}

test('the values under the pointer are those of the file, and a click pins them', async () => {
  await open('quad.gltf', gltf({ attributes: { ...QUAD, TANGENT: TANGENTS } }));
  await viewer.page.mouse.move(...(await place(0.2, 0.5)));
  await viewer.settled();
  const left = await values();
  assert.deepEqual([left['In the file'], left.Normal, left.Tangent], ['mesh_0', '0, 0, 1', '-1, 0, 0']);
  const [, , vertex] = left['Triangle, corner, vertex'].split(', ').map(Number);
  assert.equal(left.Position, [...QUAD.POSITION[0].subarray(3 * vertex, 3 * vertex + 3)].join(', '));
  assert.equal(left.UV, [...QUAD.TEXCOORD_0[0].subarray(2 * vertex, 2 * vertex + 2)].join(', '));
  assert.equal(left.w, '-1');
  assert.match(left['Angle to the other side'], /^[\d.e-]+°$/);
  await viewer.page.mouse.click(...(await place(0.7, 0.5)));
  await viewer.page.mouse.move(...(await place(0.2, 0.5)));
  await viewer.settled();
  const right = await values();
  assert.deepEqual([right.MikkTSpace, right.w], ['mesh_0', '1'], 'they stay pinned');
  await viewer.click('#unpin');
  assert.equal(await viewer.page.isVisible('#values'), false);
  await viewer.page.focus('#view');
  await viewer.page.keyboard.press('Enter');
  assert.equal(await viewer.page.isVisible('#values'), true, 'the keyboard pins the middle');
  await viewer.page.keyboard.press('Escape');
  assert.equal(await viewer.page.isVisible('#values'), false);
});

test('edges are drawn, on the model and in the UV layout with its texture', async () => {
  await viewer.click('#open-sample');
  const before = await viewer.picture();
  await viewer.click('#wireframe');
  assert.ok((await viewer.picture()).differs(before) > 0.02);
  await viewer.click('#wireframe');
  await viewer.click('#layout');
  const layout = await viewer.picture();
  assert.ok(layout.share((r, g, b) => Math.abs(r - 128) < 40 && Math.abs(g - 128) < 40 && b > 220, 0.6) > 0.005, 'the normal map is seen');
  await viewer.click('#layout');
});

test('the UV layout is moved by dragging, zoomed by the wheel and by two fingers, and set back', async () => {
  const page = await Viewer.open(chromium, server.address, { viewport: { width: 1000, height: 600 }, hasTouch: true });
  await page.click('#layout');
  const box = await page.page.locator('#layout-frame').boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const whole = await page.picture();
  /** How much the layout differs from the whole one, and what lies beside it. */
  const changed = async () => {
    await page.settled();
    const now = await page.picture();
    return [now.differs(whole, 0.55), now.differs(whole, 0, 0.4)];
  };
  const isOnlyLayout = async (what) => {
    const [layout, rest] = await changed();
    assert.ok(layout > 0.02 && rest === 0, `${what}: ${layout} of the layout, ${rest} of the rest`);
  };
  const isWhole = async () => assert.equal((await changed())[0], 0);
  await page.page.mouse.move(x, y);
  await page.page.mouse.down();
  await page.page.mouse.move(x - 60, y + 30, { steps: 3 });
  await page.page.mouse.up();
  await isOnlyLayout('drag');
  await page.page.mouse.dblclick(x, y);
  await isWhole();
  await page.page.mouse.wheel(0, -400);
  await isOnlyLayout('wheel');
  await page.page.focus('#layout-frame');
  await page.page.keyboard.press('Home');
  await page.page.$eval('#layout-frame', (frame) => frame.blur());
  await isWhole();
  const session = await page.page.context().newCDPSession(page.page);
  const touch = (type, apart) => session.send('Input.dispatchTouchEvent', { type, touchPoints: apart ? [{ x: x - apart, y, id: 1 }, { x: x + apart, y, id: 2 }] : [] });
  for (const [type, apart] of [['touchStart', 30], ['touchMove', 50], ['touchMove', 80], ['touchEnd', 0]]) await touch(type, apart);
  await isOnlyLayout('pinch');
  for (const key of ['Home', '+', 'ArrowLeft']) await page.page.press('#layout-frame', key);
  await page.page.$eval('#layout-frame', (frame) => frame.blur());
  await isOnlyLayout('keys');
  await page.click('#reset');
  assert.equal(await page.page.isVisible('#layout-frame'), false);
  await page.click('#layout');
  await isWhole();
  assert.deepEqual(page.faults, []);
  await page.close();
});

test('parts can be hidden', async () => {
  await viewer.give('folder', join(root, 'assets/Morphing'));
  const name = await viewer.text('name');
  await viewer.click('#open-sample');
  assert.equal(await viewer.page.isVisible('#parts'), false, 'one part is not listed');
  const { json } = { json: JSON.parse(gltf()) };
  json.meshes.push({ ...json.meshes[0], name: 'Other' });
  json.nodes.push({ mesh: 1, translation: [0, 1.2, 0] });
  json.scenes[0].nodes.push(1);
  await open('two.gltf', JSON.stringify(json));
  const both = await viewer.picture();
  await viewer.click('#parts-list input[value="1"]');
  const one = await viewer.picture();
  assert.ok(one.differs(both) > 0.03, `hidden after ${name}`);
  await viewer.click('#reset');
  assert.ok((await viewer.picture()).differs(both) < 0.002, 'and shown again');
});

test('clips, morph targets and cameras of the file pose the model', async () => {
  await viewer.give('files', [join(root, 'assets/Fox/Fox.glb')]);
  const rest = await viewer.picture();
  assert.ok((await viewer.page.locator('#clip option').count()) > 1);
  await viewer.choose('clip', '1');
  await viewer.slide('clip-time', 0.4);
  assert.ok((await viewer.picture()).differs(rest) > 0.01, 'it moved');
  const time = () => viewer.page.inputValue('#clip-time').then(Number);
  await viewer.press('#clip-play');
  await viewer.page.waitForFunction(() => Math.abs(document.getElementById('clip-time').valueAsNumber - 0.4) > 0.05);
  assert.equal(await viewer.page.getAttribute('#clip-play', 'aria-pressed'), 'true');
  await viewer.press('#clip-play');
  await viewer.settled();
  const stopped = await time();
  await viewer.page.waitForTimeout(300);
  assert.equal(await time(), stopped, 'it stays where it was stopped');
  assert.equal(await viewer.text('clip-play'), 'Play');
  await viewer.choose('clip', '');
  assert.ok((await viewer.picture()).differs(rest) < 0.002, 'and back');
  const up = QUAD.POSITION[0].map((_, at) => (at % 3 === 2 && at < 6 ? 1 : 0));
  const look = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 6, 1];
  await open('morph.gltf', gltf({ targets: [{ POSITION: [up, 3] }], mesh: { weights: [0] }, json: () => ({ cameras: [{ type: 'perspective', name: 'Front', perspective: { yfov: 0.6, znear: 0.1 } }], nodes: [{ mesh: 0 }, { camera: 0, matrix: look }], scenes: [{ nodes: [0, 1] }] }) }));
  const flat = await viewer.picture();
  await viewer.slide('morphs input', 1);
  assert.ok((await viewer.picture()).differs(flat) > 0.02, 'the morph target moved it');
  await viewer.slide('morphs input', 0);
  await viewer.choose('camera', '0');
  await viewer.page.waitForFunction(() => {
    const view = new URLSearchParams(location.hash.slice(1)).get('view').split(',').map(Number);
    return [0, 0, 6, 0, 0, 0].every((x, at) => Math.abs(x - view[at]) < 1e-3);
  });
});

test('a link shows the same', async () => {
  await viewer.click('#open-sample');
  await viewer.click('#reset');
  await viewer.choose('right', 'lengyel');
  await viewer.click('input[value=tangent]');
  await viewer.click('#flip-w');
  await viewer.slide('split', 40);
  await viewer.page.focus('#view');
  for (const key of ['ArrowLeft', 'ArrowUp', '+']) await viewer.page.keyboard.press(key);
  await viewer.page.waitForFunction(() => /right=lengyel.*split=40.*flip-w=1.*paint=tangent.*view=/.test(location.hash));
  await viewer.page.waitForTimeout(500);
  await viewer.page.$eval('#view', (view) => view.blur());
  const expected = await viewer.picture();
  const other = await Viewer.open(chromium, viewer.page.url());
  const same = (await other.picture()).differs(expected);
  assert.ok(same < 0.01, `${same} differs`);
  assert.equal(await other.page.inputValue('#right'), 'lengyel');
  assert.deepEqual(other.faults, []);
  await other.close();
  await viewer.click('#reset');
  assert.deepEqual([await viewer.page.inputValue('#right'), await viewer.page.inputValue('#split')], ['mikktspace', '50']);
});

test('a page that lies in a folder opens the model that its address names', async () => {
  const page = await Viewer.open(chromium, `${server.address}?file=shield.glb`);
  assert.deepEqual([await page.text('name'), await page.text('error')], ['shield.glb', '']);
  await page.close();
  const foreign = await Viewer.open(chromium, `${server.address}?file=${encodeURIComponent('https://example.com/a.glb')}`);
  assert.match(await foreign.text('error'), /^https:\/\/example\.com\/a\.glb is on another machine/);
  assert.deepEqual(foreign.faults, []);
  await foreign.close();
});
