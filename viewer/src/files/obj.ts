// Opens OBJ with three.js, with the materials and textures that are among the files.

import { LoadingManager, Mesh, MeshPhongMaterial, MeshStandardMaterial, type Material, type Object3D, type Texture } from 'three';
import { MTLLoader } from 'three/addons/loaders/MTLLoader.js';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';

import { counted } from '../plural';
import { index } from './indexing';
import { isColored } from './image-colours';
import { resolvePath, type FileBundle } from './file-bundle';
import { setExportedOrigins } from './origin';

/** An opened OBJ. */
export interface Obj {
  scene: Object3D;
  /** Faults that are not errors, one sentence each. */
  warnings: string[];
}

/** Opens an OBJ. Errors: one sentence to show. */
export async function openObj(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: FileBundle): Promise<Obj> {
  const text = new TextDecoder().decode(bytes);
  if (!/^\s*(v|f)\s/m.test(text)) throw new Error(`${name} has no vertices and faces of an OBJ; export it again.`);
  const loader = new OBJLoader();
  const manager = managerOf(bundle, name);
  const loaded = new Promise<void>((resolve) => (manager.onLoad = resolve));
  let lost = 0;
  manager.onError = () => lost++;
  // An item of its own keeps the manager from ending before all textures have started, and lets it end without any.
  manager.itemStart(name);
  const lines = Array.from(text.matchAll(/^\s*mtllib\s+(.+?)\s*$/gm), ([, line]) => line);
  const libraries = new Set(lines.flatMap((line) => librariesOf(line, name, bundle)));
  const { creators, missing } = await creatorsOf([...libraries], name, bundle, manager);
  loader.setMaterials({ create: (material: string) => creators.find(({ materialsInfo }) => Object.hasOwn(materialsInfo, material))?.create(material) } as MaterialCreator);
  const scene = loader.parse(text);
  manager.itemEnd(name);
  await loaded;
  const heights = new Set<string>();
  const standardOf = (material: Material) => standardMaterial(material, () => heights.add(material.name));
  scene.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    index(object.geometry);
    object.material = Array.isArray(object.material) ? object.material.map(standardOf) : standardOf(object.material);
  });
  setExportedOrigins(scene);
  const warnings = missing.map((library) => `${library} is not among the files, and its materials are missing`);
  if (!/^\s*vn\s/m.test(text)) warnings.push('the file has no normals, so every triangle is shown and saved flat');
  if (lost) warnings.push(`${counted(lost, 'texture', 'textures')} missing or not decodable`);
  for (const material of heights) warnings.push(`the bump map of ${material} is grey, so it is a height map, which is not shown`);
  return { scene, warnings };
}

type MaterialCreator = MTLLoader.MaterialCreator;

/** The material libraries of a line: one whose name may contain spaces, or several. */
function librariesOf(line: string, name: string, bundle: FileBundle): string[] {
  const isGiven = (library: string) => bundle.has(resolvePath(library, name) ?? '');
  const words = line.split(/\s+/);
  return !isGiven(line) && words.some(isGiven) ? words : [line];
}

/** The material libraries that are among the files, and the names of the missing ones. */
async function creatorsOf(libraries: string[], name: string, bundle: FileBundle, manager: LoadingManager) {
  const [creators, missing]: [MaterialCreator[], string[]] = [[], []];
  for (const library of libraries) {
    const file = bundle.get(resolvePath(library, name) ?? '');
    // Texture paths are relative to their library.
    if (file) creators.push(new MTLLoader(manager).parse(await file.text(), library.replace(/[^/\\]*$/, '')));
    else missing.push(library);
  }
  return { creators, missing };
}

/** Loads textures from the files. Nothing is fetched: missing files stay missing. */
function managerOf(bundle: FileBundle, name: string): LoadingManager {
  return new LoadingManager().setURLModifier((uri) => {
    const file = bundle.get(resolvePath(uri, name) ?? '');
    return file ? URL.createObjectURL(file) : 'data:,';
  });
}

/** A texture whose image was loaded, or null. */
function ifLoaded(texture: Texture | null): Texture | null {
  return texture?.image ? texture : null;
}

/** Converts a material to the type that glTF has. Calls `onHeightMap` for a bump map that is not a normal map. */
function standardMaterial(material: Material, onHeightMap: () => void): MeshStandardMaterial {
  const out = new MeshStandardMaterial({ name: material.name, side: material.side, roughness: 0.6 });
  if (!(material instanceof MeshPhongMaterial)) return out;
  out.color.copy(material.color);
  out.map = ifLoaded(material.map);
  out.normalMap = ifLoaded(material.normalMap);
  const bump = ifLoaded(material.bumpMap);
  if (out.normalMap || !bump) return out;
  // OBJ has a keyword for height maps only, and many programs write normal maps there.
  if (isColored(bump.image as CanvasImageSource)) out.normalMap = bump;
  else onHeightMap();
  return out;
}
