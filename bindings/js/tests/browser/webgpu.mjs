// The functions that tests/webgpu.test.mjs calls in the page.

import * as darboux from 'darboux';
import { generateTangents, openDevice } from 'darboux/webgpu';
import { degenerates, grid, mirrored, seams, soup } from '../meshes.mjs';
import { gpu } from './gpu.mjs';

export const { ready } = darboux;

/** The example of the package's README, with its device and its results. */
export const example = () => import('text:example');

/** Whether the browser has an adapter. */
export const hasAdapter = async () => Boolean(await navigator.gpu?.requestAdapter());

let opened;
const device = () => (opened ??= openDevice());

const unindexed = ([positions, normals, uvs, indices]) => {
  const rows = (array, width) => Float32Array.from({ length: width * indices.length }, (_, at) => array[width * indices[Math.floor(at / width)] + (at % width)]);
  return [rows(positions, 3), rows(normals, 3), rows(uvs, 2)];
};
const scaled = (scale, [positions, ...others]) => [positions.map((x) => scale * x), ...others];

const MESHES = {
  waves: () => grid(150, 100),
  'waves, indices of 16 bits': () => [...grid(60, 40).slice(0, 3), Uint16Array.from(grid(60, 40)[3])],
  'waves without indices': () => unindexed(grid(30, 20)),
  'mirrored squares': mirrored,
  seams,
  degenerates,
  soup: () => soup(900, 7),
  tiny: () => scaled(2 ** -70, grid(30, 20)),
  'no triangles': () => [new Float32Array(3), new Float32Array(3), new Float32Array(2), new Uint32Array()],
  endless: () => scaled(Infinity, grid(3, 2)),
};

/** The bits of floats, with one value for all NaNs. */
const bits = (floats) => new Uint32Array(floats.map((x) => (Number.isNaN(x) ? NaN : x)).buffer);

const differing = (a, b) => (a.length === b.length ? a.reduce((sum, x, at) => sum + (x !== b[at]), 0) : Infinity);

/** Compares a mesh on WebGPU and on the CPU. */
async function compared(mesh, options) {
  const [positions, normals, uvs, indices] = mesh;
  const { tangents, report, ...counts } = await generateTangents(await device(), positions, normals, uvs, indices, { ...options, returnReport: true });
  const expected = darboux.generateTangents(positions, normals, uvs, indices, { ...options, returnReport: true });
  const isReported = JSON.stringify(report) === JSON.stringify(expected.report);
  return { differing: differing(bits(tangents), bits(expected.tangents)), isReported, corners: tangents.length / 4, ...counts };
}

export const onBothSides = (name, options) => compared(MESHES[name](), options);

/** Faces as fans of triangles. */
function triangles(indices, sizes) {
  let start = 0;
  return Uint32Array.from(sizes.flatMap((size) => {
    const fan = Array.from({ length: size - 2 }, (_, at) => [start, start + at + 1, start + at + 2]).flat();
    start += size;
    return fan.map((corner) => indices[corner]);
  }));
}

/** Takes the bits of a mesh's arrays. Returns the result of WebGPU, and the comparison of its triangles on both sides. */
export async function ofWords([words, indices], { faces, ...options }) {
  const floats = words.map((array) => new Float32Array(Uint32Array.from(array).buffer));
  const all = faces.every((size) => size === 3) ? 3 : Uint32Array.from(faces);
  const tangents = await generateTangents(await device(), ...floats, Uint32Array.from(indices), { ...options, faces: all });
  return { tangents: Array.from(new Uint32Array(tangents.buffer)), inTriangles: await compared([...floats, triangles(indices, faces)], options) };
}

/** Whether the caller's buffers hold the returned tangents and nothing else. */
export async function intoBuffers(names) {
  const { device, errors, filled, read } = await gpu();
  const found = [];
  for (const name of names) {
    const mesh = MESHES[name]();
    const length = 4 * mesh[3].length;
    const buffer = filled(new Float32Array(length + 4).fill(7));
    const tangents = await generateTangents(device, ...mesh, { buffer });
    const [words] = await read(() => {}, [buffer]);
    const rest = Array.from(new Float32Array(words.slice(length).buffer));
    found.push({ name, differing: differing(words.slice(0, length), new Uint32Array(tangents.buffer)), rest });
  }
  return { found, errors };
}

/** The errors for arguments that do not fit. */
export async function refusals() {
  const { device, errors, filled } = await gpu();
  const [positions, normals, uvs, indices] = mirrored();
  const said = async (device, options, list = indices) =>
    generateTangents(device, positions, normals, uvs, list, options).then(() => 'nothing', ({ name, message }) => `${name}: ${message}`);
  const all = [
    await said(undefined),
    await said(device, { mode: 'best' }),
    await said(device, { method: 'lengyel' }),
    await said(device, {}, Uint32Array.of(0, 1, 6)),
    await said(device, { buffer: filled(new Float32Array(4)) }),
    await said(device, { buffer: device.createBuffer({ size: 256, usage: GPUBufferUsage.STORAGE }) }),
    await said(device, {}, new Uint32Array(3 * 2 ** 21)),
  ];
  const before = errors.slice();
  device.destroy();
  return [...all, await said(device), before];
}
