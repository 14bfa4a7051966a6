// OBJ, with materials and textures where they were given.

import { LoadingManager, Mesh, MeshPhongMaterial, MeshStandardMaterial, type Material, type Object3D } from 'three';
import { MTLLoader } from 'three/addons/loaders/MTLLoader.js';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';

import { located, type Bundle } from './bundle';

/** Opens an OBJ. Errors: a sentence for people. */
export async function openObj(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Object3D> {
  const text = new TextDecoder().decode(bytes);
  if (!/^\s*(v|f)\s/m.test(text)) throw new Error(`${name} has no vertices and faces as an OBJ has them; export it again.`);
  const loader = new OBJLoader();
  const library = /^\s*mtllib\s+(.+?)\s*$/m.exec(text)?.[1];
  const materials = library && bundle.get(located(library, name) ?? '');
  const manager = managerOf(bundle, name);
  const loaded = new Promise<void>((resolve) => (manager.onLoad = resolve));
  // Holds back the end of loading until all textures have begun, of which there may be none.
  manager.itemStart(name);
  if (materials) loader.setMaterials(new MTLLoader(manager).parse(await materials.text(), ''));
  const scene = loader.parse(text);
  manager.itemEnd(name);
  await loaded;
  scene.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    object.material = Array.isArray(object.material) ? object.material.map(standard) : standard(object.material);
  });
  return scene;
}

/** Textures are read from the bundle. What is not there stays away. */
function managerOf(bundle: Bundle, name: string): LoadingManager {
  return new LoadingManager().setURLModifier((uri) => {
    const file = bundle.get(located(uri, name) ?? '');
    return file ? URL.createObjectURL(file) : 'data:,';
  });
}

/** The kind of material that has normal maps as glTF's. */
function standard(material: Material): MeshStandardMaterial {
  const out = new MeshStandardMaterial({ name: material.name, side: material.side, roughness: 0.6 });
  if (!(material instanceof MeshPhongMaterial)) return out;
  out.color.copy(material.color);
  out.map = material.map;
  out.normalMap = material.normalMap;
  return out;
}
