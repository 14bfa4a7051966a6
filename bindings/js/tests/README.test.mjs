// The examples of README.md run, and make what they say.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';

const readme = readFileSync(new URL('../README.md', import.meta.url), 'utf8');
const examples = [...readme.matchAll(/```js\n([^]*?)```/g)].map(([, code]) => code);

test('the first example', async () => {
  // As a module of its own beside this one, so that it finds the package.
  const code = examples[0].replaceAll(/'(darboux[^']*)'/g, (_, name) => JSON.stringify(import.meta.resolve(name)));
  const { tangents } = await import(`data:text/javascript,${encodeURIComponent(`${code}\nexport { tangents };`)}`);
  assert.deepEqual(Array.from(tangents), Array.from({ length: 6 }, () => [1, 0, 0, 1]).flat());
});
