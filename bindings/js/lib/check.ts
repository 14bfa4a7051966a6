// `darboux/check`: what is wrong with models and normal maps, their repair and conversion, and how tangents were computed. It has a WebAssembly module of its own.

import { checkType, choice, optionsOf, rowCount } from './core/checks.js';
import { ASSUMED_MAPS } from './core/choices.js';
import { checkedMesh, indexError, writeArrays, writeMesh, writeTexts } from './core/mesh.js';
import { load, type Exports } from './core/wasm-module.js';
import type { Convention, Faces, Indices, Method, Mode } from './types.js';
import simd from './wasm/check.simd.wasm';

/** The functions of the module; bindings/js/src/check.rs documents them. */
interface CheckExports extends Exports {
  file_bytes(bytes: number): number;
  tangents_to_recognise(corners: number): number;
  codes_to_repair(bytes: number): number;
  check_file(isGreenDown: number, judgesMaps: number, assumedMap: number, repairs: number): number;
  judge_normal_map(isWide: number, channels: number, width: number, height: number): number;
  recognise_recipe(): number;
  json_length(): number;
  conversion_text(bytes: number): number;
  convert_file(): number;
  repaired_file(): number;
  repaired_length(): number;
}

/** Options of {@link check}, and of {@link fix} with {@link FixOptions}. */
export interface CheckOptions {
  /** Where the green of normal maps should point: 'up' (glTF, OpenGL) or 'down' (DirectX). Default: 'up'. */
  green?: 'up' | 'down' | null;
  /** Whether the normal maps of a model are decoded and judged; otherwise they are taken to be right. Default: true. */
  maps?: boolean | null;
  /** What normal maps are where neither their texels nor the faces decide it. Default: nothing is assumed. */
  assume?: (typeof ASSUMED_MAPS)[number] | null;
}

/** Options of {@link fix}. */
export interface FixOptions extends CheckOptions {
  /** The codes that are repaired. Default: all, but tangents of another method than MikkTSpace are left (of no known method unless many point to wrong directions), because the map may have been baked with them: `['tangent-other-recipe']` computes them again. */
  only?: readonly string[] | null;
}

/** A number that supports a finding. */
export interface Evidence {
  what: string;
  value: number;
  /** `degrees`, `corners`, `%` and so on; empty for ratios. */
  unit: string;
}

/** One thing that is wrong. docs/check.md explains every code. Indices are those of the glTF document. */
export interface Finding {
  code: string;
  /** Where the primitive is in a file of another format, such as `Armature/Body in your FBX`; absent for glTF. */
  source?: string;
  /** 'not-checked': a map in a format that is not read. */
  severity: 'error' | 'warning' | 'info' | 'not-checked';
  mesh: number | null;
  meshName: string | null;
  primitive: number | null;
  /** The number of further primitives with the same data. */
  sameAs: number;
  material: number | null;
  image: number | null;
  /** The number of vertices, corners, triangles or texels that show it, as the text says, and the indices of the first ones. */
  count: number;
  first: number[];
  /** What {@link first} numbers, where it has elements. */
  firstAre: 'triangles' | 'vertices';
  evidence: Evidence[];
  /** What is wrong, in one sentence. */
  text: string;
  /** What it looks like on screen. */
  looksLike: string;
  cure: string;
  /** Whether {@link fix} repairs it. */
  fixable: boolean;
  /** Why {@link fix} leaves it; null where it repairs it. */
  leftBecause: string | null;
  /** Whether {@link fix} repaired it; absent from {@link check}. */
  repaired?: boolean;
  /** What {@link fix} did to the tangents of the primitive: some were corrected, `count` of them, or all computed again; absent for other findings. */
  change?: { kind: 'corrected_tangents'; count: number } | { kind: 'recomputed_tangents' };
}

/** The findings of a file, and words about all of it. */
export type Findings = Finding[] & {
  /** What happened to it, what it looks like and what to do, in one to three sentences. */
  diagnosis: string;
  /** The indices of findings that say the same of several places, together. The most severe come first, and causes before what follows from them. */
  statements: number[][];
  /** What importers of another format make of the mistakes; null for glTF, and without mistakes. */
  importerNote: string | null;
  /** What a model of another format lost as it became glTF, such as textures that are not among its bytes; empty for glTF. */
  warnings: string[];
};

/** The verdict on a normal map. Counts leave out black, white and middle grey texels. */
export interface MapJudgement {
  /** Green points up ('opengl') or down ('directx'). */
  verdict: 'opengl' | 'directx' | 'no_gradient' | 'flat' | 'cannot_tell';
  /** For 'opengl' and 'directx' an estimate of the probability that the verdict is right, 0.5 to 0.999. */
  confidence: number;
  /** From -1 (DirectX) to 1 (OpenGL). */
  correlation: number;
  /** The correlation in units of its standard error. */
  zScore: number;
  /** Negative where red and green are exchanged. */
  logEnergyRatio: number;
  texels: number;
  background: number;
  notUnit: number;
  negativeZ: number;
  grey: number;
  notNormal: number;
  tiles: MapTiles;
}

/** The tiles of a normal map and how each votes, at the size of the map whose mean is {@link MapJudgement.correlation}. */
export interface MapTiles {
  /** The texels of the map along a side of a tile. */
  side: number;
  /** The tiles of a row. Tile i begins `side * (i % columns)` texels from the left and `side * Math.floor(i / columns)` from the top. */
  columns: number;
  /** From -1 (DirectX) to 1 (OpenGL), the top row first; null where a tile has no vote: one value, or mostly background or borders. */
  correlations: (number | null)[];
}

/** How well a way of computing tangents explains given ones. */
export interface RecipeMatch {
  method: Method;
  /** The mode of 'mikktspace'; else null. */
  mode: Mode | null;
  /** Whether the tangents were computed with 1 - v. */
  flipsV: boolean;
  /** Whether they were computed before quads were cut into triangles, as Unity does; which were quads is an estimate. */
  fromQuads: boolean;
  /** 'corners': every corner has its own; otherwise the last or the first corner of each vertex decides. */
  writing: 'corners' | 'last-corner' | 'first-corner';
  /** Bits per component: 32 (floats), 16 or 8. */
  bits: 32 | 16 | 8;
  corners: number;
  /** Corners with equal bits after rounding. */
  identical: number;
  /** Corners within 0.1 degrees (1 degree for 8 bits) and with equal signs. */
  close: number;
  signFlips: number;
  /** The largest angle in degrees. */
  worst: number;
}

const checkModule = load<CheckExports>(simd, () => import('./check.scalar.js'));

/** Resolves when the other functions can be called. */
export const ready: Promise<void> = checkModule.ready;

/**
 * Says what is wrong with the tangents, normals, UVs and normal maps of a model, or with a normal map.
 *
 * @param file The bytes of a GLB, of a glTF whose buffers and images are embedded, of an FBX, OBJ, PLY or STL, or of an image (PNG, JPEG, WebP, TGA), which is
 * a normal map. Draco and meshopt compression is decoded.
 * @returns The findings, grouped by place; empty for a healthy file.
 * @throws TypeError for another type. Error for a file that cannot be read; an image that cannot be decoded is a finding.
 */
export function check(file: Uint8Array, options?: CheckOptions | null): Findings {
  checkType('file', file, ['Uint8Array']);
  return checkModule.call((exports) => findings(exports, file, options, false));
}

/**
 * Repairs a model: tangents, normals, and the texels of embedded PNG and JPEG normal maps.
 *
 * @param file As for {@link check}, but no image.
 * @returns The repaired GLB, null where nothing was repaired, and all findings with what became of each.
 * @throws As {@link check}. TypeError where `only` is not an array of strings, RangeError where it is empty. Error for an unknown code.
 */
export function fix(
  file: Uint8Array,
  options?: FixOptions | null,
): { file: Uint8Array<ArrayBuffer> | null; findings: Findings } {
  const codes = codesText(optionsOf(options).only);
  return checkModule.call((exports) => {
    writeTexts(exports, [codes], exports.codes_to_repair);
    const found = findings(exports, file, options, true);
    const repaired = newFile(exports);
    return { file: repaired.length ? repaired : null, findings: found };
  });
}

/** Codes as the module reads them, one per line; empty for all. Errors: another type, no code, or a code that is not one line. */
function codesText(codes: FixOptions['only']): string {
  if (codes == null) return '';
  checkType('only', codes, ['Array']);
  if (codes.length === 0) throw new RangeError('only is empty; name the codes that are repaired, or leave it out');
  return Array.from(codes, (code, at) => {
    checkType(`only[${at}]`, code, ['String']);
    if (code.includes('\n')) throw new Error(`only[${at}] is ${JSON.stringify(code)}, which has a line break; give each code an element of its own`);
    return `${code}\n`;
  }).join('');
}

/** Options of {@link convertFile}, for normal maps. */
export interface FileConversionOptions {
  /** The channels of x, y and, if stored, z: 'rgb', 'rg', 'ag', ... Default: 'rgb'. */
  layout?: string | null;
  /** The channels in the new map. Default: those of `layout`. A z that is not stored is computed from x and y. */
  toLayout?: string | null;
}

/**
 * Converts a model or a normal map from one convention to another, as `darboux convert` does.
 *
 * Models: positions, normals, tangents, UVs, morph targets and winding; nodes, skins and animations if the axes differ. A correct glTF file is in
 * glTF's convention, so this repairs files whose writer copied the numbers of another one. Any other target than 'gltf' is for programs that use the
 * numbers as they are; a warning says so. Maps: red and green are inverted where the conventions differ, which is exact.
 *
 * @param file The bytes of a PNG image of 8 or 16 bits, or of a model as for {@link check}.
 * @returns The new PNG or GLB, and warnings about what was not converted, such as cameras.
 * @throws TypeError for another type. Error for a file that cannot be read, an unknown convention, or channels that the image does not have.
 */
export function convertFile(
  file: Uint8Array,
  source: Convention,
  target: Convention,
  options?: FileConversionOptions | null,
): { file: Uint8Array<ArrayBuffer>; warnings: string[] } {
  checkType('file', file, ['Uint8Array']);
  const { layout, toLayout } = optionsOf(options);
  const from = layout ?? 'rgb';
  return checkModule.call((exports) => {
    writeBytes(exports, file);
    writeTexts(exports, [[source, target, from, toLayout ?? from].join('\n')], exports.conversion_text);
    const converted = readJson<{ warnings?: string[]; error?: string }>(exports, exports.convert_file());
    if (converted.error !== undefined) throw new Error(converted.error);
    return { file: newFile(exports), warnings: converted.warnings! };
  });
}

/** A copy of the file that a call made; empty where it made none. */
function newFile(exports: CheckExports): Uint8Array<ArrayBuffer> {
  return new Uint8Array(exports.memory.buffer, exports.repaired_file() >>> 0, exports.repaired_length() >>> 0).slice();
}

function findings(exports: CheckExports, file: Uint8Array, options: CheckOptions | null | undefined, repairs: boolean): Findings {
  checkType('file', file, ['Uint8Array']);
  const { green, maps, assume } = optionsOf(options);
  if (green != null && green !== 'up' && green !== 'down') throw new RangeError(`green is '${green}'; it must be 'up' or 'down'`);
  const assumed = assume == null ? 0 : choice('assume', assume, ASSUMED_MAPS) + 1;
  writeBytes(exports, file);
  const address = exports.check_file(Number(green === 'down'), Number(maps ?? true), assumed, Number(repairs));
  type Checked = Pick<Findings, 'diagnosis' | 'statements' | 'importerNote' | 'warnings'> & { findings: Finding[] };
  const checked = readJson<Checked | { error: string }>(exports, address);
  if ('error' in checked) throw new Error(checked.error);
  const { findings, ...words } = checked;
  return Object.assign(findings, words);
}

/**
 * Judges a normal map by its texels: whether green points up or down, and whether they are normals at all.
 *
 * @param texels The channels of all texels, the top row first; x, y and, if stored, z come first. Alpha is ignored. The data of an `ImageData`
 * has 4 channels.
 * @param channels 2 to 4 channels per texel. Default: 4.
 * @throws TypeError for an array of another type. RangeError for another length than width times height times channels.
 */
export function judgeNormalMap(
  texels: Uint8Array | Uint8ClampedArray | Uint16Array,
  width: number,
  height: number,
  channels: 2 | 3 | 4 = 4,
): MapJudgement {
  checkType('texels', texels, ['Uint8Array', 'Uint8ClampedArray', 'Uint16Array']);
  if (![2, 3, 4].includes(channels)) throw new RangeError(`channels is ${channels}; it must be 2, 3 or 4`);
  if (texels.length !== width * height * channels) {
    throw new RangeError(`texels has a length of ${texels.length}, not width * height * channels, which is ${width * height * channels}`);
  }
  const isWide = texels.BYTES_PER_ELEMENT === 2;
  return checkModule.call((exports) => {
    writeBytes(exports, new Uint8Array(texels.buffer, texels.byteOffset, texels.byteLength));
    return readJson(exports, exports.judge_normal_map(Number(isWide), channels, width, height));
  });
}

/**
 * Ranks the ways in which the tangents of a mesh could have been computed, the best one first.
 *
 * @param positions 3 per vertex.
 * @param normals 3 per vertex.
 * @param uvs 2 per vertex.
 * @param indices The vertex of each corner; null where corners are vertices.
 * @param tangents 4 per corner, with the sign that `generateTangents` returns.
 * @throws As `generateTangents`; RangeError for another number of tangents than corners.
 */
export function recogniseRecipe(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: Indices | null | undefined,
  tangents: Float32Array,
  options?: { faces?: Faces | null } | null,
): RecipeMatch[] {
  const mesh = checkedMesh(positions, [['normals', normals, 3], ['uvs', uvs, 2]], indices, optionsOf(options).faces);
  const rows = rowCount('tangents', tangents, 4);
  if (rows !== mesh.corners) throw new RangeError(`there are ${rows} tangents but ${mesh.corners} corners; give one per corner`);
  return checkModule.call((exports) => {
    writeMesh(exports, mesh);
    writeArrays(exports, [[tangents, exports.tangents_to_recognise(rows)]]);
    const address = exports.recognise_recipe();
    if (!address) throw indexError(mesh);
    return readJson(exports, address);
  });
}

function writeBytes(exports: CheckExports, bytes: Uint8Array): void {
  const address = exports.file_bytes(bytes.length) >>> 0;
  new Uint8Array(exports.memory.buffer, address, bytes.length).set(bytes);
}

/** What the module wrote. Its names are those of `darboux check --json`, in which words are separated by underscores. */
function readJson<T>(exports: CheckExports, address: number): T {
  const bytes = new Uint8Array(exports.memory.buffer, address >>> 0, exports.json_length() >>> 0);
  return JSON.parse(new TextDecoder().decode(bytes), camelCase) as T;
}

/** Names the fields of an object as JavaScript does. */
function camelCase(_: string, value: unknown): unknown {
  if (value === null || typeof value !== 'object' || Array.isArray(value)) return value;
  const named = Object.entries(value).map(([name, field]) => [name.replace(/_./g, (end) => end[1]!.toUpperCase()), field]);
  return Object.fromEntries(named);
}
