// Opens a page of headless Chromium with a bundled module.

import { existsSync } from 'node:fs';
import { basename } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';
import { chromium } from 'playwright-core';

const FLAGS = [
  '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
  '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--enable-unsafe-webgpu',
];

/** The browser: the environment variable CHROMIUM, or the path of Debian. */
const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** The reason to skip tests without a browser. Continuous integration must have one. */
export const skip = existsSync(executablePath) || process.env.CI !== undefined ? false : `there is no Chromium at ${executablePath}`;

/** Modules that tests pass as text, imported as 'text:NAME'. */
const ofTexts = (texts) => ({
  name: 'texts',
  setup: (build) => {
    build.onResolve({ filter: /^text:/ }, ({ path }) => ({ path: path.slice('text:'.length), namespace: 'text' }));
    build.onLoad({ filter: /.*/, namespace: 'text' }, ({ path }) => ({ contents: texts[path], resolveDir: fileURLToPath(new URL('.', import.meta.url)) }));
  },
});

/** Bundles a module and opens a page in which it is the global `tested`. */
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
