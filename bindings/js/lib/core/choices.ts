// Generated from Rust. The position of a name in its list is the code that WebAssembly takes.

export const METHODS = ['mikktspace', 'angle-area', 'lengyel', 'lengyel-per-vertex', 'average', 'area', 'face', 'from-normal', 'angle-edge'] as const;
export const MODES = ['repaired', 'reference', 'corrected'] as const;
export const SHADINGS = ['smooth', 'flat'] as const;
export const NORMAL_WEIGHTS = ['angle', 'area', 'angle-area'] as const;
export const SMOOTHING_SEAMS = ['ignored', 'respected'] as const;
export const ENCODINGS = ['snorm8', 'snorm10', 'snorm16', 'octahedral', 'diamond'] as const;
export const TANGENT_ENCODINGS = ['f32x4', 'snorm16x4', 'snorm8x4'] as const;
export const ASSUMED_MAPS = ['opengl', 'directx', 'red-inverted', 'both-inverted'] as const;
export const MAP_CONVENTIONS = ['opengl', 'directx'] as const;
export const MAP_KINDS = ['normal', 'object-normal', 'height', 'ao', 'position', 'bent-normal', 'object-bent-normal', 'thickness', 'curvature', 'id', 'vertex-color', 'base-color', 'opacity', 'roughness', 'metalness', 'emission', 'texture', 'world-direction', 'uv-islands', 'wireframe'] as const;
export const BITANGENTS = ['pixel', 'vertex'] as const;
export const OCCLUSION_FALLOFFS = ['none', 'linear', 'quadratic'] as const;
export const OCCLUSION_WEIGHTS = ['cosine', 'uniform'] as const;
export const ID_SOURCES = ['material', 'mesh', 'part', 'vertex-color'] as const;
export const PART_MATCHES = ['nearest', 'name'] as const;
export const CONVENTIONS = ['gltf', 'opengl', 'directx', 'blender', 'unity', 'unreal', 'godot', 'threejs', 'maya', '3dsmax'] as const;

/** Numbers per texel of each of {@link MAP_KINDS}. */
export const MAP_CHANNELS = [3, 3, 1, 1, 3, 3, 3, 1, 1, 3, 4, 3, 1, 1, 1, 3, 4, 3, 3, 1] as const;
