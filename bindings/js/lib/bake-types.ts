// The meshes, options and results of `darboux/bake`.

import type { BITANGENTS, ID_SOURCES, MAP_KINDS, OCCLUSION_FALLOFFS, OCCLUSION_WEIGHTS, PART_MATCHES } from './core/choices.js';
import type { Convention, Indices } from './types.js';

/** A kind of image. `darboux bake --help` says what each is. */
export type MapKind = (typeof MAP_KINDS)[number];

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
  /** Rays begin on the mesh with its vertices moved to these positions, 3 per vertex, in place of the inflated copy; they end as far inside as `cageOffset` or `distance` says. */
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

/** Options of `bake`. */
export interface BakeOptions {
  /** Width and height in texels. Default: [1024, 1024]. */
  size?: readonly [number, number] | null;
  /** Rays begin on a copy of the low model, inflated by this distance, and end as far inside. Default: 2 % of the model's diagonal. */
  cageOffset?: number | null;
  /**
   * Rays begin on a cage that is made for the models: at every vertex as close as all but this share of the rays around allows, such as 0.001. Detail that
   * stands on the surface lies inside it, and what stands over it behind a gap outside. It is at most `cageOffset` away; default for that: 10 % of the diagonal.
   */
  autoCage?: number | null;
  /** Turns rays to the normals of the low model's triangles, from 0, not at all, to 1. Default: 0. */
  skew?: number | null;
  /** In place of a cage: how far outside rays begin along the normals, and how far inside they end, in units of the positions. */
  distance?: readonly [number, number] | null;
  /** The images that are made; they share rays. Default: ['normal']. */
  maps?: readonly MapKind[] | null;
  /** Samples per texel and axis, 1 to 16. Default: 1. */
  samples?: number | null;
  /** How the renderer rebuilds the bitangent. Default: 'pixel'. */
  bitangent?: (typeof BITANGENTS)[number] | null;
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
  aoFalloff?: (typeof OCCLUSION_FALLOFFS)[number] | null;
  /** How the directions of occlusion and bent normals are weighted. Default: 'cosine'. */
  aoWeights?: (typeof OCCLUSION_WEIGHTS)[number] | null;
  /** How far the other side is looked for by 'thickness'. Default: any distance. */
  thicknessDistance?: number | null;
  /** The radius of 'curvature', in `curvatureUnit`. Default: 4. */
  curvatureRadius?: number | null;
  /** Default: 'texels'. */
  curvatureUnit?: 'texels' | 'distance' | null;
  /** The direction of 'world-direction', along the axes of the meshes. Default: [0, 1, 0]. */
  worldDirection?: readonly [number, number, number] | null;
  /** The tile of the UV plane that is baked, 1001 + column + 10 * row, as `udimTiles` names them. Default: all tiles lie over each other. */
  udim?: number | null;
  /** The convention of the meshes, whose UVs and axes it describes. Default: 'gltf', which models are in. */
  meshConvention?: Convention | null;
  /** Called while the call runs, with the finished part from 0 to 1. */
  onProgress?: ((done: number) => void) | null;
}

/** Options of `bakeModels`. */
export interface BakeModelsOptions extends Omit<BakeOptions, 'meshConvention'> {
  /** The bytes of a cage: the low model with its vertices moved, on which rays begin; they end as far inside as `cageOffset` says. */
  cage?: Uint8Array | null;
  /** The index of the only material of the low model that is baked. Default: all. */
  material?: number | null;
  /** The n of `TEXCOORD_n`. Default: the set that the normal map of each material uses. */
  uvSet?: number | null;
  /** 'name': the part `crate_low` is baked from `crate_high` and `crate_high_bolts` only. Default: 'nearest'. */
  match?: (typeof PART_MATCHES)[number] | null;
  /** Whether the normal maps of the high models count. Default: true. */
  highMaps?: boolean | null;
  /** Whether parts of the high models are occluded by themselves only. Default: false. */
  aoOwnPart?: boolean | null;
  /** What the colours of 'id' stand for. Default: 'material'. */
  idFrom?: (typeof ID_SOURCES)[number] | null;
  /** The texture of the map 'texture': its place in the JSON of the high models' materials, such as 'occlusionTexture'. */
  texture?: string | null;
}

/** Options of `PreparedModels`: what all bakes of its models share. */
export type PreparedModelsOptions = Pick<BakeModelsOptions, 'maps' | 'material' | 'uvSet' | 'match' | 'highMaps' | 'texture'>;

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

/** The result of `bake` and `bakeModels`. */
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

/** A normal map, 3 numbers per texel, the top row first: codes of 8 or 16 bits as a file has them, or components from -1 to 1. Lengths do not count. */
export type NormalTexels = Uint8Array | Uint16Array | Float32Array;

/** Options of `verify`: those of the bake that count. */
export interface VerifyOptions extends Pick<BakeOptions, 'cageOffset' | 'autoCage' | 'skew' | 'distance' | 'bitangent' | 'convention' | 'backFaces' | 'udim' | 'meshConvention' | 'onProgress'> {
  /** The map as it is in its file. Default: the map of the bake. */
  written?: NormalTexels | null;
}

/** Options of `verifyModels`: those of the bake that count. */
export interface VerifyModelsOptions extends Omit<VerifyOptions, 'meshConvention'>, Pick<BakeModelsOptions, 'cage' | 'material' | 'uvSet' | 'match' | 'highMaps'> {}

/** Statistics of angles in degrees. All are 0 where there are no points. */
export interface ErrorStatistics {
  points: number;
  median: number;
  mean: number;
  /** 95 % of the angles are smaller. */
  p95: number;
  /** 99 % of the angles are smaller. */
  p99: number;
  worst: number;
}

/** The angles between what a renderer shows and the normals of the high model. */
export interface Verification {
  /** Of all points. */
  all: ErrorStatistics;
  /** Between the written map and the map before its components were rounded. */
  rounding: ErrorStatistics;
  /** Where the filter reads texels with hits of their own: resolution and rounding. */
  inside: ErrorStatistics;
  /** Where it also reads texels outside the chart. */
  border: ErrorStatistics;
  /** Where it also reads texels whose rays missed. */
  missed: ErrorStatistics;
  /** Where it reads texels that another triangle owns. */
  overlap: ErrorStatistics;
  /** What a renderer with the other `bitangent` would show. */
  otherBitangent: ErrorStatistics;
  /** With green the other way. */
  otherGreen: ErrorStatistics;
  /** With normal and tangent normalised per pixel. */
  normalisedFrame: ErrorStatistics;
  /** Of each part of the low model. */
  parts: (ErrorStatistics & { name: string })[];
  /** Points whose ray hits nothing, so that there is nothing to compare with. */
  pointsWithoutHit: number;
  pointsWithoutFrame: number;
  /** Width and height of `heat`. */
  heatSize: [number, number];
  /** The largest error around each texel in degrees; NaN where no point lies. */
  heat: Float32Array<ArrayBuffer>;
}

/** Options of `convertSpace`. */
export interface ConvertSpaceOptions extends Pick<BakeOptions, 'bitangent' | 'convention' | 'padding' | 'udim' | 'meshConvention'> {
  /** Width and height in texels. */
  size: readonly [number, number];
  /** The space of the result; the map is in the other one. */
  to: 'tangent' | 'object';
  /** The convention of the map; `convention` is that of the result. Default: 'gltf'. */
  sourceConvention?: Convention | null;
}

/** Options of `convertSpaceOfModel`. */
export interface ConvertSpaceOfModelOptions extends Omit<ConvertSpaceOptions, 'meshConvention'>, Pick<BakeModelsOptions, 'material' | 'uvSet'> {}

/** The result of `convertSpace`. */
export interface ConvertedSpace {
  /** Unit normals, 3 floats per texel, the top row first. */
  texels: Float32Array<ArrayBuffer>;
  /** Texels that the charts cover. */
  chartedTexels: number;
  /** Texels that more than one triangle covers. The first triangle's frame counts. */
  overlappingTexels: number;
  /** Texels without a frame, or where the map holds no direction. */
  invalidTexels: number;
}
