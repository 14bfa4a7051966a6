// The types of arguments and results.

import type { CONVENTIONS, METHODS, MODES, NORMAL_WEIGHTS, SHADINGS, SMOOTHING_SEAMS } from './core/choices.js';

/** The vertex of each corner. */
export type Indices = Uint8Array | Uint16Array | Uint32Array;

/** The number of corners per face: 3, 4, or one number for each face. */
export type Faces = 3 | 4 | Uint32Array;

/**
 * 'reference': the bits of mikktspace.c, defects included. 'repaired': the same, except that unusable tangents are replaced. 'corrected':
 * known defects of mikktspace.c are corrected as well.
 */
export type Mode = (typeof MODES)[number];

/** Options of MikkTSpace. The defaults fit normal maps of current bakers. */
export interface MikkTSpaceOptions {
  /** Default: 'repaired'. */
  mode?: Mode | null;
  /**
   * Degrees. Faces around a vertex share a tangent if their tangents and bitangents differ by less. Default: 180. Below 180 the faces
   * are compared in pairs, which takes a time that grows with the square of their number.
   */
  threshold?: number | null;
  /** Default: 3. Faces with another number of corners than 3 or 4 get tangents that depend on their normals only. */
  faces?: Faces | null;
}

/** How tangents are computed. A normal map needs the method that it was baked with, nearly always 'mikktspace'. */
export type Method = (typeof METHODS)[number];

/** Options of `generateTangents` of `darboux`. `threshold` is for 'mikktspace' only. */
export interface TangentOptions extends MikkTSpaceOptions {
  /** Default: 'mikktspace'. */
  method?: Method | null;
}

/** Counts of what the mesh of a run contains. A quad counts as the two triangles that it is split into. */
export interface Report {
  triangles: number;
  /** Faces with another number of corners than 3 or 4. */
  unsupportedFaces: number;
  /** Triangles with two equal positions. */
  degenerateTriangles: number;
  /** Triangles whose UVs span no area, degenerate triangles excluded. */
  uvDegenerateTriangles: number;
  /** Corners with a NaN or an infinity in position, normal or UV. */
  nonFiniteCorners: number;
  /** Corners whose reference tangent is missing or unusable. It is replaced except in the mode 'reference'. */
  repairedCorners: number;
  /** Faces whose corners have both signs. The mode 'corrected' gives them one. */
  mixedSignFaces: number;
  /** Edges between two triangles of opposite UV orientation. */
  mirroredEdges: number;
  /** Vertices that need more than one tangent; `splitVertices` splits them. */
  splitVertices: number;
  /** Vertices whose triangles of both UV orientations share one tangent, which 'lengyel-per-vertex' gets wrong. */
  mergedVertices: number;
}

/** The tangents of corners and the report of the run. */
export interface ReportedTangents {
  /** 4 per corner. */
  tangents: Float32Array<ArrayBuffer>;
  report: Report;
}

/** The whole frame of every corner, and the report of the run. */
export interface Frames {
  /** 4 per corner: the direction of increasing u, of unit length, and the sign w, -1 where the UV map is mirrored. */
  tangents: Float32Array<ArrayBuffer>;
  /** 3 per corner: the direction of increasing v, of unit length, perpendicular to the normal but not always to the tangent. */
  bitangents: Float32Array<ArrayBuffer>;
  /** 2 per corner: world units per unit of u and per unit of v. */
  magnitudes: Float32Array<ArrayBuffer>;
  report: Report;
}

/** The vertices and indices of a mesh after splitting. */
export interface VertexSplit {
  /** 4 per new vertex; (1, 0, 0, 1) for a vertex that no corner uses. */
  tangentOfVertex: Float32Array<ArrayBuffer>;
  /** The new vertex of each corner, in the old order of corners. */
  indices: Uint32Array<ArrayBuffer>;
  /** The old vertex that each new vertex copies. Use it for all other attributes: new[i] = old[sourceOfVertex[i]]. */
  sourceOfVertex: Uint32Array<ArrayBuffer>;
}

/** The vertices and indices of a mesh after splitting by normals. */
export interface NormalSplit {
  /** 3 per new vertex; (0, 0, 1) for a vertex that no corner uses. */
  normalOfVertex: Float32Array<ArrayBuffer>;
  /** The new vertex of each corner, in the old order of corners. */
  indices: Uint32Array<ArrayBuffer>;
  /** The old vertex that each new vertex copies. */
  sourceOfVertex: Uint32Array<ArrayBuffer>;
}

/** How well tangents follow the UVs. Angles are in degrees. */
export interface UvFidelity {
  /** The mean angle over the surface, weighted by area. */
  mean: number;
  /** The root of the mean square of the angle. */
  rootMeanSquare: number;
  /** The area of the triangles that were measured. */
  area: number;
  /** The number of triangles that have no area or no direction of u. */
  unmeasuredTriangles: number;
}

/** The name of a program's convention, optionally with changes after commas: 'gltf,green=down'. docs/conventions.md lists them. */
export type Convention = ConventionName | `${ConventionName},${string}`;

/** A convention with a name. */
export type ConventionName = (typeof CONVENTIONS)[number];

/** Vertex data to convert. Everything may be left out. */
export interface VertexData {
  /** 3 each: positions, or offsets of morph targets. */
  positions?: Float32Array | null;
  /** 3 each. */
  normals?: Float32Array | null;
  /** 2 each. */
  uvs?: Float32Array | null;
  /** 4 each: xyz and the sign w. */
  tangents?: Float32Array | null;
  /** The vertex of each corner, or any other number of each corner. All corners of a face but the first are reversed if front faces differ. */
  indices?: Indices | null;
  /** Default: 3. */
  faces?: Faces | null;
  /** True if the tangents come from `generateTangents` on a mesh in the source convention. Default: false. */
  generated?: boolean | null;
}

/** New arrays; null for those that were left out. */
export interface ConvertedVertexData {
  positions: Float32Array<ArrayBuffer> | null;
  normals: Float32Array<ArrayBuffer> | null;
  uvs: Float32Array<ArrayBuffer> | null;
  tangents: Float32Array<ArrayBuffer> | null;
  indices: Uint32Array<ArrayBuffer> | null;
  /** Whether the red channel of normal maps must be inverted, as `convertTexels` does. */
  invertsRed: boolean;
  /** Whether the green channel must be inverted. */
  invertsGreen: boolean;
}

/** Normals and tangents under a matrix or a skin. */
export interface MovedFrames {
  /** 3 per vertex, of unit length. */
  normals: Float32Array<ArrayBuffer>;
  /** 4 per vertex: unit xyz, perpendicular to the normal, and the sign w. */
  tangents: Float32Array<ArrayBuffer>;
}

/** Normals and tangents under one matrix. */
export interface TransformedFrames extends MovedFrames {
  /** -1 where the matrix mirrors, which also reverses the winding of faces; else 1. */
  orientation: 1 | -1;
}

/** Options of `generateNormals`. */
export interface NormalOptions {
  /** Default: 'smooth'. */
  shading?: (typeof SHADINGS)[number] | null;
  /** The weight of each face at a smooth vertex. Default: 'angle'. */
  weight?: (typeof NORMAL_WEIGHTS)[number] | null;
  /** Degrees. An edge is sharp if the normals of its faces differ by more. Default: 180, so that no edge is sharp. */
  crease?: number | null;
  /** 'ignored': vertices with equal positions are one vertex. 'respected': only equal indices are one vertex. Default: 'ignored'. */
  seams?: (typeof SMOOTHING_SEAMS)[number] | null;
  /** Default: 3. Faces may have any number of corners from 3. */
  faces?: Faces | null;
}

/** The difference of two sets of tangents. Angles are in degrees, between the xyz of the same corner in both. */
export interface TangentDifference {
  corners: number;
  /** Corners whose four floats have the same bits. */
  identical: number;
  /** Corners whose signs differ. */
  signFlips: number;
  /** Corners where a tangent is zero or not finite. The numbers below exclude them. */
  withoutAngle: number;
  mean: number;
  min: number;
  median: number;
  /** The 95th percentile of the angles. */
  p95: number;
  max: number;
  /** Corners per bin; the bins end at 0, 0.001, 0.01, 0.1, 1, 5, 15, 45, 90 and 180 degrees. */
  histogram: number[];
  /** The corners with the largest angles, at most 16, the largest first. */
  worst: { corner: number; angle: number }[];
}

/** The array type of each encoding, with 4, 1, 4, 2 and 1 elements per tangent. */
export interface TangentCodes {
  /** x, y, z and the sign. The angular error is at most 0.40 degrees. */
  snorm8: Int8Array<ArrayBuffer>;
  /** From the lowest bits: 10 bits each for x, y and z, and 2 bits for w. The angular error is at most 0.098 degrees. */
  snorm10: Uint32Array<ArrayBuffer>;
  /** x, y, z and the sign. The angular error is at most 0.0016 degrees. */
  snorm16: Int16Array<ArrayBuffer>;
  /** Octahedral coordinates. The lowest bit of the second is the sign. The angular error is at most 0.0057 degrees. */
  octahedral: Int16Array<ArrayBuffer>;
  /** An angle around the normal. The lowest bit is the sign. The angular error is at most 0.0071 degrees. */
  diamond: Uint16Array<ArrayBuffer>;
}

/** The name of an encoding. */
export type TangentEncoding = keyof TangentCodes;

/** The part of a mesh that stays the same when its vertices move, as arrays for the shaders of `darboux/webgpu`. It can be posted to a worker
 * and stored. */
export interface PlanTopology {
  vertexCount: number;
  cornerCount: number;
  /** The number of triangles that are not degenerate. They come first. */
  triangleCount: number;
  /** The number of triangles with two equal positions. */
  degenerateCount: number;
  sumCount: number;
  /** Whether unusable tangents are replaced. */
  repairs: boolean;
  /** The number of vertices whose corners have several tangents. */
  splitVertices: number;
  triangles: Uint32Array<ArrayBuffer>;
  representatives: Uint32Array<ArrayBuffer>;
  sums: Uint32Array<ArrayBuffer>;
  sumOfCorner: Uint32Array<ArrayBuffer>;
  /** Empty if `splitVertices` is not 0. */
  sumOfVertex: Uint32Array<ArrayBuffer>;
}

/** Options of `generateTangents` of `darboux/webgpu`. */
export interface GpuTangentOptions extends MikkTSpaceOptions {
  /** Receives the tangents, 16 bytes per corner from offset 0. Its usage includes COPY_DST. Its content is unspecified after an error. */
  buffer?: GPUBuffer;
}

/** The result of a run on WebGPU. */
export interface GpuTangents extends ReportedTangents {
  /** The number of corners that the CPU computed: rare cases, and corners whose last bits the device's floats leave open. */
  cpuCorners: number;
  /** Why the CPU computed all corners: 'faces' that are not triangles, or 'values' that are not finite, huge, or zeros of different signs. Null
   * where it did not. */
  cpuFallback: 'faces' | 'values' | null;
}
