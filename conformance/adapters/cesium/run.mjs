import { ComponentDatatype, Geometry, GeometryAttribute, GeometryPipeline, PrimitiveType } from '@cesium/engine';
import { run, Skip } from '../../readers/case.mjs';

await run(({ positions, normals, uvs, faces, indices, threshold }) => {
  if (faces.some((size) => size !== 3)) throw new Skip('triangles only');
  if (threshold !== 180) throw new Skip('no angular threshold');
  if (indices.length === 0) throw new Skip('no meshes without triangles');
  const attribute = (values, componentsPerAttribute) => new GeometryAttribute({ componentDatatype: ComponentDatatype.FLOAT, componentsPerAttribute, values });
  const geometry = new Geometry({
    attributes: { position: attribute(positions, 3), normal: attribute(normals, 3), st: attribute(uvs, 2) },
    indices,
    primitiveType: PrimitiveType.TRIANGLES,
  });
  try {
    GeometryPipeline.computeTangentAndBitangent(geometry);
  } catch (error) {
    console.error(`Cesium: ${error}`);
    return new Float32Array(4 * indices.length).fill(NaN);
  }
  const { tangent, bitangent } = geometry.attributes;
  const tangents = new Float32Array((positions.length / 3) * 4);
  for (let v = 0; v < tangents.length / 4; v++) {
    const [n, t, b] = [normals, tangent.values, bitangent.values].map((array) => array.slice(3 * v, 3 * v + 3));
    // Cesium keeps a bitangent instead of a sign.
    const sign = b[0] * (n[1] * t[2] - n[2] * t[1]) + b[1] * (n[2] * t[0] - n[0] * t[2]) + b[2] * (n[0] * t[1] - n[1] * t[0]);
    tangents.set([...t, sign < 0 ? -1 : 1], 4 * v);
  }
  return { tangents, indices };
});
