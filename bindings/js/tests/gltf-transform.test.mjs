// `darboux/gltf-transform`: its files against glTF-Transform's own function, the Khronos validator and the `darboux` command.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Document, Logger, NodeIO, Verbosity } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { tangents as theirTangents, unweld } from '@gltf-transform/functions';
import validator from 'gltf-validator';
import mikktspace from 'mikktspace';
import { tangents } from 'darboux/gltf-transform';
import { mirrored } from './meshes.mjs';

const root = fileURLToPath(new URL('../../..', import.meta.url));
const silent = new Logger(Verbosity.SILENT);
const io = new NodeIO().setLogger(silent).registerExtensions(ALL_EXTENSIONS);
const work = mkdtempSync(join(tmpdir(), 'darboux-'));
after(() => rmSync(work, { recursive: true }));

const words = ['run', '--quiet', '--package', 'darboux-cli', '--features', 'full', '--', 'tangents', '--overwrite', '--quiet', '-o'];
const MODELS = [
  'Fox/Fox.glb', 'Morphing/morphing.gltf', 'NormalTangentTest/NormalTangentTest.glb', 'TwoSidedPlane/TwoSidedPlane.gltf',
  'made/degenerate.gltf', 'made/shared-vertices-two-uv-sets.gltf', 'made/skinned-morphed-mirrored.gltf',
  'made/strips-fans-lines-points.gltf',
];

/** The attributes and targets of every primitive, per corner. */
function contents(document) {
  const primitives = document.getRoot().listMeshes().flatMap((mesh) => mesh.listPrimitives());
  return primitives.map((primitive) => {
    const list = corners(primitive);
    return [primitive, ...primitive.listTargets()].map((owner) =>
      Object.fromEntries(owner.listSemantics().sort().map((semantic) => [semantic, ofCorners(owner.getAttribute(semantic), list)])),
    );
  });
}

/** The vertex of each corner of triangles, or of each element of other primitives. */
function corners(primitive) {
  const count = primitive.getAttribute('POSITION').getCount();
  const list = Array.from(primitive.getIndices()?.getArray() ?? { length: count }, (vertex, at) => vertex ?? at);
  const mode = primitive.getMode();
  if (mode !== 5 && mode !== 6) return list;
  const triangle = (at) => (mode === 6 ? [at + 1, at + 2, 0] : at % 2 ? [at, at + 2, at + 1] : [at, at + 1, at + 2]);
  return list.slice(2).flatMap((_, at) => triangle(at).map((place) => list[place]));
}

function ofCorners(accessor, list) {
  const width = accessor.getElementSize();
  return list.map((vertex) => Array.from(accessor.getArray().subarray(width * vertex, width * vertex + width)));
}

/** The codes of the validator's errors. */
async function errors(bytes, externalResourceFunction) {
  const { issues } = await validator.validateBytes(bytes, { maxIssues: 0, externalResourceFunction });
  return new Set(issues.messages.filter(({ severity }) => severity === 0).map(({ code }) => code));
}

const without = (parts, semantic) => parts.map((part) => part.map(({ [semantic]: _, ...others }) => others));

for (const model of MODELS) {
  test(`${model}: the tangents of the command, all else as it was, as valid as the input`, async () => {
    const input = join(root, 'assets', model);
    const native = join(work, basename(model));
    execFileSync('cargo', [...words, native, input], { cwd: root });
    const [document, expected] = [await io.read(input), await io.read(native)];
    const [before, faults] = [contents(document), await errors(await io.writeBinary(document))];
    await document.transform(tangents({ overwrite: true }));
    const written = await io.writeBinary(document);
    const found = contents(await io.readBinary(written));
    assert.deepEqual(found, contents(expected));
    assert.deepEqual(without(found, 'TANGENT'), without(before, 'TANGENT'));
    // One model has normals that are not unit length.
    assert.deepEqual([...(await errors(written))].filter((code) => !faults.has(code)), []);
  });
}

/** A document with two mirrored squares. */
function document() {
  const [positions, normals, uvs, indices] = mirrored();
  const made = new Document().setLogger(silent);
  const buffer = made.createBuffer();
  const accessor = (type, array) => made.createAccessor().setBuffer(buffer).setType(type).setArray(array);
  const primitive = made.createPrimitive().setIndices(accessor('SCALAR', indices));
  primitive.setAttribute('POSITION', accessor('VEC3', positions)).setAttribute('NORMAL', accessor('VEC3', normals));
  primitive.setAttribute('TEXCOORD_0', accessor('VEC2', uvs));
  const scene = made.createScene().addChild(made.createNode().setMesh(made.createMesh('wall').addPrimitive(primitive)));
  made.getRoot().setDefaultScene(scene);
  return { made, primitive, accessor };
}

test('unindexed primitives have the bytes of glTF-Transform\'s own function, called alike', async () => {
  const [ours, theirs] = [document(), document()];
  for (const [{ made }, own] of [[ours, tangents], [theirs, theirTangents]]) {
    await made.transform(unweld(), own({ generateTangents: mikktspace.generateTangents, overwrite: false }));
  }
  const [found, expected] = [ours, theirs].map(({ primitive }) => primitive.getAttribute('TANGENT').getArray());
  assert.deepEqual(found, expected);
  assert.equal(tangents().name, theirTangents({ generateTangents() {} }).name);
});

test('at a mirrored seam vertices are copied, and unused accessors are removed', async () => {
  const { made, primitive } = document();
  await made.transform(tangents());
  assert.equal(primitive.getAttribute('POSITION').getCount(), 8);
  assert.deepEqual(Array.from(primitive.getIndices().getArray()), [0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7]);
  const signs = Array.from(primitive.getAttribute('TANGENT').getArray()).filter((_, at) => at % 4 === 3);
  assert.deepEqual(signs, [1, 1, 1, 1, -1, -1, -1, -1]);
  assert.equal(made.getRoot().listAccessors().length, 5);
});

test('quantised values are dequantised', async () => {
  const { made, primitive, accessor } = document();
  const codes = (semantic, Kind, scale) => Kind.from(primitive.getAttribute(semantic).getArray(), (x) => x * scale);
  const normals = accessor('VEC3', codes('NORMAL', Int8Array, 127)).setNormalized(true);
  const uvs = accessor('VEC2', codes('TEXCOORD_0', Uint16Array, 65535)).setNormalized(true);
  primitive.setAttribute('POSITION', accessor('VEC3', codes('POSITION', Int16Array, 1)));
  primitive.setAttribute('NORMAL', normals).setAttribute('TEXCOORD_0', uvs);
  await made.transform(tangents());
  const [position, tangent] = ['POSITION', 'TANGENT'].map((semantic) => primitive.getAttribute(semantic));
  assert.deepEqual([position.getCount(), position.getArray().constructor], [8, Int16Array]);
  assert.deepEqual([0, 7].map((vertex) => tangent.getElement(vertex, [])), [[-1, 0, 0, 1], [1, 0, 0, -1]]);
});

test('primitives keep sharing a vertex buffer', async () => {
  const { made, primitive, accessor } = document();
  const all = primitive.getIndices();
  const [left, right] = [all.getArray().slice(0, 6), all.getArray().slice(6)];
  const other = primitive.clone().setIndices(accessor('SCALAR', right));
  primitive.setIndices(accessor('SCALAR', left));
  made.getRoot().listMeshes()[0].addPrimitive(other);
  const untouched = made.createMesh('unlit').addPrimitive(made.createPrimitive().setAttribute('POSITION', primitive.getAttribute('POSITION')));
  await made.transform(tangents());
  assert.equal(primitive.getAttribute('TANGENT'), other.getAttribute('TANGENT'));
  assert.equal(primitive.getAttribute('POSITION'), other.getAttribute('POSITION'));
  assert.equal(primitive.getAttribute('POSITION').getCount(), 8);
  assert.equal(untouched.listPrimitives()[0].getAttribute('POSITION').getCount(), 6);
});

test('the UV set is the normal texture\'s, or that of its transform', async () => {
  const { made, primitive, accessor } = document();
  const uvs = primitive.getAttribute('TEXCOORD_0');
  primitive.setAttribute('TEXCOORD_0', accessor('VEC2', new Float32Array(12))).setAttribute('TEXCOORD_2', uvs);
  const material = made.createMaterial().setNormalTexture(made.createTexture());
  const info = material.getNormalTextureInfo().setTexCoord(1);
  primitive.setMaterial(material);
  await made.transform(tangents());
  assert.equal(primitive.getAttribute('TANGENT'), null);
  const { KHRTextureTransform } = await import('@gltf-transform/extensions');
  info.setExtension('KHR_texture_transform', made.createExtension(KHRTextureTransform).createTransform().setTexCoord(2));
  await made.transform(tangents());
  assert.deepEqual(primitive.getAttribute('TANGENT').getElement(0, []), [-1, 0, 0, 1]);
});

test('existing tangents are kept unless overwritten; shared targets are cloned', async () => {
  const { made, primitive, accessor } = document();
  const kept = accessor('VEC4', new Float32Array(24).fill(0.5));
  primitive.setAttribute('TANGENT', kept);
  primitive.addTarget(made.createPrimitiveTarget().setAttribute('POSITION', accessor('VEC3', new Float32Array(18).fill(1))));
  const other = primitive.clone().setAttribute('TANGENT', null);
  made.getRoot().listMeshes()[0].addPrimitive(other);
  await made.transform(tangents());
  assert.equal(primitive.getAttribute('TANGENT'), kept);
  assert.deepEqual([primitive, other].map((one) => one.listTargets()[0].getAttribute('POSITION').getCount()), [6, 8]);
  assert.equal(other.listTargets()[0].getAttribute('TANGENT').getCount(), 8);
  await made.transform(tangents({ overwrite: true }));
  assert.equal(primitive.getAttribute('TANGENT').getCount(), 8);
  assert.equal(kept.isDisposed(), true);
  assert.deepEqual([...(await errors(await io.writeBinary(made)))], []);
});

test('errors name the primitive and leave the document unchanged', async () => {
  const { made, primitive } = document();
  primitive.getIndices().setArray(Uint16Array.of(0, 1, 6));
  await assert.rejects(made.transform(tangents()), {
    name: 'RangeError',
    message: 'tangents: primitive 0 of mesh "wall": index 6 at place 2 is out of range: there are 6 vertices',
  });
  primitive.getIndices().setArray(Uint16Array.of(0, 1, 2));
  primitive.getAttribute('NORMAL').setArray(new Float32Array(15));
  await assert.rejects(made.transform(tangents()), /NORMAL has 5 elements for 6 vertices; export the file again$/);
  assert.equal(primitive.getAttribute('TANGENT'), null);
  assert.throws(() => tangents({ mode: 'reference' }), /^RangeError: mode is 'reference'; it must be one of 'repaired', 'corrected'$/);
});
