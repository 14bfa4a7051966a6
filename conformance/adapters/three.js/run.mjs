import { BufferAttribute, BufferGeometry } from 'three';
import { computeMikkTSpaceTangents } from 'three/addons/utils/BufferGeometryUtils.js';
import * as MikkTSpace from 'three/addons/libs/mikktspace.module.js';
import { run, Skip } from '../../readers/case.mjs';

const method = process.argv.splice(2, 1)[0];

await run((mesh) => {
  if (mesh.faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (mesh.threshold !== 180) throw new Skip('no angular threshold');
  const geometry = new BufferGeometry();
  for (const [name, array, size] of [['position', mesh.positions, 3], ['normal', mesh.normals, 3], ['uv', mesh.uvs, 2]]) {
    geometry.setAttribute(name, new BufferAttribute(array, size));
  }
  geometry.setIndex(new BufferAttribute(mesh.indices, 1));
  if (method === 'lengyel') {
    geometry.computeTangents();
    return { tangents: geometry.getAttribute('tangent').array, indices: mesh.indices };
  }
  // The sign is MikkTSpace's own for UVs as given, so it is not negated as for glTF.
  return computeMikkTSpaceTangents(geometry, MikkTSpace, false).getAttribute('tangent').array;
});
