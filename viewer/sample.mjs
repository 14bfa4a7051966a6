// `node viewer/sample.mjs`, after `cargo xtask dist-viewer`, writes assets/made/shield.glb, the sample model of the page: a shield whose
// halves share one half of the texture. Its tangents are one per vertex, as many tools write them, so that they are wrong in the middle.

import { writeFileSync } from 'node:fs';
import { deflateSync } from 'node:zlib';

import { generateNormals, generateTangents, ready } from 'darboux';

import { glb, padded, pngChunk } from './tests/glb.mjs';

/** The number of quads across one half, and from top to bottom. */
const [ACROSS, DOWN] = [8, 24];
/** The width and height of the normal map. */
const SIZE = 512;

await ready;
writeFileSync(new URL('../assets/made/shield.glb', import.meta.url), sample());

/** Makes the GLB. */
function sample() {
  const { positions, uvs, indices } = shield();
  const normals = ofVertices(generateNormals(positions, indices), 3, indices, positions.length / 3);
  const corners = generateTangents(positions, normals, uvs, indices, { method: 'lengyel-per-vertex' });
  const tangents = ofVertices(corners, 4, indices, positions.length / 3);
  // v points down in glTF.
  for (let w = 3; w < tangents.length; w += 4) tangents[w] = -tangents[w];
  return model({ positions, normals, uvs, tangents, indices }, png());
}

/** Both halves. u grows from the middle outwards. */
function shield() {
  const [positions, uvs, indices] = [[], [], []];
  const columns = 2 * ACROSS + 1;
  for (let row = 0; row <= DOWN; row++) {
    const v = row / DOWN;
    // From the upper rim to the tip at the bottom.
    const half = 0.8 * (1 - 0.06 * Math.sin(Math.PI * v)) * (v < 0.35 ? 1 : Math.sqrt(Math.max(0, 1 - ((v - 0.35) / 0.66) ** 2)));
    for (let column = 0; column < columns; column++) {
      const side = (column - ACROSS) / ACROSS;
      const x = side * half;
      const y = 1 - 2 * v - 0.12 * (1 - Math.abs(side)) * (v > 0.5 ? v - 0.5 : 0) + 0.1 * Math.abs(side) * (1 - v);
      positions.push(x, y, 0.45 - 0.5 * x * x - 0.22 * y * y);
      uvs.push(Math.abs(x), v);
      if (row === DOWN || column === columns - 1) continue;
      const at = row * columns + column;
      indices.push(at, at + columns, at + 1, at + 1, at + columns, at + columns + 1);
    }
  }
  return { positions: new Float32Array(positions), uvs: new Float32Array(uvs), indices: new Uint16Array(indices) };
}

/** Values of corners as values of vertices, whose corners all have the same value. */
function ofVertices(corners, width, indices, count) {
  const out = new Float32Array(count * width);
  indices.forEach((vertex, corner) => out.set(corners.subarray(corner * width, (corner + 1) * width), vertex * width));
  return out;
}

/** The height of the surface at a UV: rows of scales, each row over the next lower one. */
function height(u, v) {
  const rows = 14;
  let highest = 0;
  for (const above of [0, 1]) {
    const row = Math.floor(v * rows) - above;
    const shift = row % 2 ? 0.5 : 0;
    const x = ((u * rows + shift) % 1) - 0.5;
    const y = v * rows - row;
    const distance = Math.hypot(x, Math.max(0, y - 0.7) * 0.8);
    if (distance < 0.5) highest = Math.max(highest, 0.55 + 0.35 * Math.sqrt(1 - 4 * distance * distance) + 0.25 * y);
  }
  return highest / rows / 3;
}

/** The normal map. Green points up the image. */
function png() {
  const raw = Buffer.alloc(SIZE * (1 + 3 * SIZE));
  const step = 0.5 / SIZE;
  for (let row = 0; row < SIZE; row++) {
    for (let column = 0; column < SIZE; column++) {
      const [u, v] = [(column + 0.5) / SIZE, (row + 0.5) / SIZE];
      const slope = [height(u + step, v) - height(u - step, v), height(u, v + step) - height(u, v - step)].map((rise) => rise / (2 * step));
      const normal = [-slope[0], slope[1], 1].map((x) => x / Math.hypot(slope[0], slope[1], 1));
      normal.forEach((x, at) => (raw[row * (1 + 3 * SIZE) + 1 + 3 * column + at] = Math.round(127.5 * x + 127.5)));
    }
  }
  const header = Buffer.alloc(13);
  header.writeUInt32BE(SIZE, 0);
  header.writeUInt32BE(SIZE, 4);
  header.set([8, 2], 8);
  const parts = [pngChunk('IHDR', header), pngChunk('IDAT', deflateSync(raw, { level: 9 })), pngChunk('IEND', Buffer.alloc(0))];
  return Buffer.concat([Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), ...parts]);
}

/** The glTF: one mesh with one material and its normal map. */
function model({ positions, normals, uvs, tangents, indices }, image) {
  const parts = [positions, normals, uvs, tangents, indices, image].map((part) => Buffer.from(part.buffer, part.byteOffset, part.byteLength));
  let at = 0;
  const bufferViews = parts.map((part) => {
    const view = { buffer: 0, byteOffset: at, byteLength: part.length };
    at += Math.ceil(part.length / 4) * 4;
    return view;
  });
  const count = positions.length / 3;
  const bounds = [Math.min, Math.max].map((best) => [0, 1, 2].map((axis) => positions.reduce((found, x, i) => (i % 3 === axis ? best(found, x) : found), positions[axis])));
  const json = {
    asset: { version: '2.0', generator: 'Darboux', copyright: 'CC0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    // Rotated, so that the slider crosses the middle.
    nodes: [{ mesh: 0, name: 'Shield', rotation: [0, 0, Math.sin(-0.15), Math.cos(-0.15)] }],
    meshes: [{ name: 'Shield', primitives: [{ attributes: { POSITION: 0, NORMAL: 1, TEXCOORD_0: 2, TANGENT: 3 }, indices: 4, material: 0 }] }],
    materials: [{ name: 'Bronze', doubleSided: true, normalTexture: { index: 0 }, pbrMetallicRoughness: { baseColorFactor: [0.4, 0.23, 0.11, 1], metallicFactor: 0.6, roughnessFactor: 0.45 } }],
    textures: [{ source: 0, sampler: 0 }],
    samplers: [{ magFilter: 9729, minFilter: 9987, wrapS: 10497, wrapT: 10497 }],
    images: [{ bufferView: 5, mimeType: 'image/png' }],
    accessors: [
      { bufferView: 0, componentType: 5126, count, type: 'VEC3', min: bounds[0], max: bounds[1] },
      { bufferView: 1, componentType: 5126, count, type: 'VEC3' },
      { bufferView: 2, componentType: 5126, count, type: 'VEC2' },
      { bufferView: 3, componentType: 5126, count, type: 'VEC4' },
      { bufferView: 4, componentType: 5123, count: indices.length, type: 'SCALAR' },
    ],
    bufferViews,
    buffers: [{ byteLength: at }],
  };
  return glb(json, Buffer.concat(parts.map((part) => padded(part, 0))));
}
