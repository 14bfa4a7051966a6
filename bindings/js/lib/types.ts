// What users pass, as types.

/** The vertex of each corner. */
export type Indices = Uint8Array | Uint16Array | Uint32Array;

/** Corners per face: 3, 4, or those of every face. */
export type Faces = 3 | 4 | Uint32Array;

/**
 * 'reference': every bit of mikktspace.c, its defects included; 'repaired': the same but for unusable tangents; 'corrected': its known
 * defects corrected as well.
 */
export type Mode = 'reference' | 'repaired' | 'corrected';

/** What generateTangents does; the defaults are right for normal maps from today's bakers. */
export interface MikkTSpaceOptions {
  /** Default: 'repaired'. */
  mode?: Mode;
  /** Degrees; faces around a vertex share a tangent while their tangents and their bitangents differ by less. Default: 180. */
  threshold?: number;
  /** Default: 3. Faces of other than 3 or 4 corners get tangents from their normals alone. */
  faces?: Faces;
}

/** How tangents are computed; normal maps need the method that they were baked with, nearly always 'mikktspace'. */
export type Method =
  | 'mikktspace'
  | 'angle-area'
  | 'lengyel'
  | 'lengyel-per-vertex'
  | 'average'
  | 'area'
  | 'face'
  | 'from-normal';

/** What generateTangents of `darboux` does; `threshold` belongs to 'mikktspace'. */
export interface TangentOptions extends MikkTSpaceOptions {
  /** Default: 'mikktspace'. */
  method?: Method;
}

/** What a run met. Quads count as the two triangles that they are split into. */
export interface Report {
  triangles: number;
  /** Faces of other than 3 or 4 corners. */
  unsupportedFaces: number;
  /** Triangles with two equal positions. */
  degenerateTriangles: number;
  /** Triangles, not degenerate, whose UVs span no area. */
  uvDegenerateTriangles: number;
  /** Corners with a NaN or an infinity in position, normal or UV. */
  nonFiniteCorners: number;
  /** Corners whose reference tangent is absent or unusable; replaced, but for the mode 'reference'. */
  repairedCorners: number;
  /** Faces whose corners carry both signs; the mode 'corrected' gave them one. */
  mixedSignFaces: number;
  /** Edges between two triangles of opposite UV orientation. */
  mirroredEdges: number;
  /** Vertices that need more than one tangent: what splitVertices splits. */
  splitVertices: number;
  /** Vertices at which both UV orientations share one tangent: seams that 'lengyel-per-vertex' breaks. */
  mergedVertices: number;
}

/** Tangents of corners and the report of the run. */
export interface ReportedTangents {
  /** 4 per corner. */
  tangents: Float32Array<ArrayBuffer>;
  report: Report;
}

/** The whole frame of every corner, and the report of the run. */
export interface Frames {
  /** 4 per corner: the direction of increasing u, unit, and the sign w, -1 where the UV map mirrors. */
  tangents: Float32Array<ArrayBuffer>;
  /** 3 per corner: the direction of increasing v, unit, perpendicular to the normal but not always to the tangent. */
  bitangents: Float32Array<ArrayBuffer>;
  /** 2 per corner: world units per unit of u and per unit of v. */
  magnitudes: Float32Array<ArrayBuffer>;
  report: Report;
}

/** An indexed mesh's vertices after splitting. */
export interface VertexSplit {
  /** 4 per new vertex; (1, 0, 0, 1) where no corner uses it. */
  tangentOfVertex: Float32Array<ArrayBuffer>;
  /** The new index list, in the old corner order. */
  indices: Uint32Array<ArrayBuffer>;
  /** The old vertex that each new vertex copies: new = old[sourceOfVertex], for every other attribute. */
  sourceOfVertex: Uint32Array<ArrayBuffer>;
}

export interface NormalOptions {
  /** Default: 'smooth'. */
  shading?: 'flat' | 'smooth';
  /** How much each face counts at a vertex, where shading is smooth. Default: 'angle'. */
  weight?: 'angle' | 'area' | 'angle-area';
  /** Degrees; smooth shading stops at edges whose faces' normals differ by more. Default: 180, nowhere. */
  crease?: number;
  /** 'ignored': vertices at equal positions are one; 'respected': only the index list joins. Default: 'ignored'. */
  seams?: 'ignored' | 'respected';
  /** Default: 3. Any size from 3 on. */
  faces?: Faces;
}

/** How two sets of tangents differ. Angles are between the xyz of a corner in both, in degrees. */
export interface TangentDifference {
  corners: number;
  /** Corners whose four floats are the same bits. */
  identical: number;
  /** Corners whose signs differ. */
  signFlips: number;
  /** Corners where a tangent is zero or not finite. They are in none of the numbers below. */
  withoutAngle: number;
  mean: number;
  min: number;
  median: number;
  /** The angle that 95 corners in 100 do not exceed. */
  p95: number;
  max: number;
  /** Corners per bin; the bins end at 0, 0.001, 0.01, 0.1, 1, 5, 15, 45, 90 and 180 degrees. */
  histogram: number[];
  /** The corners with the largest angles, at most 16, the largest first. */
  worst: { corner: number; angle: number }[];
}

/** The array that each encoding has: 4, 1, 4, 2 and 1 elements per tangent. */
export interface TangentCodes {
  /** x, y, z and the sign; directions turn by up to 0.40 degrees. */
  snorm8: Int8Array<ArrayBuffer>;
  /** 10 bits each for x (the lowest), y and z, 2 for w; directions turn by up to 0.098 degrees. */
  snorm10: Uint32Array<ArrayBuffer>;
  /** Directions turn by up to 0.0016 degrees. */
  snorm16: Int16Array<ArrayBuffer>;
  /** The sign is the lowest bit of the second; directions turn by up to 0.0057 degrees. */
  octahedral: Int16Array<ArrayBuffer>;
  /** An angle around the normal and, as the lowest bit, the sign; directions turn by up to 0.0071 degrees. */
  diamond: Uint16Array<ArrayBuffer>;
}

/** Names of encodings. */
export type TangentEncoding = keyof TangentCodes;

/** What of a mesh does not move when its vertices do, as the shaders of `darboux/webgpu` read it. Data: it may be posted and stored. */
export interface PlanTopology {
  vertexCount: number;
  cornerCount: number;
  /** Triangles without those that have two equal positions, which come after them. */
  triangleCount: number;
  degenerateCount: number;
  sumCount: number;
  /** Whether unusable tangents are replaced. */
  repairs: boolean;
  /** Vertices whose corners have several tangents. */
  splitVertices: number;
  triangles: Uint32Array<ArrayBuffer>;
  representatives: Uint32Array<ArrayBuffer>;
  sums: Uint32Array<ArrayBuffer>;
  sumOfCorner: Uint32Array<ArrayBuffer>;
  /** Empty where there are split vertices. */
  sumOfVertex: Uint32Array<ArrayBuffer>;
}

/** What generateTangents of `darboux/webgpu` does. */
export interface GpuTangentOptions extends MikkTSpaceOptions {
  /** Receives the tangents, 16 bytes per corner from its start on; with the usage COPY_DST. After an error it may hold anything. */
  buffer?: GPUBuffer;
}

/** What a run on WebGPU met. */
export interface GpuTangents extends ReportedTangents {
  /** Corners that the CPU did: rare cases, and what the device's floats leave open. */
  cornersOfCpu: number;
  /** Why the CPU did them all, if it did: faces that are not triangles; values that are not finite, huge, or zeros whose signs differ. */
  leftToCpu: 'faces' | 'values' | null;
}
