// `darboux`: every function, its bits, arguments and errors.

import assert from 'node:assert/strict';
import { test } from 'node:test';
import * as esm from 'darboux';
import { bits, corpus, native } from './corpus.mjs';
import { formsOf } from './forms.mjs';
import { square } from './meshes.mjs';

const forms = await formsOf('darboux');
const METHODS = ['mikktspace', ...Object.keys(corpus[0].answer.methods)].filter((method) => method !== 'from-normal');

/** A strip of two squares that meet at right angles, wound outwards. */
const bend = () => [Float32Array.of(0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, -1, 1, 1, -1), Uint16Array.of(0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2)];

for (const [name, darboux] of Object.entries(forms)) {
  const { generateTangents, generateFrames, Plan, splitVertices, generateNormals, measureTangents, encodeTangents, decodeTangents } = darboux;

  test(`${name}: tangents and vertices of the corpus have the bits of the native library`, () => {
    for (const { name, arrays, options, answer } of corpus) {
      const tangents = generateTangents(...arrays, options);
      assert.deepEqual(bits(tangents), native(answer.tangents), name);
      // Splits compare bits, and those of NaN depend on the processor.
      if (tangents.some(Number.isNaN)) continue;
      const split = splitVertices(arrays[3], tangents, arrays[0].length / 3);
      assert.deepEqual(Array.from(split.indices), answer.split_indices, name);
      assert.deepEqual(Array.from(split.sourceOfVertex), answer.split_sources, name);
      assert.deepEqual(bits(split.tangentOfVertex), native(answer.split_tangents), name);
    }
  });

  test(`${name}: frames, plans and every method have the bits of the native library on the corpus`, () => {
    for (const { name, arrays, options, answer } of corpus) {
      const frames = generateFrames(...arrays, options);
      assert.deepEqual(bits(frames.tangents), native(answer.frames), name);
      assert.deepEqual(bits(frames.bitangents), native(answer.bitangents), name);
      assert.deepEqual(bits(frames.magnitudes), native(answer.magnitudes), name);
      const plan = new Plan(...arrays, options);
      assert.deepEqual(bits(plan.base), native(answer.tangents), name);
      assert.equal(plan.report.repairedCorners, answer.repaired, name);
      assert.deepEqual(bits(plan.evaluate(answer.moved, arrays[1])), native(answer.planned), name);
      const { faces } = options;
      for (const [method, tangents] of Object.entries(answer.methods)) {
        assert.deepEqual(bits(generateTangents(...arrays, { method, faces })), native(tangents), `${name}, ${method}`);
      }
    }
  });

  test(`${name}: a report counts`, () => {
    const [positions, normals, uvs, indices] = square();
    const { tangents, report } = generateTangents(positions, normals, uvs.map((x) => 0 * x), indices, { returnReport: true });
    assert.equal(tangents.length, 24);
    assert.deepEqual([report.triangles, report.uvDegenerateTriangles, report.degenerateTriangles], [2, 2, 0]);
    assert.equal(generateFrames(...square()).report.triangles, 2);
  });

  test(`${name}: a plan keeps its groups, and counts what a fresh run would change`, () => {
    const [positions, normals, uvs, indices] = square();
    const plan = new Plan(...square());
    generateTangents(normals, normals, uvs, indices); // other calls do not disturb it
    const turned = positions.map((_, at) => [-positions[at + 1], positions[at - 1], positions[at]][at % 3]);
    assert.deepEqual(values(plan.evaluate(turned, normals)), Array.from({ length: 6 }, () => [0, 1, 0, 1]).flat());
    assert.equal(plan.countRegrouped(turned, normals), 0);
    assert.throws(() => plan.evaluate(positions.slice(3), normals), /^RangeError: positions has 3 elements but the plan has 4 vertices$/);
  });

  test(`${name}: every method gives a square the tangents of its UVs`, () => {
    for (const method of METHODS) {
      const tangents = generateTangents(...square(), { method });
      assert.deepEqual(values(tangents), Array.from({ length: 6 }, () => [1, 0, 0, 1]).flat(), method);
    }
    const [x, y, z, w] = generateTangents(...square(), { method: 'from-normal' });
    assert.deepEqual([Math.hypot(x, y), Math.abs(z), Math.abs(w)], [1, 0, 1]);
  });

  test(`${name}: normals are flat, smooth or creased`, () => {
    const [positions, indices] = bend();
    const of = (options) => {
      const normals = generateNormals(positions, indices, options);
      assert.equal(normals.length, 36);
      return [0, 3, 18].map((at) => values(normals.subarray(at, at + 3)));
    };
    const mean = (x, z) => [Math.fround(x / Math.hypot(x, z)), 0, Math.fround(z / Math.hypot(x, z))];
    const flat = [[0, 0, 1], [0, 0, 1], [1, 0, 0]];
    assert.deepEqual(of({ shading: 'flat' }), flat);
    assert.deepEqual(of({ crease: 60 }), flat);
    assert.deepEqual(of({ weight: 'angle' }), [[0, 0, 1], mean(1, 1), mean(1, 1)]);
    // Corner 1 has one triangle in the first square, two in the second.
    assert.deepEqual(of({ weight: 'area' }), [[0, 0, 1], mean(2, 1), mean(2, 1)]);
  });

  test(`${name}: normals of corners become vertices`, () => {
    const [positions, indices] = bend();
    const normals = generateNormals(positions, indices, { shading: 'flat' });
    const split = darboux.splitNormals(indices, normals, 7);
    // The two vertices of the edge have two normals each; the seventh vertex is unused.
    assert.deepEqual([split.sourceOfVertex.length, split.normalOfVertex.length], [9, 27]);
    split.indices.forEach((vertex, corner) => {
      assert.equal(split.sourceOfVertex[vertex], indices[corner]);
      assert.deepEqual(split.normalOfVertex.subarray(3 * vertex, 3 * vertex + 3), normals.subarray(3 * corner, 3 * corner + 3));
    });
    assert.deepEqual([...split.normalOfVertex.subarray(3 * split.sourceOfVertex.indexOf(6)).subarray(0, 3)], [0, 0, 1]);
  });

  test(`${name}: tangents are measured against the UVs`, () => {
    const right = darboux.measureUvFidelity(...square(), generateTangents(...square()));
    assert.deepEqual(right, { mean: 0, rootMeanSquare: 0, area: 1, unmeasuredTriangles: 0 });
    const turned = Float32Array.from({ length: 24 }, (_, at) => [Math.SQRT1_2, Math.SQRT1_2, 0, 1][at % 4]);
    const wrong = darboux.measureUvFidelity(...square(), turned);
    assert.ok(Math.abs(wrong.mean - 45) < 1e-4 && Math.abs(wrong.rootMeanSquare - 45) < 1e-4);
  });

  test(`${name}: differences are measured`, () => {
    const [c, s] = [Math.cos(Math.PI / 6), 0.5];
    const found = measureTangents(Float32Array.of(1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1), Float32Array.of(1, 0, 0, 1, c, s, 0, -1, 1, 0, 0, 1));
    assert.deepEqual([found.corners, found.identical, found.signFlips, found.withoutAngle], [3, 1, 1, 1]);
    assert.ok(Math.abs(found.max - 30) < 1e-5 && Math.abs(found.mean - 15) < 1e-5);
    assert.deepEqual(found.histogram, [1, 0, 0, 0, 0, 0, 0, 1, 0, 0]);
    assert.deepEqual(found.worst, [{ corner: 1, angle: found.max }]);
  });

  test(`${name}: vertex data in other conventions comes back`, () => {
    const [positions, normals, uvs, indices] = square();
    const tangents = darboux.splitVertices(indices, generateTangents(...square()), 4).tangentOfVertex;
    for (const source of darboux.CONVENTIONS) {
      for (const target of [...darboux.CONVENTIONS, 'gltf,axes=z/-y/x,fronts=cw,v0=bottom,red=left,green=down,w=t-cross-n']) {
        const there = darboux.convert(source, target, { positions, normals, uvs, indices, tangents });
        const back = darboux.convert(target, source, there);
        for (const [name, array] of Object.entries({ positions, normals, uvs, tangents })) {
          assert.deepEqual(values(back[name]), values(array), `${source}, ${target}, ${name}`);
        }
        assert.deepEqual(Array.from(back.indices), Array.from(indices));
        assert.equal(there.invertsGreen, back.invertsGreen);
      }
    }
    const generated = darboux.convert('gltf', 'gltf', { tangents, generated: true });
    assert.deepEqual([generated.positions, generated.indices, generated.tangents[3]], [null, null, -tangents[3]]);
    const quads = darboux.convert('gltf', 'unity', { indices: Uint16Array.of(0, 1, 2, 3), faces: 4 }).indices;
    assert.deepEqual(Array.from(quads), [0, 3, 2, 1]);
  });

  test(`${name}: texels are inverted where conventions differ`, () => {
    const texels = Uint8ClampedArray.of(1, 2, 3, 4, 250, 251, 252, 253);
    assert.deepEqual(darboux.convertTexels(texels, 'gltf', 'directx'), Uint8ClampedArray.of(1, 253, 3, 4, 250, 4, 252, 253));
    const wide = Uint16Array.of(1, 2, 65535, 0);
    assert.deepEqual(darboux.convertTexels(wide, 'gltf', 'gltf,red=left', 2), Uint16Array.of(65534, 2, 0, 0));
    assert.deepEqual(Array.from(texels.slice(0, 2)), [1, 2]);
  });

  test(`${name}: frames follow matrices and skins`, () => {
    const [normals, tangents] = [Float32Array.of(0.6, 0.8, 0), Float32Array.of(0.8, -0.6, 0, 1)];
    const isClose = (found, expected) => expected.every((x, at) => Math.abs(found[at] - x) < 1e-6);
    const stretched = darboux.transformFrames([2, 0, 0, 0, 1, 0, 0, 0, 1], normals, tangents);
    assert.ok(isClose(stretched.normals, [0.3 / Math.hypot(0.3, 0.8), 0.8 / Math.hypot(0.3, 0.8), 0]));
    assert.ok(isClose(stretched.tangents, [1.6 / Math.hypot(1.6, 0.6), -0.6 / Math.hypot(1.6, 0.6), 0, 1]));
    assert.equal(stretched.orientation, 1);
    const mirror = darboux.transformFrames([-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1], normals, tangents);
    assert.ok(isClose(mirror.tangents, [-0.8, -0.6, 0, -1]) && mirror.orientation === -1);
    const turn = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
    const bones = Float32Array.of(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, ...turn);
    const three = (array) => Float32Array.from([0, 1, 2].flatMap(() => [...array]));
    const skinned = darboux.skinFrames(bones, Uint8Array.of(0, 1, 1, 0, 0, 1), Float32Array.of(1, 0, 1, 0, 0.5, 0.5), three(normals), three(tangents));
    const [half, turned] = [Math.SQRT1_2, [-0.8, 0.6, 0]];
    const mean = normals.subarray(0, 3).map((x, at) => half * (x + turned[at]));
    assert.ok(isClose(skinned.normals, [...normals, ...turned, ...mean]), `${skinned.normals}`);
    assert.deepEqual([3, 7, 11].map((at) => skinned.tangents[at]), [1, 1, 1]);
  });

  test(`${name}: encodings turn tangents by no more than they say`, () => {
    const { tangents, normals } = directions(1000);
    const bounds = { snorm8: 0.4, snorm10: 0.098, snorm16: 0.0016, octahedral: 0.0057, diamond: 0.0071 };
    for (const [encoding, bound] of Object.entries(bounds)) {
      const codes = encodeTangents(tangents, encoding, normals);
      const { max, signFlips } = measureTangents(tangents, decodeTangents(codes, encoding, normals));
      assert.ok(max > 0 && max <= bound, `${encoding}: ${max}`);
      assert.equal(signFlips, 0, encoding);
    }
  });
}

/** Numbers, with -0 as 0. */
const values = (floats) => Array.from(floats, (x) => x + 0);

/** Unit tangents of both signs, and perpendicular unit normals. */
function directions(count) {
  const [tangents, normals] = [new Float32Array(4 * count), new Float32Array(3 * count)];
  for (let at = 0; at < count; at++) {
    const [z, turn] = [1 - (2 * at + 1) / count, at * 2.4];
    const r = Math.sqrt(1 - z * z);
    tangents.set([r * Math.cos(turn), r * Math.sin(turn), z, at % 2 ? 1 : -1], 4 * at);
    normals.set([-Math.sin(turn), Math.cos(turn), 0], 3 * at);
  }
  return { tangents, normals };
}

const [positions, normals, uvs, indices] = square();
const tangents = new Float32Array(24);
const wrong = [
  [() => esm.generateTangents(positions, normals, uvs, indices, { method: 'best' }), RangeError, /^method is 'best'; it must be one of 'mikktspace', /],
  [() => esm.generateTangents(positions, normals, uvs, indices, { method: 'face', threshold: 60 }), RangeError, /^threshold belongs to the method/],
  [() => esm.generateNormals(positions, indices, { weight: 'best' }), RangeError, /^weight is 'best'/],
  [() => esm.generateNormals(positions, Uint16Array.of(0, 1, 4)), RangeError, /^index 4 at place 2 is out of range: there are 4 vertices$/],
  [() => esm.splitVertices(null, tangents, 4), TypeError, /^indices must be .*, not Null$/],
  [() => esm.splitVertices(indices, tangents.slice(4), 4), RangeError, /^there are 5 tangents but 6 indices; /],
  [() => esm.splitVertices(indices, tangents, 3), RangeError, /^index 3 at place 5 is out of range: there are 3 vertices$/],
  [() => esm.splitNormals(indices, tangents.slice(0, 3), 4), RangeError, /^there are 1 normals but 6 indices; /],
  [() => esm.measureUvFidelity(...square(), tangents.slice(4)), RangeError, /^there are 5 tangents but 6 corners; /],
  [() => esm.splitVertices(indices, tangents, -1), RangeError, /^vertexCount is -1; /],
  [() => esm.measureTangents(tangents, tangents.slice(4)), RangeError, /^b has 5 tangents but a has 6; /],
  [() => esm.convert('metal', 'gltf', {}), RangeError, /^source is 'metal'; it must be one of 'gltf', /],
  [() => esm.convert('gltf', 'gltf,green=left', {}), RangeError, /^target is 'gltf,green=left'; /],
  [() => esm.convert('gltf', 'unity', { indices: Uint16Array.of(0, 1) }), RangeError, /^2 corners are not a multiple of 3/],
  [() => esm.convert('gltf', 'unity', { uvs: new Float32Array(3) }), RangeError, /^uvs has a length of 3, /],
  [() => esm.convertTexels(new Uint8Array(7), 'gltf', 'unity'), RangeError, /^texels has a length of 7, /],
  [() => esm.convertTexels(new Float32Array(4), 'gltf', 'unity'), TypeError, /^texels must be a Uint8Array or /],
  [() => esm.transformFrames([1, 0, 0], normals, tangents.slice(0, 16)), RangeError, /^matrix has 3 numbers; it must have 9 or 16$/],
  [() => esm.transformFrames(new Float32Array(9), normals, tangents), RangeError, /^there are 6 tangents but 4 normals; /],
  [() => esm.skinFrames(new Float32Array(16), Uint8Array.of(0, 0, 0, 1), new Float32Array(4), normals, tangents.slice(0, 16)), RangeError, /^joint 1 of vertex 3 is out of range: there are 1 bones$/],
  [() => esm.skinFrames(new Float32Array(16), Uint8Array.of(0, 0, 0), new Float32Array(3), normals, tangents.slice(0, 16)), RangeError, /^there are 3 joints but 4 vertices; /],
  [() => esm.skinFrames(new Float32Array(16), Uint8Array.of(0), new Float32Array(2), normals, tangents.slice(0, 16)), RangeError, /^there are 2 weights but 1 joints$/],
  [() => esm.encodeTangents(tangents, 'snorm4'), RangeError, /^encoding is 'snorm4'; /],
  [() => esm.encodeTangents(tangents, 'diamond'), TypeError, /^normals must be a Float32Array, not Undefined$/],
  [() => esm.encodeTangents(tangents, 'diamond', normals), RangeError, /^normals has 4 elements but there are 6 tangents; /],
  [() => esm.decodeTangents(new Int16Array(4), 'snorm8'), TypeError, /^codes must be an Int8Array, not Int16Array$/],
  [() => esm.decodeTangents(new Int8Array(5), 'snorm8'), RangeError, /^codes has a length of 5, /],
];

test('null stands for missing options', () => {
  const corners = esm.generateTangents(positions, normals, uvs, indices);
  assert.deepEqual(esm.generateTangents(positions, normals, uvs, indices, null), corners);
  assert.deepEqual(esm.generateTangents(positions, normals, uvs, indices, { method: null, threshold: null }), corners);
  assert.deepEqual(esm.generateFrames(positions, normals, uvs, indices, null).tangents, corners);
  assert.deepEqual(new esm.Plan(positions, normals, uvs, indices, null).base, corners);
  assert.deepEqual(esm.planTopology(positions, normals, uvs, indices, null), esm.planTopology(positions, normals, uvs, indices));
  const smooth = esm.generateNormals(positions, indices);
  assert.deepEqual(esm.generateNormals(positions, indices, null), smooth);
  assert.deepEqual(esm.generateNormals(positions, indices, { shading: null, weight: null, crease: null, seams: null, faces: null }), smooth);
});

test('wrong arguments are refused in one sentence', () => {
  for (const [call, kind, message] of wrong) {
    assert.throws(call, (error) => error instanceof kind && message.test(error.message), `${message}`);
  }
});
