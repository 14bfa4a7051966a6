// MikkTSpace of whole meshes on WebGPU, loaded by the first call of `generateTangents` of `darboux/webgpu`. The native counterpart is
// crates/darboux-gpu/src/mikktspace/generate.rs.
//
//   upload the mesh; run the passes of `vertices` (weld) and `triangles` (groups, tangents)
//   read back: whether the device refused the mesh, the welded vertices, the tangents
//   the CPU computes what the device left open (`gpuResume`), or everything where the device refused

import kernels from 'darboux-gpu/mikktspace';
import { triangles, vertices } from 'darboux-gpu/passes';
import { generateTangents as generateOnCpu, gpuResume, ready } from './darboux.js';
import { CallBuffers, checkDevice, readBuffer, reportingErrors } from './gpu/device.js';
import { checkBufferSize, PassProgram, type NamedBuffers } from './gpu/pass-program.js';
import { BUFFER_USAGE, filledBuffer } from './gpu/pipelines.js';
import type { GpuTangentOptions, GpuTangents, Indices } from './types.js';

/** The compiled passes of each device. */
const programs = new WeakMap<GPUDevice, Promise<PassProgram>>();

function programOf(device: GPUDevice): Promise<PassProgram> {
  const cached = programs.get(device);
  if (cached) return cached;
  const compiled = PassProgram.compile(device, kernels, [...vertices, ...triangles]).catch((cause: Error) => {
    programs.delete(device);
    throw new Error(`the GPU refused to work: ${cause.message}`, { cause });
  });
  programs.set(device, compiled);
  return compiled;
}

/** `generateTangents` of `darboux/webgpu`; always with the report. */
export async function generateTangents(
  device: GPUDevice,
  positions: Float32Array,
  normals: Float32Array,
  uvs: Float32Array,
  indices: Indices | null | undefined,
  options: GpuTangentOptions | null | undefined,
): Promise<GpuTangents> {
  checkDevice(device);
  await ready;
  const buffer = options?.buffer;
  const input = gpuResume.checkGpuInput(positions, normals, uvs, indices, options);
  if (buffer) checkOutputBuffer(buffer, indices?.length ?? positions.length / 3);
  const onCpu = (cpuFallback: GpuTangents['cpuFallback']): GpuTangents => {
    const result = generateOnCpu(positions, normals, uvs, indices, { ...options, returnReport: true });
    return { ...result, cpuCorners: result.tangents.length / 4, cpuFallback };
  };
  const onGpu = async (mesh: Mesh): Promise<GpuTangents | null> => {
    const { refused, welded, tangents: started } = await runPasses(device, mesh, buffer);
    if (refused[0]) return null;
    const { corners: cpuCorners, ...result } = gpuResume.complete(positions, normals, uvs, mesh.indices, options, welded, started);
    return { ...result, cpuCorners, cpuFallback: null };
  };
  const result = input ? ((await onGpu({ ...input, positions, normals, uvs })) ?? onCpu('values')) : onCpu('faces');
  if (buffer && result.cpuCorners) device.queue.writeBuffer(buffer, 0, result.tangents);
  return result;
}

/** Errors: a buffer that is too small or that cannot be copied to. */
function checkOutputBuffer({ size, usage }: GPUBuffer, corners: number): void {
  if (size < 16 * corners) throw new RangeError(`the tangents need ${16 * corners} bytes but their buffer has ${size}`);
  if (!(usage & BUFFER_USAGE.COPY_DST)) throw new RangeError('the buffer of tangents was made without GPUBufferUsage.COPY_DST');
}

/** A mesh of triangles. */
interface Mesh extends gpuResume.GpuInput {
  positions: Float32Array;
  normals: Float32Array;
  uvs: Float32Array;
}

/** The results of the passes. */
interface PassResults {
  /** One word, not 0 where only the CPU can weld the vertices. */
  refused: Uint32Array;
  /** For each vertex, the first vertex that equals it. */
  welded: Uint32Array;
  tangents: Float32Array;
}

async function runPasses(device: GPUDevice, mesh: Mesh, output: GPUBuffer | undefined): Promise<PassResults> {
  const [vertices, corners] = [mesh.vertices, mesh.indices.length];
  if (!vertices || !corners) return { refused: new Uint32Array(1), welded: new Uint32Array(vertices), tangents: new Float32Array(4 * corners) };
  const program = await reportingErrors(device, () => programOf(device));
  const buffers = new CallBuffers(device);
  try {
    const copies = await reportingErrors(device, () => {
      const named = upload(buffers.device, mesh);
      const steps = program.bind(buffers.device, { vertices, triangles: corners / 3 }, named);
      const encoder = device.createCommandEncoder();
      for (const record of steps) record(encoder);
      if (output) encoder.copyBufferToBuffer(named.tangent_of_corner!, 0, output, 0, 16 * corners);
      const copies = [named.failure_count!, named.welded_vertex!, named.tangent_of_corner!].map((source) => buffers.copy(encoder, source));
      device.queue.submit([encoder.finish()]);
      return copies;
    });
    const [refused, welded, tangents] = await Promise.all(copies.map(readBuffer));
    return { refused: refused!, welded: welded!, tangents: new Float32Array(tangents!.buffer) };
  } finally {
    buffers.destroy();
  }
}

/** The input buffers of the passes. */
function upload(device: GPUDevice, mesh: Mesh): NamedBuffers {
  const { vertices: count, indices, thresholdCosine } = mesh;
  const corners = indices.length;
  checkBufferSize(device, 'vertices', 32 * count);
  const [cosine] = new Uint32Array(Float32Array.of(thresholdCosine).buffer);
  const words = (values: number[]) => Uint32Array.from(values);
  return {
    // The struct `Mesh` of the shaders: 32-bit indices, and vertices of position, normal and UV without padding.
    mesh: filledBuffer(device, 'mesh', words([count, corners / 3, 0, 0, 8, 0, 3, 6, 0, 0, 0, 0, 0, 0, 0, 0]), BUFFER_USAGE.UNIFORM),
    evaluation: filledBuffer(device, 'evaluation', words([corners, cosine!, 0, 0]), BUFFER_USAGE.UNIFORM),
    vertices: filledBuffer(device, 'vertices', new Uint32Array(interleaved(mesh).buffer)),
    indices: filledBuffer(device, 'indices', indices instanceof Uint32Array ? indices : Uint32Array.from(indices)),
  };
}

/** Position, normal and UV of each vertex: 8 floats. */
function interleaved({ positions, normals, uvs, vertices }: Mesh): Float32Array<ArrayBuffer> {
  const result = new Float32Array(8 * vertices);
  for (let at = 0; at < vertices; at++) {
    for (let i = 0; i < 3; i++) {
      result[8 * at + i] = positions[3 * at + i]!;
      result[8 * at + 3 + i] = normals[3 * at + i]!;
    }
    result[8 * at + 6] = uvs[2 * at]!;
    result[8 * at + 7] = uvs[2 * at + 1]!;
  }
  return result;
}
