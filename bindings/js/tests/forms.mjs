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
