import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Plan, ready } from 'darboux';

await ready;

test('10,000 plans leave no memory behind', () => {
  const mesh = [9, 9, 6].map((length) => new Float32Array(30 * length));
  const [positions, normals] = mesh;
  const plans = (count) => {
    for (let at = 0; at < count; at++) assert.equal(new Plan(...mesh).evaluate(positions, normals).length, 360);
    return process.memoryUsage().rss;
  };
  const some = plans(500);
  const all = plans(10_000);
  // What 10,000 live ones would use is 2 GB.
  assert.ok(all - some < 300_000_000, `${some} bytes, then ${all}`);
});
