// The meshes of the corpus and the results of the native library.

import { execFileSync } from 'node:child_process';

const words = ['run', '--quiet', '--package', 'darboux-tests', '--bin', 'corpus'];
const lines = execFileSync('cargo', words, { encoding: 'utf8', maxBuffer: 2 ** 30 }).trim().split('\n');

const floats = (bits) => new Float32Array(Uint32Array.from(bits).buffer);

export const corpus = lines.map((line) => {
  const read = JSON.parse(line);
  return {
    name: `${read.name}, ${read.mode}, ${read.threshold}`,
    arrays: [floats(read.positions), floats(read.normals), floats(read.uvs), Uint32Array.from(read.indices)],
    options: { mode: read.mode, threshold: read.threshold, faces: Uint32Array.from(read.faces) },
    answer: { ...read, moved: floats(read.moved) },
  };
});

/** The bits of floats, with one value for all NaNs. */
export const bits = (values) => Array.from(new Uint32Array(Float32Array.from(values).buffer), canonical);

const canonical = (bits) => ((bits & 0x7fffffff) > 0x7f800000 ? 0x7fc00000 : bits);

/** The bits that the native library wrote, with one value for all NaNs. */
export const native = (words) => words.map(canonical);
