// The functions that tests/browser.test.mjs calls in the page.

import { Document, WebIO } from '@gltf-transform/core';
import * as darboux from 'darboux';
import { tangents } from 'darboux/gltf-transform';
import * as mikktspace from 'darboux/mikktspace';
import { computeTangents } from 'darboux/three';
import { Average, Planner } from 'darboux/webgpu';
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { computeMikkTSpaceTangents } from 'three/addons/utils/BufferGeometryUtils.js';
import { grid, mirrored, seams } from '../meshes.mjs';
import { gpu } from './gpu.mjs';

export { generateTangents, ready } from 'darboux/tangents';
export const { Plan } = darboux;

const SIZE = 64;

/** The normal of every texel of the normal map, in three.js's convention: x 0.6, y 0.48, z 0.64. */
const TEXEL = [0.6, 0.48, 0.64].map((x) => Math.round(255 * (x / 2 + 0.5)));

function geometry([positions, normals, uvs, indices]) {
  const result = new THREE.BufferGeometry().setIndex(new THREE.BufferAttribute(indices, 1));
  result.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  result.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  return result.setAttribute('uv', new THREE.BufferAttribute(uvs, 2));
}

function normalMap() {
  const texture = new THREE.DataTexture(Uint8Array.of(...TEXEL, 255), 1, 1);
  texture.needsUpdate = true;
  return texture;
}

let renderer;

/** Draws a geometry from the front. Returns its pixels, and whether the shader uses tangents. */
function render(geometry, material) {
  renderer ??= new THREE.WebGLRenderer({ antialias: false });
  const scene = new THREE.Scene().add(new THREE.Mesh(geometry, material));
  const light = new THREE.DirectionalLight(0xffffff, 3);
  light.position.set(1, 1, 1);
  scene.add(light);
  const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 10);
  camera.position.z = 5;
  const target = new THREE.WebGLRenderTarget(SIZE, SIZE);
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = new Uint8Array(4 * SIZE * SIZE);
  renderer.readRenderTargetPixels(target, 0, 0, SIZE, SIZE, pixels);
  const gl = renderer.getContext();
  const { vertexShader } = renderer.properties.get(material).currentProgram;
  return { pixels, takesTangents: gl.getShaderSource(vertexShader).includes('#define USE_TANGENT') };
}

/** The normals that are drawn left and right of the mirrored edge, and whether the shader uses tangents. */
function sides(geometry, normalScale = [1, 1]) {
  const material = new THREE.MeshNormalMaterial({ normalMap: normalMap(), normalScale: new THREE.Vector2(...normalScale) });
  const { pixels, takesTangents } = render(geometry, material);
  const at = (x, y) => Array.from(pixels.subarray(4 * (SIZE * y + x)).subarray(0, 3), (code) => code / 127.5 - 1);
  return { left: at(SIZE / 4, (3 * SIZE) / 4), right: at((3 * SIZE) / 4, (3 * SIZE) / 4), takesTangents };
}

/** The mirrored squares with the tangents of each adapter. */
export const mirroredSquares = {
  async 'darboux/three, v down'() {
    return sides(computeTangents(geometry(mirrored()), { flipY: false }));
  },
  async 'darboux/three, v up'() {
    return sides(computeTangents(geometry(mirrored()), { flipY: true }));
  },
  async 'darboux/mikktspace in three.js, v down'() {
    return sides(computeMikkTSpaceTangents(geometry(mirrored()), mikktspace));
  },
  async 'darboux/mikktspace, v up'() {
    const unindexed = geometry(mirrored()).toNonIndexed();
    const arrays = ['position', 'normal', 'uv'].map((name) => unindexed.getAttribute(name).array);
    return sides(unindexed.setAttribute('tangent', new THREE.BufferAttribute(mikktspace.generateTangents(...arrays), 4)));
  },
  async 'darboux/gltf-transform, v down'() {
    const { geometry, material } = await loaded(await glb([tangents()]));
    return sides(geometry, material.normalScale.toArray());
  },
  async 'derivatives, v down'() {
    const { geometry, material } = await loaded(await glb([]));
    return sides(geometry, material.normalScale.toArray());
  },
  async 'derivatives, v up'() {
    return sides(geometry(mirrored()));
  },
};

/** A glTF of the mirrored squares. */
async function glb(transforms) {
  const document = new Document();
  const buffer = document.createBuffer();
  const accessor = (type, array) => document.createAccessor().setBuffer(buffer).setType(type).setArray(array);
  const [positions, normals, uvs, indices] = mirrored();
  const primitive = document.createPrimitive().setIndices(accessor('SCALAR', indices));
  primitive.setAttribute('POSITION', accessor('VEC3', positions)).setAttribute('NORMAL', accessor('VEC3', normals));
  primitive.setAttribute('TEXCOORD_0', accessor('VEC2', uvs)).setMaterial(document.createMaterial());
  document.createScene().addChild(document.createNode().setMesh(document.createMesh().addPrimitive(primitive)));
  await document.transform(...transforms);
  return new WebIO().writeBinary(document);
}

async function loaded(bytes) {
  const { scene } = await new GLTFLoader().parseAsync(bytes.buffer, '');
  return scene.getObjectByProperty('isMesh', true);
}

/** For a coarse sphere with a normal map, the number of pixels that differ from those with derivatives, and from those with rotated tangents. */
export function standardMaterial() {
  const sphere = () => new THREE.SphereGeometry(0.9, 12, 8);
  const turned = computeTangents(sphere(), { flipY: true });
  const { array } = turned.getAttribute('tangent');
  for (let at = 0; at < array.length; at += 4) array.subarray(at, at + 3).forEach((x, i) => (array[at + i] = -x));
  const pictures = [sphere(), computeTangents(sphere(), { flipY: true }), turned].map((geometry) =>
    render(geometry, new THREE.MeshStandardMaterial({ normalMap: normalMap(), roughness: 0.4 })),
  );
  const [derivatives, ours, other] = pictures.map(({ pixels }) => pixels);
  const differing = (a, b) => Array.from({ length: SIZE * SIZE }, (_, at) => 4 * at).filter((at) => [0, 1, 2].some((i) => Math.abs(a[at + i] - b[at + i]) > 8)).length;
  return {
    drawn: ours.filter((code, at) => at % 4 === 3 && code).length,
    fromDerivatives: differing(ours, derivatives),
    fromTurned: differing(ours, other),
    takesTangents: pictures.map(({ takesTangents }) => takesTangents),
  };
}

/** Tangents per vertex of a grid with one unused vertex, by WebGPU and by the CPU; null without an adapter. */
export async function averages(method, indexFormat) {
  const found = await gpu();
  if (!found) return null;
  const { device, errors, filled, read } = found;
  const [positions, normals, uvs, indices] = grid(100, 70);
  const vertexCount = positions.length / 3;
  const interleaved = new Float32Array(8 * vertexCount);
  for (let at = 0; at < vertexCount; at++) {
    interleaved.set([...uvs.subarray(2 * at, 2 * at + 2), ...positions.subarray(3 * at, 3 * at + 3), ...normals.subarray(3 * at, 3 * at + 3)], 8 * at);
  }
  const list = indexFormat === 'uint16' ? Uint16Array.from(indices) : indices;
  const frames = filled(new Float32Array(7 * vertexCount));
  const mesh = { vertices: filled(interleaved), vertexCount, stride: 32, position: 8, normal: 20, uv: 0, indices: filled(list), indexFormat, indexCount: list.length };
  const work = new Average(device, method).ofMesh(mesh, { buffer: frames, stride: 28, tangent: 0, sign: 12, bitangent: 16 });
  const [words, counts] = await read((encoder) => work.record(encoder), [frames, work.counts]);
  const ofVertex = new Float32Array(words.buffer);
  const ofCorner = darboux.generateTangents(positions, normals, uvs, indices, { method });
  const ours = Float32Array.from({ length: ofCorner.length }, (_, at) => ofVertex[7 * indices[at >> 2] + (at & 3)]);
  return { errors, counts: Array.from(counts), difference: darboux.measureTangents(ours, ofCorner) };
}

/** Plans a grid that moves and shrinks. Returns the number of corners with other bits on WebGPU than on the CPU. */
export async function plans(per, options, name, scale = 1) {
  const found = await gpu();
  if (!found) return null;
  const { device, errors, filled, read } = found;
  const mesh = MESHES[name]();
  const [positions, normals, , indices] = mesh;
  const moved = positions.map((x, at) => scale * (x + (at % 3 === 2 ? Math.sin(positions[at - 2] / 3) : 0)));
  const vertexCount = positions.length / 3;
  const outputs = per === 'corner' ? indices.length : vertexCount;
  // One buffer for positions, normals and, where there is one tangent per vertex, tangents.
  const vertices = new Float32Array(10 * vertexCount);
  for (let at = 0; at < vertexCount; at++) {
    vertices.set(moved.subarray(3 * at, 3 * at + 3), 10 * at);
    vertices.set(normals.subarray(3 * at, 3 * at + 3), 10 * at + 3);
  }
  const buffer = filled(vertices);
  const part = (offset) => ({ buffer, stride: 40, offset });
  const tangents = per === 'corner' ? { buffer: filled(new Float32Array(4 * outputs)), stride: 16, offset: 0 } : part(24);
  const plan = new Planner(device).plan(darboux.planTopology(...mesh, options));
  const work = plan.bind({ positions: part(0), normals: part(12), tangents, per });
  const [words, counts] = await read((encoder) => work.record(encoder), [tangents.buffer, work.counts]);
  const ours = new Float32Array(words.buffer);
  const theirs = new darboux.Plan(...mesh, options).evaluate(moved, normals);
  const of = (corner, i) => (per === 'corner' ? ours[4 * corner + i] : ours[10 * indices[corner] + 6 + i]);
  const differs = (corner) => [0, 1, 2, 3].some((i) => !Object.is(of(corner, i), theirs[4 * corner + i]));
  const differing = Array.from(indices.keys()).filter(differs).length;
  return { errors, counts: Array.from(counts), corners: indices.length, differing };
}

/** The errors of a plan for buffers that do not fit. */
export async function refusals() {
  const found = await gpu();
  if (!found) return null;
  const buffer = found.filled(new Float32Array(60));
  const part = (offset, stride = 40) => ({ buffer, stride, offset });
  const plan = new Planner(found.device).plan(darboux.planTopology(...mirrored()));
  const said = (mesh) => {
    try {
      plan.bind({ positions: part(0), normals: part(12), tangents: part(24), per: 'corner', ...mesh });
    } catch (error) {
      return `${error.name}: ${error.message}`;
    }
  };
  return [said({ per: 'vertex' }), said({ positions: part(2) }), said({ tangents: part(8) }), said({}), found.errors];
}

const MESHES = { waves: () => grid(60, 40), seams };
