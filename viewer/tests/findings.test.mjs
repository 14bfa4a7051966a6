// The findings of the check: listed, visited, repaired and saved, and the normal maps with their verdicts.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { changedMap, glb, parts, shield, withImage } from './glb.mjs';
import { browser, serve, Viewer } from './page.mjs';

const DARBOUX = process.env.DARBOUX;

let server, chromium, viewer, folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'viewer-'));
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { viewport: { width: 800, height: 500 } });
});

after(async () => {
  await chromium?.close();
  server?.close();
  rmSync(folder, { recursive: true });
  assert.deepEqual(viewer?.faults.filter((fault) => !fault.includes("Couldn't load texture")), []);
});

const isMagenta = (r, g, b) => r > 200 && b > 150 && g < 140;

async function open(name, bytes) {
  writeFileSync(join(folder, name), bytes);
  await viewer.give('files', [join(folder, name)]);
}

const codes = async () => (await viewer.findings()).map(({ code }) => code);

test('findings have a severity in words, a sentence, a look, a cure, and evidence on demand', async () => {
  const findings = await viewer.findings();
  assert.deepEqual(findings.map(({ code }) => code), ['tangent-shared-across-mirror', 'tangent-sign-mixed', 'tangent-other-recipe', 'uv-mirrored', 'uv-overlapping']);
  assert.equal(await viewer.text('findings-summary'), '1 error, 2 warnings, 2 notes.');
  const diagnosis = await viewer.text('diagnosis');
  assert.match(diagnosis, /Shield.*A line along the middle of the model.* Press Repair\.$/s);
  assert.ok(!diagnosis.includes('`'), diagnosis);
  const words = { error: 'Error', warning: 'Warning', info: 'Note' };
  for (const { severity, text } of findings) {
    assert.match(text, new RegExp(`^${words[severity]}\\s*Shield: .*\\.\\s+Looks like: .*\\s+Cure: .*\\s+Evidence`), text);
  }
  const icons = await viewer.page.$$eval('#findings svg, #notes-list svg', (all) => all.map((icon) => icon.querySelector('.shape').getAttribute('d')));
  assert.equal(new Set(icons).size, 3, 'every severity has a shape of its own');
  const evidence = viewer.page.locator('#findings li').first().locator('dl');
  assert.equal(await evidence.isVisible(), false);
  await viewer.page.locator('#findings summary').first().click();
  assert.match(await evidence.innerText(), /tangent-shared-across-mirror.*25.*vertices/s);
});

/** Waits until the status says where the camera is, and until it is there. */
async function arrived({ source }) {
  await viewer.page.waitForFunction((source) => new RegExp(source, 's').test(document.getElementById('status').textContent), source);
  await viewer.settled();
}

test('a click leads to each place of a finding, and marks it', async () => {
  for (const [code, kind] of [['tangent-shared-across-mirror', 'vertex'], ['tangent-sign-mixed', 'triangle']]) {
    const before = await viewer.picture();
    await viewer.click(`[data-code=${code}] button`);
    await arrived(new RegExp(`^Shield: .*, ${kind} \\d+, place 1 of 8, at \\(.*\\)$`));
    const there = await viewer.picture();
    assert.ok(there.differs(before) > 0.1, 'the camera went there');
    assert.ok(there.share(isMagenta, 0.45, 0.55) > 0.0005, 'the place is in the middle, and marked');
    await viewer.click(`[data-code=${code}] button`);
    await arrived(/, place 2 of 8, at /);
  }
  await viewer.click('[data-code=tangent-other-recipe] button');
  await arrived(/^Shield: the tangents were computed by .*, at /);
  assert.ok((await viewer.picture()).share(isMagenta) > 0.0005, 'the whole part is marked');
});

test('a repair shows before and after, says what it did, and is saved', async () => {
  await viewer.click('#open-sample');
  await viewer.slide('split', 100);
  const before = await viewer.picture();
  await viewer.click('#repair');
  assert.deepEqual([await viewer.page.inputValue('#left'), await viewer.page.inputValue('#right')], ['file', 'repaired']);
  assert.equal((await viewer.picture()).differs(before), 0, 'the left side is as it was');
  await viewer.slide('split', 0);
  assert.ok((await viewer.picture()).differs(before, 0.4, 0.6) > 0.005, 'the seam is repaired on the right');
  assert.match(await viewer.text('findings-summary'), /; 2 of them repaired\.$/);
  const became = Object.fromEntries((await viewer.findings()).map(({ code, text }) => [code, /✓ Repaired|Left, because .*/.exec(text)?.[0]]));
  assert.equal(became['tangent-shared-across-mirror'], '✓ Repaired');
  assert.match(became['uv-mirrored'], /^Left, because /);
  assert.equal(await viewer.page.isVisible('#repair'), false);
  assert.equal(await viewer.page.isDisabled('input[value=angle]'), true);
  const { name, bytes } = await viewer.download('#save-repaired');
  assert.equal(name, 'shield.repaired.glb');
  if (DARBOUX) {
    writeFileSync(join(folder, 'shield.glb'), shield());
    const command = join(folder, 'command.glb');
    execFileSync(DARBOUX, ['check', '--fix', '--quiet', '--fail-on', 'never', join(folder, 'shield.glb'), '-o', command]);
    assert.ok(bytes.equals(readFileSync(command)), 'the same bytes as those of the command');
  }
  await open('again.glb', bytes);
  const left = (await viewer.findings()).filter(({ severity }) => severity !== 'info');
  assert.deepEqual(left.map(({ code }) => code), ['tangent-other-recipe'], 'the method is kept');
  assert.equal(await viewer.page.isVisible('#repair'), false, 'there is nothing left to repair');
  assert.equal(await viewer.page.inputValue('#right'), 'mikktspace');
  await viewer.slide('split', 50);
});

test('a map has its verdict and the tiles that voted, and a repaired one is shown beside it', async () => {
  await viewer.click('#open-sample');
  assert.match(await viewer.text('maps'), /^image 0 \(Bronze\)OpenGL: green points up, as glTF wants it \(99\.\d % sure\)\.▲ [\d,]+ tiles for up▼ \d+ for down/);
  await open('flipped.glb', withImage(changedMap(([r, g, b]) => [r, 255 - g, b])));
  assert.ok((await codes()).includes('map-green-flipped'));
  assert.match(await viewer.text('maps'), /DirectX: green points down, .*▲ \d+ tiles for up▼ [\d,]+ for down/);
  const pixels = () => viewer.page.$eval('#maps canvas', (canvas) => canvas.toDataURL());
  const withTiles = await pixels();
  await viewer.click('#tiles');
  assert.notEqual(await pixels(), withTiles);
  await viewer.click('#tiles');
  assert.equal(await pixels(), withTiles);
  await viewer.click('[data-code=map-green-flipped] button');
  assert.equal(await viewer.page.evaluate(() => document.activeElement.dataset.image), '0', 'a click leads to the map');
  await viewer.click('#repair');
  assert.match(await viewer.text('maps'), /DirectX: .*After the repair: .*OpenGL: green points up/);
});

test('an image that cannot be decoded is a finding, and the model is shown', async () => {
  await open('undecodable.glb', withImage(Buffer.from('this is no image')));
  assert.equal(await viewer.text('error'), '');
  assert.match(await viewer.text('status'), /^768 triangles in 1 part; 1 texture missing or not decodable$/);
  assert.ok((await codes()).includes('map-unreadable'));
  assert.match(await viewer.text('maps'), /The image cannot be decoded/);
});

test('findings name the parts of a model with several meshes', async () => {
  const { json, binary } = parts(shield());
  json.meshes.push({ name: 'Second', primitives: [{ ...json.meshes[0].primitives[0], attributes: { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2 } }] });
  json.nodes.push({ mesh: 1, translation: [3, 0, 0] });
  json.scenes[0].nodes.push(1);
  await open('two.glb', glb(json, binary));
  await viewer.click('[data-code=tangent-missing] button');
  assert.match(await viewer.text('status'), /^Second: its material has a normal map, and it has no tangents, at \((2\.9|3|3\.0)/);
});

test('an OBJ is checked, too', async () => {
  await open('quad.obj', 'v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 -1\nf 1/1/1 2/2/1 3/3/1\n');
  assert.deepEqual(await codes(), ['normal-against-winding']);
  await viewer.click('#findings button');
  assert.match(await viewer.text('status'), /, triangle 0, place 1 of 1, at \(0\.6666667, 0\.3333333, 0\)$/);
});
