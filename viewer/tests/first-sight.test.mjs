// The first screen of a model: its worst fault, the file and the cure, one sentence; and what is shared of it.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { changedMap, glb, parts, shield, withImage } from './glb.mjs';
import { browser, Picture, serve, Viewer } from './page.mjs';
import { gltf } from './quads.mjs';

let server, chromium;

before(async () => {
  [server, chromium] = [await serve(), await browser()];
});

after(async () => {
  await chromium?.close();
  server?.close();
});

/** Opens the page as people do. `state`: of controls, as in links. */
async function opened(use, options = {}, state = '') {
  const viewer = await Viewer.open(chromium, `${server.address}#${state}`, { viewport: { width: 800, height: 500 }, ...options });
  await use(viewer);
  assert.deepEqual(viewer.faults, []);
  await viewer.close();
}

async function give(viewer, name, buffer) {
  await viewer.page.setInputFiles('#files', { name, mimeType: 'model/gltf-binary', buffer });
  // Until the page has begun with this file, it is at rest with the one before.
  await viewer.page.waitForFunction((name) => document.getElementById('name').textContent === name, name);
  await viewer.settled();
}

const isOutline = (r, g, b) => b > 200 && g > 180 && r < 130;

test('the camera goes to the fault, which has an outline, and a sentence says what it is and what the cure costs', () =>
  opened(async (viewer) => {
    assert.match(await viewer.text('verdict-text'), /^Shield: 25 vertices serve both sides of mirrored UV seams\. .* The repaired file has 25 vertices more and [\d.]+ kB more\.$/);
    assert.equal(await viewer.page.inputValue('#split'), '62');
    const near = await viewer.picture();
    assert.ok(near.share(isOutline) > 0.003, 'the outline is seen');
    assert.match(await viewer.text('legend'), /around the fault/);
    await viewer.click('#outline');
    assert.equal((await viewer.picture()).share(isOutline), 0);
    await viewer.press('#verdict-close');
    assert.equal(await viewer.page.isVisible('#verdict'), false);
    await viewer.page.focus('#view');
    await viewer.page.keyboard.press('Home');
    await viewer.settled();
    const isBack = (r, g, b) => Math.abs(r - 223) < 3 && Math.abs(g - 225) < 3 && Math.abs(b - 228) < 3;
    assert.ok(near.share(isBack) + 0.1 < (await viewer.picture()).share(isBack), 'the fault was seen from nearby');
  }));

/** A strip whose signs are wrong at its upper end, or at its right end if it lies. u grows towards that. */
function strip(lies = false) {
  const count = 40;
  const vertices = Array.from({ length: 2 * (count + 1) }, (_, at) => [0.5 - (at & 1), ((at >> 1) / count - 0.5) * 8]);
  const of = (width, values) => [Float32Array.from(vertices.flatMap(values)), width];
  const attributes = {
    POSITION: of(3, ([x, y]) => (lies ? [y, -x, 0] : [x, y, 0])),
    NORMAL: of(3, () => [0, 0, 1]),
    TEXCOORD_0: of(2, ([x, y]) => [y / 8, 0.5 + x]),
    TANGENT: of(4, ([, y]) => [...(lies ? [1, 0] : [0, 1]), 0, y > (lies ? 3.5 : 3) ? -1 : 1]),
  };
  const indices = Uint16Array.from({ length: 6 * count }, (_, at) => 2 * Math.floor(at / 6) + [0, 2, 1, 1, 2, 3][at % 6]);
  const { json, binary } = parts(shield());
  const { byteOffset, byteLength } = json.bufferViews[json.images[0].bufferView];
  const uri = `data:image/png;base64,${binary.subarray(byteOffset, byteOffset + byteLength).toString('base64')}`;
  const dressed = { materials: [{ normalTexture: { index: 0 } }], textures: [{ source: 0 }], images: [{ uri }] };
  return Buffer.from(gltf({ attributes, indices, primitive: { material: 0 }, json: () => dressed }));
}

/** The number of the model's pixels that nothing covers, and the part of them that is left of the divide. */
async function seen(viewer) {
  // The line around what has the focus is no part of the picture.
  await viewer.page.$eval('#view', (view) => view.blur());
  const [top, bottom] = await viewer.page.evaluate(() => {
    const [view, caption, verdict] = ['view', 'caption-left', 'verdict'].map((id) => document.getElementById(id).getBoundingClientRect());
    return [caption.bottom - view.top, verdict.top - view.top];
  });
  const { width, data } = await viewer.picture();
  const divide = ((await viewer.page.inputValue('#split')) / 100) * width;
  let [left, area] = [0, 0];
  for (let at = width * Math.round(top); at < width * Math.round(bottom); at++) {
    const isModel = [0x33, 0x37, 0x3e].some((channel, i) => Math.abs(data[4 * at + i] - channel) > 3);
    area += Number(isModel);
    left += Number(isModel && at % width < divide);
  }
  return { area, left: left / area };
}

test('a third of the model is in sight at first, and a fifth of that on each side of the divide', () =>
  opened(
    async (viewer) => {
      await give(viewer, 'strip.gltf', strip());
      assert.match(await viewer.text('verdict-text'), /signs w/);
      const near = await seen(viewer);
      await viewer.page.focus('#view');
      const presses = 12;
      for (let press = 0; press < presses; press++) await viewer.page.keyboard.press('-');
      await viewer.settled();
      const inSight = near.area / ((await seen(viewer)).area * 1.15 ** (2 * presses));
      assert.ok(near.left > 0.19 && near.left < 0.81, `${near.left} of the model is left of the divide`);
      assert.ok(inSight > 0.28, `${inSight} of the model is in sight`);
      assert.ok(inSight < 0.9, 'the fault is seen from nearby');
    },
    { colorScheme: 'dark' },
    'ground=0',
  ));

test('a fault at the right end of a model is not hidden under the cure', () =>
  opened(
    async (viewer) => {
      await give(viewer, 'lying.gltf', strip(true));
      assert.match(await viewer.text('verdict-text'), /signs w/);
      const split = Number(await viewer.page.inputValue('#split'));
      assert.ok(split >= 50 && (await seen(viewer)).left < 1, `the divide stands at ${split} %`);
    },
    { colorScheme: 'dark' },
    'ground=0',
  ));

test('a fault of a map is shown beside the repaired file; a model without a fault is shown whole, without a sentence', () =>
  opened(async (viewer) => {
    const bare = (file) => {
      const { json, binary } = parts(file);
      delete json.meshes[0].primitives[0].attributes.TANGENT;
      return glb(json, binary);
    };
    await give(viewer, 'flipped.glb', bare(withImage(changedMap(([r, g, b]) => [r, 255 - g, b]))));
    assert.match(await viewer.text('verdict-text'), /^Image 0: it is in the convention of DirectX.*Dents look like bumps/);
    assert.equal(await viewer.page.inputValue('#right'), 'repaired');
    await give(viewer, 'bare.glb', bare(shield()));
    assert.equal(await viewer.page.isVisible('#verdict'), false);
  }));

test('where textures hide a fault, the surface is plain grey until the next model', () =>
  opened(async (viewer) => {
    const { json, binary } = parts(shield());
    const [material] = json.materials;
    // A black surface without highlights.
    material.pbrMetallicRoughness = { baseColorFactor: [0, 0, 0, 1], roughnessFactor: 1, metallicFactor: 0 };
    await give(viewer, 'black.glb', glb(json, binary));
    assert.equal(await viewer.page.isChecked('input[value=plain]'), true);
    assert.match(await viewer.text('chips'), /^Plain grey/);
    await give(viewer, 'shield.glb', shield());
    assert.equal(await viewer.page.isChecked('input[value=shaded]'), true);
  }));

test('where both sides look alike, it says by how much they differ, and shows where', () =>
  opened(async (viewer) => {
    const { json, binary } = parts(shield());
    json.materials[0].normalTexture.scale = 0.01;
    await give(viewer, 'smooth.glb', glb(json, binary));
    assert.match(await viewer.text('verdict-text'), /Both sides look alike from here: they differ by [\d.]+° \(median\), \d+° \(worst\); the signs differ at \d+ vertices: show$/);
    await viewer.click('#verdict-text button');
    assert.equal(await viewer.page.isChecked('input[value=angle]'), true);
  }));

test('the slider swings once, and a press stops it', () =>
  opened(
    async (viewer) => {
      // The places of the slider in every frame.
      await viewer.page.evaluate(() => {
        globalThis.places = [];
        const look = () => {
          globalThis.places.push(document.getElementById('split').valueAsNumber);
          requestAnimationFrame(look);
        };
        look();
      });
      const open = async () => {
        await viewer.page.evaluate(() => (globalThis.places.length = 0));
        await viewer.press('#open-sample');
        await viewer.page.waitForFunction(() => globalThis.places.some((place) => place > 68));
      };
      await open();
      await viewer.page.waitForFunction(() => globalThis.places.some((place) => place < 50) && globalThis.places.at(-1) === 62);
      await open();
      await viewer.page.mouse.click(300, 300);
      const stopped = await viewer.page.inputValue('#split');
      assert.notEqual(stopped, '62');
      await viewer.settled();
      await viewer.page.waitForTimeout(300);
      assert.equal(await viewer.page.inputValue('#split'), stopped, 'it stays where it was');
    },
    { reducedMotion: 'no-preference' },
  ));

test('a link decides what is seen first', async () => {
  const viewer = await Viewer.open(chromium, `${server.address}#view=0,0,9,0,0,0&tab=light&flip-green=1`, { viewport: { width: 800, height: 500 } });
  assert.equal(await viewer.page.isVisible('#verdict'), false);
  assert.equal(await viewer.page.isVisible('#panel-light'), true);
  assert.match(await viewer.text('caption-right'), /^MikkTSpace ✕ mistake: green flipped$/);
  await viewer.close();
});

test('saved pictures and clips carry captions and mistakes', () =>
  opened(async (viewer) => {
    await viewer.click('#flip-green');
    const { name, bytes } = await viewer.download('#save-picture');
    assert.equal(name, 'shield.png');
    const picture = await Picture.decode(viewer.page, bytes);
    const isError = (r, g, b) => r > 130 && g < 70 && b < 50 && r > 2.5 * g;
    assert.ok(picture.share(isError, 0.6) > 0.0005, 'the mistake is written in the colour of errors');
    const clip = await viewer.download('#save-clip');
    assert.equal(clip.name, 'shield.webm');
    assert.deepEqual([...clip.bytes.subarray(0, 4)], [0x1a, 0x45, 0xdf, 0xa3], 'it is WebM');
  }));

test('a broken file names itself on the canvas, and a drag shows where to drop', () =>
  opened(async (viewer) => {
    await viewer.page.setInputFiles('#files', { name: 'broken.glb', mimeType: 'model/gltf-binary', buffer: Buffer.from('glTF no more') });
    await viewer.settled();
    assert.match(await viewer.text('broken'), /broken\.glb/);
    const dispatch = (type) => viewer.page.evaluate((type) => document.dispatchEvent(new DragEvent(type, { bubbles: true, cancelable: true })), type);
    await dispatch('dragover');
    assert.equal(await viewer.page.isVisible('#drop-target'), true);
    await dispatch('dragleave');
    assert.equal(await viewer.page.isVisible('#drop-target'), false);
    await viewer.click('#open-sample');
    assert.equal(await viewer.page.isVisible('#broken'), false);
  }));
