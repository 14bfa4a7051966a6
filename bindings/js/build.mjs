// `node build.mjs MODULES OUT VERSION`: makes the folder that is published in OUT, of the WebAssembly modules in MODULES.

import { spawnSync } from 'node:child_process';
import { copyFileSync, cpSync, mkdirSync, readdirSync, readFileSync, rmdirSync, rmSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import zopfli from '@gfx/zopfli';
import binaryen from 'binaryen';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const [modules, out, version] = process.argv.slice(2);

/** What users import, each with a WebAssembly module of its name. */
const ENTRIES = ['darboux', 'tangents'];

/** What users import beside, most of it over one of those. */
const ADAPTERS = ['three', 'gltf-transform', 'mikktspace', 'webgpu'];

/** What those import when it is asked for, CommonJS too. */
const LATER = ['webgpu.tangents.ts'];

/** What the compiler uses without being told. */
const FEATURES = ['bulk-memory', 'bulk-memory-opt', 'nontrapping-float-to-int', 'sign-ext', 'mutable-globals', 'reference-types', 'multivalue', 'call-indirect-overlong'];

function run(program, ...words) {
  const { status, error } = spawnSync(join(here, 'node_modules/.bin', program), words, { cwd: here, stdio: ['ignore', 2, 2] });
  if (status !== 0) throw error ?? new Error(`${program} failed`);
}

/** Functions of the standard library that end a call, and those that write what no one hears then. */
const ENDS = /^_R.*(4core3fmt|9panicking\d|_fail$|_failed$|17rust_begin_unwind|15panic_with_hook|12handle_error|18handle_alloc_error|17capacity_overflow|8rust_oom)/;

/** A module whose panics are traps, without their words. */
function withoutWords(from, to) {
  const module = binaryen.readBinary(readFileSync(from));
  for (let at = 0; at < module.getNumFunctions(); at++) {
    const place = module.getFunctionByIndex(at);
    if (ENDS.test(binaryen.getFunctionInfo(place).name)) binaryen.Function(place).body = module.unreachable();
  }
  writeFileSync(to, module.emitBinary());
  module.dispose();
}

/** The modules, made smaller. */
function optimize(entry, form) {
  const features = [...FEATURES, ...(form === 'simd' ? ['simd'] : [])].map((name) => `--enable-${name}`);
  const place = join(here, 'lib/wasm', `${entry}.${form}.wasm`);
  mkdirSync(dirname(place), { recursive: true });
  withoutWords(join(modules, `${entry}.${form}.wasm`), place);
  // Functions with one caller stay functions: those alike lie nearer to each other for it, and no loop has a call within.
  const levels = ['-O3', '--one-caller-inline-max-function-size=0'];
  run('wasm-opt', ...features, ...levels, '--strip-debug', '--strip-producers', '--strip-target-features', place, '-o', place);
}

/** Modules are embedded deflated: what a server compresses again then barely grows, while plain base64 grows by half. */
const deflated = {
  name: 'deflated',
  setup: (build) =>
    build.onLoad({ filter: /\.wasm$/ }, async ({ path }) => ({
      contents: await (smallest[path] ??= zopfli.deflateAsync(readFileSync(path), { numiterations: 5 })),
      loader: 'binary',
    })),
};

/** Modules that have been deflated, by path: both forms of an entry have the same. */
const smallest = {};

/** A WGSL file without its comment lines. */
const withoutComments = (text) => text.replace(/^\s*\/\/.*\n/gm, '');

/** The shaders of crates/darboux-gpu, each file once, put together as its list says. Parts that are no files stand for themselves. */
const shaders = {
  name: 'shaders',
  setup: (build) => {
    const folder = join(here, '../../crates/darboux-gpu/shaders');
    const list = (path) => join(folder, `${basename(path)}.json`);
    build.onResolve({ filter: /^darboux-gpu\/passes$/ }, ({ path }) => ({ path: list(path) }));
    build.onResolve({ filter: /^darboux-gpu\/(kernels|mikktspace)$/ }, ({ path }) => ({ path: list(path), namespace: 'shaders' }));
    build.onLoad({ filter: /.*/, namespace: 'shaders' }, ({ path }) => {
      const kernels = Object.entries(JSON.parse(readFileSync(path, 'utf8')));
      const parts = [...new Set(kernels.flatMap(([, parts]) => parts))];
      const texts = parts.map((part) => (part.endsWith('.wgsl') ? withoutComments(readFileSync(join(folder, part), 'utf8')) : part));
      const lists = kernels.map(([name, list]) => `${name}: [${list.map((part) => `t[${parts.indexOf(part)}]`)}]`);
      return { contents: `const t = ${JSON.stringify(texts)};\nexport default { ${lists} };` };
    });
  },
};

/** Adapters import their entry as users do, so that it is there once. */
const entries = (extension) => ({
  name: 'entries',
  setup: (build) =>
    build.onResolve({ filter: new RegExp(`^\\./(${ENTRIES.join('|')})\\.js$`) }, ({ path }) => ({
      path: path.replace('.js', extension),
      external: true,
    })),
});

/** Chunks that are loaded on demand lie beside the entries, whatever file imports them. */
const lazyChunks = {
  name: 'lazy-chunks',
  setup: (build) => build.onResolve({ filter: /\.scalar\.js$/ }, ({ path }) => ({ path: `./${basename(path)}`, external: true })),
};

const common = {
  absWorkingDir: join(here, 'lib'),
  outdir: out,
  bundle: true,
  minify: true,
  // Node.js shows the line that throws: not the whole module.
  lineLimit: 400,
  target: 'es2022',
  platform: 'neutral',
  plugins: [deflated, shaders, lazyChunks],
  external: ['./webgpu.tangents.js', 'three'],
  logLevel: 'warning',
};

/** The form without SIMD is a file of its own, which is imported where it is needed. */
async function bundle(entry) {
  await build({ ...common, format: 'esm', entryPoints: [`${entry}.ts`, `${entry}.scalar.ts`] });
  await build({ ...common, format: 'cjs', entryPoints: [`${entry}.ts`], outExtension: { '.js': '.cjs' } });
}

async function bundleAdapters() {
  const entryPoints = ADAPTERS.map((adapter) => `${adapter}.ts`);
  const plugins = (extension) => [entries(extension), shaders];
  await build({ ...common, format: 'esm', entryPoints: [...entryPoints, ...LATER], plugins: plugins('.js') });
  await build({ ...common, format: 'cjs', entryPoints, plugins: plugins('.cjs'), outExtension: { '.js': '.cjs' } });
}

/** Keeps the type declarations that the entries reach, for ES modules and for CommonJS, and deletes the others. */
function keepTypes() {
  const reached = new Set();
  const visit = (path) => {
    if (reached.has(path)) return;
    reached.add(path);
    const text = readFileSync(path, 'utf8');
    for (const [, imported] of text.matchAll(/from '(\..*)\.js'/g)) visit(join(dirname(path), `${imported}.d.ts`));
    writeFileSync(path.replace(/\.d\.ts$/, '.d.cts'), text.replaceAll(/from '(\..*)\.js'/g, "from '$1.cjs'"));
  };
  for (const entry of [...ENTRIES, ...ADAPTERS]) visit(join(out, `${entry}.d.ts`));
  for (const path of readdirSync(out, { recursive: true }).map((name) => join(out, name))) {
    if (path.endsWith('.d.ts') && !reached.has(path)) rmSync(path);
  }
  for (const folder of readdirSync(out, { withFileTypes: true })) {
    if (folder.isDirectory() && !readdirSync(join(out, folder.name)).length) rmdirSync(join(out, folder.name));
  }
}

rmSync(out, { recursive: true, force: true });
for (const entry of ENTRIES) {
  for (const form of ['simd', 'scalar']) optimize(entry, form);
  await bundle(entry);
}
await bundleAdapters();
run('tsc', '-p', 'lib', '--outDir', out);
keepTypes();
const manifest = JSON.parse(readFileSync(join(here, 'lib/package.json'), 'utf8'));
writeFileSync(join(out, 'package.json'), JSON.stringify({ ...manifest, version }, null, 2) + '\n');
copyFileSync(join(here, 'README.md'), join(out, 'README.md'));
for (const license of ['LICENSE-APACHE', 'LICENSE-MIT']) copyFileSync(join(here, '../..', license), join(out, license));

// Tests and examples import it as users do, beside the libraries that it extends.
const installed = join(here, 'node_modules/darboux');
rmSync(installed, { recursive: true, force: true });
cpSync(out, installed, { recursive: true });
