// The parts of a model: its meshes, one material each.

import { Mesh, MeshStandardMaterial, type BufferAttribute, type BufferGeometry, type InterleavedBufferAttribute, type Matrix4, type Object3D } from 'three';

import type { GivenSurface } from '../surface/surface';

type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** A mesh of the model. It is shown as its file stores it, without skin and morph targets, at its node's place. */
export interface Part {
  name: string;
  geometry: BufferGeometry;
  material: MeshStandardMaterial;
  /** Which UVs the normal map is laid by: the attribute's name. */
  uvName: string;
  place: Matrix4;
  surface: GivenSurface;
  /** Whether three.js turned the normal map's green channel because it found no tangents. */
  isGreenTurned: boolean;
}

/** The parts of a model, those first that the scene has first. Errors: there is none. */
export function partsOf(scene: Object3D, kind: 'gltf' | 'obj'): Part[] {
  scene.updateMatrixWorld(true);
  const parts: Part[] = [];
  scene.traverse((object) => {
    if (object instanceof Mesh && object.geometry.getAttribute('position')?.count) parts.push(...partsOfMesh(object, kind));
  });
  if (!parts.length) throw new Error('The model has no triangles to show.');
  return parts;
}

function partsOfMesh(mesh: Mesh, kind: 'gltf' | 'obj'): Part[] {
  const materials = [mesh.material].flat();
  const geometry = mesh.geometry as BufferGeometry;
  const count = geometry.index?.count ?? geometry.getAttribute('position').count;
  const ranges = materials.length > 1 ? geometry.groups : [{ start: 0, count, materialIndex: 0 }];
  return ranges.map(({ start, count, materialIndex }, at) => {
    const found = materials[materialIndex ?? 0];
    const material = found instanceof MeshStandardMaterial ? found : new MeshStandardMaterial({ roughness: 0.6 });
    const channel = material.normalMap?.channel ?? 0;
    const uvName = channel ? `uv${channel}` : 'uv';
    const surface = surfaceOf(geometry, uvName, start, count, kind === 'gltf');
    const name = [mesh.name || 'mesh', ranges.length > 1 && (material.name || at + 1)].filter(Boolean).join(' / ');
    const isGreenTurned = kind === 'gltf' && !surface.tangents;
    return { name, geometry, material, uvName, place: mesh.matrixWorld, surface, isGreenTurned };
  });
}

function surfaceOf(geometry: BufferGeometry, uvName: string, start: number, count: number, vDown: boolean): GivenSurface {
  const floats = (name: string, width: number) => {
    const attribute = geometry.getAttribute(name) as Attribute | undefined;
    return attribute ? floatsOf(attribute, width) : null;
  };
  const list = geometry.index;
  const whole = count - (count % 3);
  const indices = Uint32Array.from({ length: whole }, (_, corner) => (list ? list.getX(start + corner) : start + corner));
  const positions = floats('position', 3)!;
  return { positions, normals: floats('normal', 3), uvs: floats(uvName, 2), tangents: floats('tangent', 4), indices, vDown };
}

/** The elements of an attribute as floats: dequantised, and out of interleaved arrays. Errors: three.js could not read it. */
export function floatsOf(attribute: Attribute, width: number): Float32Array<ArrayBuffer> {
  if (!Number.isInteger(attribute.count)) {
    throw new Error('The model cannot be shown: three.js does not read sparse data whose elements lie apart; the command darboux does.');
  }
  const out = new Float32Array(attribute.count * width);
  for (let at = 0; at < attribute.count; at++) {
    for (let i = 0; i < width; i++) out[at * width + i] = attribute.getComponent(at, i);
  }
  return out;
}

/** The square that holds the UV square and all UVs: its left, its bottom and its side. */
export function squareOf(parts: Part[]): [number, number, number] {
  let [left, bottom, right, top] = [0, 0, 1, 1];
  for (const { surface } of parts) {
    const uvs = surface.uvs ?? [];
    for (let at = 0; at < uvs.length; at += 2) {
      const [x, y] = [uvs[at], surface.vDown ? 1 - uvs[at + 1] : uvs[at + 1]];
      if (!Number.isFinite(x + y)) continue;
      [left, right, bottom, top] = [Math.min(left, x), Math.max(right, x), Math.min(bottom, y), Math.max(top, y)];
    }
  }
  return [left, bottom, Math.max(right - left, top - bottom)];
}
