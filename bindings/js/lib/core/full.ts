// The full WebAssembly module, which `darboux` and its plans share: its exports, the codes of options, and reports.

import { choice, degrees, optionsOf } from './checks.js';
import { METHODS, MODES } from './choices.js';
import { checkedMesh, type Mesh } from './mesh.js';
import { load, type Exports } from './wasm-module.js';
import type * as types from '../types.js';
import simd from '../wasm/darboux.simd.wasm';

/** The functions of the full module; bindings/js/src documents them. */
export interface FullExports extends Exports {
  generate_tangents(mode: number, threshold: number, method: number): number;
  report(): number;
  generate_frames(mode: number, threshold: number, method: number): number;
  frame_bitangents(): number;
  frame_magnitudes(): number;
  make_plan(mode: number, threshold: number, method: number): number;
  plan_base(plan: number): number;
  evaluate_plan(plan: number): number;
  count_regrouped(plan: number): number;
  free_plan(plan: number): void;
  plan_topology(mode: number, threshold: number, maxMembers: number): number;
  gpu_plan_array(array: number): number;
  gpu_plan_array_len(array: number): number;
  free_gpu_plan(): void;
  threshold_cosine(threshold: number): number;
  welded_vertices(vertices: number): number;
  complete_tangents(mode: number, threshold: number): number;
  generate_normals(shading: number, weight: number, crease: number, seams: number): number;
  given_tangents(tangents: number): number;
  other_tangents(tangents: number): number;
  encoded_bytes(bytes: number): number;
  split_vertices(vertices: number): number;
  split_tangents(): number;
  split_indices(): number;
  split_sources(): number;
  measure_tangents(): number;
  measure_uv_fidelity(): number;
  convention_texts(bytes: number): number;
  convert(sourceBytes: number, generated: number): number;
  convert_texels(sourceBytes: number, isWide: number, channels: number): number;
  matrices(count: number): number;
  joints(joints: number): number;
  weights(joints: number): number;
  transform_frames(): number;
  skin_frames(influences: number): void;
  encode_tangents(encoding: number): number;
  decode_tangents(encoding: number): number;
}

/** The counts of a report, in the order in which WebAssembly writes them. */
const COUNTS = [
  'triangles', 'unsupportedFaces', 'degenerateTriangles', 'uvDegenerateTriangles', 'nonFiniteCorners', 'repairedCorners',
  'mixedSignFaces', 'mirroredEdges', 'splitVertices', 'mergedVertices',
] as const satisfies (keyof types.Report)[];

export const fullModule = load<FullExports>(simd, () => import('../darboux.scalar.js'));

/** Checks a mesh that has all that tangents need. */
export function tangentMesh(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices | null | undefined,
  options: types.TangentOptions | null | undefined,
): Mesh {
  return checkedMesh(positions, [['normals', normals, 3], ['uvs', uvs, 2]], indices, optionsOf(options).faces);
}

/** Options as WebAssembly takes them. */
export function tangentOptions(options: types.TangentOptions | null | undefined): [mode: number, threshold: number, method: number] {
  const given = optionsOf(options);
  const method = choice('method', given.method, METHODS, 'mikktspace');
  const mode = choice('mode', given.mode, MODES, 'repaired');
  const threshold = degrees('threshold', given.threshold);
  if (method && mode !== MODES.indexOf('repaired')) throw new RangeError("mode belongs to the method 'mikktspace'; leave one of them out");
  if (method && threshold !== 180) throw new RangeError("threshold belongs to the method 'mikktspace'; leave one of them out");
  return [mode, threshold, method];
}

/** The report of the last run. */
export function readReport(exports: FullExports): types.Report {
  const counts = Array.from(new Float64Array(exports.memory.buffer, exports.report() >>> 0, COUNTS.length));
  return Object.fromEntries(COUNTS.map((name, at) => [name, counts[at]])) as unknown as types.Report;
}
