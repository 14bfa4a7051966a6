// `darboux/bake`: maps of a low-poly model from the detail of high-poly ones. It has a WebAssembly module of its own.

import { checkIndices, checkType, choice, optionsOf, rowCount } from './core/checks.js';
import { checkedMesh, writeArrays, writeMesh, writeTexts, type Copy } from './core/mesh.js';
import { load, type Exports } from './core/wasm-module.js';
import type { Convention, Indices } from './types.js';
import simd from './wasm/bake.simd.wasm';

/** The functions of the module; bindings/js/src/bake.rs and bake_meshes.rs document them. */
interface BakeExports extends Exports {
  begin_bake(): void;
  model_bytes(bytes: number): number;
  bake_options(bytes: number): number;
  bake_models(): number;
  low_tangents(corners: number): number;
  cage_positions(vertices: number): number;
  high_positions(vertices: number): number;
  high_normals(vertices: number): number;
  high_indices(corners: number): number;
  bake_meshes(): number;
  json_length(): number;
  baked_image(kind: number): number;
  baked_states(): number;
}

/** A kind of image. `darboux bake --help` says what each is. */
export type MapKind = (typeof KINDS)[number][0];

/** The kinds in the order of their numbers in WebAssembly: names of images, and floats per texel. */
const KINDS = [
  ['normal', 'normal', 3],
  ['object-normal', 'objectNormal', 3],
  ['height', 'height', 1],
  ['ao', 'ao', 1],
  ['position', 'position', 3],
  ['bent-normal', 'bentNormal', 3],
  ['object-bent-normal', 'objectBentNormal', 3],
  ['thickness', 'thickness', 1],
  ['curvature', 'curvature', 1],
  ['id', 'id', 3],
  ['vertex-color', 'vertexColor', 4],
  ['base-color', 'baseColor', 3],
  ['opacity', 'opacity', 1],
  ['roughness', 'roughness', 1],
  ['metalness', 'metalness', 1],
  ['emission', 'emission', 3],
  ['texture', 'texture', 4],
  ['world-direction', 'worldDirection', 3],
  ['uv-islands', 'uvIslands', 3],
  ['wireframe', 'wireframe', 1],
] as const satisfies (readonly [string, keyof BakedImages, number])[];

const FALLOFFS = ['none', 'linear', 'quadratic'] as const;
const WEIGHTS = ['cosine', 'uniform'] as const;
const ID_SOURCES = ['material', 'mesh', 'part', 'vertex-color'] as const;

/** A mesh of triangles that receives the detail. */
export interface LowMesh {
  /** 3 per vertex. */
  positions: Float32Array;
  /** 3 per vertex. They should have unit length. */
  normals: Float32Array;
  /** 2 per vertex. */
  uvs: Float32Array;
  /** The vertex of each corner. Without indices, the corners are the vertices in order. */
  indices?: Indices | null;
  /** 4 per corner, as `generateTangents` returns them, which is the default. The sign w in a glTF file's TANGENT is the opposite of theirs: negate it first. */
  tangents?: Float32Array | null;
  /** Rays begin on the mesh with its vertices moved to these positions, 3 per vertex, in place of the inflated copy. */
  cage?: Float32Array | null;
}

/** A mesh of triangles that has the detail. */
export interface HighMesh {
  /** 3 per vertex. */
  positions: Float32Array;
  /** 3 per vertex. Without normals, every triangle is flat. */
  normals?: Float32Array | null;
  /** The vertex of each corner, counter-clockwise as seen from the front. Without indices, the corners are the vertices in order. */
  indices?: Indices | null;
}

/** Options of {@link bake}. */
export interface BakeOptions {
  /** Width and height in texels. Default: [1024, 1024]. */
  size?: readonly [number, number] | null;
  /** Rays begin on a copy of the low model, inflated by this distance, and end as far inside. Default: 2 % of the model's diagonal. */
  cageOffset?: number | null;
  /** In place of a cage: how far outside rays begin along the normals, and how far inside they end, in units of the positions. */
  distance?: readonly [number, number] | null;
  /** The images that are made; they share rays. Default: ['normal']. */
  maps?: readonly MapKind[] | null;
  /** Samples per texel and axis, 1 to 16. Default: 1. */
  samples?: number | null;
  /** How the renderer rebuilds the bitangent. Default: 'pixel'. */
  bitangent?: 'pixel' | 'vertex' | null;
  /** The convention of the maps. Default: 'gltf'. */
  convention?: Convention | null;
  /** How far texels outside the charts are filled, in texels. Default: all are. */
  padding?: number | null;
  /** Whether rays also hit triangles from behind. Default: false. */
  backFaces?: boolean | null;
  /** Rays of ambient occlusion per sample. Default: 64. */
  aoRays?: number | null;
  /** How far surfaces occlude each other. Default: any distance. */
  aoDistance?: number | null;
  /** How occlusion fades up to `aoDistance`. Default: 'none'. */
  aoFalloff?: (typeof FALLOFFS)[number] | null;
  /** How the directions of occlusion and bent normals are weighted. Default: 'cosine'. */
  aoWeights?: (typeof WEIGHTS)[number] | null;
  /** How far the other side is looked for by 'thickness'. Default: any distance. */
  thicknessDistance?: number | null;
  /** The radius of 'curvature', in `curvatureUnit`. Default: 4. */
  curvatureRadius?: number | null;
  /** Default: 'texels'. */
  curvatureUnit?: 'texels' | 'distance' | null;
  /** The direction of 'world-direction', along the axes of the meshes. Default: [0, 1, 0]. */
  worldDirection?: readonly [number, number, number] | null;
  /** The convention of the meshes, whose UVs and axes it describes. Default: 'gltf', which models are in. */
  meshConvention?: Convention | null;
  /** Called while the call runs, with the finished part from 0 to 1. */
  onProgress?: ((done: number) => void) | null;
}

/** Options of {@link bakeModels}. */
export interface BakeModelsOptions extends Omit<BakeOptions, 'meshConvention'> {
  /** The index of the only material of the low model that is baked. Default: all. */
  material?: number | null;
  /** The n of `TEXCOORD_n`. Default: the set that the normal map of each material uses. */
  uvSet?: number | null;
  /** 'name': the part `crate_low` is baked from `crate_high` and `crate_high_bolts` only. Default: 'nearest'. */
  match?: 'nearest' | 'name' | null;
  /** Whether the normal maps of the high models count. Default: true. */
  highMaps?: boolean | null;
  /** Whether parts of the high models are occluded by themselves only. Default: false. */
  aoOwnPart?: boolean | null;
  /** What the colours of 'id' stand for. Default: 'material'. */
  idFrom?: (typeof ID_SOURCES)[number] | null;
  /** The texture of the map 'texture': its place in the JSON of the high models' materials, such as 'occlusionTexture'. */
  texture?: string | null;
}

/** The images of a bake, the top row first; null where a kind was not chosen. */
export interface BakedImages {
  /** Unit normals in tangent space, 3 floats per texel, (0, 0, 1) in the background. A texel of 8 bits is 127.5 + 127.5 n, rounded. */
  normal: Float32Array<ArrayBuffer> | null;
  /** Unit normals along the axes of the convention, 3 floats per texel. */
  objectNormal: Float32Array<ArrayBuffer> | null;
  /** Distances along the rays, positive outside. */
  height: Float32Array<ArrayBuffer> | null;
  /** From 0, closed, to 1, open. */
  ao: Float32Array<ArrayBuffer> | null;
  /** Positions along the axes of the convention, 3 floats per texel. */
  position: Float32Array<ArrayBuffer> | null;
  /** The mean of the open directions in tangent space, 3 floats per texel. */
  bentNormal: Float32Array<ArrayBuffer> | null;
  /** The same along the axes of the convention, 3 floats per texel. */
  objectBentNormal: Float32Array<ArrayBuffer> | null;
  /** The mean distance to the other side. */
  thickness: Float32Array<ArrayBuffer> | null;
  /** The mean curvature times its radius: convex above 0, concave below. */
  curvature: Float32Array<ArrayBuffer> | null;
  /** A colour for each material, mesh or part, 3 floats per texel; `legends` says which. */
  id: Float32Array<ArrayBuffer> | null;
  /** Red, green, blue and alpha, 4 floats per texel. */
  vertexColor: Float32Array<ArrayBuffer> | null;
  /** Linear light, 3 floats per texel. */
  baseColor: Float32Array<ArrayBuffer> | null;
  /** From 0, transparent, to 1. */
  opacity: Float32Array<ArrayBuffer> | null;
  /** From 0 to 1. */
  roughness: Float32Array<ArrayBuffer> | null;
  /** From 0 to 1. */
  metalness: Float32Array<ArrayBuffer> | null;
  /** Linear light, 3 floats per texel. */
  emission: Float32Array<ArrayBuffer> | null;
  /** The texture of the option `texture`, 4 floats per texel. */
  texture: Float32Array<ArrayBuffer> | null;
  /** The direction of the option `worldDirection` in tangent space, 3 floats per texel. */
  worldDirection: Float32Array<ArrayBuffer> | null;
  /** A colour for each chart, 3 floats per texel. */
  uvIslands: Float32Array<ArrayBuffer> | null;
  /** 1 along the edges of the low mesh. */
  wireframe: Float32Array<ArrayBuffer> | null;
}

/** The result of {@link bake} and {@link bakeModels}. */
export interface BakedMaps extends BakedImages {
  /** Width and height in texels. */
  size: readonly [number, number];
  /** What is in each texel: a number of {@link TEXEL_STATES}. */
  states: Uint8Array<ArrayBuffer>;
  report: BakeReport;
  /** The diagonal of the box around the low model, in units of its positions. */
  diagonal: number;
  /** How far outside rays began and how far inside they ended. */
  distance: readonly [number, number];
  /** What was left out, one sentence each. */
  warnings: string[];
  /** What the colours of 'id' and 'uv-islands' stand for. */
  legends: Partial<Record<MapKind, LegendEntry[]>>;
}

/** A colour of a map, and what it stands for. */
export interface LegendEntry {
  /** The number of the material, mesh, part or chart. */
  id: number;
  /** Its name; null where it has none. */
  name: string | null;
  /** Red, green and blue from 0 to 255. */
  color: [number, number, number];
  texels: number;
}

/** The states of texels. 'missed': in a chart, but no ray hit; 'missedBehind': and rays met triangles from behind. Both are filled from around. */
export const TEXEL_STATES = ['outside', 'baked', 'extended', 'missed', 'missedBehind'] as const;

/** The counts of a bake. A texel counts where at least one of its samples does. */
export interface BakeReport {
  texels: number;
  /** Texels that the charts cover. */
  chartedTexels: number;
  /** Charted texels without any hit. */
  missedTexels: number;
  /** Those of the missed texels whose rays met triangles from behind. */
  backFacingTexels: number;
  /** Texels that more than one triangle covers. The first triangle owns them. */
  overlappingTexels: number;
  /** The area of all charts in texels; greater than `chartedTexels` where charts overlap or repeat. */
  chartArea: number;
  /** Texels at which the normal of the high model points to the back of its triangle. */
  invertedTexels: number;
  /** Texels at which the frame of the low model does not span space. */
  framelessTexels: number;
  /** Texels whose normal points below the low surface. */
  belowHorizonTexels: number;
  rays: number;
  lowTriangles: number;
  /** Triangles of the low model without an area in the image. They are not baked. */
  degenerateTriangles: number;
  /** Triangles of the low model across more than 16 tiles of UVs. They are not baked. */
  oversizedTriangles: number;
  /** Triangles of the low model with positions or normals that are not finite. They are not baked. */
  nonFiniteLowTriangles: number;
  highTriangles: number;
  /** Triangles of the high models with positions that are not finite. No ray hits them. */
  nonFiniteTriangles: number;
}

/** What the module reports: counts by their names in Rust, or a sentence. */
interface Outcome {
  report?: Pick<BakedMaps, 'diagonal' | 'distance' | 'warnings' | 'legends'> & { counts: Record<string, number> };
  error?: string;
}

/** The receiver of the running call's progress. */
let tell: ((done: number) => void) | null | undefined;

const bakeModule = load<BakeExports>(
  simd,
  () => import('./bake.scalar.js'),
  { progress: (done, total) => tell?.(done! / total!) },
  'the models and maps need more memory than WebAssembly can have; choose a smaller size, fewer maps, or high models with fewer triangles',
);

/** Resolves when the other functions can be called. */
export const ready: Promise<void> = bakeModule.ready;

/**
 * Bakes the detail of a high mesh into images over the UVs of a low mesh, as {@link bakeModels} does with files.
 *
 * @param low Arrays that fit together. Indices are of 8, 16 or 32 bits.
 * @param high The same.
 * @param options May be left out, undefined or null, and so may each option.
 * @throws TypeError for an array of another type. RangeError for lengths that do not fit together, for an unknown choice, for numbers that cannot be
 * read, and where WebAssembly has not enough memory. Error for an index out of range, meshes without triangles, and options out of range.
 */
export function bake(low: LowMesh, high: HighMesh, options?: BakeOptions | null): BakedMaps {
  checkType('low', low, ['Object']);
  checkType('high', high, ['Object']);
  const chosen = optionsOf(options);
  const text = optionsText({ ...chosen, material: null, uvSet: null, match: null, highMaps: null }, chosen.meshConvention);
  const { positions, normals, uvs, indices, tangents, cage } = low;
  const mesh = checkedMesh(positions, [['normals', normals, 3], ['uvs', uvs, 2]], indices, 3);
  const corners = tangents ? rowCount('low.tangents', tangents, 4) : 0;
  const places = cage ? rowCount('low.cage', cage, 3) : 0;
  const highRows = { positions: rowCount('high.positions', high.positions, 3), normals: high.normals ? rowCount('high.normals', high.normals, 3) : 0 };
  if (high.indices) checkIndices(high.indices, 'high.indices');
  return call(chosen, (exports) => {
    writeMesh(exports, mesh);
    const floats: Copy<Float32Array>[] = [[high.positions, exports.high_positions(highRows.positions)]];
    if (tangents) floats.push([tangents, exports.low_tangents(corners)]);
    if (cage) floats.push([cage, exports.cage_positions(places)]);
    if (high.normals) floats.push([high.normals, exports.high_normals(highRows.normals)]);
    const integers: Copy<Indices>[] = high.indices ? [[high.indices, exports.high_indices(high.indices.length)]] : [];
    writeArrays(exports, floats, integers);
    writeTexts(exports, [text], exports.bake_options);
    return exports.bake_meshes();
  });
}

/**
 * Bakes the detail of high models into images over the UVs of a low model, as `darboux bake` does, with the same bits.
 *
 * From every texel that a triangle of the low model covers, a ray passes from outside through it; the first triangle of a high model that it hits
 * gives the content. Normals are in the frames of the tangents that the low model has, or else of MikkTSpace's. The call does not return before all
 * is done: run it in a worker, which a page can end.
 *
 * @param low The bytes of a GLB, or of a glTF whose buffers and images are embedded. Draco and meshopt compression is decoded.
 * @param high The same of one high model, or of several.
 * @throws TypeError for another type. RangeError for an unknown choice, for numbers that cannot be read, and where WebAssembly has not enough memory. Error for a file that
 * cannot be read, a model without normals, UVs or triangles, and numbers out of range.
 */
export function bakeModels(low: Uint8Array, high: Uint8Array | readonly Uint8Array[], options?: BakeModelsOptions | null): BakedMaps {
  const files = [low, ...(Array.isArray(high) ? (high as readonly Uint8Array[]) : [high as Uint8Array])];
  if (files.length === 1) throw new RangeError('high is empty; give at least one model');
  files.forEach((file, at) => checkType(at ? 'high' : 'low', file, ['Uint8Array']));
  const chosen = optionsOf(options);
  const text = optionsText(chosen);
  return call(chosen, (exports) => {
    for (const file of files) writeBytes(exports, file);
    writeTexts(exports, [text], exports.bake_options);
    return exports.bake_models();
  });
}

/** Calls the module. `run` writes the models and the options, and returns the address of the outcome. Errors: the module's sentence. */
function call(chosen: BakeOptions, run: (exports: BakeExports) => number): BakedMaps {
  tell = chosen.onProgress;
  return bakeModule.call((exports) => {
    exports.begin_bake();
    const { report, error } = readJson<Outcome>(exports, run(exports));
    if (!report) throw new Error(error);
    const { counts, diagonal, distance, warnings, legends } = report;
    const size = sizeOf(chosen);
    return { ...images(exports, size), size, states: states(exports, size), report: camelCased(counts), diagonal, distance, warnings, legends };
  });
}

function sizeOf({ size }: BakeOptions): readonly [number, number] {
  return size ?? [1024, 1024];
}

/** Errors: a value that is not an array of two. */
function checkPair(name: string, pair: readonly [number, number] | null | undefined): void {
  if (pair == null) return;
  checkType(name, pair, ['Array']);
  if (pair.length !== 2) throw new RangeError(`${name} has ${(pair as readonly number[]).length} elements; it must have 2`);
}

/** The options as the JSON that the module reads. Errors: numbers that JSON or the module does not have. */
function optionsText(options: BakeModelsOptions, meshConvention?: Convention | null): string {
  const { cageOffset, distance, maps, samples, padding, material, uvSet, aoRays, aoDistance } = options;
  checkPair('size', options.size);
  checkPair('distance', distance);
  if (maps != null) checkType('maps', maps, ['Array']);
  const whole = { width: sizeOf(options)[0], height: sizeOf(options)[1], samples: samples ?? 1, padding, material, uvSet, aoRays: aoRays ?? 64 };
  for (const [name, value] of Object.entries(whole)) {
    if (value != null && !(Number.isInteger(value) && value >= 0 && value < 2 ** 32)) throw new RangeError(`${name} is ${value}; it must be a whole number from 0 on`);
  }
  const [x, y, z] = options.worldDirection ?? [0, 1, 0];
  const { thicknessDistance, curvatureRadius } = options;
  const lengths = { cageOffset, aoDistance, thicknessDistance, curvatureRadius, 'worldDirection[0]': x, 'worldDirection[1]': y, 'worldDirection[2]': z, 'the first distance': distance?.[0], 'the second distance': distance?.[1] };
  for (const [name, value] of Object.entries(lengths)) {
    if (value != null && !Number.isFinite(value)) throw new RangeError(`${name} is ${value}; it must be a finite number`);
  }
  return JSON.stringify({
    size: sizeOf(options),
    cageOffset: cageOffset ?? null,
    distance: distance ?? null,
    maps: (maps ?? ['normal']).map((kind) => choice('maps', kind, KINDS.map(([kind]) => kind))),
    samples: whole.samples,
    isPerVertex: choice('bitangent', options.bitangent, ['pixel', 'vertex'], 'pixel') === 1,
    convention: options.convention ?? 'gltf',
    meshConvention: meshConvention ?? 'gltf',
    padding: padding ?? null,
    backFaces: Boolean(options.backFaces),
    material: material ?? null,
    uvSet: uvSet ?? null,
    matchesNames: choice('match', options.match, ['nearest', 'name'], 'nearest') === 1,
    highMaps: options.highMaps ?? true,
    aoRays: whole.aoRays,
    aoDistance: aoDistance ?? null,
    aoFalloff: FALLOFFS[choice('aoFalloff', options.aoFalloff, FALLOFFS, 'none')],
    aoWeights: WEIGHTS[choice('aoWeights', options.aoWeights, WEIGHTS, 'cosine')],
    ownPartOnly: Boolean(options.aoOwnPart),
    thicknessDistance: options.thicknessDistance ?? null,
    curvatureRadius: options.curvatureRadius ?? 4,
    isCurvatureInTexels: choice('curvatureUnit', options.curvatureUnit, ['texels', 'distance'], 'texels') === 0,
    idFrom: ID_SOURCES[choice('idFrom', options.idFrom, ID_SOURCES, 'material')],
    worldDirection: options.worldDirection ?? [0, 1, 0],
    texture: options.texture ?? null,
  });
}

function images(exports: BakeExports, [width, height]: readonly [number, number]): BakedImages {
  const entries = KINDS.map(([, name, channels], kind) => {
    const address = exports.baked_image(kind) >>> 0;
    return [name, address ? new Float32Array(exports.memory.buffer, address, width * height * channels).slice() : null];
  });
  return Object.fromEntries(entries) as BakedImages;
}

function states(exports: BakeExports, [width, height]: readonly [number, number]): Uint8Array<ArrayBuffer> {
  return new Uint8Array(exports.memory.buffer, exports.baked_states() >>> 0, width * height).slice();
}

/** Counts with their names in JavaScript. */
function camelCased(counts: Record<string, number>): BakeReport {
  const named = Object.entries(counts).map(([name, count]) => [name.replaceAll(/_(.)/g, (_, letter: string) => letter.toUpperCase()), count]);
  return Object.fromEntries(named) as BakeReport;
}

function writeBytes(exports: BakeExports, bytes: Uint8Array): void {
  const address = exports.model_bytes(bytes.length) >>> 0;
  new Uint8Array(exports.memory.buffer, address, bytes.length).set(bytes);
}

function readJson<T>(exports: BakeExports, address: number): T {
  const bytes = new Uint8Array(exports.memory.buffer, address >>> 0, exports.json_length() >>> 0);
  return JSON.parse(new TextDecoder().decode(bytes)) as T;
}
