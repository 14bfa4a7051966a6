// The pixels of the sample model in every view.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { browser, serve, Viewer } from './page.mjs';
import { gltf } from './quads.mjs';

let server, chromium, viewer;

before(async () => {
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address);
});

after(async () => {
  await chromium?.close();
  server?.close();
  assert.deepEqual(viewer?.faults, []);
});

/** Colours that occur nowhere else on the page. */
const isRed = (r, g, b) => r > 200 && g < 110 && b < 110;
const isGreen = (r, g, b) => g > 150 && r < 120 && b < 120;
const isBlue = (r, g, b) => b > 200 && r < 130 && g < 170;
const isMagenta = (r, g, b) => r > 220 && b > 180 && g < 130;
const isPlus = (r, g, b) => b > r + 60 && g > r;
const isMinus = (r, g, b) => r > b + 80 && g < r;

test('the page opens with a sample and reports its faults', async () => {
  assert.equal(await viewer.text('name'), 'shield.glb');
  assert.equal(await viewer.text('error'), '');
  assert.equal(await viewer.text('status'), '768 triangles in 1 part');
  assert.equal((await viewer.codes())[0], 'tangent-shared-across-mirror');
  assert.equal(await viewer.page.inputValue('#left'), 'file');
});

test('white stays below white, so that its shading is seen', async () => {
  // A white ball without a material.
  const [count, lines] = [24, []];
  for (let j = 0; j <= count; j++) {
    for (let i = 0; i <= 2 * count; i++) {
      const [a, b] = [(Math.PI * j) / count, (Math.PI * i) / count];
      const place = [Math.sin(a) * Math.sin(b), Math.cos(a), Math.sin(a) * Math.cos(b)].join(' ');
      lines.push(`v ${place}`, `vn ${place}`, `vt ${i / (2 * count)} ${1 - j / count}`);
    }
  }
  for (let j = 0; j < count; j++) {
    for (let i = 0; i < 2 * count; i++) {
      const row = 2 * count + 1;
      lines.push(`f ${[j * row + i, (j + 1) * row + i, (j + 1) * row + i + 1, j * row + i + 1].map((at) => `${at + 1}/${at + 1}/${at + 1}`).join(' ')}`);
    }
  }
  await viewer.page.setInputFiles('#files', { name: 'ball.obj', mimeType: 'text/plain', buffer: Buffer.from(lines.join('\n')) });
  await viewer.settled();
  const picture = await viewer.picture();
  const isLit = (limit) => (r, g, b) => Math.min(r, g, b) > limit;
  const ball = picture.share(isLit(90));
  assert.ok(ball > 0.1, 'most of the ball is bright');
  assert.ok(picture.share(isLit(235)) < 0.02 * ball, 'and not washed out');
  assert.ok(picture.share(isLit(200)) > 0.3 * ball, 'and it is white');
  await viewer.click('#open-sample');
});

test('the slider separates two sources', async () => {
  await viewer.slide('split', 100);
  const left = await viewer.picture();
  await viewer.slide('split', 0);
  const right = await viewer.picture();
  assert.ok(left.differs(right, 0.4, 0.6) > 0.01, 'the seam is broken on the left');
  assert.ok(left.differs(right, 0, 0.35) < 0.002 && left.differs(right, 0.65) < 0.002, 'all else is the same');
  await viewer.slide('split', 50);
  const both = await viewer.picture();
  assert.equal(both.differs(left, 0, 0.49), 0);
  assert.equal(both.differs(right, 0.51), 0);
});

test('every source shows a surface, and derivatives show facets', async () => {
  await viewer.slide('split', 100);
  const pictures = {};
  for (const source of ['mikktspace', 'angle-area', 'lengyel', 'derivatives']) {
    await viewer.choose('left', source);
    pictures[source] = await viewer.picture();
    assert.equal(await viewer.text('error'), '');
  }
  assert.ok(pictures.mikktspace.differs(pictures.derivatives) > 0.005);
  assert.ok(pictures.mikktspace.differs(pictures['angle-area']) < 0.1);
  await viewer.choose('left', 'file');
});

test('signs have two colours, one for each half', async () => {
  await viewer.slide('split', 0);
  await viewer.click('input[value=sign]');
  const picture = await viewer.picture();
  const [plus, minus] = [picture.share(isPlus, 0, 0.38), picture.share(isMinus, 0.6)];
  assert.ok(picture.share(isPlus) > 0.05 && picture.share(isMinus) > 0.05);
  assert.ok((plus < 0.001) === (minus < 0.001), 'each half has one');
  assert.match(await viewer.text('legend'), /w = 1.*w = -1/);
});

test('the angle between the sides has a scale in degrees, and flips a colour of their own', async () => {
  await viewer.click('input[value=angle]');
  assert.match(await viewer.text('legend'), /0.01°.*1°.*180°.*signs differ/);
  const picture = await viewer.picture();
  assert.ok(picture.share((r, g, b) => r > 200 && g < 60 && b < 60) > 0.002, 'flipped triangles are red');
  assert.ok(picture.share((r, g, b) => r < 90 && g < 40 && b > 50) > 0.1, 'what agrees is dark');
  await viewer.choose('right', 'file');
  const same = await viewer.picture();
  assert.equal(same.share((r, g, b) => r > 200 && g < 60 && b < 60), 0, 'a source agrees with itself');
  await viewer.choose('right', 'mikktspace');
});

test('the UV layout has the same colours', async () => {
  const before = await viewer.picture();
  await viewer.click('#layout');
  const picture = await viewer.picture();
  assert.ok(picture.differs(before, 0.65) > 0.1);
  assert.equal(picture.differs(before, 0, 0.4), 0);
  await viewer.click('#layout');
});

test('frames and seams are drawn as lines', async () => {
  await viewer.click('input[value=normal]');
  for (const [id, isTheirs] of [['lines-tangent', isRed], ['lines-bitangent', isGreen], ['lines-normal', isBlue], ['seams', isMagenta]]) {
    const before = (await viewer.picture()).share(isTheirs);
    await viewer.click(`#${id}`);
    assert.ok((await viewer.picture()).share(isTheirs) > before + 0.0003, id);
    await viewer.click(`#${id}`);
  }
  await viewer.click('input[value=shaded]');
});

test('mistakes change the right side only', async () => {
  await viewer.slide('split', 50);
  const before = await viewer.picture();
  for (const mistake of ['green', 'w', 'v']) {
    await viewer.click(`#flip-${mistake}`);
    const picture = await viewer.picture();
    assert.ok(picture.differs(before, 0.5) > 0.05, mistake);
    assert.equal(picture.differs(before, 0, 0.49), 0, mistake);
    assert.equal(await viewer.page.getAttribute(`#flip-${mistake}`, 'aria-pressed'), 'true');
    assert.notEqual(await viewer.text('mistake'), '');
    await viewer.click(`#flip-${mistake}`);
  }
  assert.equal((await viewer.picture()).differs(before), 0);
});

test('the light moves', async () => {
  const before = await viewer.picture();
  await viewer.slide('light-around', -120);
  assert.ok((await viewer.picture()).differs(before) > 0.05);
  await viewer.slide('light-around', 40);
  assert.equal((await viewer.picture()).differs(before), 0);
});

test('a lit model stands on the ground, unless it is seen from below or the switch is off', async () => {
  const page = await Viewer.open(chromium, `${server.address}#first-sight=0`, { colorScheme: 'light' });
  const darkened = async () => {
    // The line around what has the focus is no part of the picture.
    await page.page.$eval('#view', (view) => view.blur());
    const on = await page.picture();
    await page.click('#ground');
    const off = await page.picture();
    await page.click('#ground');
    return on.differs(off);
  };
  assert.ok((await darkened()) > 0.01, 'shaded');
  await page.click('input[name=paint][value=sign]');
  assert.equal(await darkened(), 0, 'frames as colours have no ground');
  await page.click('input[name=paint][value=plain]');
  assert.ok((await darkened()) > 0.01, 'plain grey');
  await page.click('#ground');
  await page.page.waitForFunction(() => /ground=0/.test(location.hash));
  const other = await Viewer.open(chromium, page.page.url());
  assert.equal(await other.page.isChecked('#ground'), false, 'a link carries the switch');
  await other.close();
  await page.click('#reset');
  assert.equal(await page.page.isChecked('#ground'), true);
  await page.page.focus('#view');
  for (let press = 0; press < 12; press++) await page.page.keyboard.press('ArrowDown');
  await page.settled();
  assert.equal(await darkened(), 0, 'not from below');
  assert.deepEqual(page.faults, []);
  await page.close();
});

test('a sentence beside the switch says where a model has too many triangles for the ground', async () => {
  const page = await Viewer.open(chromium, server.address);
  const open = async (copies) => {
    const extension = 'EXT_mesh_gpu_instancing';
    // Large triangles that lie flat need more samples than small ones. They face down, so that they are not drawn.
    const placed = (attributes) => ({ extensionsUsed: [extension], nodes: [{ mesh: 0, rotation: [Math.SQRT1_2, 0, 0, Math.SQRT1_2], extensions: { [extension]: { attributes } } }] });
    const name = `${copies}.gltf`;
    const buffer = Buffer.from(gltf({ more: { TRANSLATION: [new Float32Array(3 * copies), 3] }, json: placed }));
    await page.page.setInputFiles('#files', { name, mimeType: 'model/gltf+json', buffer });
    await page.page.waitForFunction((name) => document.getElementById('name').textContent === name, name);
    await page.settled();
    await page.reveal('#ground');
    return page.page.isVisible('#no-ground');
  };
  assert.equal(await open(1), false);
  assert.equal(await open(2000), true);
  assert.match(await page.text('no-ground'), /no ground: it has too many triangles/);
  await page.click('#ground');
  assert.equal(await page.page.isVisible('#no-ground'), false, 'nobody asks for a ground');
  assert.deepEqual(page.faults, []);
  await page.close();
});
