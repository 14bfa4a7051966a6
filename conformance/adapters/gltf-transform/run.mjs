import { createRequire } from 'node:module';
import { Document } from '@gltf-transform/core';
import { tangents, unweld } from '@gltf-transform/functions';
import { run, Skip } from '../../readers/case.mjs';

const require = createRequire(import.meta.url);

// As its documentation says: unweld, then tangents. The file is judged corner by corner; its sign is glTF's, for v down.
await run(async ({ positions, normals, uvs, faces, indices, threshold }) => {
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  if (indices.length === 0) throw new Skip('glTF has no meshes without triangles');
  if (![positions, normals, uvs].every((array) => array.every(Number.isFinite))) throw new Skip('glTF has finite numbers only');
  const document = new Document();
  const buffer = document.createBuffer();
  const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
  const primitive = document
    .createPrimitive()
    .setAttribute('POSITION', accessor('VEC3', positions))
    .setAttribute('NORMAL', accessor('VEC3', normals))
    .setAttribute('TEXCOORD_0', accessor('VEC2', uvs))
    .setIndices(accessor('SCALAR', indices))
    .setMaterial(document.createMaterial().setNormalTexture(document.createTexture('normal')));
  document.createMesh().addPrimitive(primitive);
  try {
    const mikktspace = require('mikktspace');
    await document.transform(unweld(), tangents({ generateTangents: mikktspace.generateTangents }));
  } catch (error) {
    console.error(`glTF-Transform: ${error}`);
    // After an error inside WebAssembly its memory cannot be trusted, so the next case gets a new instance.
    for (const key of Object.keys(require.cache)) delete require.cache[key];
    return new Float32Array(4 * indices.length).fill(NaN);
  }
  const found = primitive.getAttribute('TANGENT').getArray();
  const order = primitive.getIndices()?.getArray();
  const rows = Float32Array.from({ length: 4 * indices.length }, (_, at) => found[4 * (order ? order[at >> 2] : at >> 2) + (at & 3)]);
  return rows.map((x, at) => (at % 4 === 3 ? -x : x));
});
