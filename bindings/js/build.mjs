// `node build.mjs MODULES OUT VERSION quick|release ENTRY...`: makes the package's folder OUT from the WebAssembly modules in MODULES.
//
//   release: shrink each module: panics become traps, wasm-opt; deflate it
//   quick: deflate each module; the forms without SIMD are missing
//   bundle each entry with its module, as ES module and CommonJS; bundle the adapters
//   write type declarations, package.json, README and licences
//
// Shrunk modules are cached by their content, because wasm-opt takes most of the time.

import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { copyFileSync, cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmdirSync, rmSync, writeFileSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { deflateRawSync } from 'node:zlib';
import zopfli from '@gfx/zopfli';
import binaryen from 'binaryen';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const [modules, out, version, kind, ...entries] = process.argv.slice(2);
const isRelease = kind === 'release';

/** The entries of the whole package, each with a WebAssembly module of its name. */
const ALL_ENTRIES = ['darboux', 'tangents', 'check', 'bake'];

/** The other entries of the whole package. Most import one of the above. */
const ADAPTERS = entries.length === ALL_ENTRIES.length ? ['three', 'gltf-transform', 'mikktspace', 'webgpu'] : [];

/** Chunks that adapters load on demand. They are ES modules in CommonJS, too. */
const LAZY_CHUNKS = ADAPTERS.includes('webgpu') ? ['webgpu.tangents.ts'] : [];

/** The WebAssembly features that rustc enables by default. */
const FEATURES = ['bulk-memory', 'bulk-memory-opt', 'nontrapping-float-to-int', 'sign-ext', 'mutable-globals', 'reference-types', 'multivalue', 'call-indirect-overlong'];

/** Runs a step, with a line when it starts, every 5 seconds while it runs, and when it ends. */
async function step(name, work) {
  const start = performance.now();
  const seconds = () => (performance.now() - start) / 1000;
  console.error(`  ${name} ...`);
  const timer = setInterval(() => console.error(`  ${name} ... ${seconds().toFixed(0)} s so far`), 5000);
  try {
    return await work();
  } finally {
    clearInterval(timer);
    console.error(`  ${name}: done after ${seconds().toFixed(1)} s`);
  }
}

/** Runs an installed program. Errors: it fails. */
function run(program, ...words) {
  return new Promise((resolve, reject) => {
    const child = spawn(join(here, 'node_modules/.bin', program), words, { cwd: here, stdio: ['ignore', 2, 2] });
    child.on('error', reject);
    child.on('close', (status) => (status === 0 ? resolve() : reject(new Error(`${program} failed`))));
  });
}

/** The entries that return messages. */
const WITH_MESSAGES = ['check', 'bake'];

/** Functions of the standard library that format messages. */
const MESSAGES = /^_R.*4core3fmt/;

/** Functions of the standard library that end a call. */
const PANICS = /^_R.*(9panicking\d|_fail$|_failed$|17rust_begin_unwind|15panic_with_hook|12handle_error|18handle_alloc_error|17capacity_overflow|8rust_oom)/;

/** Replaces the bodies of panics by traps. Their messages, which nothing can print, are not linked then. */
function trapPanics(entry, from, to) {
  const isTrapped = (name) => PANICS.test(name) || (!WITH_MESSAGES.includes(entry) && MESSAGES.test(name));
  const module = binaryen.readBinary(readFileSync(from));
  // Keeps the names of functions, which wasm-opt sorts by.
  binaryen.setDebugInfo(true);
  for (let at = 0; at < module.getNumFunctions(); at++) {
    const pointer = module.getFunctionByIndex(at);
    if (isTrapped(binaryen.getFunctionInfo(pointer).name)) binaryen.Function(pointer).body = module.unreachable();
  }
  writeFileSync(to, module.emitBinary());
  module.dispose();
}

/** The shrunk module of an entry, and the same deflated. */
const shrunkPath = (entry, form) => join(here, 'lib/wasm', `${entry}.${form}.wasm`);
const deflatedPath = (path) => `${path}.deflated`;

/** Shrinks and deflates a module, unless the same module was shrunk before. */
async function shrink(entry, form) {
  const [source, path] = [join(modules, `${entry}.${form}.wasm`), shrunkPath(entry, form)];
  const key = createHash('sha256').update(readFileSync(source)).update(`${FEATURES} ${PANICS} ${MESSAGES} ${trapPanics} ${shrink}`).digest('hex');
  const keyPath = `${path}.key`;
  if (existsSync(keyPath) && readFileSync(keyPath, 'utf8') === key) return;
  mkdirSync(dirname(path), { recursive: true });
  await step(`shrink the module of ${entry} (${form})`, async () => {
    trapPanics(entry, source, path);
    const features = [...FEATURES, ...(form === 'simd' ? ['simd'] : [])].map((name) => `--enable-${name}`);
    // Functions with one caller are not inlined: similar functions compress better side by side, and no hot loop contains a call.
    // Functions sorted by name lie beside those of the same module, which compresses better.
    const passes = ['-O3', '--one-caller-inline-max-function-size=0', '--reorder-functions-by-name'];
    await run('wasm-opt', ...features, ...passes, '--strip-debug', '--strip-producers', '--strip-target-features', path, '-o', path);
    writeFileSync(deflatedPath(path), await zopfli.deflateAsync(readFileSync(path), { numiterations: 5, blocksplittingmax: 40 }));
  });
  writeFileSync(keyPath, key);
}

/** Runs tasks, as many at the same time as there are processors. */
async function inParallel(tasks) {
  const queue = tasks.values();
  const work = async () => {
    for (const task of queue) await task();
  };
  await Promise.all(Array.from({ length: availableParallelism() }, work));
}

/** What stands in the place of a form that a quick build lacks. */
const MISSING = "throw new Error('this build of darboux needs SIMD; cargo xtask dist-js --release builds it without'); export default undefined;";

/** The deflated module of an entry, for esbuild. */
function embed(path) {
  if (isRelease) return { contents: readFileSync(deflatedPath(path)), loader: 'binary' };
  const compiled = join(modules, basename(path));
  return existsSync(compiled) ? { contents: deflateRawSync(readFileSync(compiled)), loader: 'binary' } : { contents: MISSING };
}

/** Modules are embedded deflated. A server's compression then adds little, whereas plain base64 of a module grows by half. */
const deflated = {
  name: 'deflated',
  setup: (build) => {
    build.onResolve({ filter: /\.wasm$/ }, ({ path, resolveDir }) => ({ path: join(resolveDir, path) }));
    build.onLoad({ filter: /\.wasm$/ }, ({ path }) => embed(path));
  },
};

/** A WGSL file without its comment lines. */
const withoutComments = (text) => text.replace(/^\s*\/\/.*\n/gm, '');

/** Embeds the shaders of crates/darboux-gpu: each file once, and per kernel the list of its parts. A part that is not a file name is WGSL. */
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

/** Adapters import the entries as users do, so that a program has each entry once. */
const externalEntries = (extension) => ({
  name: 'external-entries',
  setup: (build) =>
    build.onResolve({ filter: new RegExp(`^\\./(${ALL_ENTRIES.join('|')})\\.js$`) }, ({ path }) => ({
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
  // Node.js prints the source line of an uncaught error, so lines are short.
  lineLimit: 100,
  target: 'es2022',
  platform: 'neutral',
  plugins: [deflated, shaders, lazyChunks],
  external: ['./webgpu.tangents.js', 'three'],
  logLevel: 'warning',
};

/** Bundles with esbuild. Joins the string literals that it splits at the line limit, which would add thousands of bytes. */
async function bundle(options) {
  const { outputFiles } = await build({ ...common, ...options, write: false });
  for (const { path, text } of outputFiles) writeFileSync(path, text.replaceAll('\\\n', ''));
}

/** The form without SIMD is a lazy chunk, which browsers without SIMD load. */
async function bundleEntry(entry) {
  await bundle({ format: 'esm', entryPoints: [`${entry}.ts`, `${entry}.scalar.ts`] });
  await bundle({ format: 'cjs', entryPoints: [`${entry}.ts`], outExtension: { '.js': '.cjs' } });
}

async function bundleAdapters() {
  if (!ADAPTERS.length) return;
  // Most errors of adapters are thrown by their entry, so longer lines, which are smaller, do no harm here.
  const lineLimit = 400;
  const entryPoints = ADAPTERS.map((adapter) => `${adapter}.ts`);
  const plugins = (extension) => [externalEntries(extension), shaders];
  await bundle({ format: 'esm', entryPoints: [...entryPoints, ...LAZY_CHUNKS], plugins: plugins('.js'), lineLimit });
  await bundle({ format: 'cjs', entryPoints, plugins: plugins('.cjs'), outExtension: { '.js': '.cjs' }, lineLimit });
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
  for (const entry of [...entries, ...ADAPTERS]) visit(join(out, `${entry}.d.ts`));
  for (const path of readdirSync(out, { recursive: true }).map((name) => join(out, name))) {
    if (path.endsWith('.d.ts') && !reached.has(path)) rmSync(path);
  }
  for (const folder of readdirSync(out, { withFileTypes: true })) {
    if (folder.isDirectory() && !readdirSync(join(out, folder.name)).length) rmdirSync(join(out, folder.name));
  }
}

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
if (isRelease) await inParallel(entries.flatMap((entry) => ['simd', 'scalar'].map((form) => () => shrink(entry, form))));
await step('bundle the package and write its types', async () => {
  const types = run('tsc', '-p', 'lib', '--outDir', out);
  for (const entry of entries) await bundleEntry(entry);
  await bundleAdapters();
  await types;
  keepTypes();
});
const manifest = JSON.parse(readFileSync(join(here, 'lib/package.json'), 'utf8'));
writeFileSync(join(out, 'package.json'), JSON.stringify({ ...manifest, version }, null, 2) + '\n');
copyFileSync(join(here, 'README.md'), join(out, 'README.md'));
for (const name of ['LICENSE-APACHE', 'LICENSE-MIT', 'ATTRIBUTION.md']) copyFileSync(join(here, '../..', name), join(out, name));

// Tests and examples import the package as users do, beside the libraries that it extends.
const installed = join(here, 'node_modules/darboux');
if (ADAPTERS.length) {
  rmSync(installed, { recursive: true, force: true });
  cpSync(out, installed, { recursive: true });
}
