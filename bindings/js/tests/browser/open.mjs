// A page of headless Chromium with a module in it.

import { existsSync } from 'node:fs';
import { basename } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { chromium } from 'playwright-core';

const FLAGS = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--enable-unsafe-webgpu',
];

/** The path in CHROMIUM, or where Debian has it. */
const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** Why there can be no page, if so. Continuous integration has to have one. */
export const skip = existsSync(executablePath) || process.env.CI !== undefined ? false : `there is no Chromium at ${executablePath}`;

/** Modules of the tests' own, imported as 'text:NAME'. */
const ofTexts = (texts) => ({
  name: 'texts',
  setup: (build) => {
    build.onResolve({ filter: /^text:/ }, ({ path }) => ({ path: path.slice('text:'.length), namespace: 'text' }));
    build.onLoad({ filter: /.*/, namespace: 'text' }, ({ path }) => ({ contents: texts[path], resolveDir: fileURLToPath(new URL('.', import.meta.url)) }));
  },
});

/** Bundles a module, opens a page, and has the module there as `tested`. */
export async function open(module, texts = {}) {
  const { outputFiles } = await build({
    entryPoints: [module],
    bundle: true,
    splitting: true,
    format: 'esm',
    external: ['node:*'],
    plugins: [ofTexts(texts)],
    outdir: '/',
    write: false,
    logLevel: 'error',
  });
  const files = new Map(outputFiles.map(({ path, text }) => [path, text]));
  const browser = await chromium.launch({ executablePath, args: FLAGS });
  const page = await browser.newPage();
  await page.route('http://localhost/**', (route) => {
    const body = files.get(new URL(route.request().url()).pathname);
    return body ? route.fulfill({ body, contentType: 'text/javascript' }) : route.fulfill({ body: '<!doctype html>', contentType: 'text/html' });
  });
  await page.goto('http://localhost/');
  await page.evaluate(async (path) => {
    globalThis.tested = await import(path);
  }, `/${basename(module).replace('.mjs', '.js')}`);
  return { browser, page };
}
