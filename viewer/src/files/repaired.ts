// The model with new tangents, as a GLB.

import { Mesh, MeshStandardMaterial, type BufferGeometry, type Material, type Object3D, type Texture } from 'three';
import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';

import { call } from '../surface/thread';
import type { Outcome, Summary } from './engine';
import type { Model } from './model';

/** Tangents are written into the file that was opened, of which all else stays; an OBJ becomes a GLB first. */
export async function repairedGlb({ name, scene, bytes }: Model): Promise<Outcome<Summary>> {
  return call('repair', name, bytes ?? (await exported(scene)));
}

async function exported(scene: Object3D): Promise<Uint8Array<ArrayBuffer>> {
  const upright = scene.clone();
  upright.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    object.geometry = vDown(object.geometry);
    object.material = Array.isArray(object.material) ? object.material.map(imagesAsTheyAre) : imagesAsTheyAre(object.material);
  });
  return new Uint8Array((await new GLTFExporter().parseAsync(upright, { binary: true })) as ArrayBuffer);
}

/** glTF's v runs down. The exporter would turn the images over instead, and with them what green means. */
function vDown(geometry: BufferGeometry): BufferGeometry {
  const copy = geometry.clone();
  const uvs = copy.getAttribute('uv');
  for (let at = 0; at < (uvs?.count ?? 0); at++) uvs.setY(at, 1 - uvs.getY(at));
  return copy;
}

function imagesAsTheyAre(material: Material): Material {
  if (!(material instanceof MeshStandardMaterial)) return material;
  const copy = material.clone();
  copy.map &&= notTurned(copy.map);
  copy.normalMap &&= notTurned(copy.normalMap);
  return copy;
}

function notTurned(texture: Texture): Texture {
  const copy = texture.clone();
  copy.flipY = false;
  return copy;
}
