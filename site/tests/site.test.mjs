// The documentation's site in headless Chromium. SITE is its folder; playwright-core is the one of bindings/js, and axe-core that of the viewer.
// The environment variable PICTURES names a folder for screenshots and a printed page to look at.

import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { extname, join, relative } from 'node:path';
import { after, before, test } from 'node:test';

const { chromium } = createRequire(new URL('../../bindings/js/', import.meta.url))('playwright-core');
const axe = readFileSync(createRequire(new URL('../../viewer/', import.meta.url)).resolve('axe-core/axe.min.js'), 'utf8');
const site = process.env.SITE;
const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
const skip = existsSync(executablePath) || process.env.CI !== undefined ? false : `there is no Chromium at ${executablePath}`;
const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.png': 'image/png', '.wasm': 'application/wasm' };

let server;
let browser;
let origin;

before(async () => {
  if (skip) return;
  server = createServer((request, response) => {
    const path = join(site, decodeURIComponent(new URL(request.url, 'http://localhost').pathname));
    const file = existsSync(path) && statSync(path).isDirectory() ? join(path, 'index.html') : path;
    if (!existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': TYPES[extname(file)] ?? 'text/plain' }).end(readFileSync(file));
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  origin = `http://127.0.0.1:${server.address().port}`;
  browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking'] });
});

after(async () => {
  await browser?.close();
  server?.close();
});

/** Opens a page; errors in it and files that are missing are collected. */
async function open(path, options = {}) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(error.message));
  page.on('response', (response) => response.status() >= 400 && faults.push(`${response.status()} ${response.url()}`));
  await page.goto(`${origin}/${path}`, { waitUntil: 'networkidle' });
  return { page, faults, close: () => context.close() };
}

/** All pages but the viewer's, which has tests of its own. */
const pages = () => readdirSync(site, { recursive: true }).filter((name) => name.endsWith('.html') && !name.startsWith('viewer/'));

/** The sizes of a phone, a tablet and a desktop. */
const SCREENS = { phone: { width: 390, height: 844 }, tablet: { width: 768, height: 1024 }, desktop: { width: 1280, height: 800 } };

test('every page loads without errors or missing files, and every link of every page leads somewhere', { skip, timeout: 300_000 }, async () => {
  const context = await browser.newContext();
  const page = await context.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(`${page.url()}: ${error.message}`));
  page.on('response', (response) => response.status() >= 400 && faults.push(`${page.url()}: ${response.status()} ${response.url()}`));
  const ids = new Map();
  const links = [];
  for (const name of pages()) {
    await page.goto(`${origin}/${name}`, { waitUntil: 'load' });
    const found = await page.evaluate(() => ({
      ids: Array.from(document.querySelectorAll('[id]'), ({ id }) => id),
      links: Array.from(document.querySelectorAll('a[href]'), ({ href }) => href),
      title: document.title,
    }));
    assert.match(found.title, /./, name);
    for (const viewport of [SCREENS.phone, SCREENS.desktop]) {
      await page.setViewportSize(viewport);
      const [scrollWidth, clientWidth] = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.clientWidth]);
      if (scrollWidth > clientWidth) faults.push(`${name} scrolls sideways, ${scrollWidth} wide on ${clientWidth}`);
    }
    ids.set(new URL(`${origin}/${name}`).pathname, new Set(found.ids));
    links.push(...found.links.map((href) => [name, new URL(href)]));
  }
  for (const [name, url] of links.filter(([, url]) => url.origin === origin)) {
    const path = join(site, decodeURIComponent(url.pathname));
    if (!existsSync(path)) faults.push(`${name}: ${url}: there is no such file`);
    const file = existsSync(path) && statSync(path).isDirectory() ? join(path, 'index.html') : path;
    const known = ids.get(`/${relative(site, file)}`);
    if (url.hash && known && !known.has(decodeURIComponent(url.hash.slice(1)))) faults.push(`${name}: ${url}: there is no such heading`);
  }
  await context.close();
  assert.deepEqual(faults, []);
});

/** The findings of the rules for accessible pages, beside those inside the viewer's frames. */
async function violations(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => globalThis.axe.run(document, { iframes: false }));
  return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(' ')}`);
}

for (const [name, viewport] of Object.entries(SCREENS)) {
  test(`the rules for accessible pages hold, light and dark (${name})`, { skip, timeout: 600_000 }, async () => {
    const faults = [];
    // Scripts of the viewer in frames would take most of the time.
    const context = await browser.newContext({ viewport });
    await context.route('**/viewer/**', (route) => route.abort());
    const page = await context.newPage();
    for (const path of pages().filter((path) => name === 'desktop' || /^(index|docs\/(learn\/|viewer|bake))/.test(path))) {
      await page.goto(`${origin}/${path}`, { waitUntil: 'load' });
      for (const colorScheme of ['light', 'dark']) {
        await page.emulateMedia({ colorScheme });
        faults.push(...(await violations(page)).map((fault) => `${path}, ${colorScheme}: ${fault}`));
        if (process.env.PICTURES && /symptoms|5-mirrored/.test(path)) await page.screenshot({ path: join(process.env.PICTURES, `${path.replace(/.*\//, '')}-${name}-${colorScheme}.png`) });
      }
    }
    await context.close();
    assert.deepEqual(faults, []);
  });
}

test('a right and a wrong picture lie under a slider, and beside each other without scripts', { skip, timeout: 60_000 }, async () => {
  const { page, faults, close } = await open('docs/check.html', { viewport: SCREENS.phone });
  const pair = page.locator('.pair').first();
  await pair.waitFor();
  assert.equal(await page.locator('main td > img').count(), 0, 'every pair is a slider');
  const shots = [];
  for (const percent of ['100', '0']) {
    await pair.locator('input').fill(percent);
    shots.push((await pair.screenshot()).toString('base64'));
  }
  assert.notEqual(shots[0], shots[1]);
  assert.deepEqual(faults, []);
  await close();
  const still = await open('docs/check.html', { javaScriptEnabled: false });
  assert.ok((await still.page.locator('main td > img').count()) > 20);
  await still.close();
});

test('the front page begins at its top, with the viewer in it', { skip, timeout: 120_000 }, async () => {
  const { page, faults, close } = await open('index.html', { viewport: SCREENS.phone });
  await page.frameLocator('iframe').locator('#status', { hasText: /^768 triangles in 1 part$/ }).waitFor({ timeout: 60_000 });
  assert.equal(await page.evaluate(() => scrollY), 0);
  assert.deepEqual(faults, []);
  await close();
});

test('a lesson embeds the viewer in a state', { skip, timeout: 120_000 }, async () => {
  const { page, faults, close } = await open('docs/learn/5-mirrored.html', { viewport: SCREENS.desktop });
  await page.locator('iframe').scrollIntoViewIfNeeded();
  const viewer = page.frameLocator('iframe');
  await viewer.locator('#status', { hasText: /^768 triangles in 1 part$/ }).waitFor({ timeout: 60_000 });
  assert.deepEqual([await viewer.locator('#left').inputValue(), await viewer.locator('#right').inputValue()], ['file', 'mikktspace']);
  assert.ok(await viewer.locator('#lines-tangent').isChecked());
  assert.ok((await page.locator('figure.viewer a').getAttribute('href')).startsWith('../../viewer/index.html#left=file'));
  if (process.env.PICTURES) await page.locator('figure.viewer').screenshot({ path: join(process.env.PICTURES, 'embedded.png') });
  assert.deepEqual(faults, []);
  await close();
});

test('what is seen leads to the mistake in two clicks', { skip }, async () => {
  const { page, close } = await open('index.html');
  for (const [seen, mistake] of [
    ['Bumps look like dents everywhere', 'map-green-flipped'],
    ['Bumps look like dents everywhere', 'tangent-sign-flipped'],
    ['A line down the middle', 'one-tangent-per-vertex-at-a-mirrored-seam'],
    ['Fine until I scaled it', 'tangent-transformed-by-the-normal-matrix'],
  ]) {
    await page.goto(`${origin}/index.html`);
    await page.locator('main a[href*="symptoms"]').first().click();
    await page.locator('tr', { hasText: seen }).locator(`td:nth-child(2) a[href$="#${mistake}"]`).click();
    await page.waitForURL(new RegExp(`#${mistake}$`));
    const heading = page.locator(`[id="${mistake}"]`);
    const { y } = await heading.boundingBox();
    assert.ok(y >= 0 && y < 300, `${mistake} is at ${y}`);
    assert.ok((await heading.locator('xpath=following::img').count()) > 0, 'a picture follows');
  }
  await close();
});

test('search finds sections, and its links lead to them', { skip }, async () => {
  const { page, faults, close } = await open('index.html');
  await page.fill('input[type=search]', 'mirrored seam');
  const first = page.locator('.found a').first();
  await first.waitFor();
  assert.match(await first.getAttribute('href'), /^docs\/(algorithms\/mistakes|learn|check)/, 'a page for people stands above reports');
  await page.fill('input[type=search]', 'prefix sum');
  const link = page.locator('.found a', { hasText: 'parallel' }).first();
  await link.waitFor();
  await link.click();
  await page.waitForURL(/10-parallel\.html/);
  await page.fill('input[type=search]', 'xyzzyplugh');
  await page.locator('.found li', { hasText: 'Nothing found.' }).waitFor();
  assert.deepEqual(faults, []);
  await close();
});

for (const [name, viewport, colorScheme] of [['phone', { width: 390, height: 844 }, 'light'], ['desktop', { width: 1280, height: 800 }, 'dark']]) {
  test(`interactive figures follow the pointer and the keys (${name}, ${colorScheme})`, { skip }, async () => {
    const options = { viewport, colorScheme, hasTouch: name === 'phone' };
    const triangle = await open('docs/learn/2-two-derivatives.html', options);
    const output = triangle.page.locator('.interactive output');
    await output.waitFor();
    const before = await output.innerText();
    assert.match(before, /^det U = 0\.64, .*w = \+1$/);
    const handle = triangle.page.getByRole('button', { name: 'uv of p1 in the picture' });
    await handle.scrollIntoViewIfNeeded();
    const box = await handle.boundingBox();
    await triangle.page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await triangle.page.mouse.down();
    await triangle.page.mouse.move(box.x - 10, box.y - 30, { steps: 4 });
    await triangle.page.mouse.up();
    assert.notEqual(await output.innerText(), before);
    // Beyond the other side, the picture is mirrored.
    await triangle.page.getByRole('button', { name: 'uv of p2 in the picture' }).focus();
    for (let step = 0; step < 9; step++) await triangle.page.keyboard.press('ArrowDown');
    for (let step = 0; step < 9; step++) await triangle.page.keyboard.press('ArrowRight');
    assert.match(await output.innerText(), /det U = −.*w = −1: mirrored$/);
    await triangle.page.getByRole('button', { name: 'p2 on the surface' }).focus();
    for (let step = 0; step < 30; step++) await triangle.page.keyboard.press('ArrowDown');
    assert.match(await output.innerText(), /w = −1: mirrored; you see its back$/);
    assert.deepEqual(triangle.faults, []);
    if (process.env.PICTURES) await triangle.page.locator('.interactive').screenshot({ path: `${process.env.PICTURES}/triangle-${name}.png` });
    await triangle.close();

    const seam = await open('docs/learn/5-mirrored.html', options);
    const said = seam.page.locator('.interactive output');
    await said.waitFor();
    assert.match(await said.innerText(), /^Both halves have w = \+1/);
    await seam.page.getByRole('button', { name: 'u of the right edge' }).focus();
    for (let step = 0; step < 7; step++) await seam.page.keyboard.press('ArrowLeft');
    assert.match(await said.innerText(), /2 vertices at the seam were split/);
    assert.deepEqual(seam.faults, []);
    if (process.env.PICTURES) await seam.page.locator('.interactive').screenshot({ path: `${process.env.PICTURES}/seam-${name}.png` });
    await seam.close();

    const weights = await open('docs/learn/6-weights.html', options);
    const angle = weights.page.locator('.interactive output');
    await angle.waitFor();
    const angles = new Set();
    for (const method of ['average', 'lengyel', 'area', 'mikktspace']) {
      await weights.page.locator(`input[value=${method}]`).check();
      angles.add(await angle.innerText());
    }
    assert.equal(angles.size, 4, [...angles].join('\n'));
    assert.deepEqual(weights.faults, []);
    if (process.env.PICTURES) await weights.page.screenshot({ path: `${process.env.PICTURES}/weights-${name}.png`, fullPage: true });
    await weights.close();
  });
}

test('a page prints as text and figures, with the answers open', { skip }, async () => {
  const { page, close } = await open('docs/learn/6-weights.html');
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  await page.emulateMedia({ media: 'print' });
  assert.ok(!(await page.locator('header').isVisible()));
  assert.ok(await page.locator('main details p').first().isVisible());
  const printed = await page.pdf({ printBackground: true, ...(process.env.PICTURES ? { path: join(process.env.PICTURES, 'printed.pdf') } : {}) });
  assert.ok(printed.length > 10_000);
  await close();
});
