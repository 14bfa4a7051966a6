// Baking in the page: a pair of models, the effect of the distance, misses, the end of a bake, and the saved maps.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { browser, Picture, serve, Viewer } from './page.mjs';
import { gltf } from './quads.mjs';

const DARBOUX = process.env.DARBOUX;

let server, chromium, viewer, folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'viewer-'));
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { viewport: { width: 900, height: 500 } });
});

after(async () => {
  await chromium?.close();
  server?.close();
  rmSync(folder, { recursive: true });
  assert.deepEqual(viewer?.faults, []);
});

/** A plate of unit size with waves of some height, as a glTF. */
function plate(side, height) {
  const places = Array.from({ length: (side + 1) ** 2 }, (_, at) => [(at % (side + 1)) / side - 0.5, Math.floor(at / (side + 1)) / side - 0.5]);
  const of = (width, values) => [Float32Array.from(places.flatMap(values)), width];
  const unit = (v) => v.map((x) => x / Math.hypot(...v));
  const slope = ([x, y]) => [-12 * height * Math.cos(12 * x) * Math.cos(12 * y), 12 * height * Math.sin(12 * x) * Math.sin(12 * y), 1];
  const attributes = {
    POSITION: of(3, ([x, y]) => [x, y, height * Math.sin(12 * x) * Math.cos(12 * y)]),
    NORMAL: of(3, (place) => unit(slope(place))),
    TEXCOORD_0: of(2, ([x, y]) => [x + 0.5, 0.5 - y]),
  };
  const corners = [0, 1, side + 2, 0, side + 2, side + 1];
  const indices = Uint32Array.from({ length: side * side * 6 }, (_, at) => {
    const quad = Math.floor(at / 6);
    return Math.floor(quad / side) * (side + 1) + (quad % side) + corners[at % 6];
  });
  return { attributes, indices };
}

const path = (name) => join(folder, name);

function write(name, model) {
  writeFileSync(path(name), gltf(model));
  return path(name);
}

/** Opens a flat plate and one with waves, whose height is 2 % of the diagonal. */
async function openPair() {
  await viewer.give('files', [write('plate_high.gltf', plate(96, 0.02 * Math.SQRT2)), write('plate_low.gltf', plate(2, 0))]);
}

const isRed = (r, g, b) => r > 200 && g < 60 && b < 60;

test('a pair that is dropped together is baked: the low model looks like the high one', async () => {
  await openPair();
  assert.deepEqual([await viewer.text('error'), await viewer.text('name')], ['', 'plate_low.gltf']);
  assert.deepEqual([await viewer.page.inputValue('#left'), await viewer.page.inputValue('#right')], ['high', 'baked']);
  await viewer.slide('bake-distance', 1);
  assert.match(await viewer.text('bake-result'), /^Rays of all 65,536 texels hit the high model\. Baked in [\d.e-]+ s$/);
  await viewer.slide('split', 100);
  const high = await viewer.picture();
  await viewer.slide('split', 0);
  const baked = await viewer.picture();
  await viewer.choose('right', 'mikktspace');
  const flat = await viewer.picture();
  const [near, far] = [baked.distance(high), flat.distance(high)];
  assert.ok(near < 0.35 * far, `the baked picture is ${near} from that of the high model, the flat one ${far}`);
  await viewer.choose('right', 'baked');
  await viewer.slide('split', 50);
});

test('a cage that is too small misses, which is seen at once', async () => {
  assert.equal((await viewer.picture()).share(isRed), 0);
  await viewer.slide('bake-distance', -1);
  assert.match(await viewer.text('bake-result'), /^Rays of \d+ % of the texels \([\d,]+\) hit nothing/);
  const missing = await viewer.picture();
  assert.ok(missing.share(isRed, 0.5) > 0.1, `${missing.share(isRed, 0.5)} red`);
  assert.equal(missing.share(isRed, 0, 0.49), 0, 'on the low model only');
  await viewer.click('#bake-misses');
  assert.equal((await viewer.picture()).share(isRed), 0);
  await viewer.click('#bake-misses');
  await viewer.pick('#bake-rays', 'normals');
  await viewer.slide('bake-inwards', 1);
  await viewer.slide('bake-distance', 1);
  assert.match(await viewer.text('bake-result'), /^Rays of all /);
  await viewer.pick('#bake-rays', 'cage');
  await viewer.settled();
});

test('the saved map is the command\'s', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  await viewer.pick('#bake-size', '128');
  await viewer.pick('#bake-samples', '2');
  await viewer.slide('bake-distance', 0.8);
  const { name, bytes } = await viewer.download('#bake-save');
  assert.equal(name, 'plate_low.normal.png');
  const offset = String((10 ** 0.8 / 100) * Math.SQRT2);
  const options = ['--size', '128', '--samples', '4', '--bits', '8', '--cage-offset', offset, '--quiet'];
  execFileSync(DARBOUX, ['bake', path('plate_low.gltf'), '--high', path('plate_high.gltf'), '-o', path('map.png'), ...options]);
  const [ours, theirs] = [await Picture.decode(viewer.page, bytes), await Picture.decode(viewer.page, readFileSync(path('map.png')))];
  assert.deepEqual([ours.width, ours.height], [theirs.width, theirs.height]);
  assert.ok(ours.data.equals(theirs.data), 'the same texels');
  assert.ok(ours.share((r, g, b) => r !== 128 || g !== 128 || b !== 255) > 0.9, 'with content');
});

/** The further maps that are listed. */
const listed = () => viewer.page.locator('#bake-maps figure:not([hidden]) button').allTextContents();

test('further maps share a bake with the normal map: they are listed, saved, and shown on the model', async () => {
  const high = JSON.parse(gltf(plate(96, 0.02 * Math.SQRT2)));
  high.materials = [{ pbrMetallicRoughness: { baseColorFactor: [1, 0, 0, 1] } }];
  high.meshes[0].primitives[0].material = 0;
  writeFileSync(path('red_high.gltf'), JSON.stringify(high));
  await viewer.give('files', [path('red_high.gltf'), path('plate_low.gltf')]);
  await viewer.pick('#bake-size', '128');
  await viewer.pick('#bake-samples', '1');
  await viewer.slide('bake-distance', 0.8);
  const redRight = async () => (await viewer.picture()).share((r, g, b) => r > 2 * g && r > 2 * b, 0.51);
  assert.deepEqual([await listed(), await redRight()], [[], 0]);
  for (const kind of ['ao', 'base-color']) await viewer.click(`#bake-kind-${kind}`);
  assert.deepEqual(await listed(), ['Save ao', 'Save base-color']);
  assert.ok((await redRight()) > 0.1, `${await redRight()} red`);
  assert.deepEqual(await viewer.violations(), []);
  const saved = {};
  for (const kind of await listed()) {
    const { name, bytes } = await viewer.download(`#bake-maps button:text-is("${kind}")`);
    assert.equal(bytes.subarray(0, 8).toString('latin1'), '\x89PNG\r\n\x1a\n');
    saved[name] = await Picture.decode(viewer.page, bytes);
  }
  assert.deepEqual(Object.entries(saved).map(([name, { width, height }]) => [name, width, height]), [['plate_low.ao.png', 128, 128], ['plate_low.base-color.png', 128, 128]]);
  assert.equal(saved['plate_low.base-color.png'].share((r, g, b) => r === 255 && g === 0 && b === 0), 1);
  assert.ok(saved['plate_low.ao.png'].share((r, g, b) => r === g && g === b && r < 250) > 0.1, 'the valleys are occluded');
});

test('a baked base colour is not multiplied by colours of the vertices', async () => {
  const low = plate(2, 0);
  low.attributes.COLOR_0 = [Float32Array.from(low.attributes.POSITION[0], (_, at) => Number(at % 3 === 2)), 3];
  await viewer.give('files', [path('red_high.gltf'), write('blue_low.gltf', low)]);
  await viewer.slide('split', 0);
  const part = async (channel) => (await viewer.picture()).share((...texel) => texel[channel] > 1.2 * Math.max(...texel.filter((_, at) => at !== channel)));
  const [red, blue] = [await part(0), await part(2)];
  assert.ok(red > 0.1 && blue === 0, `${red} red, ${blue} blue`);
  await viewer.click('#bake-kind-base-color');
  assert.ok((await part(2)) > 0.1, 'without the map, the low model is blue');
  await viewer.click('#bake-kind-base-color');
  await viewer.slide('split', 50);
  await viewer.give('files', [path('red_high.gltf'), path('plate_low.gltf')]);
});

test('the further maps are the command\'s', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  const kinds = ['ao', 'base-color', 'curvature', 'thickness', 'height', 'position', 'object-normal', 'id'];
  for (const kind of kinds) await viewer.page.setChecked(`#bake-kind-${kind}`, true);
  await viewer.settled();
  const offset = String((10 ** 0.8 / 100) * Math.SQRT2);
  const options = ['--size', '128', '--bits', '8', '--cage-offset', offset, '--quiet', '--map', kinds.join(',')];
  execFileSync(DARBOUX, ['bake', path('plate_low.gltf'), '--high', path('red_high.gltf'), '-o', path('maps.png'), ...options]);
  const apart = {};
  for (const kind of kinds) {
    const { bytes } = await viewer.download(`#bake-figure-${kind} button`);
    const [ours, theirs] = [await Picture.decode(viewer.page, bytes), await Picture.decode(viewer.page, readFileSync(path(`maps.${kind}.png`)))];
    apart[kind] = ours.data.reduce((most, x, at) => Math.max(most, Math.abs(x - theirs.data[at])), 0);
  }
  for (const kind of kinds) await viewer.page.setChecked(`#bake-kind-${kind}`, ['ao', 'base-color'].includes(kind));
  await viewer.settled();
  // The command rounds in single precision before it rounds to codes.
  assert.ok(Object.values(apart).every((codes) => codes <= 1), JSON.stringify(apart));
});

test('a link carries the chosen maps, plain grey leaves them out, and Reset takes them away', async () => {
  await viewer.page.waitForFunction(() => /bake-kind-ao=1&bake-kind-base-color=1/.test(location.hash));
  await viewer.click('input[name=paint][value=plain]');
  assert.equal((await viewer.picture()).share((r, g, b) => r > 2 * g && r > 2 * b), 0);
  await viewer.click('#bake-kind-ao');
  assert.deepEqual(await listed(), ['Save base-color']);
  await viewer.click('#reset');
  assert.deepEqual(await listed(), []);
  await openPair();
  await viewer.slide('bake-distance', 1);
});

test('a bake can be ended, and the next change starts another one', async () => {
  await viewer.pick('#bake-samples', '4');
  await viewer.pick('#bake-size', '2048');
  await viewer.page.waitForSelector('#bake-cancel', { state: 'visible' });
  await viewer.page.waitForFunction(() => document.getElementById('bake-progress').value > 0);
  await viewer.page.focus('#bake-cancel');
  await viewer.page.keyboard.press('Enter');
  await viewer.page.waitForSelector('#bake-cancel', { state: 'hidden' });
  assert.match(await viewer.text('bake-result'), /^The bake was ended/);
  assert.equal(await viewer.page.evaluate(() => document.activeElement.id), 'bake-rays', 'the focus stays in the panel');
  await viewer.pick('#bake-samples', '1');
  await viewer.page.waitForSelector('#bake-cancel', { state: 'visible' });
  await viewer.pick('#bake-size', '256');
  await viewer.settled();
  assert.match(await viewer.text('bake-result'), /^Rays of all 65,536 texels/);
});

test('the controls of a bake are accessible, and Reset sets them back', async () => {
  assert.deepEqual(await viewer.violations(), []);
  await viewer.slide('bake-distance', 1.2);
  assert.equal(await viewer.page.getAttribute('#bake-distance', 'aria-valuetext'), "16 % of the model's diagonal");
  await viewer.page.waitForFunction(() => /bake-distance=1\.2/.test(location.hash));
  await viewer.click('#reset');
  assert.deepEqual([await viewer.page.inputValue('#bake-distance'), await viewer.page.inputValue('#bake-samples')], ['0.3', '1']);
});

test('a high model for the open one by button, and the sentence about a pair that cannot be baked', async () => {
  const { POSITION, NORMAL } = plate(2, 0).attributes;
  await viewer.give('files', [write('bare.gltf', { attributes: { POSITION, NORMAL }, indices: plate(2, 0).indices })]);
  assert.equal(await viewer.page.isVisible('#bake-controls'), false, 'the pair before is gone');
  await viewer.give('high', [path('plate_high.gltf')]);
  assert.match(await viewer.text('bake-result'), /^There is no map: the low model: no triangles have UVs, onto which to bake; unwrap the model first\.$/);
  await viewer.give('files', [path('plate_low.gltf')]);
  await viewer.give('high', [path('plate_high.gltf')]);
  assert.equal(await viewer.page.inputValue('#right'), 'baked');
  assert.match(await viewer.text('bake-result'), /^Rays of /);
});

test('what cannot be a high model is refused in a sentence, and the low model is still checked', async () => {
  writeFileSync(path('text_high.glb'), 'no model');
  writeFileSync(path('picture.png'), 'no model either');
  for (const [high, sentence] of [['text_high.glb', /^text_high\.glb: is named as glTF, but its content is that of no format that is read /], ['picture.png', /^There is no model in these files \(picture\.png\); open /]]) {
    await viewer.give('files', [path('plate_low.gltf')]);
    await viewer.give('high', [path(high)]);
    assert.match(await viewer.text('error'), sentence);
  }
  write('nothing_high.gltf', { attributes: plate(2, 0).attributes, indices: new Uint32Array() });
  await viewer.give('high', [path('nothing_high.gltf')]);
  assert.match(await viewer.text('bake-result'), /^There is no map: the high model has no triangles; /);
  assert.equal(await viewer.page.isDisabled('#bake-save'), true);
  await viewer.give('files', [path('plate_low.gltf'), path('text_high.glb')]);
  assert.match(await viewer.text('error'), /^text_high\.glb: /);
  assert.doesNotMatch(await viewer.text('findings-summary'), /text_high/);
  assert.equal(await viewer.page.isVisible('#bake-controls'), false);
});

test('a model with several materials is baked for one of them', async () => {
  const low = JSON.parse(gltf(plate(2, 0)));
  const [one] = low.meshes[0].primitives;
  low.materials = [{ name: 'wood' }, {}];
  // Both primitives lie over the whole map.
  low.meshes[0].primitives = [{ ...one, material: 0 }, { ...one, material: 1 }];
  writeFileSync(path('two_low.gltf'), JSON.stringify(low));
  await viewer.give('files', [path('two_low.gltf'), path('plate_high.gltf')]);
  assert.deepEqual(await viewer.page.locator('#bake-material option').allTextContents(), ['All, on one map', 'wood', 'Material 1']);
  assert.match(await viewer.text('bake-result'), /Several triangles share/);
  await viewer.choose('bake-material', '1');
  assert.doesNotMatch(await viewer.text('bake-result'), /Several triangles share/);
  await viewer.click('#reset');
  assert.match(await viewer.text('bake-result'), /Several triangles share/);
});

test('the address of the page names a pair', async () => {
  const page = await Viewer.open(chromium, `${server.address}?file=shield.glb&high=shield.glb#bake-size=128&bake-misses=0`);
  assert.deepEqual([await page.text('error'), await page.page.inputValue('#right')], ['', 'baked']);
  assert.match(await page.text('bake-result'), /^Rays of /);
  const asked = await page.page.evaluate(() => [document.getElementById('bake-map').width, document.getElementById('bake-misses').checked]);
  assert.deepEqual(asked, [128, false], 'as the address asks');
  assert.deepEqual(page.faults, []);
  await page.close();
});
