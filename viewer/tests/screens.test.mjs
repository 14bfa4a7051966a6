// The page on a phone, a tablet and a desktop, dark and light: the model is in view, nothing is cut off, and the rules for accessible pages hold.
// The environment variable SCREENS names a folder for screenshots to look at.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { browser, root, serve, Viewer } from './page.mjs';

let server, chromium;

before(async () => ([server, chromium] = [await serve(), await browser()]));

after(async () => {
  await chromium?.close();
  server?.close();
});

const SCREENS = { phone: [390, 844, true], tablet: [768, 1024, true], desktop: [1280, 800, false] };

for (const [name, [width, height, isTouched]] of Object.entries(SCREENS)) {
  test(`${name}: the model comes first, and the panel is beside or below it`, async () => {
    const viewer = await Viewer.open(chromium, server.address, { viewport: { width, height }, hasTouch: isTouched, isMobile: isTouched });
    const box = (selector) => viewer.page.locator(selector).boundingBox();
    const [view, panel] = [await box('#view'), await box('#panel')];
    assert.ok(view.width * view.height > 0.4 * width * height, `the view has ${view.width} x ${view.height}`);
    if (isTouched) {
      assert.equal(view.width, width);
      assert.ok(panel.y >= view.y + view.height - 1, 'the panel is below');
    }
    assert.ok(panel.height > 200 && panel.y + panel.height <= height + 1);
    // Everything that can be shown at once.
    await viewer.page.locator('#findings summary').first().click();
    await viewer.click('#repair');
    for (const id of ['wireframe', 'layout']) await viewer.tick(`#${id}`);
    await viewer.page.focus('#view');
    await viewer.page.keyboard.press('Enter');
    assert.ok(await viewer.page.isVisible('#values'));
    for (const colorScheme of ['light', 'dark']) {
      await viewer.page.emulateMedia({ colorScheme });
      assert.deepEqual(await viewer.violations(), [], colorScheme);
      assert.equal(await viewer.page.evaluate(() => document.documentElement.scrollWidth), width, 'nothing is wider than the screen');
      if (process.env.SCREENS) await viewer.page.screenshot({ path: join(process.env.SCREENS, `${name}-${colorScheme}.png`) });
    }
    await viewer.click('#reset');
    await remembers(viewer);
    if (isTouched) await touches(viewer, view);
    await poses(viewer, width);
    assert.deepEqual(viewer.faults, []);
    await viewer.close();
  });
}

test('embedded, there is the picture with its slider and a link to the whole page', async () => {
  const viewer = await Viewer.open(chromium, `${server.address}?embed#left=file&right=mikktspace&first-sight=0`, { viewport: { width: 480, height: 360 } });
  for (const selector of ['header .row', '#panel']) assert.equal(await viewer.page.isVisible(selector), false, selector);
  const view = await viewer.page.locator('#view').boundingBox();
  assert.deepEqual([view.width, view.height], [480, 360]);
  assert.deepEqual(await viewer.violations(), []);
  const left = await viewer.picture();
  await viewer.slide('split', 100);
  assert.ok((await viewer.picture()).differs(left) > 0.003, 'the slider shows the file');
  await viewer.page.mouse.move(240, 100);
  const before = await viewer.picture();
  await viewer.page.mouse.wheel(0, 300);
  await viewer.settled();
  assert.ok((await viewer.picture()).differs(before) < 0.001, 'the wheel scrolls the page around it');
  await viewer.page.waitForFunction(() => /split=100/.test(location.hash));
  const [whole] = await Promise.all([viewer.page.context().waitForEvent('page'), viewer.page.click('#whole-page')]);
  await whole.waitForSelector('#panel');
  assert.match(whole.url(), /#.*split=100/);
  assert.ok(!whole.url().includes('embed'));
  if (process.env.SCREENS) await viewer.page.screenshot({ path: join(process.env.SCREENS, 'embedded.png') });
  await viewer.close();
});

/** A link to the page shows the same at this size. */
async function remembers(viewer) {
  await viewer.choose('right', 'lengyel');
  await viewer.click('#flip-w');
  await viewer.page.waitForFunction(() => /right=lengyel.*flip-w=1.*view=/.test(location.hash));
  const viewport = viewer.page.viewportSize();
  const other = await Viewer.open(chromium, viewer.page.url(), { viewport });
  assert.deepEqual([await other.page.inputValue('#right'), await other.page.getAttribute('#flip-w', 'aria-pressed')], ['lengyel', 'true']);
  await other.close();
  await viewer.click('#reset');
}

/** A clip, with its button and its slider, can be used at this size, and values are shown of the pose. */
async function poses(viewer, width) {
  await viewer.give('files', [join(root, 'assets/Fox/Fox.glb')]);
  await viewer.choose('clip', '1');
  for (const id of ['clip', 'clip-time', 'clip-play']) {
    await viewer.page.locator(`#${id}`).scrollIntoViewIfNeeded();
    const { x, width: wide } = await viewer.page.locator(`#${id}`).boundingBox();
    assert.ok(x >= 0 && x + wide <= width, `${id} is cut off`);
  }
  await viewer.page.focus('#view');
  await viewer.page.keyboard.press('Enter');
  const position = () => viewer.page.$eval('#values-list', (list) => list.innerText);
  const before = await position();
  await viewer.press('#clip-play');
  await viewer.page.waitForFunction(() => document.getElementById('clip-time').valueAsNumber > 0.1);
  await viewer.press('#clip-play');
  await viewer.slide('clip-time', 0.5);
  await viewer.page.focus('#view');
  await viewer.page.keyboard.press('Escape');
  await viewer.page.keyboard.press('Enter');
  assert.notEqual(await position(), before, 'the values are those of the pose');
}

/** The line between the sides follows a finger, a finger turns the model, and the sheet can be closed. */
async function touches(viewer, view) {
  const session = await viewer.page.context().newCDPSession(viewer.page);
  const drag = async (from, to) => {
    const point = ([x, y]) => [{ x, y }];
    await session.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: point(from) });
    for (const part of [0.25, 0.5, 0.75, 1]) {
      const at = from.map((x, i) => x + part * (to[i] - x));
      await session.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: point(at) });
    }
    await session.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
    await viewer.settled();
  };
  const middle = view.y + 0.4 * view.height;
  await drag([view.width / 2, middle], [0.25 * view.width, middle]);
  const split = Number(await viewer.page.inputValue('#split'));
  assert.ok(Math.abs(split - 25) < 1, `the line is at ${split} percent`);
  const before = await viewer.picture();
  await drag([0.6 * view.width, middle], [0.9 * view.width, middle]);
  assert.ok((await viewer.picture()).differs(before) > 0.05, 'the model turned');
  // A click, because a tap so soon after a drag may count as its second half.
  await viewer.press('#sheet');
  await viewer.page.waitForSelector('#sheet[aria-expanded=false]');
  const taller = (await viewer.page.locator('#view').boundingBox()).height;
  assert.ok(taller > 1.3 * view.height, `${taller} after ${view.height}`);
  await viewer.press('#sheet');
}
