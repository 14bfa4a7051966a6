// The page of the conformance suite, from the file system: light, dark and on a phone.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';

import { browser, root } from './page.mjs';

const address = pathToFileURL(join(root, 'conformance/results/index.html')).href;
let chromium;

before(async () => (chromium = await browser()));
after(() => chromium?.close());

/** The pictures beside the page, the only files that it loads. */
const pictures = new URL('model/', address).href;

/** The page and what it complained about. */
async function open(options) {
  const page = await (await chromium.newContext(options)).newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('console', (message) => message.type() === 'error' && faults.push(message.text()));
  page.on('request', (request) => request.url() !== address && !request.url().startsWith(pictures) && faults.push(`a request to ${request.url()}`));
  page.on('requestfailed', (request) => faults.push(`there is no ${request.url()}`));
  await page.goto(address);
  return { page, faults };
}

test('a failing case unfolds with its sentence, numbers and pictures', async () => {
  const { page, faults } = await open({ viewport: { width: 1000, height: 700 } });
  assert.ok((await page.$$('tbody tr')).length > 16);
  const drawn = await page.$eval('details.case[data-case="mirrored-pair"]', async (details) => {
    details.closest('section > details').open = true;
    details.open = true;
    await new Promise((resolve) => details.addEventListener('toggle', resolve, { once: true }));
    return {
      words: details.textContent,
      pictures: Array.from(details.querySelectorAll('canvas'), (canvas) => {
        const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
        return new Set(data.filter((_, at) => at % 4 === 0)).size;
      }),
    };
  });
  assert.match(drawn.words, /corners differ/);
  const { shows } = JSON.parse(readFileSync(new URL('../../conformance/cases/mirrored-pair.json', import.meta.url), 'utf8'));
  assert.ok(drawn.words.includes(shows), drawn.words);
  assert.equal(drawn.pictures.length, 3);
  assert.ok(drawn.pictures[0] > 20, `the reference has ${drawn.pictures[0]} shades`);
  assert.deepEqual(faults, []);
});

test('every picture can be drawn', async () => {
  const { page, faults } = await open({});
  const [cases, blank] = await page.evaluate(() => {
    const all = Array.from(document.querySelectorAll('details.case[data-case]'));
    all.forEach(draw);
    return [all.length, all.filter((details) => details.querySelectorAll('canvas').length !== 3).length];
  });
  assert.ok(cases > 20);
  assert.deepEqual([blank, faults], [0, []]);
});

for (const colorScheme of ['light', 'dark']) {
  test(`text is readable on every colour: ${colorScheme}`, async () => {
    const { page } = await open({ colorScheme });
    const contrasts = await page.$$eval('body, td.bits, td.angle, td.seams, td.fails, small', (elements) => {
      const context = Object.assign(document.createElement('canvas'), { width: 1, height: 1 }).getContext('2d', { willReadFrequently: true });
      const luminance = (colour) => {
        context.clearRect(0, 0, 1, 1);
        context.fillStyle = colour;
        context.fillRect(0, 0, 1, 1);
        const [r, g, b] = Array.from(context.getImageData(0, 0, 1, 1).data, (x) => (x / 255 <= 0.04045 ? x / 255 / 12.92 : ((x / 255 + 0.055) / 1.055) ** 2.4));
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
      };
      const canvas = matchMedia('(prefers-color-scheme: dark)').matches ? '#121212' : '#ffffff';
      return elements.map((element) => {
        const style = getComputedStyle(element);
        const behind = style.backgroundColor === 'rgba(0, 0, 0, 0)' ? canvas : style.backgroundColor;
        const [low, high] = [luminance(style.color), luminance(behind)].sort((a, b) => a - b);
        return (high + 0.05) / (low + 0.05);
      });
    });
    assert.ok(Math.min(...contrasts) >= 4.5, `the least contrast is ${Math.min(...contrasts)}`);
  });
}

test('a phone scrolls the table, not the page', async () => {
  const { page } = await open({ viewport: { width: 360, height: 640 }, isMobile: true });
  const { width, inner } = await page.evaluate(() => ({ width: document.documentElement.scrollWidth, inner: innerWidth }));
  assert.ok(width <= inner, `${width} > ${inner}`);
});
