// Loads an entry in all its forms: ES module, CommonJS, and without SIMD.

import { createRequire } from 'node:module';

const require = createRequire(import.meta.url);
const { compile } = WebAssembly;

/** The forms of an entry, loaded one after the other. */
export async function formsOf(entry) {
  const forms = { 'ES module': await import(entry), CommonJS: require(entry) };
  for (const form of Object.values(forms)) await form.ready;
  return { ...forms, scalar: await withoutSimd(entry) };
}

/** The entry in an environment whose WebAssembly compiler refuses SIMD. */
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
