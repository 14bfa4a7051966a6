// The module of `darboux`, and what its entry and plans share.

import { load, type Exports } from './wasm-module.js';
import { choice, degrees, mesh, type Mesh } from './mesh.js';
import type * as types from '../types.js';
import simd from '../wasm/darboux.simd.wasm';

/** What the module of `darboux` has. */
export interface AllExports extends Exports {
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
  plan_topology(mode: number, threshold: number, most: number): number;
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
  encode_tangents(form: number): number;
  decode_tangents(form: number): number;
}

// In the order of the codes that the WebAssembly side knows.
const MODES = ['reference', 'repaired', 'corrected'] as const;
const METHODS = ['mikktspace', 'angle-area', 'lengyel', 'lengyel-per-vertex', 'average', 'area', 'face', 'from-normal'] as const;
const COUNTS = [
  'triangles', 'unsupportedFaces', 'degenerateTriangles', 'uvDegenerateTriangles', 'nonFiniteCorners', 'repairedCorners',
  'mixedSignFaces', 'mirroredEdges', 'splitVertices', 'mergedVertices',
] as const satisfies (keyof types.Report)[];

export const engine = load<AllExports>(simd, () => import('../darboux.scalar.js'));

/** A mesh with UVs. */
export function surface(
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: types.Indices | null | undefined,
  { faces }: types.TangentOptions,
): Mesh {
  return mesh(positions, [['normals', normals, 3], ['uvs', uvs, 2]], indices, faces);
}

/** Options as the WebAssembly side has them. */
export function choices(options: types.TangentOptions): [mode: number, threshold: number, method: number] {
  const method = choice('method', options.method ?? 'mikktspace', METHODS);
  const mode = choice('mode', options.mode ?? 'repaired', MODES);
  const threshold = degrees('threshold', options.threshold);
  if (method && threshold !== 180) throw new RangeError("threshold belongs to the method 'mikktspace'; leave one of them out");
  return [mode, threshold, method];
}

/** What the last run met. */
export function report(exports: AllExports): types.Report {
  const counts = Array.from(new Float64Array(exports.memory.buffer, exports.report() >>> 0, COUNTS.length));
  return Object.fromEntries(COUNTS.map((name, at) => [name, counts[at]])) as unknown as types.Report;
}
