// glTF and GLB.

import { LoadingManager, Mesh, type Object3D, type Texture } from 'three';
import { type GLTF, GLTFLoader, type GLTFLoaderPlugin, type GLTFParser } from 'three/addons/loaders/GLTFLoader.js';

import { counted } from '../plural';
import { TANGENT_TARGETS } from '../scene/morph-and-skin';
import { call } from '../worker/client';
import type { Bundle } from './file-bundle';

/** What a .gltf or .glb shows, and all of it as one GLB. */
export interface Gltf {
  scene: Object3D;
  bytes: Uint8Array<ArrayBuffer>;
  /** What is odd but not an error, as sentences. */
  warnings: string[];
}

const KTX2 = 'KHR_texture_basisu';

/**
 * In place of a decoder of KTX 2, which would be larger than all else of the page: the textures that stand in for them where there are
 * some, else none, of which `told` is told.
 */
function withoutKtx2({ json }: GLTFParser, told: () => void): GLTFLoaderPlugin {
  const loadTexture = (index: number) => {
    const { source, extensions } = json.textures[index];
    if (!extensions?.[KTX2] || source !== undefined) return null;
    told();
    return Promise.resolve(null) as unknown as Promise<Texture>;
  };
  return { name: KTX2, loadTexture };
}

/** Leaves with geometries what morph targets do to tangents. */
async function keepTangentTargets({ scene, parser }: GLTF): Promise<void> {
  const meshes: Mesh[] = [];
  scene.traverse((object) => object instanceof Mesh && meshes.push(object));
  for (const mesh of meshes) {
    const { meshes: index, primitives = 0 } = parser.associations.get(mesh) ?? {};
    const targets: Record<string, number>[] = parser.json.meshes?.[index!]?.primitives[primitives].targets ?? [];
    const read = targets.map(({ TANGENT }) => (TANGENT === undefined ? undefined : parser.getDependency('accessor', TANGENT)));
    mesh.geometry.userData[TANGENT_TARGETS] = await Promise.all(read);
  }
}

/** Opens a .gltf or .glb. Errors: a sentence for people. */
export async function openGltf(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: Bundle): Promise<Gltf> {
  const whole = (await call('whole', name, bytes, bundle)).bytes;
  // What the file refers to and was not given is not looked for elsewhere.
  const manager = new LoadingManager().setURLModifier((url) => (/^(data|blob):/.test(url) ? url : 'data:,'));
  let lost = 0;
  manager.onError = () => lost++;
  let ktx2 = 0;
  const loader = new GLTFLoader(manager).register((parser) => withoutKtx2(parser, () => ktx2++));
  try {
    const gltf = await loader.parseAsync(whole.buffer, '');
    await keepTangentTargets(gltf);
    const warnings = [];
    if (ktx2) warnings.push(`${counted(ktx2, 'texture in KTX 2 is', 'textures in KTX 2 are')} left out, as this page has no decoder for it`);
    if (lost) warnings.push(`${counted(lost, 'texture', 'textures')} missing or not decodable`);
    if (hasMoreJoints(gltf.scene)) warnings.push('vertices have more than 4 joints, of which the first 4 move them');
    return { scene: gltf.scene, bytes: whole, warnings };
  } catch (error) {
    throw new Error(`${name} cannot be shown: ${error instanceof Error ? error.message : error}.`, { cause: error });
  }
}

/** Whether there are joints that three.js does not use. */
function hasMoreJoints(scene: Object3D): boolean {
  let found = false;
  scene.traverse((object) => (found ||= object instanceof Mesh && object.geometry.hasAttribute('joints_1')));
  return found;
}
