// Generated from the core. The position of a name in its list is the code that WebAssembly takes.

export const METHODS = ['mikktspace', 'angle-area', 'lengyel', 'lengyel-per-vertex', 'average', 'area', 'face', 'from-normal', 'angle-edge'] as const;
export const MODES = ['repaired', 'reference', 'corrected'] as const;
export const SHADINGS = ['smooth', 'flat'] as const;
export const NORMAL_WEIGHTS = ['angle', 'area', 'angle-area'] as const;
export const SMOOTHING_SEAMS = ['ignored', 'respected'] as const;
export const ENCODINGS = ['snorm8', 'snorm10', 'snorm16', 'octahedral', 'diamond'] as const;
