// MikkTSpace on WebGPU, which `darboux/webgpu` loads when it is asked for: the counterpart of crates/darboux-gpu/src/mikktspace/generate.rs.

import kernels from 'darboux-gpu/mikktspace';
import { triangles, vertices } from 'darboux-gpu/passes';
import { gpuResume, generateTangents as onCpu, ready } from './darboux.js';
import { checkDevice, guarded, read, Room } from './gpu/device.js';
import { filled, USAGE } from './gpu/pipelines.js';
import { checkSize, Program, type Named } from './gpu/pass-program.js';
import type { GpuTangentOptions, GpuTangents, Indices } from './types.js';

/** What each device has compiled. */
const programs = new WeakMap<GPUDevice, Promise<Program>>();

function programOf(device: GPUDevice): Promise<Program> {
  const known = programs.get(device);
  if (known) return known;
  const compiled = Program.soon(device, kernels, [...vertices, ...triangles]).catch((cause: Error) => {
    programs.delete(device);
    throw new Error(`the GPU refused to work: ${cause.message}`, { cause });
  });
  programs.set(device, compiled);
  return compiled;
}

/** As that of `darboux/webgpu`, with all that there is to say. */
export async function generateTangents(
  device: GPUDevice,
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: Indices | null | undefined,
  options: GpuTangentOptions,
): Promise<GpuTangents> {
  checkDevice(device);
  await ready;
  const { buffer } = options;
  const given = gpuResume.begin(positions, normals, uvs, indices, options);
  if (buffer) checkBuffer(buffer, indices?.length ?? positions.length / 3);
  const left = (leftToCpu: GpuTangents['leftToCpu']): GpuTangents => {
    const made = onCpu(positions, normals, uvs, indices, { ...options, returnReport: true });
    return { ...made, cornersOfCpu: made.tangents.length / 4, leftToCpu };
  };
  const onGpu = async (mesh: Mesh): Promise<GpuTangents | null> => {
    const { refused, welded, tangents: begun } = await run(device, mesh, buffer);
    if (refused[0]) return null;
    const { corners: cornersOfCpu, ...made } = gpuResume.complete(positions, normals, uvs, mesh.indices, options, welded, begun);
    return { ...made, cornersOfCpu, leftToCpu: null };
  };
  const made = given ? ((await onGpu({ ...given, positions, normals, uvs })) ?? left('values')) : left('faces');
  if (buffer && made.cornersOfCpu) device.queue.writeBuffer(buffer, 0, made.tangents);
  return made;
}

/** Errors: a buffer that is too small, or cannot be written. */
function checkBuffer({ size, usage }: GPUBuffer, corners: number): void {
  if (size < 16 * corners) throw new RangeError(`the tangents need ${16 * corners} bytes but their buffer has ${size}`);
  if (!(usage & USAGE.COPY_DST)) throw new RangeError('the buffer of tangents was made without GPUBufferUsage.COPY_DST');
}

/** A mesh of triangles. */
interface Mesh extends gpuResume.Begun {
  positions: Float32Array;
  normals: Float32Array;
  uvs: Float32Array;
}

/** What is known when the shaders are done. */
interface Found {
  /** One word: vertices that only the CPU can weld. */
  refused: Uint32Array;
  welded: Uint32Array;
  tangents: Float32Array;
}

async function run(device: GPUDevice, mesh: Mesh, buffer: GPUBuffer | undefined): Promise<Found> {
  const [vertices, corners] = [mesh.vertices, mesh.indices.length];
  if (!vertices || !corners) return { refused: new Uint32Array(1), welded: new Uint32Array(vertices), tangents: new Float32Array(4 * corners) };
  const program = await guarded(device, () => programOf(device));
  const room = new Room(device);
  try {
    const copies = await guarded(device, () => {
      const named = upload(room.device, mesh);
      const steps = program.on(room.device, { vertices, triangles: corners / 3 }, named);
      const encoder = device.createCommandEncoder();
      for (const step of steps) step(encoder);
      if (buffer) encoder.copyBufferToBuffer(named.tangent_of_corner!, 0, buffer, 0, 16 * corners);
      const copies = [named.failure_count!, named.welded_vertex!, named.tangent_of_corner!].map((source) => room.copy(encoder, source));
      device.queue.submit([encoder.finish()]);
      return copies;
    });
    const [refused, welded, tangents] = await Promise.all(copies.map(read));
    return { refused: refused!, welded: welded!, tangents: new Float32Array(tangents!.buffer) };
  } finally {
    room.leave();
  }
}

/** What the passes do not make. */
function upload(device: GPUDevice, mesh: Mesh): Named {
  const { vertices: count, indices, thresholdCosine } = mesh;
  const corners = indices.length;
  checkSize(device, 'vertices', 32 * count);
  const [cosine] = new Uint32Array(Float32Array.of(thresholdCosine).buffer);
  const words = (of: number[]) => Uint32Array.from(of);
  return {
    // The shaders' `Mesh`: 32-bit indices, vertices of positions, normals and UVs in this order without gaps.
    mesh: filled(device, 'mesh', words([count, corners / 3, 0, 0, 8, 0, 3, 6, 0, 0, 0, 0, 0, 0, 0, 0]), USAGE.UNIFORM),
    evaluation: filled(device, 'evaluation', words([corners, cosine!, 0, 0]), USAGE.UNIFORM),
    vertices: filled(device, 'vertices', new Uint32Array(packed(mesh).buffer)),
    indices: filled(device, 'indices', indices instanceof Uint32Array ? indices : Uint32Array.from(indices)),
  };
}

function packed({ positions, normals, uvs, vertices }: Mesh): Float32Array<ArrayBuffer> {
  const packed = new Float32Array(8 * vertices);
  for (let at = 0; at < vertices; at++) {
    for (let i = 0; i < 3; i++) {
      packed[8 * at + i] = positions[3 * at + i]!;
      packed[8 * at + 3 + i] = normals[3 * at + i]!;
    }
    packed[8 * at + 6] = uvs[2 * at]!;
    packed[8 * at + 7] = uvs[2 * at + 1]!;
  }
  return packed;
}
