// `darboux/bake`: maps, counts, progress, options and errors.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { formsOf } from './forms.mjs';

const forms = await formsOf('darboux/bake');
const { convertFile, ready } = await import('darboux/check');
await ready;
const asset = (path) => new Uint8Array(readFileSync(fileURLToPath(new URL(`../../../assets/${path}`, import.meta.url))));
const shield = asset('made/shield.glb');

/** A square of unit size as a glTF, bent upwards along x by a slope; without UVs where `hasUvs` is false. */
function square(slope, { name = 'square', hasUvs = true } = {}) {
  const corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
  const arrays = [corners.map(([x, y]) => [x, y, slope * x]), corners.map(() => [-slope, 0, 1].map((c) => c / Math.hypot(slope, 1))), corners.map(([x, y]) => [x, 1 - y])];
  const floats = Float32Array.from(arrays.flat(2));
  const uri = `data:application/octet-stream;base64,${Buffer.from(floats.buffer).toString('base64')}`;
  const starts = [0, 48, 96];
  const bufferViews = starts.map((byteOffset, at) => ({ buffer: 0, byteOffset, byteLength: arrays[at].flat().length * 4 }));
  const bounds = { min: [0, 0, Math.min(0, slope)], max: [1, 1, Math.max(0, slope)] };
  const accessors = bufferViews.map((_, at) => ({ bufferView: at, componentType: 5126, count: 4, type: at < 2 ? 'VEC3' : 'VEC2', ...(at ? {} : bounds) }));
  const attributes = { POSITION: 0, NORMAL: 1, ...(hasUvs ? { TEXCOORD_0: 2 } : {}) };
  const meshes = [{ name, primitives: [{ attributes, mode: 6 }] }];
  return Buffer.from(JSON.stringify({ asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, name }], meshes, accessors, bufferViews, buffers: [{ byteLength: floats.byteLength, uri }] }));
}

/** The same square as arrays. */
function squareMesh(slope) {
  const corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
  const arrays = [corners.map(([x, y]) => [x, y, slope * x]), corners.map(() => [-slope, 0, 1].map((c) => c / Math.hypot(slope, 1))), corners.map(([x, y]) => [x, 1 - y])];
  const [positions, normals, uvs] = arrays.map((rows) => Float32Array.from(rows.flat()));
  return { positions, normals, uvs, indices: Uint8Array.of(0, 1, 2, 0, 2, 3) };
}

const bytes = (...arguments_) => new Uint8Array(square(...arguments_));
const results = [];

/** The codes of a map as a file of 8 or 16 bits has them. */
const codes = (vectors, bits) => (bits === 8 ? Uint8Array : Uint16Array).from(vectors, (c) => Math.round((c + 1) * (2 ** bits - 1) / 2));

for (const [name, { bake, bakeModels, PreparedModels, TEXEL_STATES, verify, verifyModels, convertSpace, convertSpaceOfModel, udimTiles, udimTilesOfModel }] of Object.entries(forms)) {
  test(`${name}: a slope leans the normal against it`, () => {
    const progress = [];
    const maps = ['normal', 'object-normal', 'height', 'ao', 'position'];
    const baked = bakeModels(bytes(0), bytes(0.5), { size: [64, 32], distance: [1, 1], maps, onProgress: (done) => progress.push(done) });
    assert.deepEqual([baked.size, baked.normal.length, baked.height.length], [[64, 32], 64 * 32 * 3, 64 * 32]);
    const [x, y, z] = baked.normal;
    assert.ok(Math.abs(x / z + 0.5) < 1e-6 && Math.abs(y) < 1e-6, `${x}, ${y}, ${z}`);
    assert.ok(Math.abs(baked.position[0] - 0.5 / 64) < 1e-6 && Math.abs(baked.height[0] - 0.25 / 64) < 1e-6);
    assert.ok(baked.objectNormal[0] < -0.4 && baked.ao.every((open) => open === 1));
    assert.ok(baked.states.every((state) => TEXEL_STATES[state] === 'baked'));
    assert.deepEqual([baked.report.chartedTexels, baked.report.missedTexels, baked.warnings], [2048, 0, []]);
    assert.ok(progress.at(-1) === 1 && progress.every((done, at) => done > (progress[at - 1] ?? 0)));
    results.push(baked);
  });

  test(`${name}: prepared models are baked with the same bits, again and again`, () => {
    const shared = { maps: ['normal', 'height'] };
    const prepared = new PreparedModels(shield, [shield], shared);
    const all = [{ size: [64, 64], cageOffset: 0.02 }, { size: [32, 64], distance: [0.05, 0.03], samples: 2 }, { size: [64, 64], cageOffset: 0.001, backFaces: true }, { size: [64, 64], cageOffset: 0.02 }];
    for (const options of all) {
      const once = bakeModels(shield, shield, { ...shared, ...options });
      assert.deepEqual(prepared.bake(options), once);
    }
    const other = new PreparedModels(bytes(0), bytes(0.5));
    assert.deepEqual(other.bake({ size: [8, 8], distance: [1, 1] }), bakeModels(bytes(0), bytes(0.5), { size: [8, 8], distance: [1, 1] }));
    assert.deepEqual(prepared.bake(all[0]), bakeModels(shield, shield, { ...shared, ...all[0] }), 'not those of the other object');
  });

  test(`${name}: a cage is made, for models, prepared models and arrays alike`, () => {
    const options = { size: [8, 4], maps: ['height'], autoCage: 0.001 };
    const high = bytes(0.5);
    const made = bakeModels(bytes(0), high, { ...options, cageOffset: 2 });
    assert.equal(made.report.missedTexels, 0);
    assert.ok(made.distance[0] === 0 && made.distance[1] > 0 && made.distance[1] < 0.1, `${made.distance}`);
    assert.deepEqual(new PreparedModels(bytes(0), high, { maps: ['height'] }).bake({ size: [8, 4], autoCage: 0.001, cageOffset: 2 }), made);
    // The corners of a fan, as glTF orders them.
    const fan = (slope) => ({ ...squareMesh(slope), indices: Uint8Array.of(1, 2, 0, 2, 3, 0) });
    assert.deepEqual(bake(fan(0), fan(0.5), { ...options, cageOffset: 2 }).height, made.height);
    assert.ok(bakeModels(bytes(0), high, options).report.missedTexels > 0, 'the slope is higher than 10 % of the diagonal');
    assert.throws(() => bakeModels(bytes(0), high, { ...options, distance: [1, 1] }), { message: 'distance and autoCage both say where rays begin; leave one of them out' });
    assert.throws(() => bakeModels(bytes(0), high, { ...options, autoCage: null, cageOffset: 2, distance: [1, 1] }), { message: 'distance and cageOffset both say where rays begin; leave one of them out' });
    assert.throws(() => bake({ ...fan(0), cage: fan(0).positions }, fan(0.5), options), { message: 'low.cage and autoCage both say where rays begin; leave one of them out' });
    assert.throws(() => bakeModels(Uint8Array.of(1), high, { ...options, autoCage: 2 }), /share/, 'options are checked before files');
  });

  test(`${name}: a cage can be a model, and rays straight`, () => {
    const options = { size: [8, 4], maps: ['height'] };
    const [low, high, cage] = [bytes(0), bytes(0.5), bytes(1)];
    const near = { ...options, cageOffset: 0.001 };
    const caged = bakeModels(low, high, { ...near, cage });
    assert.deepEqual([caged.report.missedTexels, caged.distance[1]], [0, 0.001], 'the slope lies between the models');
    assert.ok(bakeModels(low, high, near).report.missedTexels > 0);
    assert.deepEqual(new PreparedModels(low, high, { maps: ['height'] }).bake({ size: [8, 4], cageOffset: 0.001, cage }), caged);
    assert.throws(() => bakeModels(low, high, { ...options, cage, autoCage: 0.001 }), { message: 'cage and autoCage both say where rays begin; leave one of them out' });
    assert.throws(() => bakeModels(low, high, { ...options, cage: shield }), /the cage has .* but (the low model has|that of the low)/);
    assert.throws(() => bakeModels(low, high, { ...options, cage: [1] }), { name: 'TypeError' });
    assert.throws(() => bakeModels(low, high, { ...options, skew: 2 }), /a skew correction is 2; it must be from 0 to 1/);
    assert.deepEqual(bakeModels(low, high, { ...options, cageOffset: 1, skew: 1 }).height, bakeModels(low, high, { ...options, cageOffset: 1 }).height, 'a flat mesh has nothing to straighten');
  });

  test(`${name}: prepared models refuse what a bake of models refuses, and stay usable`, () => {
    assert.throws(() => new PreparedModels(bytes(0, { hasUvs: false }), bytes(0)), /UVs|TEXCOORD_0/);
    assert.throws(() => new PreparedModels(Uint8Array.of(1, 2, 3), bytes(0)), /the low model/);
    assert.throws(() => new PreparedModels(bytes(0), []), { name: 'RangeError' });
    const prepared = new PreparedModels(bytes(0), bytes(0.5));
    const options = { size: [8, 8], distance: [1, 1] };
    assert.throws(() => prepared.bake({ ...options, distance: [0, 0] }), /distance/);
    assert.throws(() => prepared.bake({ ...options, samples: 0 }), /samples/);
    assert.deepEqual(prepared.bake(options), bakeModels(bytes(0), bytes(0.5), options));
  });

  test(`${name}: an error of onProgress reaches the caller, and says why prepared models are lost`, () => {
    const prepared = new PreparedModels(bytes(0), bytes(0.5));
    const stop = () => {
      throw new Error('enough');
    };
    assert.throws(() => prepared.bake({ size: [8, 8], distance: [1, 1], onProgress: stop }), { message: 'enough' });
    assert.throws(() => prepared.bake({ size: [8, 8], distance: [1, 1] }), /an error of a callback ended a call before/);
  });

  test(`${name}: options of prepared models and of their bakes are told apart`, () => {
    const place = 'occlusionTexture';
    assert.throws(() => bakeModels(Uint8Array.of(1), bytes(0.5), { maps: ['texture'] }), /the map texture needs the option texture/);
    assert.throws(() => new PreparedModels(bytes(0), bytes(0.5), { texture: place }), /the option texture is for the map texture/);
    const shared = { maps: ['base-color'], material: 0, uvSet: 0, match: 'name', highMaps: true, texture: place };
    const prepared = new PreparedModels(bytes(0), bytes(0.5), { size: undefined, onProgress: null });
    for (const [option, value] of Object.entries(shared)) {
      assert.throws(() => prepared.bake({ [option]: value }), { name: 'TypeError', message: `${option} is an option of PreparedModels, not of its bakes` });
    }
    const ofBakes = { size: [8, 8], cageOffset: 1, samples: 2, udim: 1001, aoOwnPart: false, idFrom: 'mesh', onProgress: () => {} };
    for (const [option, value] of Object.entries(ofBakes)) {
      assert.throws(() => new PreparedModels(bytes(0), bytes(0.5), { [option]: value }), { name: 'TypeError', message: `${option} is an option of each bake, not of PreparedModels` });
    }
    const options = { size: [8, 8], distance: [1, 1] };
    assert.deepEqual(prepared.bake({ ...options, maps: undefined, match: null }), bakeModels(bytes(0), bytes(0.5), options));
  });

  test(`${name}: onProgress can bake other models, and its errors stay its own`, () => {
    const prepared = new PreparedModels(bytes(0), bytes(0.5));
    const options = { size: [8, 8], distance: [1, 1] };
    const expected = bakeModels(bytes(0), bytes(0.5), options);
    const progress = [];
    const nested = (done) => {
      progress.push(done);
      assert.deepEqual(bakeModels(bytes(0), bytes(0.5), options), expected);
    };
    assert.deepEqual(prepared.bake({ size: [64, 64], distance: [1, 1], onProgress: nested }), bakeModels(bytes(0), bytes(0.5), { size: [64, 64], distance: [1, 1] }));
    assert.equal(progress.at(-1), 1, 'progress is told after a nested call, too');
    const stop = () => {
      nested(0);
      throw new Error('enough');
    };
    assert.throws(() => prepared.bake({ ...options, onProgress: stop }), { message: 'enough' });
    assert.throws(() => prepared.bake(options), /^Error: an error of a callback ended a call before/);
    const trap = () => {
      throw new WebAssembly.RuntimeError('of the caller');
    };
    assert.throws(() => bakeModels(bytes(0), bytes(0.5), { ...options, onProgress: trap }), { name: 'RuntimeError', message: 'of the caller' });
    assert.deepEqual(bakeModels(bytes(0), bytes(0.5), options), expected);
  });

  test(`${name}: a call in onProgress on what is being baked is refused`, () => {
    const options = { size: [8, 8], distance: [1, 1] };
    const sentence = { name: 'Error', message: 'a call is still running; make the next one after its end, not in its callback' };
    const [prepared, lost] = [0, 1].map(() => new PreparedModels(bytes(0), bytes(0.5)));
    assert.throws(() => lost.bake({ ...options, onProgress: () => lost.bake(options) }), sentence);
    assert.throws(() => bakeModels(bytes(0), bytes(0.5), { ...options, onProgress: () => bakeModels(bytes(0), bytes(0.5), options) }), sentence);
    // The refusal does no harm to the running bake.
    let refused = 0;
    const onProgress = () => {
      assert.throws(() => prepared.bake(options), sentence);
      refused++;
    };
    const expected = bakeModels(bytes(0), bytes(0.5), options);
    assert.deepEqual(prepared.bake({ ...options, onProgress }), expected);
    assert.ok(refused > 0);
    assert.deepEqual(prepared.bake(options), expected);
  });

  test(`${name}: wrong options are told before the models are read`, () => {
    const broken = Uint8Array.of(1, 2, 3);
    assert.throws(() => bakeModels(broken, broken, { samples: 17 }), /^Error: 17 samples per axis cannot be taken/);
    assert.throws(() => bakeModels(broken, broken, { size: [0, 4] }), /^Error: an image of 0 x 4 texels/);
    assert.throws(() => bakeModels(broken, broken, { convention: 'quake' }), /^Error: convention: /);
    assert.throws(() => bakeModels(broken, broken), /^Error: the low model: /);
  });

  test(`${name}: an FBX is baked as the same model in a GLB`, () => {
    const [options, high] = [{ size: [64, 64], maps: ['normal', 'position'] }, asset('blender/scene.stl')];
    for (const path of ['blender/scene.fbx', 'others/assimp.fbx']) {
      const fbx = asset(path);
      const [baked, expected] = [fbx, convertFile(fbx, 'gltf', 'gltf').file].map((low) => bakeModels(low, [high, fbx], options));
      assert.ok(baked.report.chartedTexels > 1000 && baked.report.missedTexels < 100, JSON.stringify(baked.report));
      assert.deepEqual([baked.normal, baked.position], [expected.normal, expected.position]);
    }
    assert.throws(() => bakeModels(asset('blender/scene.fbx').subarray(0, 9000), shield), /^Error: the low model: is cut off; copy or export it again$/);
  });

  test(`${name}: each option acts`, () => {
    const pair = [bytes(0), bytes(0.5)];
    const near = bakeModels(...pair, { size: [64, 64], cageOffset: 0.1 });
    assert.ok(near.report.missedTexels > 2000 && TEXEL_STATES[near.states[63]] === 'missed');
    assert.ok(Math.abs(bakeModels(...pair, { size: [64, 64] }).distance[0] - 0.02 * Math.SQRT2) < 1e-8);
    const [up, down] = ['gltf', 'directx'].map((convention) => bakeModels(bytes(0), new Uint8Array(square(0.5)), { size: [8, 8], cageOffset: 1, convention }));
    assert.ok(up.normal.every((c, at) => (at % 3 === 1 ? Math.abs(c + down.normal[at]) < 1e-7 : c === down.normal[at])));
    assert.equal(bakeModels(...pair, { size: [8, 8], samples: 2, cageOffset: 1 }).report.rays, 4 * 64);
    const named = bakeModels(bytes(0, { name: 'a_low' }), [bytes(0.5, { name: 'b_high' }), bytes(0.25, { name: 'a_high' })], { size: [8, 8], cageOffset: 1, match: 'name' });
    assert.ok(Math.abs(named.normal[0] / named.normal[2] + 0.25) < 1e-6);
    assert.ok(bakeModels(shield, shield, { size: [64, 64], cageOffset: 0.01, highMaps: false }).normal.every((c, at) => Math.abs(c - (at % 3 === 2)) < 0.01));
    assert.ok(bakeModels(shield, shield, { size: [64, 64], cageOffset: 0.01 }).normal.some((c, at) => at % 3 !== 2 && Math.abs(c) > 0.1));
  });

  test(`${name}: arrays give the bits of models`, () => {
    const options = { size: [32, 16], cageOffset: 1, maps: ['normal', 'object-normal', 'height', 'ao', 'position'], convention: 'directx' };
    const progress = [];
    const baked = bake(squareMesh(0), squareMesh(0.5), { ...options, onProgress: (done) => progress.push(done) });
    assert.deepEqual(baked, bakeModels(bytes(0), bytes(0.5), options));
    assert.equal(progress.at(-1), 1);
    assert.deepEqual(bake(squareMesh(0), squareMesh(0.5), { size: [8, 8] }), bakeModels(bytes(0), bytes(0.5), { size: [8, 8] }));
  });

  test(`${name}: each array acts`, () => {
    const [low, high] = [squareMesh(0), squareMesh(0.5)];
    const lean = (low, high, options) => bake(low, high, { size: [4, 4], distance: [1, 1], ...options }).normal.slice(0, 3);
    const [x, y, z] = lean(low, high);
    const tangents = Float32Array.from([0, 1, 2, 3, 4, 5].flatMap(() => [0, 1, 0, -1]));
    const close = (found, expected) => assert.ok(found.every((c, at) => Math.abs(c - expected[at]) < 1e-6), `${found}; expected ${expected}`);
    close(lean({ ...low, tangents }, high), [y, -x, z]);
    close(lean(low, high, { meshConvention: 'opengl' }), [x, -y, z]);
    close(lean(low, { ...high, normals: null }), [x, y, z]);
    const soup = (array) => Float32Array.from([...high.indices].flatMap((vertex) => [...array.subarray(3 * vertex, 3 * vertex + 3)]));
    close(lean(low, { positions: soup(high.positions) }), [x, y, z]);
    const cage = low.positions.map((c, at) => (at % 3 === 2 ? 1 : c));
    assert.equal(bake({ ...low, cage }, high, { size: [8, 8] }).report.missedTexels, 0);
    assert.ok(bake(low, high, { size: [8, 8] }).report.missedTexels > 0);
  });

  test(`${name}: arrays that do not fit together are refused in a sentence`, () => {
    const [low, high] = [squareMesh(0), squareMesh(0.5)];
    const floats = (length) => new Float32Array(length);
    assert.throws(() => bake(shield, high), { name: 'TypeError', message: /^low must be an Object/ });
    assert.throws(() => bake({ ...low, uvs: floats(6) }, high), { name: 'RangeError', message: /uvs has 3 elements/ });
    assert.throws(() => bake(low, { ...high, positions: [0] }), { name: 'TypeError', message: /^high.positions/ });
    assert.throws(() => bake(low, { ...high, indices: [0, 1, 2] }), { name: 'TypeError', message: /^high.indices/ });
    assert.throws(() => bake({ ...low, tangents: floats(5) }, high), { name: 'RangeError', message: /^low.tangents/ });
    assert.throws(() => bake({ ...low, tangents: floats(4) }, high), /^Error: .*tangents/);
    assert.throws(() => bake({ ...low, cage: floats(3) }, high), /^Error: .*cage/);
    assert.throws(() => bake({ ...low, indices: Uint8Array.of(0, 1, 9) }, high), /^Error: the low mesh: .*9/);
    assert.throws(() => bake(low, { ...high, indices: Uint8Array.of(0, 1, 9) }), /^Error: the high mesh: .*9/);
    assert.throws(() => bake(low, { ...high, normals: floats(3) }), /^Error: the high mesh: /);
    assert.throws(() => bake(low, { ...high, indices: new Uint32Array(0) }), /^Error: .*no triangle/);
    assert.throws(() => bake(low, high, { meshConvention: 'quake' }), /^Error: meshConvention: /);
    assert.equal(bake(low, low, { size: [4, 4] }).report.missedTexels, 0, 'and the next call works');
  });

  test(`${name}: what cannot be baked is refused in a sentence`, () => {
    assert.throws(() => bakeModels('low.glb', shield), { name: 'TypeError', message: /^low must be a Uint8Array, not String$/ });
    assert.throws(() => bakeModels(shield, [shield, 1]), TypeError);
    assert.throws(() => bakeModels(shield, shield, { maps: ['colour'] }), RangeError);
    assert.throws(() => bakeModels(shield, shield, { maps: 'normal' }), { name: 'TypeError', message: 'maps must be an Array, not String' });
    assert.throws(() => bakeModels(shield, shield, { size: [4] }), { name: 'RangeError', message: 'size has 1 elements; it must have 2' });
    assert.throws(() => bakeModels(shield, shield, { distance: 0.1 }), { name: 'TypeError' });
    assert.throws(() => bakeModels(shield, []), { name: 'RangeError', message: 'high is empty; give at least one model' });
    assert.throws(() => bakeModels(shield, shield, { samples: 1.5 }), RangeError);
    assert.throws(() => bakeModels(shield, shield, { cageOffset: NaN }), RangeError);
    assert.throws(() => bakeModels(shield, shield, { sampels: 4 }), { name: 'TypeError', message: /^sampels is not an option; the options are size, cageOffset/ });
    assert.throws(() => bakeModels(shield, shield, { backFaces: 'false' }), { name: 'TypeError', message: 'backFaces must be a Boolean, not String' });
    assert.throws(() => bakeModels(shield, shield, { highMaps: 0 }), { name: 'TypeError', message: 'highMaps must be a Boolean, not Number' });
    assert.throws(() => bakeModels(shield, shield, { worldDirection: [0, 0] }), { name: 'RangeError', message: 'worldDirection has 2 elements; it must have 3' });
    assert.throws(() => bakeModels(shield, shield, { size: ['8', 8] }), { message: 'width is "8"; it must be a whole number from 0 on' });
    assert.throws(() => bakeModels(shield, shield, { cageOffset: -1 }), /^Error: rays cannot begin -1 outside the low surface/);
    assert.throws(() => bakeModels(shield, shield, { size: [0, 4] }), /^Error: an image of 0 x 4 texels cannot be made/);
    assert.throws(() => bakeModels(shield, shield, { convention: 'quake' }), /^Error: convention: /);
    assert.throws(() => bakeModels(shield, new Uint8Array([1, 2, 3])), /the high model/);
    assert.throws(() => bakeModels(bytes(0, { hasUvs: false }), shield), /^Error: the low model: no triangles have UVs, onto which to bake; unwrap the model first$/);
    assert.throws(() => bakeModels(shield, shield, { uvSet: 9 }), /^Error: the low model: no triangles have TEXCOORD_9, onto which to bake; choose one of TEXCOORD_0$/);
    assert.throws(() => bakeModels(shield, shield, { material: 99 }), /^Error: the low model: no triangles have materials\[99\]; choose one of 0$/);
    const [low, high] = ['a_low', 'b_high'].map((name) => bytes(0, { name }));
    assert.throws(() => bakeModels(low, high, { match: 'name' }), /^Error: no part of the high models belongs to a_low; .*; no part of the low model belongs to b_high/);
    assert.equal(bakeModels(bytes(0), bytes(0), { size: [4, 4] }).report.missedTexels, 0, 'and the next call works');
  });

  test(`${name}: the error of a map is told in degrees`, () => {
    const [pair, options] = [[squareMesh(0), squareMesh(0.5)], { distance: [1, 1] }];
    const baked = bake(...pair, { ...options, size: [64, 32] });
    const exact = verify(...pair, baked, options);
    assert.ok(exact.all.points === 64 * 32 && exact.all.worst < 1e-3 && exact.rounding.worst === 0);
    assert.deepEqual([exact.heatSize, exact.heat.length, exact.pointsWithoutHit, exact.parts.length], [[64, 32], 64 * 32, 0, 1]);
    const written = verify(...pair, baked, { ...options, written: codes(baked.normal, 8) });
    assert.ok(written.all.median > 1e-3 && written.all.median < 0.4 && written.inside.points + written.border.points === 64 * 32);
    assert.ok(Math.abs(written.all.median - written.rounding.median) < 1e-3 && written.otherGreen.median < 0.8);
    const fine = verify(...pair, baked, { ...options, written: codes(baked.normal, 16) });
    assert.ok(fine.all.median < written.all.median / 100, `${fine.all.median}`);
    // Models have the same numbers, and names.
    const files = [bytes(0, { name: 'a_low' }), bytes(0.5, { name: 'a_high' })];
    const progress = [];
    const ofModels = verifyModels(...files, bakeModels(...files, { ...options, size: [64, 32] }), { ...options, onProgress: (done) => progress.push(done) });
    assert.deepEqual({ ...ofModels, parts: [{ ...ofModels.parts[0], name: '' }] }, exact);
    assert.ok(ofModels.parts[0].name === 'a_low' && progress.at(-1) === 1);
    assert.throws(() => verify(...pair, bake(...pair, { ...options, size: [4, 4], maps: ['height'] }), options), { name: 'RangeError', message: /^baked has no normal map/ });
    assert.throws(() => verify(...pair, baked, { ...options, written: new Float32Array(6) }), /^Error: .*2048/);
    assert.throws(() => verify(...pair, baked, { written: [1, 2, 3] }), { name: 'TypeError', message: /^written/ });
    assert.throws(() => verify(...pair, { ...baked, states: baked.states.map(() => 9) }, options), /^Error: baked.states has numbers that no state has/);
  });

  test(`${name}: maps go from space to space`, () => {
    const [low, options] = [squareMesh(0), { size: [16, 16], sourceConvention: 'gltf' }];
    const baked = bake(low, squareMesh(0.5), { size: [16, 16], distance: [1, 1], maps: ['normal', 'object-normal'] });
    const close = (found, expected, by = 1e-6) => assert.ok(found.every((c, at) => Math.abs(c - expected[at]) < by));
    const tangent = convertSpace(low, baked.objectNormal, { ...options, to: 'tangent' });
    close(tangent.texels, baked.normal);
    assert.deepEqual([tangent.chartedTexels, tangent.overlappingTexels, tangent.invalidTexels], [256, 0, 0]);
    close(convertSpace(low, tangent.texels, { ...options, to: 'object' }).texels, baked.objectNormal);
    close(convertSpace(low, codes(baked.objectNormal, 16), { ...options, to: 'tangent' }).texels, baked.normal, 1e-4);
    const model = convertSpaceOfModel(bytes(0), baked.objectNormal, { ...options, to: 'tangent', convention: 'directx' });
    close(model.texels.map((c, at) => (at % 3 === 1 ? -c : c)), baked.normal);
    assert.throws(() => convertSpace(low, baked.objectNormal, { ...options, to: 'world' }), { name: 'RangeError', message: /^to is 'world'; it must be one of 'tangent', 'object'$/ });
    assert.throws(() => convertSpace(low, baked.objectNormal, { to: 'tangent', size: [4, 4] }), /^Error: .*256/);
    assert.throws(() => convertSpace(low, baked.objectNormal, { ...options, to: 'object', sourceConvention: 'quake' }), /^Error: sourceConvention: /);
    assert.throws(() => convertSpace(low, baked.objectNormal), TypeError);
  });

  test(`${name}: tiles are baked one by one`, () => {
    const low = squareMesh(0);
    low.uvs = low.uvs.map((c, at) => c + (at % 2 ? -1 : 3));
    const [tile] = udimTiles(low);
    assert.equal(tile, 1014);
    assert.equal(bake(low, squareMesh(0.5), { size: [8, 4], distance: [1, 1], udim: tile }).report.chartedTexels, 32);
    assert.equal(bake(low, squareMesh(0.5), { size: [8, 4], distance: [1, 1], udim: 1001 }).report.chartedTexels, 0);
    assert.deepEqual(udimTilesOfModel(bytes(0)), [1001]);
    const baked = bakeModels(bytes(0), bytes(0.5), { size: [8, 4], distance: [1, 1], udim: 1001 });
    assert.deepEqual(baked, bakeModels(bytes(0), bytes(0.5), { size: [8, 4], distance: [1, 1] }));
    assert.throws(() => bake(low, low, { udim: 12 }), /^Error: udim is 12; it must be a number of a tile, 1001 to 9990$/);
    assert.throws(() => bake(low, low, { udim: 1.5 }), RangeError);
  });

  test(`${name}: an error of onProgress ends the bake, and the next call works`, () => {
    const fails = () => {
      throw new Error('enough');
    };
    assert.throws(() => bakeModels(bytes(0), bytes(0), { size: [4, 4], onProgress: fails }), /^Error: enough$/);
    assert.equal(bakeModels(bytes(0), bytes(0), { size: [4, 4] }).report.missedTexels, 0);
  });
}

test('all forms give the same bits', () => {
  for (const image of ['normal', 'objectNormal', 'height', 'position']) {
    for (const other of results) assert.deepEqual(other[image], results[0][image]);
  }
});
