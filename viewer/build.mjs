// `node build.mjs DARBOUX MODULE quick|release`: builds the page into `dist`, from the npm package in the folder DARBOUX and the compiled
// module of `wasm`, which is shrunk for a release.

import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
/** The WebAssembly features that rustc enables by default. */
const FEATURES = ['bulk-memory', 'bulk-memory-opt', 'nontrapping-float-to-int', 'sign-ext', 'mutable-globals', 'reference-types', 'multivalue', 'call-indirect-overlong'];

const [darboux, module, kind] = process.argv.slice(2);

/** Runs an installed program. Errors: it fails. */
function run(program, ...words) {
  const { status, error } = spawnSync(join(here, 'node_modules/.bin', program), words, { cwd: here, stdio: ['ignore', 2, 2] });
  if (status !== 0) throw error ?? new Error(`${program} failed`);
}

// The page imports the package as users do.
const link = join(here, 'node_modules/darboux');
rmSync(link, { recursive: true, force: true });
symlinkSync(darboux, link);

/** The module that the page imports. */
const shrunk = join(here, 'src/files/darboux_viewer.wasm');
const keyPath = `${shrunk}.key`;

/** Copies the module as it is. */
function copy() {
  rmSync(keyPath, { force: true });
  copyFileSync(module, shrunk);
}

/** Shrinks the module, unless the same module was shrunk before: that takes most of the time. */
function shrink() {
  const passes = [...FEATURES.map((name) => `--enable-${name}`), '-O3', ...['debug', 'producers', 'target-features'].map((name) => `--strip-${name}`)];
  const key = createHash('sha256').update(readFileSync(module)).update(passes.join()).digest('hex');
  if (existsSync(shrunk) && existsSync(keyPath) && readFileSync(keyPath, 'utf8') === key) return;
  run('wasm-opt', ...passes, module, '-o', shrunk);
  writeFileSync(keyPath, key);
}

if (kind === 'release') shrink();
else copy();
mkdirSync(join(here, 'public'), { recursive: true });
copyFileSync(join(here, '../assets/made/shield.glb'), join(here, 'public/shield.glb'));

run('tsc', '-p', '.');
run('vite', 'build');
