// MikkTSpace on WebGPU, in headless Chromium.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { openDevice } from 'darboux/webgpu';
import { open, skip } from './browser/open.mjs';
import { corpus, native } from './corpus.mjs';

const readme = readFileSync(new URL('../README.md', import.meta.url), 'utf8');
const [example] = [...readme.matchAll(/```js\n([^]*?)```/g)].map(([, code]) => code).filter((code) => code.includes('darboux/webgpu'));

let browser;
let page;
let hasAdapter = false;
const faults = [];

before(async () => {
  if (skip) return;
  const texts = { example: `${example}\nexport { device, tangents, report, cpuCorners };` };
  ({ browser, page } = await open(fileURLToPath(new URL('browser/webgpu.mjs', import.meta.url)), texts));
  page.on('pageerror', (error) => faults.push(error.message));
  await page.evaluate(() => tested.ready);
  hasAdapter = await page.evaluate(() => tested.hasAdapter());
});

after(() => browser?.close());

/** A test that is skipped without an adapter. */
const onGpu = (name, work) =>
  test(name, { skip }, (context) => (hasAdapter ? work() : context.skip('this Chromium has no WebGPU adapter')));

onGpu('the corpus has the bits of the native library', async () => {
  for (const { name, arrays, options, answer } of corpus) {
    const [indices, ...words] = arrays.map((array) => Array.from(new Uint32Array(array.buffer))).reverse();
    const given = [[words.reverse(), indices], { ...options, faces: Array.from(options.faces) }];
    const { tangents, inTriangles } = await page.evaluate(([mesh, options]) => tested.ofWords(mesh, options), given);
    assert.deepEqual(native(tangents), native(answer.tangents), name);
    assert.deepEqual([inTriangles.differing, inTriangles.isReported], [0, true], `${name}, in triangles`);
  }
});

onGpu('meshes have the bits of the CPU, and what it did is counted', async () => {
  const of = async (name, options = {}) => {
    const { differing, isReported, corners, cpuCorners, cpuFallback } = await page.evaluate(([name, options]) => tested.onBothSides(name, options), [name, options]);
    assert.deepEqual([differing, isReported], [0, true], `${name} ${JSON.stringify(options)}`);
    return cpuFallback ?? cpuCorners / Math.max(corners, 1);
  };
  for (const name of ['waves', 'waves, indices of 16 bits', 'waves without indices', 'no triangles']) assert.equal(await of(name), 0, name);
  for (const name of ['mirrored squares', 'seams', 'degenerates', 'soup']) {
    for (const mode of ['reference', 'repaired', 'corrected']) {
      const share = await of(name, { mode });
      assert.ok(share > 0 && share < 1, `${name}: ${share}`);
    }
  }
  assert.ok((await of('waves', { threshold: 3 })) > 0.01);
  assert.equal(await of('tiny'), 1); // too small for floats to be exact
  assert.equal(await of('waves', { faces: 4 }), 'faces');
  assert.equal(await of('endless'), 'values');
  const [waves, seams] = await Promise.all([of('waves'), of('seams')]);
  assert.ok(waves === 0 && seams > 0, 'at once');
});

onGpu('a buffer receives the tangents', async () => {
  const names = ['waves', 'seams'];
  const { found, errors } = await page.evaluate((names) => tested.intoBuffers(names), names);
  assert.deepEqual(found, names.map((name) => ({ name, differing: 0, rest: [7, 7, 7, 7] })));
  assert.deepEqual(errors, []);
});

onGpu('what does not fit is said', async () => {
  assert.deepEqual(await page.evaluate(() => tested.refusals()), [
    'TypeError: device must be a GPUDevice, as openDevice returns it',
    "RangeError: mode is 'best'; it must be one of 'repaired', 'reference', 'corrected'",
    "RangeError: the shaders compute the method 'mikktspace' only; leave the method out",
    'RangeError: index 6 at place 2 is out of range: there are 6 vertices',
    'RangeError: the tangents need 192 bytes but their buffer has 16',
    'RangeError: the buffer of tangents was made without GPUBufferUsage.COPY_DST',
    'RangeError: the buffer of corner_terms needs 201326592 bytes but the device binds 134217728 at most; request a device with larger limits, or compute on the CPU',
    'Error: the GPU was lost: its driver was reset or it was removed; open another device, or compute on the CPU (generateTangents of darboux)',
    [],
  ]);
});

onGpu('the example of the README', async () => {
  const { tangents, cpuCorners, triangles } = await page.evaluate(async () => {
    const { tangents, cpuCorners, report } = await tested.example();
    return { tangents: Array.from(tangents), cpuCorners, triangles: report.triangles };
  });
  assert.deepEqual(tangents, Array.from({ length: 6 }, () => [1, 0, 0, 1]).flat());
  assert.deepEqual([cpuCorners, triangles], [0, 2]);
});

test('without an adapter the error says what to do', async () => {
  const message = async (navigator) => {
    Object.defineProperty(globalThis, 'navigator', { value: navigator, configurable: true });
    return openDevice().catch((error) => error.message);
  };
  const cure = 'or compute on the CPU (generateTangents of darboux)';
  assert.equal(await message({}), `WebGPU is missing here: use a browser that has it, from https or localhost, ${cure}`);
  assert.equal(await message({ gpu: { requestAdapter: async () => null } }), `no GPU adapter was found: install a driver, ${cure}`);
});

test('CommonJS loads the shaders at the first call', async () => {
  const { generateTangents } = createRequire(import.meta.url)('darboux/webgpu');
  await assert.rejects(generateTangents({}), { name: 'TypeError', message: 'device must be a GPUDevice, as openDevice returns it' });
});

test('the page logged no error', { skip }, () => assert.deepEqual(faults, []));
