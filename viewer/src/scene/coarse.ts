// A coarse copy of a large model, which is drawn before its tangents are computed and while the camera moves: vertices in one cell of a grid
// become one vertex (Rossignac and Borrel, "Multi-resolution 3D approximations for rendering complex scenes", 1993).

import { type Box3, BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshLambertMaterial, Vector3 } from 'three';

import { placesOf, type Part } from './model-parts';

/** The cells along the longest side of the model's box. */
const CELLS = 48;

/** Makes the coarse copy. `box` contains all positions that are finite. */
export function coarseCopy(parts: Part[], box: Box3): Mesh {
  const size = box.getSize(new Vector3());
  const scale = CELLS / (Math.max(size.x, size.y, size.z) || 1);
  // One cell more takes the positions at the far sides of the box.
  const vertexOfCell = new Int32Array((CELLS + 1) ** 3).fill(-1);
  const [positions, indices]: [number[], number[]] = [[], []];
  const point = new Vector3();
  for (const part of parts) {
    const { surface } = part;
    const coarse = new Int32Array(surface.positions.length / 3);
    for (const place of placesOf(part)) {
      for (let vertex = 0; vertex < coarse.length; vertex++) {
        point.fromArray(surface.positions, vertex * 3).applyMatrix4(place);
        const [x, y, z] = [point.x - box.min.x, point.y - box.min.y, point.z - box.min.z].map((along) => Math.floor(along * scale));
        const cell = x + (CELLS + 1) * (y + (CELLS + 1) * z);
        // A position that is not finite, or is beyond the box by rounding, has no vertex.
        if (!(cell >= 0 && cell < vertexOfCell.length)) coarse[vertex] = -1;
        else {
          if (vertexOfCell[cell] < 0) vertexOfCell[cell] = positions.push(point.x, point.y, point.z) / 3 - 1;
          coarse[vertex] = vertexOfCell[cell];
        }
      }
      for (let corner = 0; corner < surface.indices.length; corner += 3) {
        const [a, b, c] = [coarse[surface.indices[corner]], coarse[surface.indices[corner + 1]], coarse[surface.indices[corner + 2]]];
        if (a >= 0 && b >= 0 && c >= 0 && a !== b && b !== c && c !== a) indices.push(a, b, c);
      }
    }
  }
  const geometry = new BufferGeometry().setAttribute('position', new BufferAttribute(Float32Array.from(positions), 3));
  geometry.setIndex(new BufferAttribute(Uint32Array.from(indices), 1));
  return new Mesh(geometry, new MeshLambertMaterial({ side: DoubleSide, flatShading: true }));
}
