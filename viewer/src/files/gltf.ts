// Opens glTF and GLB with three.js, after the worker has made the file self-contained and has checked it.

import { type AnimationClip, type Camera, LoadingManager, Mesh, type Object3D } from 'three';
import { type GLTF, GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

import { counted } from '../plural';
import { TANGENT_TARGETS } from '../scene/morph-and-skin';
import { call } from '../worker/surfaces';
import type { FileBundle } from './file-bundle';
import type { Source } from './gltf-wasm';
import { withKtx2, type Ktx2Report, type Ktx2Textures } from './ktx2';
import { setOrigin } from './origin';
import { withPackedElements } from './packed-elements';

/** An opened .gltf or .glb. */
export interface Gltf {
  scene: Object3D;
  animations: AnimationClip[];
  cameras: Camera[];
  /** The model with everything that it refers to, as one file. */
  bytes: Uint8Array<ArrayBuffer>;
  /** Faults that are not errors, one sentence each. */
  warnings: string[];
  /** The words of the file; null for glTF. */
  source: Source | null;
}

/** The members of a primitive that are read here. */
interface JsonPrimitive {
  material?: number;
  targets?: Record<string, number>[];
}

/** Stores what three.js ignores: the origins of meshes, and the tangent offsets of morph targets. */
async function storeIgnored({ scene, parser }: GLTF): Promise<void> {
  const meshes: Mesh[] = [];
  scene.traverse((object) => object instanceof Mesh && meshes.push(object));
  for (const mesh of meshes) {
    const { meshes: index, primitives = 0 } = parser.associations.get(mesh) ?? {};
    const primitive: JsonPrimitive | undefined = parser.json.meshes?.[index!]?.primitives[primitives];
    if (primitive) setOrigin(mesh, { mesh: index!, primitive: primitives, material: primitive.material ?? null });
    const targets = primitive?.targets ?? [];
    const read = targets.map(({ TANGENT }) => (TANGENT === undefined ? undefined : parser.getDependency('accessor', TANGENT)));
    mesh.geometry.userData[TANGENT_TARGETS] = await Promise.all(read);
  }
}

/** Opens a .gltf or .glb, and what the worker makes a .glb of. Errors: one sentence to show. */
export async function openGltf(name: string, bytes: Uint8Array<ArrayBuffer>, bundle: FileBundle, textures: Ktx2Textures): Promise<Gltf> {
  const { bytes: file, description } = await call('check', name, bytes, bundle);
  // Nothing is fetched: missing files stay missing.
  const manager = new LoadingManager().setURLModifier((url) => (/^(data|blob):/.test(url) ? url : 'data:,'));
  let lost = 0;
  manager.onError = () => lost++;
  const ktx2: Ktx2Report = { lost: [], smaller: 0 };
  const loader = new GLTFLoader(manager).register((parser) => withKtx2(parser, textures, ktx2)).register(withPackedElements);
  try {
    const gltf = await loader.parseAsync(file.buffer, '');
    await storeIgnored(gltf);
    const warnings = [...description.warnings];
    if (ktx2.lost.length) warnings.push(`${counted(ktx2.lost.length, 'texture in KTX 2 is', 'textures in KTX 2 are')} left out: ${ktx2.lost[0].replace(/\.$/, '')}`);
    if (ktx2.smaller) warnings.push(`${counted(ktx2.smaller, 'texture in KTX 2 has', 'textures in KTX 2 have')} more than ${textures.largest} texels along a side, which the graphics card does not take, and ${ktx2.smaller > 1 ? 'are' : 'is'} shown with fewer`);
    if (lost) warnings.push(`${counted(lost, 'texture', 'textures')} missing or not decodable`);
    if (hasMoreJoints(gltf.scene)) warnings.push('vertices have more than 4 joints, and only the first 4 are used');
    return { scene: gltf.scene, animations: gltf.animations, cameras: gltf.cameras, bytes: file, warnings, source: description.source };
  } catch (error) {
    throw new Error(`${name} cannot be shown: ${error instanceof Error ? error.message : error}.`, { cause: error });
  }
}

/** Whether vertices have joints that three.js ignores. */
function hasMoreJoints(scene: Object3D): boolean {
  let found = false;
  scene.traverse((object) => (found ||= object instanceof Mesh && object.geometry.hasAttribute('joints_1')));
  return found;
}
