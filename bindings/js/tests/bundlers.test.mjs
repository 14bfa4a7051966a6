// Bundles of the package run, and contain only the entries that they import.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { build as esbuild } from 'esbuild';
import { build as vite } from 'vite';
import webpack from 'webpack';

// A folder inside the package, so that bundlers find the installed packages.
const here = fileURLToPath(new URL('..', import.meta.url));
const work = mkdtempSync(join(here, 'node_modules/.bundles-'));
after(() => rmSync(work, { recursive: true }));

const entry = join(work, 'entry.mjs');
writeFileSync(
  entry,
  `import { generateTangents, ready } from 'darboux/tangents';
  await ready;
  const mesh = [[0, 0, 0, 1, 0, 0, 1, 1, 0], [0, 0, 1, 0, 0, 1, 0, 0, 1], [0, 0, 1, 0, 1, 1]];
  console.log(JSON.stringify(Array.from(generateTangents(...mesh.map((array) => Float32Array.from(array))))));`,
);

const bundlers = {
  esbuild: (outdir) => esbuild({ entryPoints: [entry], outdir, outExtension: { '.js': '.mjs' }, bundle: true, splitting: true, format: 'esm', logLevel: 'error' }),
  vite: (outDir) =>
    vite({
      root: work,
      configFile: false,
      logLevel: 'error',
      build: { outDir, target: 'es2022', minify: false, lib: { entry, formats: ['es'], fileName: 'entry' } },
    }),
  webpack: (path) =>
    new Promise((resolve, reject) => {
      const output = { path, filename: 'entry.mjs', module: true, chunkFormat: 'module', chunkLoading: 'import' };
      const options = { mode: 'production', target: 'es2022', context: work, entry, output, experiments: { outputModule: true }, performance: false };
      webpack(options, (error, stats) => (error || stats.hasErrors() ? reject(error ?? new Error(stats.toString())) : resolve()));
    }),
};

for (const [name, bundle] of Object.entries(bundlers)) {
  test(name, async () => {
    const out = join(work, name);
    await bundle(out);
    const [main] = readdirSync(out).filter((file) => /^entry\.m?js$/.test(file));
    const printed = execFileSync('node', [join(out, main)], { encoding: 'utf8' });
    assert.deepEqual(JSON.parse(printed), Array.from({ length: 3 }, () => [1, 0, 0, 1]).flat());
    const size = statSync(join(out, main)).size;
    const alone = readFileSync(join(here, 'node_modules/darboux/tangents.js')).length;
    // The form without SIMD, which has the same size, is a separate chunk.
    assert.ok(size < 1.1 * alone, `${size} bytes of ${alone}`);
  });
}
