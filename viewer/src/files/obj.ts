// OBJ, with materials and textures where they were given.

import { LoadingManager, Mesh, MeshPhongMaterial, MeshStandardMaterial, type Material, type Object3D, type Texture } from 'three';
import { MTLLoader } from 'three/addons/loaders/MTLLoader.js';
import { OBJLoader } from 'three/addons/loaders/OBJLoader.js';

import { counted } from '../plural';
import { isColored } from './image-colours';
import { located, type Bundle } from './file-bundle';

/** What an OBJ shows. */
export interface Obj {
  scene: Object3D;
  /** What is odd but not an error, as sentences. */
  warnings: string[];
}

/** Opens an OBJ. Errors: a sentence for people. */
export async function openObj(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Obj> {
  const text = new TextDecoder().decode(bytes);
  if (!/^\s*(v|f)\s/m.test(text)) throw new Error(`${name} has no vertices and faces as an OBJ has them; export it again.`);
  const loader = new OBJLoader();
  const manager = managerOf(bundle, name);
  const loaded = new Promise<void>((resolve) => (manager.onLoad = resolve));
  let lost = 0;
  manager.onError = () => lost++;
  // Holds back the end of loading until all textures have begun, of which there may be none.
  manager.itemStart(name);
  const lines = Array.from(text.matchAll(/^\s*mtllib\s+(.+?)\s*$/gm), ([, line]) => line);
  const libraries = new Set(lines.flatMap((line) => librariesOf(line, name, bundle)));
  const { creators, missing } = await creatorsOf([...libraries], name, bundle, manager);
  loader.setMaterials({ create: (material: string) => creators.find(({ materialsInfo }) => Object.hasOwn(materialsInfo, material))?.create(material) } as MaterialCreator);
  const scene = loader.parse(text);
  manager.itemEnd(name);
  await loaded;
  const heights = new Set<string>();
  const standardOf = (material: Material) => standard(material, () => heights.add(material.name));
  scene.traverse((object) => {
    if (!(object instanceof Mesh)) return;
    object.material = Array.isArray(object.material) ? object.material.map(standardOf) : standardOf(object.material);
  });
  const warnings = missing.map((library) => `${library} was not given, and its materials are missing`);
  if (lost) warnings.push(`${counted(lost, 'texture', 'textures')} missing or not decodable`);
  for (const material of heights) warnings.push(`the bump map of ${material} is grey, so it holds heights, which are not shown; normal maps are coloured`);
  return { scene, warnings };
}

type MaterialCreator = MTLLoader.MaterialCreator;

/** The libraries of a line: one whose name may have spaces, or several. */
function librariesOf(line: string, name: string, bundle: Bundle): string[] {
  const isGiven = (library: string) => bundle.has(located(library, name) ?? '');
  const words = line.split(/\s+/);
  return !isGiven(line) && words.some(isGiven) ? words : [line];
}

/** The material libraries that were given, and the names of those that were not. */
async function creatorsOf(libraries: string[], name: string, bundle: Bundle, manager: LoadingManager) {
  const [creators, missing]: [MaterialCreator[], string[]] = [[], []];
  for (const library of libraries) {
    const file = bundle.get(located(library, name) ?? '');
    // Textures lie where their library lies.
    if (file) creators.push(new MTLLoader(manager).parse(await file.text(), library.replace(/[^/\\]*$/, '')));
    else missing.push(library);
  }
  return { creators, missing };
}

/** Textures are read from the bundle. What is not there stays away. */
function managerOf(bundle: Bundle, name: string): LoadingManager {
  return new LoadingManager().setURLModifier((uri) => {
    const file = bundle.get(located(uri, name) ?? '');
    return file ? URL.createObjectURL(file) : 'data:,';
  });
}

/** Without its image a texture could be neither drawn nor saved. */
function loadedOf(texture: Texture | null): Texture | null {
  return texture?.image ? texture : null;
}

/** The kind of material that has normal maps as glTF's. `tellOfHeights`: told of a bump map that is none. */
function standard(material: Material, tellOfHeights: () => void): MeshStandardMaterial {
  const out = new MeshStandardMaterial({ name: material.name, side: material.side, roughness: 0.6 });
  if (!(material instanceof MeshPhongMaterial)) return out;
  out.color.copy(material.color);
  out.map = loadedOf(material.map);
  out.normalMap = loadedOf(material.normalMap);
  const bump = loadedOf(material.bumpMap);
  if (out.normalMap || !bump) return out;
  // OBJ has a place for heights alone, and many programs write normal maps there.
  if (isColored(bump.image as CanvasImageSource)) out.normalMap = bump;
  else tellOfHeights();
  return out;
}
