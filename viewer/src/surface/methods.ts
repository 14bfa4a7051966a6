// Generated from Rust.

export const METHODS = ['mikktspace', 'angle-area', 'lengyel', 'lengyel-per-vertex', 'average', 'area', 'face', 'from-normal', 'angle-edge'] as const;
