// What crates/darboux-gpu lists for other languages (shaders/*.json), as build.mjs embeds it: texts in place of files.

declare module 'darboux-gpu/kernels' {
  type Kernel = 'adjacency' | 'average' | 'scan' | 'terms' | 'gather' | 'repair' | 'write';
  const kernels: Readonly<Record<Kernel, readonly string[]>>;
  export default kernels;
}

/** The kernels of the passes. */
declare module 'darboux-gpu/mikktspace' {
  const kernels: Readonly<Record<string, readonly string[]>>;
  export default kernels;
}

declare module 'darboux-gpu/passes' {
  /** The element that there is one thread or a number of words for. */
  type Domain = 'mesh' | 'vertex' | 'slot' | 'triangle' | 'corner';
  interface Entry {
    kernel: string;
    entry: string;
  }
  /** With the names of its buffers by binding, and what runs over the list of what it was unsure of. */
  interface Run extends Entry {
    domain: Domain;
    buffers: Readonly<Record<string, string>>;
    unsure?: Run;
  }
  type Pass = { clear: string } | { scan: string; domain: Domain } | Run;

  /** What every shader's text begins with: threads of a group, values of a prefix sum's thread and block, limits of dispatches and loops. */
  const constants: Readonly<Record<'WORKGROUP' | 'VALUES_PER_THREAD' | 'BLOCK' | 'MAX_GROUPS' | 'MAX_ITERATIONS', number>>;
  /** For each buffer, its domain and its words per element. */
  const buffers: Readonly<Record<string, readonly [Domain, number]>>;
  const vertices: readonly Pass[];
  const adjacency: readonly Pass[];
  const triangles: readonly Pass[];
  export { adjacency, buffers, constants, triangles, vertices, type Domain, type Entry, type Pass, type Run };
}
