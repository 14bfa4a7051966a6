// `darboux/check`: findings, repairs, verdicts on maps, recipes.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, extname, join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { crc32, deflateSync } from 'node:zlib';
import * as darboux from 'darboux';
import { formsOf } from './forms.mjs';
import { grid, square } from './meshes.mjs';

const forms = await formsOf('darboux/check');
await darboux.ready;
const root = fileURLToPath(new URL('../../..', import.meta.url));
const asset = (path) => new Uint8Array(readFileSync(fileURLToPath(new URL(`../../../assets/${path}`, import.meta.url))));
const errors = (findings) => findings.filter(({ severity }) => severity === 'error').map(({ code }) => code);

/** A normal map of bumps with 4 channels; `up` is 1 for OpenGL and -1 for DirectX. */
function bumps(side, up) {
  const texel = (_, at) => {
    const [x, y] = [(at % side) / 5, Math.floor(at / side) / 5];
    const normal = [(-Math.cos(x) * Math.sin(y)) / 5, (up * Math.sin(x) * Math.cos(y)) / 5, 1];
    return [...normal.map((c) => Math.round(127.5 + (127.5 * c) / Math.hypot(...normal))), 255];
  };
  return Uint8ClampedArray.from(Array.from({ length: side * side }, texel).flat());
}

/** A square image of 4 channels as PNG. */
function png(side, texels) {
  const rows = Array.from({ length: side }, (_, row) => [0, ...texels.subarray(4 * side * row, 4 * side * (row + 1))]);
  const number = (value) => [24, 16, 8, 0].map((shift) => (value >>> shift) & 255);
  const chunk = (name, content) => {
    const body = [...Buffer.from(name), ...content];
    return [...number(content.length), ...body, ...number(crc32(Uint8Array.from(body)))];
  };
  const head = [...number(side), ...number(side), 8, 6, 0, 0, 0];
  const data = deflateSync(Uint8Array.from(rows.flat()));
  const signature = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
  return Uint8Array.from([...signature, ...chunk('IHDR', head), ...chunk('IDAT', data), ...chunk('IEND', [])]);
}

/** Runs the command with all of its readers. */
function command(...words) {
  return spawnSync('cargo', ['run', '--quiet', '--package', 'darboux-cli', '--features', 'full', '--', ...words], { cwd: root, encoding: 'utf8' });
}

for (const [name, { check, convertFile, fix, judgeNormalMap, recogniseRecipe }] of Object.entries(forms)) {
  test(`${name}: a broken model is named and repaired`, () => {
    const shield = asset('made/shield.glb');
    assert.deepEqual(errors(check(shield)), ['tangent-shared-across-mirror']);
    const of = (code) => check(shield).find((finding) => finding.code === code).firstAre;
    assert.deepEqual([of('tangent-shared-across-mirror'), of('tangent-sign-mixed')], ['vertices', 'triangles']);
    const fixed = fix(shield);
    assert.ok(fixed.findings.find(({ code }) => code === 'tangent-shared-across-mirror').repaired);
    assert.deepEqual(errors(check(fixed.file)), []);
    assert.equal(fix(fixed.file).file, null);
  });

  test(`${name}: repairs can be chosen`, () => {
    const shield = asset('made/shield.glb');
    const outcome = (only, code) => fix(shield, { only }).findings.find((finding) => finding.code === code);
    assert.equal(fix(shield, { only: ['tangent-zero'] }).file, null);
    assert.match(outcome(null, 'tangent-other-recipe').leftBecause, /--only tangent-other-recipe/);
    assert.ok(outcome(['tangent-other-recipe'], 'tangent-other-recipe').repaired);
    assert.throws(() => fix(shield, { only: ['tangent-odd'] }), /^Error: .*tangent-odd/);
    assert.throws(() => fix(shield, { only: [] }), RangeError);
    for (const [only, type] of [['tangent-zero', 'String'], [new Set(['tangent-zero']), 'Set'], [7, 'Number']]) {
      assert.throws(() => fix(shield, { only }), { name: 'TypeError', message: `only must be an Array, not ${type}` });
    }
    assert.throws(() => fix(shield, { only: ['tangent-zero', 7] }), { name: 'TypeError', message: 'only[1] must be a String, not Number' });
    assert.throws(() => fix(shield, { only: new Array(1) }), { name: 'TypeError', message: 'only[0] must be a String, not Undefined' });
    assert.throws(() => fix(shield, { only: ['tangent-zero\nnormal-zero'] }), { name: 'Error', message: /^only\[0\] is "tangent-zero\\nnormal-zero", which has a line break/ });
  });

  test(`${name}: findings are those of the command`, () => {
    const { stdout } = command('check', 'assets/made/shield.glb', '--json');
    const underscored = (finding) => {
      const named = Object.entries(finding).map(([word, value]) => [word.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`), value]);
      return Object.fromEntries(named);
    };
    const found = check(asset('made/shield.glb'));
    const reported = JSON.parse(stdout).files[0];
    assert.deepEqual(found.map(underscored), reported.findings);
    assert.equal(found.diagnosis, reported.diagnosis);
    assert.ok(fix(asset('made/shield.glb')).findings.some(({ change }) => change));
  });

  test(`${name}: findings that say the same are together, the most severe first`, () => {
    for (const path of ['made/shield.glb', 'blender/scene.fbx']) {
      const { statements, ...found } = check(asset(path));
      const all = statements.flat();
      assert.deepEqual([...all].sort((a, b) => a - b), Object.keys(found).map(Number).filter(Number.isInteger), path);
      const of = (number) => [found[number].severity, found[number].code];
      for (const same of statements) for (const number of same) assert.deepEqual(of(number), of(same[0]));
      const ranks = statements.map(([first]) => ['error', 'warning', 'info', 'not-checked'].indexOf(found[first].severity));
      assert.deepEqual(ranks, ranks.toSorted(), path);
    }
    assert.ok(check(asset('blender/scene.fbx')).statements.some((same) => same.length > 1));
  });

  test(`${name}: models of other formats are those of the command, with their own words`, () => {
    const folder = mkdtempSync(join(tmpdir(), 'darboux-'));
    const seen = { findings: 0, importers: 0, sources: 0, repaired: 0 };
    for (const path of ['blender/scene.fbx', 'blender/mapping.fbx', 'others/assimp.fbx', 'blender/scene.obj', 'blender/scene.ply']) {
      // Alone: the package reads no files beside a model.
      const [alone, made] = [join(folder, basename(path)), join(folder, 'made.glb')];
      writeFileSync(alone, asset(path));
      const found = check(asset(path));
      const { stdout, stderr } = command('check', alone, '--json');
      const { findings, importer_note, diagnosis } = JSON.parse(stdout).files[0];
      // A map that the package does not look up is not there for the command.
      const isRead = ({ code }) => code !== 'map-unreadable';
      const said = (findings) => findings.filter(isRead).map(({ code, text, first }) => [code, text, first]);
      assert.deepEqual(said(found), said(findings), path);
      assert.equal(found.length, findings.length, path);
      if (found.every(isRead)) assert.equal(found.diagnosis, diagnosis, path);
      assert.equal(found.importerNote, importer_note ?? null, path);
      const missing = /was not looked up, because the model came without a folder/;
      for (const warning of found.warnings) assert.ok(missing.test(warning) || stderr.includes(warning), `${warning} is not in ${stderr}`);
      const words = new RegExp(`your ${extname(path).slice(1).toUpperCase()}$`);
      const inMeshes = found.filter(({ mesh }) => mesh !== null);
      for (const { source } of inMeshes) assert.match(source, words);
      command('convert', alone, '--from', 'gltf', '--to', 'unity', '--raw', '--force', '-o', made);
      assert.ok(Buffer.from(convertFile(asset(path), 'gltf', 'unity').file).equals(readFileSync(made)), `${path}: the same bytes`);
      command('check', '--fix', '--fail-on', 'never', '--force', alone, '-o', made);
      const { file } = fix(asset(path));
      if (file) assert.ok(Buffer.from(file).equals(readFileSync(made)), `${path}: the same bytes after the repair`);
      seen.findings += found.length;
      seen.importers += Number(found.importerNote !== null);
      seen.sources += inMeshes.length;
      seen.repaired += Number(Boolean(file));
    }
    for (const [name, count] of Object.entries(seen)) assert.ok(count > 0, `no ${name} were compared`);
    rmSync(folder, { recursive: true });
    const found = check(asset('others/assimp.fbx'));
    assert.ok(found.some(({ source }) => source === 'Armature/Body in your FBX') && found.importerNote);
    assert.match(found.warnings[0], /^FBX does not say whether green points up or down/);
    assert.deepEqual([check(asset('made/shield.glb')).warnings, check(asset('made/shield.glb'))[0].source], [[], undefined]);
  });

  test(`${name}: a damaged FBX gets a sentence`, () => {
    const whole = asset('blender/scene.fbx');
    const isSentence = (error) => error.constructor === Error && /^the model: .*[;)]/.test(error.message) && !/fault of darboux/.test(error.message);
    for (let length = 23; length < whole.length; length += 997) assert.throws(() => check(whole.slice(0, length)), isSentence, `${length}`);
    let refused = 0;
    for (let at = 100; at < whole.length; at += 499) {
      const damaged = Uint8Array.from(whole);
      damaged.fill(255, at, at + 4);
      try {
        check(damaged);
      } catch (error) {
        refused++;
        assert.ok(isSentence(error), error.message);
      }
    }
    assert.ok(refused > 10, `${refused}`);
  });

  test(`${name}: the memory limit leads to the command, because the package has no such option`, () => {
    const accessors = [{ componentType: 5126, type: 'VEC3', count: 2 ** 31 }];
    const model = { asset: { version: '2.0' }, accessors, meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }] };
    assert.throws(() => check(Buffer.from(JSON.stringify(model))), /raise the limit \(--memory-limit of the command darboux\)/);
  });

  test(`${name}: compressed models are decoded`, () => {
    for (const model of ['draco.glb', 'meshopt.glb']) {
      const file = asset(`made/${model}`);
      assert.deepEqual(errors(check(file)), [], model);
      const converted = convertFile(file, 'gltf', 'unity').file;
      assert.doesNotMatch(Buffer.from(converted).toString('latin1'), /draco_mesh|meshopt_comp/, model);
    }
  });

  test(`${name}: maps are judged`, () => {
    for (const [up, verdict] of [[1, 'opengl'], [-1, 'directx']]) {
      const texels = bumps(128, up);
      const { verdict: told, tiles } = judgeNormalMap(texels, 128, 128);
      assert.equal(told, verdict);
      assert.equal(tiles.correlations.length, (128 / tiles.side) * tiles.columns);
      assert.ok(tiles.correlations.every((vote) => vote * up > 0), 'all tiles agree');
      assert.equal(judgeNormalMap(Uint16Array.from(texels, (c) => 257 * c), 128, 128).verdict, verdict);
      const two = Uint8Array.from(texels.filter((_, at) => at % 4 < 2));
      assert.equal(judgeNormalMap(two, 128, 128, 2).verdict, verdict);
    }
  });

  test(`${name}: recipes are recognised`, () => {
    const mesh = grid(12, 9);
    for (const method of ['mikktspace', 'angle-edge', 'area', 'face']) {
      const tangents = darboux.generateTangents(...mesh, { method });
      const found = recogniseRecipe(...mesh, tangents);
      const recipes = found.map(({ method, mode, flipsV, fromQuads, writing, bits }) => `${[method, mode, flipsV, fromQuads, writing, bits]}`);
      assert.equal(new Set(recipes).size, found.length);
      const [best] = found;
      assert.equal(best.method, method);
      assert.equal(best.identical, best.corners);
    }
  });

  test(`${name}: models and maps are converted, and come back`, () => {
    const shield = asset('made/shield.glb');
    const there = convertFile(shield, 'gltf', 'unreal');
    assert.match(there.warnings.at(-1), /^the file is in the convention unreal: /);
    const back = convertFile(there.file, 'unreal', 'gltf');
    assert.deepEqual(back.warnings, ['the normal maps of materials[0] were not converted; convert these images too']);
    assert.deepEqual(errors(check(back.file)), errors(check(shield)));
    assert.throws(() => convertFile(there.file, 'unity', 'gltf'), /unreal/);
    const map = png(128, bumps(128, -1));
    assert.deepEqual(errors(check(map)), ['map-green-flipped']);
    const converted = convertFile(map, 'directx', 'gltf').file;
    assert.deepEqual(errors(check(converted)), []);
    assert.deepEqual(convertFile(convertFile(converted, 'gltf', 'directx').file, 'directx', 'gltf').file, converted);
    assert.notDeepEqual(convertFile(map, 'gltf', 'gltf', { toLayout: 'ag' }).file, map);
  });

  test(`${name}: wrong input is refused`, () => {
    assert.throws(() => check(new Uint8Array([1, 2, 3])), /the model/);
    assert.throws(() => check('model.glb'), TypeError);
    assert.throws(() => check(undefined), /^TypeError: file must be a Uint8Array, not Undefined/);
    assert.throws(() => check(asset('made/shield.glb'), { green: 'left' }), RangeError);
    assert.throws(() => check(asset('made/shield.glb'), { assume: 'left' }), RangeError);
    const png = [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a];
    const tga = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 9, 0, 7, 0, 24, 0, 128, 128];
    for (const image of [png, tga]) assert.deepEqual(errors(check(new Uint8Array(image))), ['map-unreadable']);
    assert.throws(() => convertFile(asset('made/shield.glb'), 'metal', 'gltf'), /^Error: source: "metal" is not a convention/);
    assert.throws(() => convertFile(asset('made/shield.glb'), 'gltf', 'gltf', { layout: 'xyz' }), /^Error: layout: /);
    assert.throws(() => convertFile('model.glb', 'gltf', 'gltf'), TypeError);
    assert.throws(() => judgeNormalMap(new Uint8Array(7), 1, 2), RangeError);
    const [positions, normals, uvs] = square();
    assert.throws(() => recogniseRecipe(positions, normals, uvs, null, new Float32Array(4)), RangeError);
    assert.throws(() => recogniseRecipe(positions, normals, uvs, new Uint16Array([0, 1, 9]), new Float32Array(12)), /index 9/);
  });
}
