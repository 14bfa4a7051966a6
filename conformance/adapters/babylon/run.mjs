import { NullEngine } from '@babylonjs/core/Engines/nullEngine.js';
import { Scene } from '@babylonjs/core/scene.js';
import { FBXFileLoader } from '@babylonjs/loaders/FBX/fbxFileLoader.js';
import { run, Skip } from '../../readers/case.mjs';

const engine = new NullEngine();

/** A file in FBX's text format, with normals and UVs per corner. Its v points up. */
function fbx({ positions, normals, uvs, indices }) {
  const list = (name, numbers) => `${name}: *${numbers.length} {\na: ${Array.from(numbers, (x) => (Object.is(x, -0) ? '-0' : x)).join(',')}\n}`;
  const perCorner = (array, width) => Array.from(indices, (index) => Array.from(array.subarray(width * index, width * index + width))).flat();
  const layer = (kind, name, numbers) => `${kind}: 0 {\nVersion: 101\nName: ""\nMappingInformationType: "ByPolygonVertex"\nReferenceInformationType: "Direct"\n${list(name, numbers)}\n}`;
  const corners = Array.from(indices, (index, at) => (at % 3 === 2 ? -index - 1 : index));
  return [
    '; FBX 7.4.0 project file',
    'FBXHeaderExtension: {\nFBXHeaderVersion: 1003\nFBXVersion: 7400\n}',
    'Objects: {',
    'Geometry: 1, "Geometry::case", "Mesh" {',
    list('Vertices', positions),
    list('PolygonVertexIndex', corners),
    layer('LayerElementNormal', 'Normals', perCorner(normals, 3)),
    layer('LayerElementUV', 'UV', perCorner(uvs, 2)),
    '}',
    'Model: 2, "Model::case", "Mesh" {\nVersion: 232\n}',
    '}',
    'Connections: {\nC: "OO",2,0\nC: "OO",1,2\n}\n',
  ].join('\n');
}

await run(async (mesh) => {
  const { positions, normals, uvs, faces, indices, threshold } = mesh;
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  if (indices.length === 0) throw new Skip('no meshes without triangles');
  if (![positions, normals, uvs].every((array) => array.every(Number.isFinite))) throw new Skip('finite numbers only');
  const scene = new Scene(engine);
  try {
    await new FBXFileLoader().importMeshAsync('', scene, fbx(mesh), '');
    const loaded = scene.meshes.find((node) => node.getTotalVertices() > 0);
    const [tangents, order] = [loaded.getVerticesData('tangent'), loaded.getIndices()];
    if (order.length !== indices.length) throw new Error(`the loaded mesh has ${order.length} corners`);
    return { tangents: Float32Array.from(tangents), indices: order };
  } finally {
    scene.dispose();
  }
});
