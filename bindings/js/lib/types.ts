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
