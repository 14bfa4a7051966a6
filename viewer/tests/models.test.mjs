// Models with skins, morph targets, instances, and textures in formats of extensions.

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { browser, root, serve, Viewer } from './page.mjs';
import { gltf, interleaved, QUAD, TANGENTS } from './quads.mjs';

let server, chromium, viewer, folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'viewer-'));
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { viewport: { width: 700, height: 400 } });
  await viewer.slide('split', 100);
});

after(async () => {
  await chromium?.close();
  server?.close();
  rmSync(folder, { recursive: true });
  assert.deepEqual(viewer?.faults.filter((fault) => !fault.includes("Couldn't load texture")), []);
});

async function open(text) {
  writeFileSync(join(folder, 'quad.gltf'), text);
  await viewer.give('files', [join(folder, 'quad.gltf')]);
  assert.equal(await viewer.text('error'), '');
}

/** Screenshots of a file with some sources, in views of its shape, frames and mirrored edges, and a place of its findings. */
async function seen(text, sources) {
  await open(text);
  const pictures = {};
  for (const source of sources) {
    await viewer.choose('left', source);
    pictures[`${source}, shaded`] = await viewer.picture();
    await viewer.click('input[value=bitangent]');
    for (const id of LINES) await viewer.press(`#${id}`);
    pictures[`${source}, bitangent and lines`] = await viewer.picture();
    for (const id of LINES) await viewer.press(`#${id}`);
    await viewer.click('input[value=shaded]');
  }
  if (await viewer.page.isVisible(PLACE)) {
    await viewer.click(PLACE);
    pictures.place = await viewer.picture();
  }
  return pictures;
}

/** Leads to a place of a finding that models with tangents have. */
const PLACE = '[data-code=tangent-shared-across-mirror] > button';

const LINES = ['lines-tangent', 'lines-normal', 'seams'];

/** Asserts that two files look the same with some sources, and different from a third. */
async function looksAs(text, expected, other, sources) {
  const [ours, theirs] = [await seen(text, sources), await seen(expected, sources)];
  for (const view in ours) {
    const apart = ours[view].differs(theirs[view]);
    assert.ok(apart < 0.003, `${view}: ${apart} differs`);
  }
  await open(other);
  assert.ok(ours[`${sources[0]}, shaded`].differs(await viewer.picture()) > 0.02, 'the pose is seen');
}

/** A rotation by 60 degrees about z, a scale and a translation. */
const [SINE, COSINE] = [Math.sin(Math.PI / 3), Math.cos(Math.PI / 3)];
const MATRIX = [2 * COSINE, 2 * SINE, 0, 0, -2 * SINE, 2 * COSINE, 0, 0, 0, 0, 2, 0, 3, 1, 0, 1];

test('skins move models and their frames as the scene\'s joints stand', async () => {
  const joints = [Uint8Array.from({ length: 24 }, (_, at) => (at % 4 === 1 ? 1 : 0)), 4];
  const weights = [Float32Array.from({ length: 24 }, (_, at) => (at % 4 < 2 ? 0.5 : 0)), 4];
  const attributes = { ...QUAD, TANGENT: TANGENTS, JOINTS_0: joints, WEIGHTS_0: weights };
  // The inverse bind matrices take away what both joints' bind pose would add.
  const inverse = [Float32Array.from([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -7, 0, 0, 1]), 16];
  const inverses = [Float32Array.from([...inverse[0], ...inverse[0]]), 16];
  const moved = (node) => {
    const [before, after] = [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1], MATRIX];
    return gltf({
      attributes,
      more: { inverses },
      json: ({ inverses: inverseBindMatrices }) => ({
        scenes: [{ nodes: [0, 1] }],
        // The transform of a skinned mesh's own node is ignored.
        nodes: [{ mesh: 0, skin: 0, translation: [9, 9, 9] }, { matrix: node ? after : before, children: [2, 3] }, node ? { translation: [7, 0, 0] } : {}, node ? { translation: [7, 0, 0] } : {}],
        skins: [{ joints: [2, 3], inverseBindMatrices }],
      }),
    });
  };
  const placed = gltf({ attributes: { ...QUAD, TANGENT: TANGENTS }, json: () => ({ nodes: [{ mesh: 0, matrix: MATRIX }] }) });
  await looksAs(moved(true), placed, moved(false), ['mikktspace', 'file', 'derivatives']);
});

test('morph targets move models and their frames as the scene weights them', async () => {
  const { POSITION: [positions] } = QUAD;
  // A step along z at the right, and a slide along y.
  const step = positions.map((x, at) => (at % 3 === 2 && positions[at - 2] > 0 ? 1 : 0));
  const slide = positions.map((_, at) => (at % 3 === 1 ? 0.25 : 0));
  const lean = positions.map((_, at) => (at % 3 === 0 ? -0.5 : 0));
  const turn = positions.map((_, at) => (at % 3 === 2 ? 0.5 : 0));
  const targets = [{ POSITION: [step, 3], NORMAL: [lean, 3], TANGENT: [turn, 3] }, { POSITION: [slide, 3] }];
  const sum = (array, width, offsets) => array.map((x, at) => x + (at % width < 3 ? offsets[Math.floor(at / width) * 3 + (at % width)] : 0));
  const attributes = { ...QUAD, TANGENT: TANGENTS };
  const weighted = (weights) => gltf({ attributes, targets, mesh: { weights: [0, 1] }, json: () => ({ nodes: [{ mesh: 0, weights }] }) });
  const baked = gltf({
    attributes: {
      ...QUAD,
      POSITION: [sum(positions, 3, step.map((x) => 0.5 * x)), 3],
      NORMAL: [sum(QUAD.NORMAL[0], 3, lean.map((x) => 0.5 * x)), 3],
      TANGENT: [sum(TANGENTS[0], 4, turn.map((x) => 0.5 * x)), 4],
    },
  });
  await looksAs(weighted([0.5, 0]), baked, weighted([0, 0]), ['mikktspace', 'file']);
});

test('elements that lie apart are where the file has them, sparse ones too', async () => {
  const attributes = { ...QUAD, TANGENT: TANGENTS };
  const [plain, moved] = [gltf({ attributes }), interleaved({ attributes, replaced: [0, 5], isSparse: false })];
  await looksAs(interleaved({ attributes }), plain, moved, ['mikktspace', 'file']);
  await looksAs(interleaved({ attributes, replaced: [0, 5] }), plain, moved, ['mikktspace', 'file']);
});

test('instances are where the file places them', async () => {
  const [translations, scales] = [Float32Array.of(0, 0, 0, 2.5, 0, 0, 0, 2, 1), Float32Array.of(1, 1, 1, 1, 2, 1, -1, 1, 1)];
  const turned = { rotation: [0, 0, Math.sin(0.2), Math.cos(0.2)] };
  const instanced = gltf({
    more: { TRANSLATION: [translations, 3], SCALE: [scales, 3] },
    json: (attributes) => ({
      extensionsUsed: ['EXT_mesh_gpu_instancing'],
      extensionsRequired: ['EXT_mesh_gpu_instancing'],
      nodes: [{ mesh: 0, ...turned, extensions: { EXT_mesh_gpu_instancing: { attributes } } }],
    }),
  });
  const three = (array, at) => [...array.subarray(at * 3, at * 3 + 3)];
  const nodes = [0, 1, 2].map((at) => ({ mesh: 0, translation: three(translations, at), scale: three(scales, at) }));
  const placed = gltf({ json: () => ({ nodes: [{ children: [1, 2, 3], ...turned }, ...nodes] }) });
  await looksAs(instanced, placed, gltf(), ['mikktspace']);
});

/** An image of a single green. */
const GREEN_PNG = 'iVBORw0KGgoAAAANSUhEUgAAAAgAAAAICAIAAABLbSncAAAAFElEQVR4nGOUO6HBgA0wYRUdtBIA19IBHqVA1jcAAAAASUVORK5CYII=';

/** A quad with an image of an extension as its base colour. */
function dressed(extension, mimeType, bytes, texture = {}) {
  return gltf({
    primitive: { material: 0 },
    json: () => ({
      materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
      textures: [{ ...texture, extensions: { [extension]: { source: 0 } } }],
      images: [{ uri: `data:${mimeType};base64,${bytes.toString('base64')}` }, { uri: `data:image/png;base64,${GREEN_PNG}` }],
      extensionsUsed: [extension],
      extensionsRequired: 'source' in texture ? [] : [extension],
    }),
  });
}

const AVIF = Buffer.from(
  'AAAAIGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZk1BMUIAAADrbWV0YQAAAAAAAAAhaGRscgAAAAAAAAAAcGljdAAAAAAAAAAAAAAAAAAAAAAOcGl0bQAAAAAAAQAAAB5pbG9jAAAAAEQAAAEAAQAAAAEAAAETAAAAJwAAAChpaW5mAAAAAAABAAAAGmluZmUCAAAAAAEAAGF2MDFDb2xvcgAAAABqaXBycAAAAEtpcGNvAAAAFGlzcGUAAAAAAAAACAAAAAgAAAAQcGl4aQAAAAADCAgIAAAADGF2MUOBAAwAAAAAE2NvbHJuY2x4AAEADQAGgAAAABdpcG1hAAAAAAAAAAEAAQQBAoMEAAAAL21kYXQSAAoIGAi/aICGg0IyGReHh4YhhJJJJlAAAABIVDZgY5pI7uGL18A=',
  'base64',
);
const WEBP = Buffer.from('UklGRh4AAABXRUJQVlA4TBEAAAAvB8ABAAdQ5HoUpf+BiOh/AAA=', 'base64');

const isGreen = (r, g, b) => g > 1.5 * r && g > 1.5 * b;

test('textures in WebP and AVIF are shown', async () => {
  for (const [extension, mimeType, bytes] of [['EXT_texture_webp', 'image/webp', WEBP], ['EXT_texture_avif', 'image/avif', AVIF]]) {
    await open(dressed(extension, mimeType, bytes));
    assert.equal(await viewer.text('status'), '4 triangles in 1 part');
    assert.ok((await viewer.picture()).share(isGreen) > 0.05, extension);
  }
});

const isBlue = (r, g, b) => b > 1.2 * r && b > 1.2 * g;

test('textures in KTX 2 are shown', async () => {
  for (const name of ['bumps-uastc', 'bumps-uastc-zstd', 'bumps-etc1s']) {
    await open(dressed('KHR_texture_basisu', 'image/ktx2', readFileSync(join(root, 'crates/darboux-io/tests/ktx2', `${name}.ktx2`))));
    assert.equal(await viewer.text('status'), '4 triangles in 1 part');
    assert.ok((await viewer.picture()).share(isBlue) > 0.05, name);
  }
});

test('damaged textures in KTX 2 are left out with a warning, or their fallback images are shown', async () => {
  const ktx2 = Buffer.from('«KTX 20»\r\n\x1a\n', 'latin1');
  await open(dressed('KHR_texture_basisu', 'image/ktx2', ktx2));
  assert.match(await viewer.text('status'), /; 1 texture in KTX 2 is left out: the texture cannot be decoded \(its header is damaged\); save it again$/);
  assert.ok((await viewer.picture()).share(isGreen) < 0.001);
  await open(dressed('KHR_texture_basisu', 'image/ktx2', ktx2, { source: 1 }));
  assert.equal(await viewer.text('status'), '4 triangles in 1 part');
  assert.ok((await viewer.picture()).share(isGreen) > 0.05);
});

/** A KTX 2 with green texels that are not compressed. */
function greenKtx2(width, height) {
  const start = Buffer.from('\u00abKTX 20\u00bb\r\n\x1a\n', 'latin1');
  // R8G8B8A8_UNORM, one level, no descriptor, no keys and no global data.
  const header = Uint32Array.of(37, 1, width, height, 0, 0, 1, 1, 0, 104, 4, 0, 0, 0, 0, 0, 0);
  const texels = Buffer.alloc(4 * width * height, Buffer.of(0, 200, 0, 255));
  const level = BigUint64Array.of(108n, BigInt(texels.length), BigInt(texels.length));
  return Buffer.concat([start, Buffer.from(header.buffer), Buffer.from(level.buffer), Buffer.of(4, 0, 0, 0), texels]);
}

test('a texture in KTX 2 that the graphics card does not take is shown with fewer texels, which a sentence says', async (t) => {
  const most = await viewer.page.evaluate(() => {
    const gl = new OffscreenCanvas(1, 1).getContext('webgl2');
    return gl.getParameter(gl.MAX_TEXTURE_SIZE);
  });
  if (most > 16_000) return t.skip('the graphics card takes all that is decoded');
  await open(dressed('KHR_texture_basisu', 'image/ktx2', greenKtx2(most + 100, 5)));
  assert.equal(await viewer.text('status'), `4 triangles in 1 part; 1 texture in KTX 2 has more than ${most} texels along a side, which the graphics card does not take, and is shown with fewer`);
  assert.ok((await viewer.picture()).share(isGreen) > 0.05);
});

/** A quad with a wrong tangent, once for each texture in KTX 2. */
function withTextures(textures) {
  const file = JSON.parse(gltf({ attributes: { ...QUAD, TANGENT: TANGENTS } }));
  const [mesh] = file.meshes;
  mesh.primitives = textures.map((_, material) => ({ ...mesh.primitives[0], material }));
  const extension = 'KHR_texture_basisu';
  return JSON.stringify({
    ...file,
    materials: textures.map((_, index) => ({ normalTexture: { index }, pbrMetallicRoughness: { baseColorTexture: { index } } })),
    textures: textures.map((_, source) => ({ extensions: { [extension]: { source } } })),
    images: textures.map((texture) => ({ uri: `data:image/ktx2;base64,${texture.toString('base64')}` })),
    extensionsUsed: [extension],
    extensionsRequired: [extension],
  });
}

/** The numbers of textures that were sent to threads for decoding since this was called first, and of replies. */
const decoding = () =>
  viewer.page.evaluate(() => {
    if (globalThis.decoding === undefined) {
      const counts = (globalThis.decoding = { sent: 0, replies: 0 });
      const post = Worker.prototype.postMessage;
      Worker.prototype.postMessage = function (message, ...rest) {
        if (/decode/.test(message.name)) {
          counts.sent++;
          this.addEventListener('message', ({ data }) => (counts.replies += Number(data.id === message.id)));
        }
        return post.call(this, message, ...rest);
      };
    }
    return globalThis.decoding;
  });

test('a texture in KTX 2 is decoded once, also for the repaired file', async () => {
  const before = (await decoding()).sent;
  const [one, other] = [greenKtx2(8, 8), greenKtx2(16, 8)];
  await open(withTextures([one, other, one]));
  assert.equal((await decoding()).sent - before, 2);
  await viewer.click('#repair');
  assert.equal(await viewer.page.inputValue('#right'), 'repaired');
  await viewer.slide('split', 0);
  assert.ok((await viewer.picture()).share(isGreen) > 0.05, 'the repaired file has its texture');
  await viewer.slide('split', 100);
  assert.equal((await decoding()).sent - before, 2);
});

/** A KTX 2 in UASTC with many times the blocks of a small one, which takes long to decode. */
function largeKtx2(side) {
  const small = readFileSync(join(root, 'crates/darboux-io/tests/ktx2/bumps-uastc.ktx2'));
  const start = Number(small.readBigUInt64LE(80));
  const head = Buffer.from(small.subarray(0, start));
  const blocks = Buffer.alloc(side * side, small.subarray(start, start + 4096));
  for (const at of [20, 24]) head.writeUInt32LE(side, at);
  for (const at of [88, 96]) head.writeBigUInt64LE(BigInt(blocks.length), at);
  return Buffer.concat([head, blocks]);
}

test('another file does not wait for the textures of the one before', async () => {
  const textures = Array.from({ length: 20 }, (_, at) => {
    const texture = largeKtx2(1024);
    // Another block at the end, so that no two are equal.
    texture.copy(texture, texture.length - 16, texture.length - 16 * (at + 2), texture.length - 16 * (at + 1));
    return texture;
  });
  const give = (name, text) => viewer.page.setInputFiles('#files', { name, mimeType: 'model/gltf+json', buffer: Buffer.from(text) });
  const before = await decoding();
  await give('slow.gltf', withTextures(textures));
  while ((await decoding()).sent === before.sent) await viewer.page.waitForTimeout(20);
  await give('other.gltf', gltf());
  await viewer.page.waitForFunction(() => document.getElementById('name').textContent === 'other.gltf');
  const replies = (await decoding()).replies - before.replies;
  assert.ok(replies < textures.length, `all ${replies} textures were decoded first`);
  await viewer.settled();
});
