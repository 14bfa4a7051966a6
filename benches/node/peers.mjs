// One engine of npm on one mesh: `node peers.mjs ENGINE FOLDER`. The folder has positions.f32, normals.f32, uvs.f32 and, for
// an indexed mesh, indices.u32. Answers each line of standard input with a line of JSON: a number runs the engine as often
// and gives nanoseconds, a file's name writes the last tangents there.

import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { createInterface } from 'node:readline';

const [engine, folder] = process.argv.slice(2);

const mesh = {
  positions: floats('positions.f32'),
  normals: floats('normals.f32'),
  uvs: floats('uvs.f32'),
  indices: existsSync(`${folder}/indices.u32`) ? new Uint32Array(bytes('indices.u32')) : null,
};

function bytes(name) {
  const data = readFileSync(`${folder}/${name}`);
  return data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength);
}

function floats(name) {
  return new Float32Array(bytes(name));
}

/** The corners' values of a vertex attribute, for engines that take no indices. Not part of what is timed. */
function expanded(values, width) {
  if (!mesh.indices) return values;
  const result = new Float32Array(mesh.indices.length * width);
  mesh.indices.forEach((vertex, corner) => {
    for (let i = 0; i < width; i++) result[corner * width + i] = values[vertex * width + i];
  });
  return result;
}

function unindexed(generate) {
  const [positions, normals, uvs] = [expanded(mesh.positions, 3), expanded(mesh.normals, 3), expanded(mesh.uvs, 2)];
  return () => generate(positions, normals, uvs);
}

const starters = {
  async 'three.js port'() {
    const { generateTangents } = await import('three/addons/libs/mikktspace.module.js');
    return unindexed(generateTangents);
  },
  async 'npm mikktspace'() {
    const { default: module } = await import('mikktspace');
    return unindexed(module.generateTangents);
  },
  async 'npm meshoptimizer'() {
    const { MeshoptTangents } = await import('meshoptimizer');
    await MeshoptTangents.ready;
    const { positions, normals, uvs, indices } = mesh;
    return () => MeshoptTangents.generateTangents(indices, positions, 3, normals, 3, uvs, 2);
  },
};

const call = await starters[engine]();
let tangents;

function run(count) {
  const [wall, cpu] = [process.hrtime.bigint(), process.cpuUsage()];
  for (let i = 0; i < count; i++) tangents = call();
  const used = process.cpuUsage(cpu);
  return { wall: Number(process.hrtime.bigint() - wall), cpu: 1000 * (used.user + used.system) };
}

console.log('{}');
for await (const line of createInterface({ input: process.stdin })) {
  const answer = /^\d+$/.test(line) ? run(Number(line)) : (writeFileSync(line, tangents), {});
  console.log(JSON.stringify(answer));
}
