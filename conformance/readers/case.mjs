// Reads a case and writes a result, for adapters in JavaScript. Copy it. Licence: CC0.

import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const REPETITIONS = 5;

const number = (x) => (typeof x === 'string' ? { nan: NaN, inf: Infinity, '-inf': -Infinity }[x] : x);

/** A case with Float32Array positions, normals and uvs, and Uint32Array faces and indices. */
export function readCase(path) {
  const json = JSON.parse(readFileSync(path, 'utf8'));
  const floats = (rows) => Float32Array.from(rows.flat(), number);
  return {
    ...json,
    threshold: Math.fround(number(json.threshold)),
    positions: floats(json.positions),
    normals: floats(json.normals),
    uvs: floats(json.uvs),
    faces: Uint32Array.from(json.faces),
    indices: Uint32Array.from(json.indices),
  };
}

/** Writes tangents, four numbers each: per corner, or per vertex with the new index of each corner. */
export function writeResult(path, tangents, seconds, indices) {
  const rows = [];
  for (let at = 0; at < tangents.length; at += 4) {
    rows.push(Array.from(tangents.subarray(at, at + 4), (x) => (Number.isFinite(x) ? (Object.is(x, -0) ? '-0.0' : String(x)) : { NaN: '"nan"', Infinity: '"inf"', '-Infinity': '"-inf"' }[x])).join(', '));
  }
  const members = [`"seconds": ${seconds}`, `"tangents": [${rows.map((row) => `[${row}]`).join(',\n')}]`];
  if (indices) members.push(`"indices": [${Array.from(indices).join(', ')}]`);
  writeFileSync(path, `{${members.join(',\n')}}\n`);
}

/** A reason to skip a case. */
export class Skip extends Error {}

/**
 * Runs an adapter `CASES RESULTS`: calls compute(case) for every case, which gives tangents (Float32Array), or { tangents, indices }.
 * The least processor time of several runs of a large case counts.
 */
export async function run(compute) {
  const [cases, results] = process.argv.slice(2);
  mkdirSync(results, { recursive: true });
  for (const file of readdirSync(cases).filter((name) => name.endsWith('.json')).sort()) {
    const mesh = readCase(join(cases, file));
    try {
      let [found, seconds] = [undefined, Infinity];
      for (let round = 0; round < (mesh.class === 'large' ? REPETITIONS : 1); round++) {
        const start = process.cpuUsage();
        found = await compute(mesh);
        const { user, system } = process.cpuUsage(start);
        seconds = Math.min(seconds, (user + system) / 1e6);
      }
      const { tangents, indices } = found.tangents ? found : { tangents: found };
      writeResult(join(results, file), tangents, seconds, indices);
    } catch (error) {
      if (!(error instanceof Skip)) throw error;
      writeFileSync(join(results, file), JSON.stringify({ skipped: error.message }));
    }
  }
}
