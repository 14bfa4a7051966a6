// `darboux/three` with three.js itself.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { computeMikkTSpaceTangents } from 'three/addons/utils/BufferGeometryUtils.js';
import { generateTangents as theirs } from 'three/addons/libs/mikktspace.module.js';
import * as darboux from 'darboux/three';
import { mirrored } from './meshes.mjs';

const { computeTangents, ready } = darboux;
await ready;

const attribute = (array, size, normalized) => new THREE.BufferAttribute(array, size, normalized);

/** The geometry of a mesh. */
function geometry([positions, normals, uvs, indices]) {
  const result = new THREE.BufferGeometry();
  result.setAttribute('position', attribute(positions, 3));
  result.setAttribute('normal', attribute(normals, 3));
  result.setAttribute('uv', attribute(uvs, 2));
  return indices ? result.setIndex(attribute(indices, 1)) : result;
}

/** A torus knot has no degenerate triangles and no seam that mirrors. */
const knot = () => new THREE.TorusKnotGeometry(1, 0.3, 40, 8);

/** The values of an attribute per corner, in the order of the index. */
function ofCorners(geometry, name) {
  const { array } = geometry.toNonIndexed().getAttribute(name);
  return Array.from(array);
}

/** Textures of glTF files. */
const GLTF = { flipY: false };

test('computeMikkTSpaceTangents has the same result with this module as with its own', () => {
  assert.equal(darboux.isReady, true);
  const [ours, expected] = [darboux, { isReady: true, generateTangents: theirs }].map((module) => computeMikkTSpaceTangents(knot(), module));
  assert.deepEqual(ours.getAttribute('tangent').array, expected.getAttribute('tangent').array);
  darboux.dispose();
});

test('an indexed geometry stays indexed and its corners have the tangents of three.js\'s function', () => {
  for (const flipY of [true, false]) {
    const [ours, expected] = [knot(), knot()];
    const before = ours.getAttribute('position').count;
    assert.equal(computeTangents(ours, { flipY }), ours);
    computeMikkTSpaceTangents(expected, darboux, !flipY);
    assert.deepEqual(ofCorners(ours, 'tangent'), Array.from(expected.getAttribute('tangent').array));
    assert.deepEqual(ofCorners(ours, 'position'), Array.from(expected.getAttribute('position').array));
    // No vertex was copied.
    assert.equal(ours.getAttribute('tangent').count, before);
  }
});

test('at a mirrored seam vertices are copied with all their attributes', () => {
  const split = geometry(mirrored());
  const names = ['position', 'normal', 'uv', 'skinIndex', 'skinWeight', 'color'];
  split.setAttribute('skinIndex', attribute(Uint16Array.from({ length: 24 }, (_, at) => at), 4));
  split.setAttribute('skinWeight', attribute(Uint8Array.from({ length: 24 }, (_, at) => 10 * at), 4, true));
  split.setAttribute('color', new THREE.Float16BufferAttribute(Uint16Array.from({ length: 18 }, (_, at) => 15360 + at), 3));
  split.setAttribute('offset', new THREE.InstancedBufferAttribute(new Float32Array(6), 3));
  split.morphAttributes.position = [attribute(Float32Array.from({ length: 18 }, (_, at) => at), 3)];
  split.morphTargetsRelative = true;
  split.addGroup(0, 6, 0);
  split.addGroup(6, 6, 1);
  let disposed = 0;
  split.addEventListener('dispose', () => disposed++);
  const before = names.map((name) => ofCorners(split, name));
  const morphed = split.toNonIndexed().morphAttributes.position[0].array;
  const groups = structuredClone(split.groups);

  computeTangents(split, GLTF);
  assert.equal(split.getAttribute('position').count, 8);
  assert.deepEqual(names.map((name) => ofCorners(split, name)), before);
  assert.deepEqual(split.toNonIndexed().morphAttributes.position[0].array, morphed);
  assert.deepEqual(split.groups, groups);
  assert.equal(split.index.array.constructor, Uint16Array);
  assert.equal(split.getAttribute('skinWeight').normalized, true);
  assert.equal(split.getAttribute('color').constructor, THREE.Float16BufferAttribute);
  assert.equal(split.getAttribute('offset').count, 2);
  assert.equal(disposed, 1);
  const sides = ofCorners(split, 'tangent').filter((_, at) => at % 4 === 0 || at % 4 === 3);
  assert.deepEqual(sides, [...Array(6).fill([-1, 1]), ...Array(6).fill([1, -1])].flat());
});

test('indices widen when vertices outgrow them, and a geometry computed twice is split once', () => {
  const [positions, normals, uvs, indices] = mirrored();
  const [bytes, extra] = [Uint8Array.from(indices), 254 - 6];
  const longer = (array, width) => Float32Array.of(...array, ...new Float32Array(width * extra));
  const wide = geometry([longer(positions, 3), longer(normals, 3), longer(uvs, 2), bytes]);
  computeTangents(wide, GLTF);
  assert.equal(wide.getAttribute('position').count, 256);
  assert.equal(wide.index.array.constructor, Uint32Array);
  computeTangents(wide, GLTF);
  assert.equal(wide.getAttribute('position').count, 256);
});

test('interleaved and quantised geometry has the tangents of its values', () => {
  const [positions, normals, uvs, indices] = mirrored();
  const buffer = new THREE.InterleavedBuffer(new Int16Array(6 * 8), 8);
  const interleaved = new THREE.BufferGeometry().setIndex(attribute(indices, 1));
  const layout = { position: [positions, 3, 0, 1, false], normal: [normals, 3, 3, 32767, true], uv: [uvs, 2, 6, 32767, true] };
  for (const [name, [values, width, offset, scale, normalized]] of Object.entries(layout)) {
    values.forEach((x, at) => (buffer.array[8 * Math.floor(at / width) + offset + (at % width)] = x * scale));
    interleaved.setAttribute(name, new THREE.InterleavedBufferAttribute(buffer, width, offset, normalized));
  }
  const plain = geometry(mirrored());
  computeTangents(plain, GLTF);
  computeTangents(interleaved, GLTF);
  const [position, tangent] = ['position', 'tangent'].map((name) => interleaved.getAttribute(name));
  assert.deepEqual([position.count, position.data.stride, position.data], [8, 8, interleaved.getAttribute('uv').data]);
  assert.deepEqual([tangent.array.constructor, tangent.normalized], [Int16Array, true]);
  assert.deepEqual(ofCorners(interleaved, 'position'), ofCorners(plain, 'position'));
  assert.deepEqual(Array.from(tangent.array, (x) => x / 32767), Array.from(plain.getAttribute('tangent').array));
});

test('options select UVs and method', () => {
  const [positions, normals, uvs, indices] = mirrored();
  const other = geometry([positions, normals, new Float32Array(uvs.length), indices]);
  other.setAttribute('uv1', attribute(uvs, 2));
  computeTangents(other, GLTF, { uv: 'uv1', method: 'lengyel' });
  assert.deepEqual(other.getAttribute('tangent').array.slice(0, 4), Float32Array.of(-1, 0, 0, 1));
});

test('without an index every vertex has its own tangent', () => {
  const expanded = geometry(mirrored()).toNonIndexed();
  computeTangents(expanded, GLTF);
  assert.deepEqual([expanded.index, expanded.getAttribute('tangent').count], [null, 12]);
});

test('without the normal map the sign is not guessed', () => {
  const materials = [new THREE.MeshStandardMaterial(), new THREE.MeshStandardMaterial({ normalMap: new THREE.DataTexture() })];
  for (const missing of [undefined, null, {}, materials[0].normalMap, materials[1], { negateSign: true }]) {
    assert.throws(() => computeTangents(knot(), missing), /^TypeError: computeTangents needs the normal map, /);
  }
  const [up, down] = [new THREE.Texture(), new THREE.DataTexture()].map((texture) => computeTangents(knot(), texture).getAttribute('tangent').array);
  assert.deepEqual(Array.from(up), Array.from(down, (x, at) => (at % 4 === 3 ? -x : x)));
});

test('missing attributes are named', () => {
  const bare = new THREE.BufferGeometry().setAttribute('position', attribute(new Float32Array(9), 3));
  assert.throws(() => computeTangents(bare, GLTF), /^Error: the geometry has no attribute 'normal'; /);
  const far = geometry(mirrored());
  far.setAttribute('uv', new THREE.GLBufferAttribute(null, 5126, 2, 4, 6));
  assert.throws(() => computeTangents(far, GLTF), /^Error: the attribute 'uv' is on the GPU; /);
  const wrong = geometry(mirrored()).setIndex(attribute(Uint16Array.of(0, 1, 6), 1));
  assert.throws(() => computeTangents(wrong, GLTF), /^RangeError: index 6 at place 2 is out of range: there are 6 vertices$/);
});
