// The shaders of crates/darboux-gpu that run here, by its list of files (shaders/kernels.json), as build.mjs embeds them.
declare module 'darboux-gpu/kernels' {
  type Kernel = 'adjacency' | 'average' | 'scan' | 'terms' | 'gather' | 'repair' | 'write';
  const kernels: Readonly<Record<Kernel, readonly string[]>>;
  export default kernels;
}
