import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname } from 'node:path';
import vm from 'node:vm';
import { run, Skip } from '../../readers/case.mjs';

// The package is a script for browsers, whose variable Filament becomes the module once it is initialised: run it in the global scope.
globalThis.require = createRequire(import.meta.url);
const path = globalThis.require.resolve('filament');
globalThis.__dirname = dirname(path);
vm.runInThisContext(readFileSync(path, 'utf8'), path);
await new Promise((resolve) => globalThis.Filament.init([], resolve));
const { Filament } = globalThis;

await run(({ positions, normals, uvs, faces, indices, threshold }) => {
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  if (indices.length === 0) throw new Skip('no meshes without triangles');
  const builder = new Filament.SurfaceOrientation$Builder();
  builder.vertexCount(positions.length / 3);
  builder.normals(normals, 0);
  builder.uvs(uvs, 0);
  builder.positions(positions, 0);
  builder.triangleCount(faces.length);
  builder.triangles32(indices);
  const orientation = builder.build();
  const quaternions = orientation.getQuatsFloat4(positions.length / 3);
  orientation.delete();
  const tangents = new Float32Array(quaternions.length);
  for (let at = 0; at < tangents.length; at += 4) {
    const [x, y, z, w] = quaternions.subarray(at, at + 4);
    // The tangent is the rotated x axis. The sign of the quaternion is that of w in glTF, whose v points down.
    tangents.set([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y), w < 0 ? 1 : -1], at);
  }
  return { tangents, indices };
});
