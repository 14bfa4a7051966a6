// Times several engines on a wavy grid of 1,000 by 500 squares (1M triangles), in Node.js and in browsers. Compares results first.

import { generateTangents, ready } from 'darboux/tangents';
import { MeshoptTangents } from 'meshoptimizer';
import { generateTangents as three } from 'three/addons/libs/mikktspace.module.js';
import { grid } from './grid.mjs';

const TRIANGLES = 1_000_000;

/** Times all engines in turns. Returns the minimum and the median in nanoseconds per triangle. `now` returns milliseconds. */
export async function measure(rounds, now) {
  await Promise.all([ready, MeshoptTangents.ready]);
  const [positions, normals, uvs, indices] = grid(1000, 500);
  const expanded = (values, width) => {
    const result = new Float32Array(width * indices.length);
    indices.forEach((vertex, corner) => {
      for (let i = 0; i < width; i++) result[width * corner + i] = values[width * vertex + i];
    });
    return result;
  };
  const soup = [expanded(positions, 3), expanded(normals, 3), expanded(uvs, 2)];
  const out = new Float32Array(4 * indices.length);
  const engines = {
    'darboux/tangents': () => generateTangents(positions, normals, uvs, indices),
    'darboux/tangents, into an array': () => generateTangents(positions, normals, uvs, indices, {}, out),
    'meshoptimizer WASM': () => MeshoptTangents.generateTangents(indices, positions, 3, normals, 3, uvs, 2),
    'three.js port': () => three(...soup),
    'darboux/tangents, without indices': () => generateTangents(...soup),
  };
  const [ours, theirs] = [engines['darboux/tangents'](), engines['three.js port']()];
  if (!ours.every((x, at) => Object.is(x, theirs[at]))) throw new Error('darboux and three.js differ');
  const times = Object.fromEntries(Object.keys(engines).map((name) => [name, []]));
  for (let round = 0; round < rounds; round++) {
    for (const [name, run] of Object.entries(engines)) {
      const start = now();
      run();
      times[name].push(((now() - start) * 1e6) / TRIANGLES);
    }
  }
  return Object.fromEntries(
    Object.entries(times).map(([name, list]) => {
      const sorted = list.toSorted((a, b) => a - b);
      return [name, { least: sorted[0], median: sorted[rounds >> 1] }];
    }),
  );
}
