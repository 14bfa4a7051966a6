// The built page in headless Chromium.

import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { createRequire } from 'node:module';
import { dirname, extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const here = dirname(fileURLToPath(import.meta.url));

/** The repository's root. */
export const root = join(here, '../..');

const KINDS = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

/** A timeout that a slow machine without a graphics card does not reach. */
const LONG = 120_000;

/** Serves the built page. Returns its address. */
export async function serve() {
  const server = createServer(async (request, response) => {
    const path = normalize(new URL(request.url, 'http://x').pathname);
    const name = path === '/' ? 'index.html' : path;
    try {
      const bytes = await readFile(join(here, '../dist', name));
      response.writeHead(200, { 'Content-Type': KINDS[extname(name)] ?? 'application/octet-stream' });
      response.end(bytes);
    } catch {
      response.writeHead(404).end('no such file');
    }
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() };
}

/** Starts the browser. */
export function browser(more = []) {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', ...more],
  });
}

/** A page with the viewer, and the actions of tests. */
export class Viewer {
  /** What the page said that it should not have, and what it asked of others. */
  faults = [];

  /** Opens the page, which shows the whole of models and not their faults, but for addresses with a state of their own. */
  static async open(browser, address, options = {}) {
    const context = await browser.newContext({ viewport: { width: 1000, height: 600 }, reducedMotion: 'reduce', ...options });
    const viewer = new Viewer();
    viewer.page = await context.newPage();
    viewer.page.setDefaultTimeout(LONG);
    viewer.page.on('pageerror', (error) => viewer.faults.push(error.message));
    viewer.page.on('console', (message) => message.type() === 'error' && viewer.faults.push(message.text()));
    viewer.page.on('request', (request) => {
      const url = request.url();
      if (!url.startsWith(new URL(address).origin) && !/^(blob|data):/.test(url)) viewer.faults.push(`a request to ${url}`);
    });
    await viewer.page.goto(address.includes('#') ? address : `${address}#first-sight=0`);
    await viewer.settled();
    return viewer;
  }

  /** Waits until the page has done what it was asked for. */
  async settled() {
    await this.page.waitForFunction(() => {
      const text = (id) => document.getElementById(id).textContent;
      const isChecked = document.getElementById('findings').ariaBusy === 'false';
      const isBaking = document.getElementById('bake').ariaBusy === 'true';
      const isMoving = document.getElementById('view').ariaBusy === 'true';
      return isChecked && !isBaking && !isMoving && document.getElementById('progress').hidden && (text('status') || text('error'));
    });
    // The page draws in the next animation frame.
    await this.page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  }

  text(id) {
    return this.page.textContent(`#${id}`);
  }

  /** Opens the tab and the folds that something is in. */
  reveal(selector) {
    return this.page.$$eval(selector, ([found]) => {
      for (let around = found; around; around = around.parentElement) {
        if (around.role === 'tabpanel' && around.hidden) document.getElementById(around.getAttribute('aria-labelledby')).click();
        if (around.tagName === 'DETAILS' && around !== found.closest('summary')?.parentElement) around.open = true;
      }
    });
  }

  /** The findings of the check: code, severity and sentence. */
  async findings() {
    await this.reveal('#findings');
    await this.page.$eval('#notes', (notes) => (notes.open = true));
    return this.page.$$eval('#findings > li, #notes-list > li', (items) => items.map((item) => ({ code: item.dataset.code, severity: item.dataset.severity, text: item.innerText })));
  }

  /** The findings of the rules for accessible pages. */
  async violations() {
    const axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
    await this.page.evaluate(axe);
    const { violations } = await this.page.evaluate(() => globalThis.axe.run());
    return violations.map(({ id, nodes }) => [id, nodes.map(({ html }) => html)]);
  }

  async choose(id, source) {
    await this.reveal(`#${id}`);
    await this.page.selectOption(`#${id}`, source);
    await this.settled();
  }

  /** Sets a slider, as a hand would. */
  async slide(id, value) {
    await this.page.$eval(`#${id}`, (input, value) => {
      input.value = value;
      input.dispatchEvent(new Event('input', { bubbles: true }));
    }, String(value));
    await this.settled();
  }

  /** Presses, checks or unchecks something. */
  async click(selector) {
    await this.reveal(selector);
    await this.page.click(selector);
    await this.settled();
  }

  /** Presses something, without waiting for what it does. */
  async press(selector) {
    await this.reveal(selector);
    await this.page.click(selector);
  }

  /** Checks a box. */
  async tick(selector) {
    await this.reveal(selector);
    await this.page.check(selector);
  }

  /** Chooses an option, without waiting for what it does. */
  async pick(selector, value) {
    await this.reveal(selector);
    await this.page.selectOption(selector, value);
  }

  /** The codes of the findings. */
  async codes() {
    return (await this.findings()).map(({ code }) => code);
  }

  /** Gives files or a folder to a button. */
  async give(id, paths) {
    await this.page.setInputFiles(`#${id}`, paths);
    await this.settled();
  }

  /** Drops files and folders onto the page, as the system does it. */
  async drop(...files) {
    const session = await this.page.context().newCDPSession(this.page);
    const data = { items: [], files, dragOperationsMask: 1 };
    for (const type of ['dragEnter', 'dragOver', 'drop']) await session.send('Input.dispatchDragEvent', { type, x: 200, y: 200, data });
    await session.detach();
    await this.settled();
  }

  /** What a button gives as a file: its name and bytes. */
  async download(selector) {
    await this.reveal(selector);
    const [download] = await Promise.all([this.page.waitForEvent('download'), this.page.click(selector)]);
    await this.settled();
    return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
  }

  /** The picture, without what lies over it. */
  async picture() {
    const show = (visibility) => this.page.$$eval('#divider, .caption, .split, #legend, #values, #chips, #verdict, #broken', (over, visibility) => over.forEach((one) => (one.style.visibility = visibility)), visibility);
    await show('hidden');
    const shot = await this.page.locator('#view').screenshot();
    await show('');
    return Picture.decode(this.page, shot);
  }

  close() {
    return this.page.context().close();
  }
}

/** The pixels of a screenshot. */
export class Picture {
  constructor(width, height, data) {
    Object.assign(this, { width, height, data });
  }

  /** Has a page decode a PNG. */
  static async decode(page, png) {
    const { width, height, text } = await page.evaluate(async (text) => {
      const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${text}`)).blob());
      const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
      context.drawImage(image, 0, 0);
      const bytes = context.getImageData(0, 0, image.width, image.height).data;
      let out = '';
      for (let at = 0; at < bytes.length; at += 8192) out += String.fromCharCode(...bytes.subarray(at, at + 8192));
      return { width: image.width, height: image.height, text: btoa(out) };
    }, png.toString('base64'));
    return new Picture(width, height, Buffer.from(text, 'base64'));
  }

  /** The part of the pixels between two columns, from 0 to 1, that pass a test of red, green and blue. */
  share(test, from = 0, to = 1) {
    return this.#share((at) => test(this.data[at], this.data[at + 1], this.data[at + 2]), from, to);
  }

  /** The part of the pixels between two columns that differ from another picture's by more than noise. */
  differs(other, from = 0, to = 1) {
    const differs = (at) => [0, 1, 2].some((i) => Math.abs(this.data[at + i] - other.data[at + i]) > 6);
    return this.#share(differs, from, to);
  }

  /** The mean difference of the channels from another picture. */
  distance(other) {
    return this.data.reduce((sum, x, at) => sum + Math.abs(x - other.data[at]), 0) / this.data.length;
  }

  #share(test, from, to) {
    let [found, all] = [0, 0];
    for (let y = 0; y < this.height; y++) {
      for (let x = Math.round(from * this.width); x < Math.round(to * this.width); x++, all++) {
        if (test(4 * (y * this.width + x))) found++;
      }
    }
    return found / all;
  }
}
