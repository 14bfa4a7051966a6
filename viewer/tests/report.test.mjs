// The page that `darboux report` writes: it loads nothing, its slider shows the file and the repaired file, and the rules for accessible pages hold.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { browser, Picture, root } from './page.mjs';

let folder, chromium;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'darboux-report-'));
  const words = ['report', join(root, 'assets/made/shield.glb'), '-o', join(folder, 'report.html'), '--fail-on', 'never', '--quiet'];
  execFileSync(process.env.DARBOUX ?? join(root, 'target/debug/darboux'), words);
  chromium = await browser();
});

after(async () => {
  await chromium?.close();
  rmSync(folder, { recursive: true, force: true });
});

for (const [colorScheme, width] of [['light', 1280], ['dark', 390]]) {
  test(`${colorScheme}, ${width} pixels: a slider shows both sides, and nothing is loaded`, async () => {
    const page = await chromium.newPage({ colorScheme, viewport: { width, height: 844 }, bypassCSP: true });
    const requests = [];
    page.on('request', (request) => requests.push(request.url().slice(0, 5)));
    await page.goto(`file://${join(folder, 'report.html')}`);
    assert.deepEqual(requests.filter((start) => start !== 'file:' && start !== 'data:'), []);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
    await page.evaluate(await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8'));
    const violations = await page.evaluate(async () => (await globalThis.axe.run()).violations.map(({ id }) => id));
    assert.deepEqual(violations, []);
    const frame = page.locator('.frame').first();
    const shots = [];
    for (const percent of ['100', '0']) {
      await frame.locator('input').fill(percent);
      shots.push(await Picture.decode(page, await frame.screenshot()));
    }
    assert.ok(shots[0].differs(shots[1]) > 0.03, `${shots[0].differs(shots[1])} of the close picture`);
    await page.close();
  });
}
