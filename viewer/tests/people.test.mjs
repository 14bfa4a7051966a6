// Accessibility: keyboard, screen readers, contrast, dark and light colours, and browsers without WebGL.

import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';

import { browser, serve, Viewer } from './page.mjs';

let server, chromium, viewer;

before(async () => {
  [server, chromium] = [await serve(), await browser()];
  viewer = await Viewer.open(chromium, server.address, { colorScheme: 'light' });
});

after(async () => {
  await chromium?.close();
  server?.close();
  assert.deepEqual(viewer?.faults, []);
});

/** The brightness of the background. */
async function background() {
  return (await viewer.picture()).data[0];
}

test('dark and light follow the system, then the button', async () => {
  assert.ok((await background()) > 180);
  await viewer.page.emulateMedia({ colorScheme: 'dark' });
  assert.ok((await background()) < 80);
  await viewer.click('#theme');
  assert.ok((await background()) > 180);
  assert.equal(await viewer.page.getAttribute('#theme', 'aria-pressed'), 'true');
});

test('text has enough contrast', async () => {
  for (const theme of ['light', 'dark']) {
    const ratios = await viewer.page.evaluate((theme) => {
      document.documentElement.dataset.theme = theme;
      const style = getComputedStyle(document.documentElement);
      const light = (name) => {
        const context = new OffscreenCanvas(1, 1).getContext('2d');
        context.fillStyle = style.getPropertyValue(name);
        context.fillRect(0, 0, 1, 1);
        const linear = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
        const [r, g, b] = [...context.getImageData(0, 0, 1, 1).data].map((x) => linear(x / 255));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const back = light('--back');
      return ['--front', '--faint', '--bad', '--warn', '--good', '--accent'].map((name) => {
        const [less, more] = [back, light(name)].sort((a, b) => a - b);
        return (more + 0.05) / (less + 0.05);
      });
    }, theme);
    // WCAG 2.2, success criterion 1.4.3.
    assert.ok(ratios.every((ratio) => ratio >= 4.5), `${theme}: ${ratios}`);
  }
});

test('the rules for accessible pages hold, dark and light', async () => {
  await viewer.click('input[value=angle]');
  for (const colorScheme of ['light', 'dark']) {
    await viewer.page.emulateMedia({ colorScheme });
    assert.deepEqual(await viewer.violations(), []);
  }
  await viewer.click('input[value=shaded]');
});

const TABS = ['check', 'view', 'pose', 'bake', 'light'];

for (const tab of TABS) test(`${tab}: Tab visits all controls in the order of the page, and focus is visible`, async () => {
  await viewer.click(`#tab-${tab}`);
  const all = await viewer.page.evaluate(() => {
    document.querySelectorAll('[data-order]').forEach((one) => delete one.dataset.order);
    // Tab stops at the selected radio button and the selected tab only.
    const usable = document.querySelectorAll('button:not([tabindex="-1"]), select, summary, canvas[tabindex], input:not([hidden], [type=radio]:not(:checked))');
    const visible = [...usable].filter((one) => one.checkVisibility() && !one.disabled);
    return visible.map((one, at) => (one.dataset.order = String(at)));
  });
  await viewer.page.focus('[data-order="0"]');
  const reached = ['0'];
  while (reached.length < all.length) {
    await viewer.page.keyboard.press('Tab');
    const [order, outline] = await viewer.page.evaluate(() => [document.activeElement.dataset.order, getComputedStyle(document.activeElement).outlineStyle]);
    reached.push(order);
    assert.notEqual(outline, 'none', `${order} after ${reached.length}`);
  }
  assert.deepEqual(reached, all);
  if (tab === 'view') {
    const surface = await viewer.page.$eval('input[name=paint]:checked', (input) => Number(input.dataset.order));
    assert.ok(surface <= 10, `the surface is ${surface} Tabs away`);
  }
});

test('arrow keys choose tabs', async () => {
  await viewer.page.focus('#tab-light');
  for (const [key, tab] of [['ArrowRight', 'check'], ['ArrowLeft', 'light'], ['Home', 'check'], ['ArrowRight', 'view']]) {
    await viewer.page.keyboard.press(key);
    assert.equal(await viewer.page.evaluate(() => document.activeElement.id), `tab-${tab}`);
    assert.equal(await viewer.page.isVisible(`#panel-${tab}`), true);
  }
  await viewer.click('#tab-check');
});

test('sliders have value texts with units', async () => {
  await viewer.slide('split', 30);
  assert.equal(await viewer.page.getAttribute('#split', 'aria-valuetext'), '30 percent: In the file on the left, MikkTSpace on the right');
  await viewer.choose('right', 'lengyel');
  assert.match(await viewer.page.getAttribute('#split', 'aria-valuetext'), /Lengyel on the right$/);
  await viewer.choose('right', 'mikktspace');
  await viewer.slide('split', 50);
  await viewer.slide('light-above', 35.04);
  assert.equal(await viewer.page.getAttribute('#light-above', 'aria-valuetext'), '35 degrees');
});

test('every control has an accessible name', async () => {
  let snapshot = '';
  for (const tab of TABS) {
    await viewer.click(`#tab-${tab}`);
    snapshot += await viewer.page.locator('body').ariaSnapshot();
  }
  for (const line of snapshot.split('\n')) {
    const [, role, name] = /^\s*- (button|checkbox|radio|slider|combobox)\b(?: "(.*?)")?/.exec(line) ?? [];
    if (role) assert.ok(name, `nameless: ${line}`);
  }
  const some = ['button "Open files"', 'combobox "Left"', 'slider "Position of the slider in percent"', 'radio "Shaded" [checked]', 'button "Flip green"', 'heading "Findings"', 'application "The model'];
  for (const expected of some) assert.ok(snapshot.includes(expected), expected);
});

test('the keyboard reaches and turns the model', async () => {
  await viewer.page.focus('#theme');
  await viewer.page.keyboard.press('Tab');
  assert.equal(await viewer.page.evaluate(() => document.activeElement.id), 'view');
  const front = await viewer.picture();
  for (const [key, least] of [['ArrowLeft', 0.05], ['ArrowUp', 0.05], ['+', 0.02], ['Shift+ArrowRight', 0.005]]) {
    const before = await viewer.picture();
    for (let times = 0; times < 4; times++) await viewer.page.keyboard.press(key);
    await viewer.settled();
    assert.ok((await viewer.picture()).differs(before) > least, key);
  }
  for (let times = 0; times < 4; times++) await viewer.page.keyboard.press('Shift+ArrowLeft');
  await viewer.page.keyboard.press('Home');
  await viewer.settled();
  assert.ok((await viewer.picture()).differs(front) < 0.001, 'Home is where it began');
  await viewer.page.keyboard.press('Tab');
  assert.equal(await viewer.page.evaluate(() => document.activeElement.id), 'split');
  await viewer.page.keyboard.press('Home');
  await viewer.settled();
  assert.ok((await viewer.picture()).differs(front, 0.4, 0.5) > 0.005, 'the slider moves, too');
});

test('status texts are announced to screen readers', async () => {
  assert.equal(await viewer.page.getAttribute('#status', 'role'), 'status');
  assert.equal(await viewer.page.getAttribute('#error', 'role'), 'alert');
});

test('without WebGL the page shows an error', async () => {
  const blind = await browser(['--disable-3d-apis']);
  try {
    const page = await Viewer.open(blind, server.address);
    assert.match(await page.text('error'), /WebGL 2 is missing/);
  } finally {
    await blind.close();
  }
});
