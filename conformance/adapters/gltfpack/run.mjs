// The reader of files is Python's; this only starts it with the path of gltfpack.
import { spawnSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';

const path = (name) => fileURLToPath(new URL(name, import.meta.url));
const { status } = spawnSync('python3', [path('convert.py'), ...process.argv.slice(2)], { stdio: 'inherit', env: { ...process.env, GLTFPACK: path('node_modules/gltfpack/cli.js') } });
process.exit(status ?? 1);
