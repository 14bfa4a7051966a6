// The examples of README.md run and give the documented results.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const readme = readFileSync(new URL('../README.md', import.meta.url), 'utf8');
const examples = [...readme.matchAll(/```js\n([^]*?)```/g)].map(([, code]) => code);

/** Runs an example as a module and returns some of its variables. */
async function run(example, variables) {
  const code = examples[example].replaceAll(/from '([^']*)'/g, (_, name) => `from ${JSON.stringify(import.meta.resolve(name))}`);
  return import(`data:text/javascript,${encodeURIComponent(`${code}\nexport { ${variables} };`)}`);
}

test('tangents of corners', async () => {
  const { tangents } = await run(0, 'tangents');
  assert.deepEqual(Array.from(tangents), Array.from({ length: 6 }, () => [1, 0, 0, 1]).flat());
});

test('vertices of a mirrored seam', async () => {
  const { tangentOfVertex, newIndices, newPositions } = await run(1, 'tangentOfVertex, newIndices, newPositions');
  assert.deepEqual(Array.from(newIndices), [0, 1, 2, 0, 2, 3, 6, 4, 5, 6, 5, 7]);
  assert.deepEqual(Array.from(newPositions.subarray(18)), [0, 0, 0, 0, 1, 0]);
  const signs = Array.from({ length: 8 }, (_, vertex) => [tangentOfVertex[4 * vertex], tangentOfVertex[4 * vertex + 3]]);
  assert.deepEqual(signs, [[-1, -1], [-1, -1], [-1, -1], [-1, -1], [1, 1], [1, 1], [1, 1], [1, 1]]);
});

test('a geometry of three.js', async () => {
  const { geometry, mesh, separate } = await run(2, 'geometry, mesh, separate');
  assert.deepEqual([geometry.getAttribute('tangent').count, geometry.index === null], [geometry.getAttribute('position').count, false]);
  assert.equal(mesh.geometry, geometry);
  assert.deepEqual([separate.index, separate.getAttribute('tangent').count], [null, 64 * 8 * 6]);
});

test('the module that three.js expects', async () => {
  const { geometry } = await run(3, 'geometry');
  assert.equal(geometry.getAttribute('tangent').count, 64 * 8 * 6);
});

test('a document of glTF-Transform', async () => {
  const { document } = await run(4, 'document');
  assert.equal(document.getRoot().listAccessors().length, 0);
});

test('what is wrong with a model', async () => {
  const before = process.cwd();
  process.chdir(fileURLToPath(new URL('../../..', import.meta.url)));
  const { errors, repaired, left } = await run(7, 'errors, repaired, left').finally(() => process.chdir(before));
  assert.deepEqual(errors.map(({ code }) => code), ['tangent-shared-across-mirror']);
  assert.ok(repaired.length > 0);
  assert.ok(left.every(({ severity, leftBecause }) => severity !== 'error' && leftBecause));
});

test('baking', async () => {
  const before = process.cwd();
  process.chdir(fileURLToPath(new URL('../../..', import.meta.url)));
  const { texels, missed } = await run(8, 'texels, missed').finally(() => process.chdir(before));
  assert.equal(texels.length, 256 * 256 * 3);
  assert.ok(missed < 0.01, `${missed}`);
});

test('in place of npm mikktspace', async () => {
  const { tangents } = await run(5, 'tangents');
  assert.deepEqual(Array.from(tangents), Array.from({ length: 3 }, () => [1, 0, 0, 1]).flat());
});
