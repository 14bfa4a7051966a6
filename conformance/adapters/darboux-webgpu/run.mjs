import { build } from 'esbuild';
import { chromium } from 'playwright-core';
import { run, Skip } from '../../readers/case.mjs';

const FLAGS = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--enable-unsafe-webgpu'];

const { outputFiles } = await build({
  stdin: { contents: "export * from 'darboux/webgpu'", resolveDir: process.env.DARBOUX_NPM, sourcefile: 'page.js' },
  bundle: true, splitting: true, format: 'esm', external: ['node:*'], outdir: '/', write: false, logLevel: 'error',
});
const files = new Map(outputFiles.map(({ path, text }) => [path, text]));
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', args: FLAGS });
const page = await browser.newPage();
await page.route('http://localhost/**', (route) => {
  const body = files.get(new URL(route.request().url()).pathname);
  return body ? route.fulfill({ body, contentType: 'text/javascript' }) : route.fulfill({ body: '<!doctype html>', contentType: 'text/html' });
});
await page.goto('http://localhost/');
await page.evaluate(async () => {
  const { generateTangents, openDevice } = await import('/stdin.js');
  const device = await openDevice();
  globalThis.compute = async (words, { faces, ...options }) => {
    const [positions, normals, uvs, indices] = words.map((list) => Uint32Array.from(list));
    const floats = [positions, normals, uvs].map((array) => new Float32Array(array.buffer));
    // Lists of faces go to the CPU; a number does not.
    const given = { ...options, faces: faces.every((size) => size === 3) ? 3 : Uint32Array.from(faces) };
    const tangents = await generateTangents(device, ...floats, indices, given);
    return Array.from(new Uint32Array(tangents.buffer));
  };
});

const words = (array) => Array.from(new Uint32Array(array.buffer));

try {
  await run(async ({ positions, normals, uvs, faces, indices, threshold }) => {
    if (!Number.isFinite(threshold)) throw new Skip('the package refuses thresholds that are not finite');
    if (indices.length === 0) return new Float32Array(0);
    const options = { mode: 'reference', threshold, faces: Array.from(faces) };
    const found = await page.evaluate(([words, options]) => compute(words, options), [[positions, normals, uvs, indices].map(words), options]);
    return new Float32Array(Uint32Array.from(found).buffer);
  });
} finally {
  await browser.close();
}
