// The types of the shader lists of crates/darboux-gpu (shaders/*.json). build.mjs embeds them with the text of each file in place of its name.

declare module 'darboux-gpu/kernels' {
  type Kernel = 'adjacency' | 'average' | 'lengyel' | 'scan' | 'terms' | 'gather' | 'repair' | 'write';
  const kernels: Readonly<Record<Kernel, readonly string[]>>;
  export default kernels;
}

/** The kernels of MikkTSpace on whole meshes. */
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
  /** A dispatch: the names of its buffers by binding, and the kernel that computes the items that it left open. */
  interface Run extends Entry {
    domain: Domain;
    buffers: Readonly<Record<string, string>>;
    unsure?: Run;
  }
  type Pass = { clear: string } | { scan: string; domain: Domain } | Run;

  /** The constants that every shader begins with: workgroup size, values of a prefix sum per thread and per block, limits of dispatches and
   * loops. */
  const constants: Readonly<Record<'WORKGROUP' | 'VALUES_PER_THREAD' | 'BLOCK' | 'MAX_GROUPS' | 'MAX_ITERATIONS', number>>;
  /** For each buffer, its domain and its words per element. */
  const buffers: Readonly<Record<string, readonly [Domain, number]>>;
  const vertices: readonly Pass[];
  const adjacency: readonly Pass[];
  const triangles: readonly Pass[];
  export { adjacency, buffers, constants, triangles, vertices, type Domain, type Entry, type Pass, type Run };
}
