// `darboux/bake`: maps of a low-poly model from the detail of high-poly ones. It has a WebAssembly module of its own.

import { checkIndices, checkType, choice, optionsOf, rowCount, wholeRows } from './core/checks.js';
import { MAP_CHANNELS, MAP_KINDS } from './core/choices.js';
import { checkedMesh, readFloats, writeArrays, writeMesh, writeTexts, type Copy } from './core/mesh.js';
import { load, type Call, type Exports, type OwnInstance } from './core/wasm-module.js';
import { optionsOfScope, optionsText, sizeOf } from './bake-options.js';
import type {
  BakedImages,
  BakedMaps,
  BakeModelsOptions,
  BakeOptions,
  BakeReport,
  ConvertedSpace,
  ConvertSpaceOfModelOptions,
  ConvertSpaceOptions,
  ErrorStatistics,
  HighMesh,
  LowMesh,
  MapKind,
  NormalTexels,
  PreparedModelsOptions,
  Verification,
  VerifyModelsOptions,
  VerifyOptions,
} from './bake-types.js';
import type { Indices } from './types.js';
import simd from './wasm/bake.simd.wasm';

export { TEXEL_STATES } from './bake-types.js';
export type * from './bake-types.js';

/** The functions of the module; bindings/js/src/bake.rs, bake_meshes.rs and bake_maps.rs document them. */
interface BakeExports extends Exports {
  begin_bake(): void;
  model_bytes(bytes: number): number;
  bake_options(bytes: number): number;
  bake_models(): number;
  prepare_models(): number;
  bake_prepared_models(): number;
  low_tangents(corners: number): number;
  cage_positions(vertices: number): number;
  high_positions(vertices: number): number;
  high_normals(vertices: number): number;
  high_indices(corners: number): number;
  bake_meshes(): number;
  json_length(): number;
  baked_image(kind: number): number;
  baked_states(): number;
  given_normals(texels: number): number;
  given_states(texels: number): number;
  map_floats(texels: number): number;
  map_bytes(texels: number): number;
  map_words(texels: number): number;
  verify_models(): number;
  verify_meshes(): number;
  verified_heat(): number;
  convert_space_of_model(): number;
  convert_space_of_mesh(): number;
  converted_texels(): number;
  tiles_of_model(): number;
  tiles_of_mesh(): number;
}

/** What the module reports, or a sentence why there is nothing to report. */
interface Outcome<R> {
  report?: R;
  error?: string;
}

/** What a bake reports: counts by their names in Rust. */
type BakeOutcome = Pick<BakedMaps, 'diagonal' | 'distance' | 'warnings' | 'legends'> & { counts: Record<string, number> };

/** What a verification reports, by names in Rust. */
interface VerifyOutcome {
  all: ErrorStatistics;
  rounding: ErrorStatistics;
  places: [string, ErrorStatistics][];
  mistakes: [string, ErrorStatistics][];
  parts: Verification['parts'];
  points_without_hit: number;
  points_without_frame: number;
  heat_size: [number, number];
}

/** The receiver of the innermost call's progress. */
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
  const writeMeshes = checkedMeshes(low, high);
  const chosen = optionsOf(options);
  const text = meshOptionsText(chosen);
  return call(chosen.onProgress, (exports) => {
    writeMeshes(exports);
    writeTexts(exports, [text], exports.bake_options);
    return exports.bake_meshes();
  }, bakedMaps(chosen));
}

/**
 * Bakes the detail of high models into images over the UVs of a low model, as `darboux bake` does, with the same bits.
 *
 * From every texel that a triangle of the low model covers, a ray passes from outside through it; the first triangle of a high model that it hits
 * gives the content. Normals are in the frames of the tangents that the low model has, or else of MikkTSpace's. The call does not return before all
 * is done: run it in a worker, which a page can end.
 *
 * @param low The bytes of a GLB, of a glTF whose buffers and images are embedded, or of an FBX, OBJ, PLY or STL. Draco and meshopt compression is decoded.
 * @param high The same of one high model, or of several.
 * @throws TypeError for another type. RangeError for an unknown choice, for numbers that cannot be read, and where WebAssembly has not enough memory. Error for a file that
 * cannot be read, a model without normals, UVs or triangles, and numbers out of range.
 */
export function bakeModels(low: Uint8Array, high: Uint8Array | readonly Uint8Array[], options?: BakeModelsOptions | null): BakedMaps {
  const chosen = optionsOf(options);
  const files = [...checkedFiles(low, high), ...checkedCage(chosen)];
  const text = optionsText(chosen);
  return call(chosen.onProgress, (exports) => {
    for (const file of files) writeBytes(exports, file);
    writeTexts(exports, [text], exports.bake_options);
    return exports.bake_models();
  }, bakedMaps(chosen));
}

/**
 * Models that are read once, with the hierarchies over the high ones, for several bakes with other options: other sizes, cages, distances, samples. Its
 * memory grows and never shrinks: until it is garbage-collected it keeps the models, some ten times the bytes of their files (260 MB for a GLB of 26 MB that
 * is both the low and the high model), and room for the images of its largest bake.
 */
export class PreparedModels {
  readonly #instance: OwnInstance<BakeExports>;
  readonly #options: PreparedModelsOptions;

  /**
   * Parameters and errors are those of {@link bakeModels}.
   *
   * @param options What all bakes share.
   * @throws TypeError for an option of single bakes.
   */
  constructor(low: Uint8Array, high: Uint8Array | readonly Uint8Array[], options?: PreparedModelsOptions | null) {
    const files = checkedFiles(low, high);
    this.#options = optionsOfScope(optionsOf(options), true);
    const text = optionsText(this.#options);
    this.#instance = bakeModule.newInstance();
    this.#call(null, text, (exports) => {
      for (const file of files) writeBytes(exports, file);
    }, 'prepare_models', () => undefined);
  }

  /**
   * As {@link bakeModels} with these models, with the same bits. After an error of `onProgress` the models have to be prepared again.
   *
   * @throws As {@link bakeModels}. TypeError for an option that all bakes share. Error in the `onProgress` of another bake of these models.
   */
  bake(options?: Omit<BakeModelsOptions, keyof PreparedModelsOptions> | null): BakedMaps {
    const chosen = { ...optionsOfScope(optionsOf(options), false), ...this.#options };
    const cage = checkedCage(chosen);
    return this.#call(chosen.onProgress, optionsText(chosen), (exports) => {
      for (const file of cage) writeBytes(exports, file);
    }, 'bake_prepared_models', bakedMaps(chosen));
  }

  #call<R, T>(onProgress: BakeOptions['onProgress'], text: string, write: Write, work: 'prepare_models' | 'bake_prepared_models', read: (report: R, exports: BakeExports) => T): T {
    return call(onProgress, (exports) => {
      write(exports);
      writeTexts(exports, [text], exports.bake_options);
      return exports[work]();
    }, read, this.#instance.call);
  }
}

/**
 * Measures how far the normals that a renderer shows are from those of the high mesh, in degrees.
 *
 * The low mesh is shaded with the map as a renderer does it, filtered bilinearly, at one random point per texel. The truth is the normal where the point's own ray
 * hits the high mesh.
 *
 * @param baked What {@link bake} returned for these meshes and options, with the map 'normal'.
 * @throws As {@link bake}; Error for a map of another size.
 */
export function verify(low: LowMesh, high: HighMesh, baked: BakedMaps, options?: VerifyOptions | null): Verification {
  const writeMeshes = checkedMeshes(low, high);
  const chosen = optionsOf(options);
  const writeMaps = checkedMaps(baked, chosen.written);
  const text = meshOptionsText({ ...chosen, size: baked.size });
  return call(chosen.onProgress, (exports) => {
    writeMeshes(exports);
    writeMaps(exports);
    writeTexts(exports, [text], exports.bake_options);
    return exports.verify_meshes();
  }, verification);
}

/**
 * As {@link verify}, of a bake of models: with the numbers of `darboux bake --verify`.
 *
 * @param baked What {@link bakeModels} returned for these models and options, with the map 'normal'.
 * @throws As {@link bakeModels}; Error for a map of another size.
 */
export function verifyModels(low: Uint8Array, high: Uint8Array | readonly Uint8Array[], baked: BakedMaps, options?: VerifyModelsOptions | null): Verification {
  const chosen = optionsOf(options);
  const files = [...checkedFiles(low, high), ...checkedCage(chosen)];
  const writeMaps = checkedMaps(baked, chosen.written);
  const text = optionsText({ ...chosen, size: baked.size });
  return call(chosen.onProgress, (exports) => {
    for (const file of files) writeBytes(exports, file);
    writeMaps(exports);
    writeTexts(exports, [text], exports.bake_options);
    return exports.verify_models();
  }, verification);
}

/**
 * Converts a normal map from object space to tangent space or back, without rays.
 *
 * Each texel is converted by the frame of the mesh at its centre, as a renderer interpolates it; texels outside the charts are filled from the nearest one.
 *
 * @param low The mesh; its cage does not count.
 * @throws As {@link bake}; Error for another number of texels than the size says.
 */
export function convertSpace(low: LowMesh, texels: NormalTexels, options: ConvertSpaceOptions): ConvertedSpace {
  const writeLow = checkedLow(low);
  const text = spaceOptionsText(options, options.meshConvention);
  const writeMap = checkedTexels('texels', texels);
  return call(null, (exports) => {
    writeLow(exports);
    writeMap(exports);
    writeTexts(exports, [text], exports.bake_options);
    return exports.convert_space_of_mesh();
  }, convertedSpace(options.size));
}

/**
 * As {@link convertSpace}, with the frames of a model: as `darboux convert --space` does.
 *
 * @param model The bytes of a GLB, of a glTF whose buffers are embedded, or of an FBX, OBJ, PLY or STL.
 * @throws As {@link bakeModels}; Error for another number of texels than the size says.
 */
export function convertSpaceOfModel(model: Uint8Array, texels: NormalTexels, options: ConvertSpaceOfModelOptions): ConvertedSpace {
  checkType('model', model, ['Uint8Array']);
  const text = spaceOptionsText(options);
  const writeMap = checkedTexels('texels', texels);
  return call(null, (exports) => {
    writeBytes(exports, model);
    writeMap(exports);
    writeTexts(exports, [text], exports.bake_options);
    return exports.convert_space_of_model();
  }, convertedSpace(options.size));
}

/**
 * The UDIM numbers of the tiles that the charts of a mesh cover, in order: for the option `udim`.
 *
 * @throws As {@link bake}; Error for charts where no tile has a number.
 */
export function udimTiles(low: LowMesh, options?: Pick<BakeOptions, 'meshConvention'> | null): number[] {
  const writeLow = checkedLow(low);
  const text = meshOptionsText(optionsOf(options));
  return call(null, (exports) => {
    writeLow(exports);
    writeTexts(exports, [text], exports.bake_options);
    return exports.tiles_of_mesh();
  }, (tiles: number[]) => tiles);
}

/**
 * As {@link udimTiles}, of a model.
 *
 * @param model The bytes of a GLB, of a glTF whose buffers are embedded, or of an FBX, OBJ, PLY or STL.
 * @throws As {@link bakeModels}; Error for charts where no tile has a number.
 */
export function udimTilesOfModel(model: Uint8Array, options?: Pick<BakeModelsOptions, 'material' | 'uvSet'> | null): number[] {
  checkType('model', model, ['Uint8Array']);
  const text = optionsText(optionsOf(options));
  return call(null, (exports) => {
    writeBytes(exports, model);
    writeTexts(exports, [text], exports.bake_options);
    return exports.tiles_of_model();
  }, (tiles: number[]) => tiles);
}

/** Calls an instance of the module. `run` writes the inputs and returns the address of the outcome; `read` makes the result of the report. Errors: the module's sentence. */
function call<R, T>(
  onProgress: BakeOptions['onProgress'],
  run: (exports: BakeExports) => number,
  read: (report: R, exports: BakeExports) => T,
  callInstance: Call<BakeExports> = bakeModule.call,
): T {
  const outer = tell;
  tell = onProgress;
  try {
    return callInstance((exports) => {
      exports.begin_bake();
      const { report, error } = readJson<Outcome<R>>(exports, run(exports));
      if (report === undefined) throw new Error(error);
      return read(report, exports);
    });
  } finally {
    tell = outer;
  }
}

/** Copies inputs into the memory of an instance. */
type Write = (exports: BakeExports) => void;

/** Errors: arrays of another type, and lengths that do not fit together. */
function checkedLow(low: LowMesh): Write {
  checkType('low', low, ['Object']);
  const { positions, normals, uvs, indices, tangents, cage } = low;
  const mesh = checkedMesh(positions, [['normals', normals, 3], ['uvs', uvs, 2]], indices, 3);
  const corners = tangents ? rowCount('low.tangents', tangents, 4) : 0;
  const places = cage ? rowCount('low.cage', cage, 3) : 0;
  return (exports) => {
    writeMesh(exports, mesh);
    const floats: Copy<Float32Array>[] = [];
    if (tangents) floats.push([tangents, exports.low_tangents(corners)]);
    if (cage) floats.push([cage, exports.cage_positions(places)]);
    writeArrays(exports, floats);
  };
}

/** As {@link checkedLow}, of both meshes. */
function checkedMeshes(low: LowMesh, high: HighMesh): Write {
  const writeLow = checkedLow(low);
  checkType('high', high, ['Object']);
  const { positions, normals, indices } = high;
  const rows = { positions: rowCount('high.positions', positions, 3), normals: normals ? rowCount('high.normals', normals, 3) : 0 };
  if (indices) checkIndices(indices, 'high.indices');
  return (exports) => {
    writeLow(exports);
    const floats: Copy<Float32Array>[] = [[positions, exports.high_positions(rows.positions)]];
    if (normals) floats.push([normals, exports.high_normals(rows.normals)]);
    const integers: Copy<Indices>[] = indices ? [[indices, exports.high_indices(indices.length)]] : [];
    writeArrays(exports, floats, integers);
  };
}

/** The files of a low model and of high ones. Errors: another type, or no high model. */
function checkedFiles(low: Uint8Array, high: Uint8Array | readonly Uint8Array[]): Uint8Array[] {
  const files = [low, ...(Array.isArray(high) ? (high as readonly Uint8Array[]) : [high as Uint8Array])];
  if (files.length === 1) throw new RangeError('high is empty; give at least one model');
  files.forEach((file, at) => checkType(at ? 'high' : 'low', file, ['Uint8Array']));
  return files;
}

/** The file of a cage, if there is one. Errors: another type. */
function checkedCage({ cage }: Pick<BakeModelsOptions, 'cage'>): Uint8Array[] {
  if (cage == null) return [];
  checkType('cage', cage, ['Uint8Array']);
  return [cage];
}

/** Errors: maps that are not of a bake with a normal map, and texels of another type. */
function checkedMaps(baked: BakedMaps, written: NormalTexels | null | undefined): Write {
  checkType('baked', baked, ['Object']);
  const { normal, states } = baked;
  if (!normal) throw new RangeError("baked has no normal map; bake with 'normal' in maps");
  const texels = rowCount('baked.normal', normal, 3);
  checkType('baked.states', states, ['Uint8Array']);
  const writeMap = checkedTexels('written', written ?? normal);
  return (exports) => {
    writeArrays(exports, [[normal, exports.given_normals(texels)]]);
    const address = exports.given_states(states.length) >>> 0;
    new Uint8Array(exports.memory.buffer, address, states.length).set(states);
    writeMap(exports);
  };
}

/** Errors: an array of another type, or part of a texel. */
function checkedTexels(name: string, texels: NormalTexels): Write {
  checkType(name, texels, ['Uint8Array', 'Uint16Array', 'Float32Array']);
  const count = wholeRows(name, texels, 3);
  const place = (reserve: (texels: number) => number) => reserve(count) >>> 0;
  return (exports) => {
    const { BYTES_PER_ELEMENT: bytes } = texels;
    const address = place(bytes === 1 ? exports.map_bytes : bytes === 2 ? exports.map_words : exports.map_floats);
    const { buffer } = exports.memory;
    const target = bytes === 1 ? new Uint8Array(buffer, address, 3 * count) : bytes === 2 ? new Uint16Array(buffer, address, 3 * count) : new Float32Array(buffer, address, 3 * count);
    target.set(texels);
  };
}

/** The options of functions that take meshes. */
function meshOptionsText(options: BakeOptions): string {
  return optionsText({ ...options, material: null, uvSet: null, match: null, highMaps: null }, { meshConvention: options.meshConvention });
}

/** Errors: no object, or no known space. */
function spaceOptionsText(options: ConvertSpaceOfModelOptions, meshConvention?: BakeOptions['meshConvention']): string {
  checkType('options', options, ['Object']);
  checkType('options.size', options.size, ['Array']);
  const toObject = choice('to', options.to, ['tangent', 'object']) === 1;
  return optionsText(options, { meshConvention, sourceConvention: options.sourceConvention, toObject });
}

/** The result of a bake with these options. */
function bakedMaps(options: BakeOptions): (report: BakeOutcome, exports: BakeExports) => BakedMaps {
  const size = sizeOf(options);
  return ({ counts, diagonal, distance, warnings, legends }, exports) => {
    const report = camelCased(counts) as unknown as BakeReport;
    return { ...images(exports, size), size, states: states(exports, size), report, diagonal, distance, warnings, legends };
  };
}

function verification({ all, rounding, places, mistakes, parts, ...rest }: VerifyOutcome, exports: BakeExports): Verification {
  const { heat_size: heatSize, points_without_hit: pointsWithoutHit, points_without_frame: pointsWithoutFrame } = rest;
  const heat = readFloats(exports, exports.verified_heat(), heatSize[0] * heatSize[1]);
  const named = camelCased(Object.fromEntries([...places, ...mistakes])) as unknown as Verification;
  return { ...named, all, rounding, parts, pointsWithoutHit, pointsWithoutFrame, heatSize, heat };
}

/** The result of a conversion of so many texels. */
function convertedSpace(size: readonly [number, number]): (counts: Record<string, number>, exports: BakeExports) => ConvertedSpace {
  return (counts, exports) => {
    const texels = readFloats(exports, exports.converted_texels(), 3 * size[0] * size[1]);
    return { ...(camelCased(counts) as unknown as ConvertedSpace), texels };
  };
}

/** A kind of image as the name of a member: words are joined by hyphens in one, and by capital letters in the other. */
type NameOf<S extends string> = S extends `${infer Head}-${infer Tail}` ? `${Head}${Capitalize<NameOf<Tail>>}` : S;

function images(exports: BakeExports, [width, height]: readonly [number, number]): BakedImages {
  const entries = MAP_KINDS.map((kind, code): [keyof BakedImages, Float32Array<ArrayBuffer> | null] => {
    const name = kind.replaceAll(/-(.)/g, (_, letter: string) => letter.toUpperCase()) as NameOf<MapKind>;
    const channels = MAP_CHANNELS[code]!;
    const address = exports.baked_image(code) >>> 0;
    return [name, address ? new Float32Array(exports.memory.buffer, address, width * height * channels).slice() : null];
  });
  return Object.fromEntries(entries) as unknown as BakedImages;
}

function states(exports: BakeExports, [width, height]: readonly [number, number]): Uint8Array<ArrayBuffer> {
  return new Uint8Array(exports.memory.buffer, exports.baked_states() >>> 0, width * height).slice();
}

/** Members with their names in JavaScript. */
function camelCased<T>(members: Record<string, T>): Record<string, T> {
  return Object.fromEntries(Object.entries(members).map(([name, member]) => [name.replaceAll(/_(.)/g, (_, letter: string) => letter.toUpperCase()), member]));
}

function writeBytes(exports: BakeExports, bytes: Uint8Array): void {
  const address = exports.model_bytes(bytes.length) >>> 0;
  new Uint8Array(exports.memory.buffer, address, bytes.length).set(bytes);
}

function readJson<T>(exports: BakeExports, address: number): T {
  const bytes = new Uint8Array(exports.memory.buffer, address >>> 0, exports.json_length() >>> 0);
  return JSON.parse(new TextDecoder().decode(bytes)) as T;
}
