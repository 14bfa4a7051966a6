// `node build.mjs DARBOUX quick|release MODULE [LARGER_MODULE]`: builds the page into `dist`, from the npm package in the folder DARBOUX and the
// compiled modules of `wasm`, which are shrunk for a release.

import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
/** The WebAssembly features that rustc enables by default. */
const FEATURES = ['bulk-memory', 'bulk-memory-opt', 'nontrapping-float-to-int', 'sign-ext', 'mutable-globals', 'reference-types', 'multivalue', 'call-indirect-overlong'];

const [darboux, kind, ...modules] = process.argv.slice(2);

/** Runs an installed program. Errors: it fails. */
function run(program, ...words) {
  const { status, error } = spawnSync(join(here, 'node_modules/.bin', program), words, { cwd: here, stdio: ['ignore', 2, 2] });
  if (status !== 0) throw error ?? new Error(`${program} failed`);
}

// The page imports the package as users do.
const link = join(here, 'node_modules/darboux');
rmSync(link, { recursive: true, force: true });
symlinkSync(darboux, link);

/** Copies a module as it is. */
function copy(module, to) {
  rmSync(`${to}.key`, { force: true });
  copyFileSync(module, to);
}

/** Shrinks a module, unless the same module was shrunk before: that takes most of the time. */
function shrink(module, to) {
  const passes = [...FEATURES.map((name) => `--enable-${name}`), '-O3', ...['debug', 'producers', 'target-features'].map((name) => `--strip-${name}`)];
  const key = createHash('sha256').update(readFileSync(module)).update(passes.join()).digest('hex');
  const keyPath = `${to}.key`;
  if (existsSync(to) && existsSync(keyPath) && readFileSync(keyPath, 'utf8') === key) return;
  run('wasm-opt', ...passes, module, '-o', to);
  writeFileSync(keyPath, key);
}

/** The modules that the page imports: the one for glTF, and the larger one, which reads all formats. */
const imported = ['darboux_viewer.wasm', 'darboux_viewer_larger.wasm'].map((name) => join(here, 'src/files', name));
for (const to of imported.slice(modules.length)) rmSync(to, { force: true });
for (const [at, module] of modules.entries()) (kind === 'release' ? shrink : copy)(module, imported[at]);
mkdirSync(join(here, 'public'), { recursive: true });
for (const path of ['assets/made/shield.glb', 'LICENSE-APACHE', 'LICENSE-MIT', 'ATTRIBUTION.md']) copyFileSync(join(here, '..', path), join(here, 'public', basename(path)));

run('tsc', '-p', '.');
run('vite', 'build');
