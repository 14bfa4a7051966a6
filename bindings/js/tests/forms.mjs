// What the tests of both entries share.

import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
const { compile } = WebAssembly;

/** A module of the package in all its forms, loaded one after the other. */
export async function formsOf(entry) {
  const forms = { 'ES module': await import(entry), CommonJS: require(entry) };
  for (const form of Object.values(forms)) await form.ready;
  return { ...forms, scalar: await withoutSimd(entry) };
}

/** The module again, with a compiler that knows no SIMD. */
async function withoutSimd(entry) {
  let calls = 0;
  WebAssembly.compile = async (bytes) => {
    if (calls++ === 0) throw new WebAssembly.CompileError('no SIMD');
    return compile(bytes);
  };
  const scalar = await import(`${import.meta.resolve(entry)}?scalar`);
  await scalar.ready;
  WebAssembly.compile = compile;
  if (calls !== 2) throw new Error(`${calls} modules were compiled`);
  return scalar;
}

/** Positions, normals, UVs and indices of a square. */
export const square = () => [
  new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]),
  new Float32Array([0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1]),
  new Float32Array([0, 0, 1, 0, 1, 1, 0, 1]),
  new Uint16Array([0, 1, 2, 0, 2, 3]),
];

/** Two squares side by side, whose UVs mirror where they meet, at x = 0. */
export const mirrored = () => [
  new Float32Array([-1, 0, 0, 0, 0, 0, 0, 1, 0, -1, 1, 0, 1, 0, 0, 1, 1, 0]),
  new Float32Array(18).map((_, at) => (at % 3 === 2 ? 1 : 0)),
  new Float32Array([1, 0, 0, 0, 0, 1, 1, 1, 1, 0, 1, 1]),
  new Uint16Array([0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]),
];
