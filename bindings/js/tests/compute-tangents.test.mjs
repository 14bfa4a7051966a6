// three.js's own `BufferGeometry.computeTangents` and the method 'lengyel-per-vertex', which is the same sum.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as THREE from 'three';
import { generateTangents, ready } from 'darboux';
import { grid, mirrored } from './meshes.mjs';

await ready;

/** The tangents of three.js and of Darboux, per corner. */
function both([positions, normals, uvs, indices]) {
  const geometry = new THREE.BufferGeometry();
  const attributes = { position: [positions, 3], normal: [normals, 3], uv: [uvs, 2] };
  for (const [name, [array, size]] of Object.entries(attributes)) geometry.setAttribute(name, new THREE.BufferAttribute(array, size));
  geometry.setIndex(new THREE.BufferAttribute(indices, 1)).computeTangents();
  const ours = generateTangents(positions, normals, uvs, indices, { method: 'lengyel-per-vertex', returnReport: true });
  return { theirs: geometry.toNonIndexed().getAttribute('tangent').array, ours: ours.tangents, report: ours.report };
}

/** The arrays of a geometry of three.js. */
function arrays(geometry) {
  const [positions, normals, uvs] = ['position', 'normal', 'uv'].map((name) => geometry.getAttribute(name).array);
  return [positions, normals, uvs, Uint32Array.from(geometry.index.array)];
}

test('without degenerate triangles both agree to rounding, and in every sign', () => {
  const knot = new THREE.TorusKnotGeometry(1, 0.3, 64, 12);
  for (const mesh of [grid(20, 15), arrays(knot), arrays(new THREE.TorusGeometry(2, 0.7, 12, 24))]) {
    const { theirs, ours } = both(mesh);
    assert.equal(ours.length, theirs.length);
    // A few dozen roundings of 6e-8, times 10 for thin triangles: three.js computes in double precision.
    const worst = ours.reduce((most, x, at) => Math.max(most, Math.abs(x - theirs[at])), 0);
    assert.ok(worst < 2.4e-5, `${worst}`);
  }
});

test('where three.js leaves zero tangents, ours are repaired and counted', () => {
  const mesh = grid(4, 4);
  mesh[2].fill(0.5);
  const { theirs, ours, report } = both(mesh);
  assert.ok(theirs.every((x, at) => at % 4 === 3 || x === 0));
  assert.equal(report.repairedCorners, mesh[3].length);
  for (let at = 0; at < ours.length; at += 4) assert.ok(Math.abs(Math.hypot(...ours.subarray(at, at + 3)) - 1) < 1e-6);
});

test('a mirrored seam has one tangent per vertex in both, and ours is counted', () => {
  const { report } = both(mirrored());
  assert.equal(report.mergedVertices, 2);
});
