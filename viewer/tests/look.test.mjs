// One look: the viewer and `darboux render` draw ten models alike, without and with the ground, and clip hardly any white.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { test } from 'node:test';

import { browser, Picture, root, serve, Viewer } from './page.mjs';

const DARBOUX = process.env.DARBOUX;

/** Files, or folders and the model in them. */
const MODELS = [
  ['assets/made/shield.glb'],
  ['assets/Fox/Fox.glb'],
  ['assets/NormalTangentTest/NormalTangentTest.glb'],
  ['assets/TwoSidedPlane', 'TwoSidedPlane.gltf'],
  ['assets/Morphing', 'morphing.gltf'],
  ['assets/made/draco.glb'],
  ['assets/made/meshopt.glb'],
  ['assets/made/strips-fans-lines-points.gltf'],
  ['assets/made/shared-vertices-two-uv-sets.gltf'],
  ['assets/made/skinned-morphed-mirrored.gltf'],
];

/** The mean difference of a channel, of 255, within the pixels of the model. The programs filter textures and interpolate frames differently. */
const MOST_DIFFERENCE = 9;

/** The same within the pixels of the ground, whose shadow both programs compute by the same formula. */
const MOST_GROUND_DIFFERENCE = 0.6;

/** The share of the model's pixels that may be clipped to white. */
const MOST_CLIPPED = 0.01;

test('the viewer and darboux render draw models alike', { skip: !DARBOUX && 'DARBOUX names no command' }, async () => {
  const folder = mkdtempSync(join(tmpdir(), 'look-'));
  const [server, chromium] = [await serve(), await browser()];
  try {
    const viewer = await Viewer.open(chromium, server.address, { viewport: { width: 752, height: 460 }, colorScheme: 'dark' });
    for (const [path, inside] of MODELS) {
      const name = basename(inside ?? path);
      await viewer.give(inside ? 'folder' : 'files', join(root, path));
      assert.equal(await viewer.text('error'), '');
      await viewer.choose('left', await viewer.page.$eval('#left', (select) => (select.options[0].disabled ? 'mikktspace' : 'file')));
      await viewer.slide('split', 100);
      await viewer.click('#ground');
      const shown = await viewer.picture();
      await viewer.click('#ground');
      const shownOnGround = await viewer.picture();
      // The address carries the view a while after its last change.
      await viewer.page.evaluate(() => history.replaceState(null, '', '#'));
      await viewer.slide('split', 99);
      await viewer.slide('split', 100);
      await viewer.page.waitForFunction(() => /view=/.test(location.hash));
      const view = new URLSearchParams(new URL(viewer.page.url()).hash.slice(1)).get('view');
      const draw = (...more) => {
        const output = join(folder, `${name}.png`);
        execFileSync(DARBOUX, ['render', join(root, path, inside ?? ''), '-o', output, '--look', view, '--size', `${shown.width}x${shown.height}`, '--background', '33373e', '--force', '--quiet', ...more]);
        return Picture.decode(viewer.page, readFileSync(output));
      };
      const [drawn, drawnOnGround] = [await draw(), await draw('--ground')];
      const isModel = (at) => [0x33, 0x37, 0x3e].some((channel, i) => Math.abs(shown.data[at + i] - channel) > 3);
      let [count, sum, clipped] = [0, 0, 0];
      for (let at = 0; at < shown.data.length; at += 4) {
        if (!isModel(at)) continue;
        count++;
        for (const i of [0, 1, 2]) sum += Math.abs(shown.data[at + i] - drawn.data[at + i]) / 3;
        clipped += Number([0, 1, 2].every((i) => shown.data[at + i] >= 254));
      }
      console.log(`${name}: mean difference ${(sum / count).toFixed(2)}, clipped ${((100 * clipped) / count).toFixed(2)} %`);
      assert.ok(count > 0.03 * shown.width * shown.height, `${name} is seen`);
      assert.ok(sum / count < MOST_DIFFERENCE, `${name}: ${sum / count}`);
      assert.ok(clipped / count <= MOST_CLIPPED, `${name}: ${clipped / count} is clipped`);
      const isInBoth = (at) => isModel(at) && [0x33, 0x37, 0x3e].some((channel, i) => drawn.data[at + i] !== channel);
      const ground = compareGround([shown, shownOnGround], [drawn, drawnOnGround], isModel, isInBoth);
      console.log(`${name}: mean difference of the ground ${ground.difference.toFixed(2)} in ${ground.count} pixels`);
      assert.equal(ground.changed, 0, `${name}: pixels of the model change with the ground`);
      assert.ok(ground.count > 0.005 * shown.width * shown.height && ground.difference < MOST_GROUND_DIFFERENCE, `${name}: ${ground.difference} in ${ground.count} pixels of the ground`);
    }
    await viewer.close();
  } finally {
    await chromium.close();
    server.close();
    rmSync(folder, { recursive: true });
  }
});

/**
 * Compares pictures without and with the ground of the viewer and of the command: the mean difference in the pixels that the ground darkens in one of
 * them, their number, and the number of pixels inside the model that the ground changes.
 */
function compareGround([shown, shownOnGround], [drawn, drawnOnGround], isModel, isInBoth) {
  const { width, height } = shown;
  const differ = (one, other, at) => [0, 1, 2].some((i) => one.data[at + i] !== other.data[at + i]);
  let [count, sum, changed] = [0, 0, 0];
  for (let y = 1; y < height - 1; y++) {
    for (let x = 1; x < width - 1; x++) {
      const around = [-1, 0, 1].flatMap((dy) => [-1, 0, 1].map((dx) => 4 * ((y + dy) * width + x + dx)));
      const at = around[4];
      const isChanged = [[shown, shownOnGround], [drawn, drawnOnGround]].map(([without, on]) => differ(without, on, at));
      if (around.every(isInBoth)) changed += Number(isChanged.includes(true));
      if (around.some(isModel) || !isChanged.includes(true)) continue;
      count++;
      for (const i of [0, 1, 2]) sum += Math.abs(shownOnGround.data[at + i] - drawnOnGround.data[at + i]) / 3;
    }
  }
  return { count, difference: sum / count, changed };
}
