// Opening models by address, button and drop, valid and broken, and exporting them with the same bytes as the command.

import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, truncateSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { after, before, test } from 'node:test';

import { browser, root, serve, Viewer } from './page.mjs';

const DARBOUX = process.env.DARBOUX;
const asset = (path) => join(root, 'assets', path);

let server, chromium, viewer, folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'viewer-'));
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { viewport: { width: 500, height: 400 } });
});

after(async () => {
  await chromium?.close();
  server?.close();
  rmSync(folder, { recursive: true });
  // Some models have images that no decoder reads; the page shows a warning for these.
  assert.deepEqual(viewer?.faults.filter((fault) => !fault.includes("Couldn't load texture")), []);
});

/** A PNG of 2 x 2 grey texels. */
const GREY = 'iVBORw0KGgoAAAANSUhEUgAAAAIAAAACCAAAAABX3VL4AAAADklEQVR4nGM4wcXAdQIABPIBpX867MIAAAAASUVORK5CYII=';

test('a file by button', async () => {
  await viewer.give('files', [asset('NormalTangentTest/NormalTangentTest.glb')]);
  assert.equal(await viewer.text('name'), 'NormalTangentTest.glb');
  assert.equal(await viewer.text('status'), '7,774 triangles in 1 part');
  assert.ok((await viewer.codes()).includes('tangent-missing'));
  assert.equal(await viewer.page.$eval('#left option[value=file]', (option) => option.disabled), true);
});

test('a folder by button', async () => {
  await viewer.give('folder', asset('TwoSidedPlane'));
  assert.equal(await viewer.text('error'), '');
  assert.equal(await viewer.text('name'), 'TwoSidedPlane/TwoSidedPlane.gltf');
});

test('a file and a folder by drop', async () => {
  await viewer.drop(asset('Fox/Fox.glb'));
  assert.equal(await viewer.text('name'), 'Fox.glb');
  assert.ok((await viewer.codes()).includes('normal-missing'));
  await viewer.drop(asset('Morphing'));
  assert.equal(await viewer.text('name'), 'Morphing/morphing.gltf');
  assert.equal(await viewer.text('error'), '');
});

test('compressed, strips, several UV sets, skins and morph targets', async () => {
  const triangles = { 'draco.glb': 48, 'meshopt.glb': 16, 'strips-fans-lines-points.gltf': 32, 'shared-vertices-two-uv-sets.gltf': 48, 'skinned-morphed-mirrored.gltf': 16 };
  for (const [name, count] of Object.entries(triangles)) {
    await viewer.give('files', [asset(`made/${name}`)]);
    assert.deepEqual([await viewer.text('error'), await viewer.text('name')], ['', name]);
    assert.equal(parseInt(await viewer.text('status'), 10), count, name);
  }
});

test('PLY and STL, by button and by drop', async () => {
  await viewer.give('files', [asset('blender/scene.ply')]);
  assert.deepEqual([await viewer.text('error'), await viewer.text('name')], ['', 'scene.ply']);
  assert.equal(parseInt(await viewer.text('status'), 10), 100);
  const { name, bytes } = await viewer.download('#save-model');
  assert.equal(name, 'scene.tangents.glb');
  assert.ok('TANGENT' in glbJson(bytes).meshes[0].primitives[0].attributes);
  await viewer.drop(asset('blender/scene.stl'));
  assert.deepEqual([await viewer.text('error'), await viewer.text('name')], ['', 'scene.stl']);
  assert.equal(parseInt(await viewer.text('status'), 10), 100);
  // What is lost is said, and a readable model beside an unreadable one is opened.
  const place = join(folder, 'formats');
  mkdirSync(place);
  writeFileSync(join(place, 'a.ply'), 'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float quality\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n');
  copyFileSync(asset('blender/scene.fbx'), join(place, 'a.fbx'));
  await viewer.give('folder', place);
  assert.deepEqual([await viewer.text('error'), await viewer.text('name')], ['', 'formats/a.ply']);
  assert.match(await viewer.text('status'), /not carried over: the vertex property quality/);
});

test('an FBX with its texture, in its own words', async () => {
  await viewer.give('files', ['blender/scene.fbx', 'blender/scene_normal.png'].map(asset));
  assert.deepEqual([await viewer.text('error'), await viewer.text('name')], ['', 'scene.fbx']);
  assert.equal(await viewer.text('status'), '100 triangles in 3 parts');
  const found = await viewer.findings();
  assert.ok(found.some(({ code, text }) => code === 'uv-degenerate' && text.includes('Body in your FBX: 1 triangle has no area')), JSON.stringify(found));
  assert.match(await viewer.text('diagnosis'), /^Body in your FBX, meshes\[1\].* An importer of FBX that computes tangents itself, /);
  await viewer.drop(asset('others/assimp.fbx'));
  assert.deepEqual([await viewer.text('error'), await viewer.text('name')], ['', 'assimp.fbx']);
  assert.match(await viewer.text('status'), /FBX does not say whether green points up or down in the normal map of material "Scales"/);
  await viewer.click('#open-sample');
  assert.doesNotMatch(await viewer.text('diagnosis'), /your FBX/);
});

test('what is saved of an FBX or OBJ is the command\'s', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  for (const paths of [['blender/scene.fbx', 'blender/scene_normal.png'], ['others/assimp.fbx'], ['blender/scene.obj', 'blender/scene.mtl', 'blender/scene_normal.png']]) {
    await viewer.give('files', paths.map(asset));
    const { name, bytes } = await viewer.download('#save-model');
    const ours = join(folder, name);
    execFileSync(DARBOUX, ['tangents', '--overwrite', '--force', '--quiet', asset(paths[0]), '-o', ours], { stdio: 'pipe' });
    assert.ok(bytes.equals(readFileSync(ours)), `${name}: the same bytes`);
  }
});

test('sparse and quantised elements that lie apart', async () => {
  await viewer.give('files', [asset('made/quantised-sparse.glb')]);
  assert.deepEqual([await viewer.text('error'), await viewer.text('status')], ['', '36 triangles in 1 part']);
});

test('an OBJ, and what is saved of it', async () => {
  const path = join(folder, 'quad.obj');
  writeFileSync(path, 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n');
  await viewer.give('files', [path]);
  assert.equal(await viewer.text('status'), '2 triangles in 1 part');
  const { name, bytes } = await viewer.download('#save-model');
  assert.deepEqual([name, await viewer.text('error')], ['quad.tangents.glb', '']);
  assert.ok('TANGENT' in glbJson(bytes).meshes[0].primitives[0].attributes);
});

test('on a flat surface every source lights alike, in OBJ and glTF', async () => {
  const saved = join(folder, 'saved.glb');
  await viewer.give('files', [join(folder, 'quad.obj')]);
  writeFileSync(saved, (await viewer.download('#save-model')).bytes);
  for (const [path, sources] of [[join(folder, 'quad.obj'), ['mikktspace', 'derivatives']], [saved, ['file', 'mikktspace', 'derivatives']]]) {
    await viewer.give('files', [path]);
    await viewer.slide('split', 100);
    const pictures = [];
    for (const source of sources) {
      await viewer.choose('left', source);
      pictures.push(await viewer.picture());
    }
    for (const picture of pictures) assert.ok(picture.differs(pictures[0]) < 0.002, path);
    await viewer.click('input[value=bumps]');
    assert.ok((await viewer.picture()).differs(pictures[0]) > 0.02, 'test bumps are seen');
    assert.match(await viewer.text('chips'), /^Test bumps: not in the file/);
    await viewer.click('#chips button');
    assert.equal((await viewer.picture()).differs(pictures[0]) < 0.002, true, 'the chip shows the file again');
  }
});

test('an OBJ with materials and normal map looks the same when it is saved', async () => {
  const path = join(folder, 'materials');
  mkdirSync(path);
  const quad = readFileSync(join(folder, 'quad.obj'), 'utf8').replace(/^f/m, 'mtllib other.mtl quad.mtl\nusemtl plane\nf');
  writeFileSync(join(path, 'quad.obj'), quad);
  writeFileSync(join(path, 'other.mtl'), 'newmtl other\nKd 1 0 0\n');
  writeFileSync(join(path, 'quad.mtl'), 'newmtl plane\nKd 1 1 1\nmap_Kd color.png\nnorm normal.png\n');
  copyFileSync(asset('TwoSidedPlane/TwoSidedPlane_BaseColor.png'), join(path, 'color.png'));
  writeFileSync(join(path, 'normal.png'), await normalMapOfSample());
  await viewer.give('folder', path);
  await viewer.slide('split', 100);
  await viewer.choose('left', 'mikktspace');
  const before = await viewer.picture();
  await viewer.click('input[value=bumps]');
  assert.equal((await viewer.picture()).differs(before), 0, 'it has a normal map of its own');
  await viewer.click('input[value=shaded]');
  await viewer.slide('split', 0);
  await viewer.choose('right', 'mikktspace');
  await viewer.click('#flip-green');
  assert.ok((await viewer.picture()).differs(before) > 0.02, 'green matters');
  await viewer.click('#flip-green');
  await viewer.slide('split', 100);
  const saved = join(folder, 'materials.glb');
  writeFileSync(saved, (await viewer.download('#save-model')).bytes);
  await viewer.give('files', [saved]);
  assert.ok((await viewer.picture()).differs(before) < 0.01);
});

test('a coloured bump map of an OBJ is its normal map, and a grey one is said', async () => {
  const path = join(folder, 'materials');
  const library = (statement) => writeFileSync(join(path, 'quad.mtl'), `newmtl plane\nKd 1 1 1\n${statement}\n`);
  const shown = async (statement) => {
    library(statement);
    await viewer.give('folder', path);
    await viewer.slide('split', 100);
    await viewer.choose('left', 'mikktspace');
    return [await viewer.picture(), await viewer.text('status')];
  };
  writeFileSync(join(path, 'heights.png'), Buffer.from(GREY, 'base64'));
  const [right, quiet] = await shown('norm normal.png');
  for (const statement of ['map_Bump normal.png', 'bump -bm 1 normal.png', 'map_bump heights.png\nnorm normal.png']) {
    const [same, status] = await shown(statement);
    assert.ok(same.differs(right) < 0.002, statement);
    assert.equal(status, quiet);
  }
  const [, status] = await shown('map_Bump heights.png');
  assert.match(status, /the bump map of plane is grey, so it holds heights and is left out/);
  assert.equal(await viewer.text('error'), '');
});

test('the findings are the command\'s', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  for (const name of ['made/degenerate.gltf', 'made/skinned-morphed-mirrored.gltf']) {
    await viewer.give('files', [asset(name)]);
    const found = await viewer.findings();
    const told = JSON.parse(execFileSync(DARBOUX, ['check', '--json', '--fail-on', 'never', asset(name)])).files[0].findings;
    assert.deepEqual(found.map(({ code }) => code).sort(), told.map(({ code }) => code).sort(), name);
    for (const { code, text } of told) assert.ok(found.some((one) => one.code === code && one.text.includes(text)), `${name}: ${text}`);
  }
});

test('the repaired GLB is the command\'s, and has no faults', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  await viewer.click('#open-sample');
  const shield = join(folder, 'shield.glb');
  writeFileSync(shield, Buffer.from(await (await fetch(`${server.address}shield.glb`)).arrayBuffer()));
  const { name, bytes } = await viewer.download('#save-model');
  assert.equal(name, 'shield.tangents.glb');
  assert.match(await viewer.text('status'), /^Tangents written to 1 primitive, 0 skipped/);
  const ours = join(folder, 'ours.glb');
  execFileSync(DARBOUX, ['tangents', '--overwrite', '--quiet', shield, '-o', ours]);
  assert.ok(bytes.equals(readFileSync(ours)), 'the same bytes');
  const again = join(folder, name);
  writeFileSync(again, bytes);
  await viewer.give('files', [again]);
  assert.deepEqual((await viewer.findings()).filter(({ severity }) => severity !== 'info'), []);
});

test('every fault of tangents in a file is found', async () => {
  const bytes = Buffer.from(await (await fetch(`${server.address}shield.glb`)).arrayBuffer());
  const { accessors, bufferViews, meshes } = glbJson(bytes);
  const view = bufferViews[accessors[meshes[0].primitives[0].attributes.TANGENT].bufferView];
  const start = 20 + bytes.readUInt32LE(12) + 8 + view.byteOffset;
  const set = (vertex, values) => values.forEach((value, at) => bytes.writeFloatLE(value, start + 16 * vertex + 4 * at));
  set(20, [0, 0, 0, 1]);
  set(60, [NaN, 0, 0, 1]);
  set(100, [0, 2, 0, 1]);
  set(140, [1, 0, 0, 0.5]);
  const path = join(folder, 'faulty.glb');
  writeFileSync(path, bytes);
  await viewer.give('files', [path]);
  const codes = await viewer.codes();
  for (const code of ['zero', 'not-finite', 'not-unit', 'sign-not-one']) assert.ok(codes.includes(`tangent-${code}`), `${code} in ${codes}`);
});

test('of two models that are opened at once the later is shown', async () => {
  await viewer.page.setInputFiles('#files', [asset('NormalTangentTest/NormalTangentTest.glb')]);
  await viewer.page.setInputFiles('#files', [asset('made/draco.glb')]);
  await viewer.settled();
  await viewer.page.waitForFunction(() => document.getElementById('status').textContent.startsWith('48 triangles'));
  await viewer.settled();
  assert.deepEqual([await viewer.text('name'), await viewer.text('error')], ['draco.glb', '']);
});

test('the picture is a PNG', async () => {
  const { name, bytes } = await viewer.download('#save-picture');
  assert.match(name, /\.png$/);
  assert.deepEqual([...bytes.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
  assert.ok(bytes.length > 2000, 'more than one colour');
});

test('textures that are missing are said, and not looked for elsewhere', async () => {
  const plane = readFileSync(asset('TwoSidedPlane/TwoSidedPlane.gltf'), 'utf8');
  const path = join(folder, 'plain');
  mkdirSync(path);
  copyFileSync(asset('TwoSidedPlane/TwoSidedPlane.bin'), join(path, 'TwoSidedPlane.bin'));
  writeFileSync(join(path, 'plain.gltf'), plane.replace('TwoSidedPlane_Normal.png', 'https://example.com/normal.png'));
  await viewer.give('folder', path);
  assert.equal(await viewer.text('error'), '');
  assert.match(await viewer.text('status'), /3 textures missing or not decodable$/);
});

test('textures in KTX 2 that are missing are said, and not looked for elsewhere', async () => {
  const plane = JSON.parse(readFileSync(asset('TwoSidedPlane/TwoSidedPlane.gltf'), 'utf8'));
  const image = plane.images.push({ uri: 'rock.ktx2', mimeType: 'image/ktx2' }) - 1;
  plane.textures = plane.textures.map(() => ({ extensions: { KHR_texture_basisu: { source: image } } }));
  plane.extensionsUsed = ['KHR_texture_basisu'];
  const path = join(folder, 'rock');
  mkdirSync(path);
  copyFileSync(asset('TwoSidedPlane/TwoSidedPlane.bin'), join(path, 'TwoSidedPlane.bin'));
  writeFileSync(join(path, 'rock.gltf'), JSON.stringify(plane));
  const asked = [];
  viewer.page.on('request', (request) => request.url().includes('rock.ktx2') && asked.push(request.url()));
  await viewer.give('folder', path);
  assert.equal(await viewer.text('error'), '');
  assert.match(await viewer.text('status'), /textures? in KTX 2 (is|are) left out: its file is missing; give the whole folder/);
  assert.deepEqual(asked, []);
});

test('bad files get a sentence, and leave the model that is open', async () => {
  await viewer.give('files', [asset('NormalTangentTest/NormalTangentTest.glb')]);
  const good = readFileSync(asset('NormalTangentTest/NormalTangentTest.glb'));
  const plane = readFileSync(asset('TwoSidedPlane/TwoSidedPlane.gltf'), 'utf8');
  const bad = {
    'empty.glb': ['', /^empty\.glb is empty; export it again\.$/],
    'short.glb': [good.subarray(0, 40_000), /^short\.glb: .*; .*\.$/],
    'header.glb': [good.subarray(0, 11), /^header\.glb: .*\.$/],
    'noise.glb': [Buffer.from(Array.from({ length: 5000 }, (_, at) => (at * 7919) % 251)), /^noise\.glb: .*\.$/],
    'text.gltf': ['{"asset": ', /^text\.gltf: .*not JSON.*\.$/],
    'index.gltf': [readFileSync(asset('made/shared-vertices-two-uv-sets.gltf'), 'utf8').replace(/"POSITION": *\d+/, '"POSITION": 99'), /^index\.gltf: .*99.*\.$/],
    'alone.gltf': [plane, /^alone\.gltf: buffers\[0\]\.uri: the file .TwoSidedPlane.* is not among the files; give the whole folder\.$/],
    'remote.gltf': [plane.replace('TwoSidedPlane.bin', 'https://example.com/a.bin'), /^remote\.gltf: .* on another machine; download it and refer to the file\.$/],
    'empty.obj': ['# nothing\n', /^empty\.obj: is named as OBJ, but .*\.$/],
    'points.obj': ['v 0 0 0\nv 1 0 0\n', /^points\.obj: is an OBJ without faces, a point cloud; .*\.$/],
    'cut.fbx': [readFileSync(asset('blender/scene.fbx')).subarray(0, 20_000), /^cut\.fbx: is cut off; copy or export it again\.$/],
    'damaged.fbx': [readFileSync(asset('blender/scene.fbx')).fill(255, 2000, 2100), /^damaged\.fbx: is not a valid FBX \(.*\); export it again\.$/],
    'stage.usdz': [readFileSync(asset('blender/scene.usdz')), /^stage\.usdz: is USD, which is not read here; export the model as \.glb/],
    'cloud.ply': ['ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n', /^cloud\.ply: is a PLY without faces/],
    'notes.txt': ['hello', /^There is no model in these files \(notes\.txt\)/],
  };
  for (const [name, [content, sentence]] of Object.entries(bad)) {
    writeFileSync(join(folder, name), content);
    await viewer.give('files', [join(folder, name)]);
    assert.match(await viewer.text('error'), sentence);
    assert.equal(await viewer.text('name'), 'NormalTangentTest.glb');
  }
  const huge = join(folder, 'huge.glb');
  writeFileSync(huge, 'glTF');
  truncateSync(huge, 1_600_000_000);
  await viewer.drop(huge);
  assert.match(await viewer.text('error'), /^huge\.glb has 1\.6 GB, more than a page can hold; use the command/);
  await viewer.click('#open-sample');
  assert.equal(await viewer.text('error'), '');
});

/** Starts `darboux view` and opens what it serves. */
async function viewed(path, use) {
  const command = spawn(DARBOUX, ['view', '--no-open', path], { stdio: ['ignore', 'pipe', 'ignore'] });
  try {
    const { value: address } = await createInterface({ input: command.stdout })[Symbol.asyncIterator]().next();
    const served = await Viewer.open(chromium, address, { viewport: { width: 500, height: 400 } });
    assert.deepEqual(served.faults, []);
    await use(served);
    await served.close();
  } finally {
    command.kill();
  }
}

test('darboux view shows its model', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  const place = join(folder, 'with space');
  mkdirSync(place);
  for (const name of ['TwoSidedPlane.gltf', 'TwoSidedPlane.bin', 'TwoSidedPlane_BaseColor.png', 'TwoSidedPlane_MetallicRoughness.png', 'TwoSidedPlane_Normal.png']) {
    copyFileSync(asset(`TwoSidedPlane/${name}`), join(place, name));
  }
  const path = join(place, 'TwoSidedPlane.gltf');
  await viewed(path, async (served) => {
    assert.equal(await served.text('name'), 'TwoSidedPlane.gltf');
    writeFileSync(path, '{}');
    await served.page.reload();
    await served.settled();
    assert.match(await served.text('error'), /TwoSidedPlane\.gltf: .*asset/);
  });
});

test('darboux view shows an OBJ with its materials and textures', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  const place = join(folder, 'dressed');
  mkdirSync(join(place, 'dress'), { recursive: true });
  const quad = readFileSync(join(folder, 'quad.obj'), 'utf8');
  writeFileSync(join(place, 'quad.obj'), quad.replace(/^f/m, 'mtllib dress/quad one.mtl\nusemtl plane\nf'));
  writeFileSync(join(place, 'dress/quad one.mtl'), 'newmtl plane\nKd 0 1 0\nnorm ../normal 1.png\n');
  writeFileSync(join(place, 'normal 1.png'), await normalMapOfSample());
  await viewer.give('folder', place);
  const given = await viewer.picture();
  assert.ok(given.share((r, g, b) => g > 2 * r && g > 2 * b) > 0.05, 'it is green');
  await viewed(join(place, 'quad.obj'), async (served) => {
    assert.deepEqual([await served.text('name'), await served.text('status')], ['quad.obj', '2 triangles in 1 part']);
    assert.ok((await served.picture()).differs(given) < 0.002);
  });
  // Alone it is shown, and what it lacks is said.
  await viewer.give('files', [join(place, 'quad.obj')]);
  assert.match(await viewer.text('status'), /; "dress\/quad one\.mtl" is not among the files; its materials are left out/);
  rmSync(join(place, 'normal 1.png'));
  await viewer.give('folder', place);
  assert.match(await viewer.text('status'), /; dressed\/dress\/quad one\.mtl: "\.\.\/normal 1\.png" is not among the files; the texture is left out/);
});

/** The normal map of the model that the page opens with: scales, which look otherwise upside down. */
async function normalMapOfSample() {
  const bytes = Buffer.from(await (await fetch(`${server.address}shield.glb`)).arrayBuffer());
  const { bufferViews, images } = glbJson(bytes);
  const { byteOffset, byteLength } = bufferViews[images[0].bufferView];
  const start = 20 + bytes.readUInt32LE(12) + 8 + byteOffset;
  return bytes.subarray(start, start + byteLength);
}

/** The JSON of a GLB. */
function glbJson(bytes) {
  return JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
}
