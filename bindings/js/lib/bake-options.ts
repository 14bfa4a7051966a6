// The options of `darboux/bake` as the JSON that its module reads.

import { checkType, choice } from './core/checks.js';
import { BITANGENTS, ID_SOURCES, MAP_KINDS, OCCLUSION_FALLOFFS, OCCLUSION_WEIGHTS, PART_MATCHES } from './core/choices.js';
import type { BakeModelsOptions, BakeOptions, PreparedModelsOptions } from './bake-types.js';
import type { Convention } from './types.js';

/** Options that `bakeModels` does not have. */
interface OtherOptions {
  meshConvention?: Convention | null | undefined;
  sourceConvention?: Convention | null | undefined;
  /** Whether a map becomes one in object space. */
  toObject?: boolean;
}

/** Which options of a bake of models all bakes of `PreparedModels` share. */
const IS_SHARED: { [Option in keyof Required<BakeModelsOptions>]: Option extends keyof PreparedModelsOptions ? true : false } = {
  size: false,
  cageOffset: false,
  autoCage: false,
  cage: false,
  skew: false,
  distance: false,
  maps: true,
  samples: false,
  bitangent: false,
  convention: false,
  padding: false,
  backFaces: false,
  aoRays: false,
  aoDistance: false,
  aoFalloff: false,
  aoWeights: false,
  thicknessDistance: false,
  curvatureRadius: false,
  curvatureUnit: false,
  worldDirection: false,
  udim: false,
  onProgress: false,
  material: true,
  uvSet: true,
  match: true,
  highMaps: true,
  aoOwnPart: false,
  idFrom: false,
  texture: true,
};

/** The options that have a value. Errors: one that is shared where `shared` is false, or the other way round. */
export function optionsOfScope(options: BakeModelsOptions, shared: boolean): BakeModelsOptions {
  const given = Object.entries(options).filter(([, value]) => value != null);
  for (const [name] of given) {
    if (!Object.hasOwn(IS_SHARED, name) || IS_SHARED[name as keyof BakeModelsOptions] === shared) continue;
    throw new TypeError(shared ? `${name} is an option of each bake, not of PreparedModels` : `${name} is an option of PreparedModels, not of its bakes`);
  }
  return Object.fromEntries(given);
}

/** Options of the functions beside bakes of models. */
const OTHER_OPTIONS = ['meshConvention', 'sourceConvention', 'to', 'written'];

/** Errors: a name that no option has, which is most likely mistyped, and values that are not true or false. */
function checkNames(options: object): void {
  for (const [name, value] of Object.entries(options)) {
    if (!Object.hasOwn(IS_SHARED, name) && !OTHER_OPTIONS.includes(name)) {
      throw new TypeError(`${name} is not an option; the options are ${[...Object.keys(IS_SHARED), 'meshConvention'].join(', ')}`);
    }
    if (['backFaces', 'highMaps', 'aoOwnPart'].includes(name) && value != null) checkType(name, value, ['Boolean']);
  }
}

/** Width and height in texels. */
export function sizeOf({ size }: BakeOptions): readonly [number, number] {
  return size ?? [1024, 1024];
}

/** Errors: a value that is not an array of so many elements. */
function checkTuple(name: string, tuple: readonly number[] | null | undefined, count: number): void {
  if (tuple == null) return;
  checkType(name, tuple, ['Array']);
  if (tuple.length !== count) throw new RangeError(`${name} has ${tuple.length} elements; it must have ${count}`);
}

/** The value of an option, or `fallback`. Errors: a value that is not among `values`. */
function named<V extends string>(option: string, value: V | null | undefined, values: readonly V[], fallback?: V): V {
  return values[choice(option, value, values, fallback)]!;
}

/** A value in a message: text with its quotes. */
function shown(value: unknown): string {
  return typeof value === 'string' ? JSON.stringify(value) : `${value}`;
}

/** The options as the JSON that the module reads. Errors: numbers that JSON or the module does not have. */
export function optionsText(options: BakeModelsOptions, { meshConvention, sourceConvention, toObject }: OtherOptions = {}): string {
  const { cageOffset, autoCage, distance, maps, samples, padding, material, uvSet, udim, aoRays, aoDistance } = options;
  checkNames(options);
  checkTuple('size', options.size, 2);
  checkTuple('distance', distance, 2);
  checkTuple('worldDirection', options.worldDirection, 3);
  if (maps != null) checkType('maps', maps, ['Array']);
  const whole = { width: sizeOf(options)[0], height: sizeOf(options)[1], samples: samples ?? 1, padding, material, uvSet, udim, aoRays: aoRays ?? 64 };
  for (const [name, value] of Object.entries(whole)) {
    if (value != null && !(Number.isInteger(value) && value >= 0 && value < 2 ** 32)) throw new RangeError(`${name} is ${shown(value)}; it must be a whole number from 0 on`);
  }
  const [x, y, z] = options.worldDirection ?? [0, 1, 0];
  const { thicknessDistance, curvatureRadius, skew } = options;
  const lengths = { cageOffset, autoCage, skew, aoDistance, thicknessDistance, curvatureRadius, 'worldDirection[0]': x, 'worldDirection[1]': y, 'worldDirection[2]': z, 'the first distance': distance?.[0], 'the second distance': distance?.[1] };
  for (const [name, value] of Object.entries(lengths)) {
    if (value != null && !Number.isFinite(value)) throw new RangeError(`${name} is ${shown(value)}; it must be a finite number`);
  }
  return JSON.stringify({
    size: sizeOf(options),
    cageOffset: cageOffset ?? null,
    autoCage: autoCage ?? null,
    distance: distance ?? null,
    hasCage: options.cage != null,
    skew: skew ?? null,
    maps: (maps ?? ['normal']).map((kind) => named('maps', kind, MAP_KINDS)),
    samples: whole.samples,
    bitangent: named('bitangent', options.bitangent, BITANGENTS, 'pixel'),
    convention: options.convention ?? 'gltf',
    sourceConvention: sourceConvention ?? 'gltf',
    meshConvention: meshConvention ?? 'gltf',
    toObject: toObject ?? false,
    udim: udim ?? null,
    padding: padding ?? null,
    backFaces: Boolean(options.backFaces),
    material: material ?? null,
    uvSet: uvSet ?? null,
    match: named('match', options.match, PART_MATCHES, 'nearest'),
    highMaps: options.highMaps ?? true,
    aoRays: whole.aoRays,
    aoDistance: aoDistance ?? null,
    aoFalloff: named('aoFalloff', options.aoFalloff, OCCLUSION_FALLOFFS, 'none'),
    aoWeights: named('aoWeights', options.aoWeights, OCCLUSION_WEIGHTS, 'cosine'),
    ownPartOnly: Boolean(options.aoOwnPart),
    thicknessDistance: options.thicknessDistance ?? null,
    curvatureRadius: options.curvatureRadius ?? 4,
    isCurvatureInTexels: choice('curvatureUnit', options.curvatureUnit, ['texels', 'distance'], 'texels') === 0,
    idFrom: named('idFrom', options.idFrom, ID_SOURCES, 'material'),
    worldDirection: options.worldDirection ?? [0, 1, 0],
    texture: options.texture ?? null,
  });
}
