// Large models: the page shows progress and stays responsive. Privacy: the page sends no request to another machine.

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

import { browser, serve, Viewer } from './page.mjs';
import { gltf, grid, QUAD } from './quads.mjs';

/** Quads along a side: 204,800 triangles. */
const SIDE = 320;

let server, folder;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'viewer-'));
  server = await serve();
});

after(() => {
  server?.close();
  rmSync(folder, { recursive: true });
});

test('a large model shows progress, and the page answers meanwhile', async () => {
  const chromium = await browser();
  try {
    const viewer = await Viewer.open(chromium, server.address, { viewport: { width: 500, height: 400 } });
    writeFileSync(join(folder, 'grid.gltf'), gltf(grid(SIDE)));
    // All status texts, and those during which a button worked while the progress bar was shown.
    await viewer.page.evaluate(() => {
      const [status, bar, theme] = ['status', 'progress', 'theme'].map((id) => document.getElementById(id));
      globalThis.log = { said: [], answered: [], captions: [] };
      const { said, answered, captions } = globalThis.log;
      const caption = document.getElementById('caption-left');
      new MutationObserver(() => captions.push(caption.textContent)).observe(caption, { childList: true });
      new MutationObserver((changes) => changes.forEach(({ addedNodes: [text] }) => text && said.push(text.textContent))).observe(status, { childList: true });
      setInterval(() => {
        if (bar.hidden || answered.includes(status.textContent)) return;
        const before = theme.ariaPressed;
        theme.click();
        if (theme.ariaPressed !== before) answered.push(status.textContent);
      }, 10);
    });
    await viewer.give('files', [join(folder, 'grid.gltf')]);
    assert.deepEqual([await viewer.text('error'), await viewer.text('status')], ['', '204,800 triangles in 1 part']);
    const { said, answered } = await viewer.page.evaluate(() => globalThis.log);
    const captions = await viewer.page.evaluate(() => globalThis.log.captions);
    assert.ok(captions.includes('Coarse preview'), captions.join());
    const work = ['Reading grid.gltf', 'Opening grid.gltf', 'Computing tangents of mesh_0'];
    assert.deepEqual(said.filter((text) => work.includes(text)), work);
    for (const long of ['Opening grid.gltf', 'Computing tangents of mesh_0']) assert.ok(answered.includes(long), `${long} in ${answered}`);
    assert.match(await viewer.text('findings-summary'), /\d|wrong/);
    assert.deepEqual(viewer.faults, []);
  } finally {
    await chromium.close();
  }
});

test('nothing leaves the machine', async () => {
  // A proxy that gets every request to another machine.
  const asked = [];
  const proxy = createServer((socket) => socket.on('error', () => {}).once('data', (data) => socket.end(asked.push(String(data).split('\r\n')[0]) && '')));
  await new Promise((resolve) => proxy.listen(0, '127.0.0.1', resolve));
  const chromium = await browser([`--proxy-server=http://127.0.0.1:${proxy.address().port}`]);
  try {
    const viewer = await Viewer.open(chromium, server.address, { viewport: { width: 500, height: 400 } });
    const requests = [];
    viewer.page.on('request', (request) => requests.push(request.url()));
    const elsewhere = (name) => `http://elsewhere.example/${name}`;
    const images = ['color.png', 'normal.png'].map((name) => ({ uri: elsewhere(name) }));
    const materials = [{ normalTexture: { index: 1 }, pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }];
    const textures = [{ source: 0 }, { source: 1 }];
    writeFileSync(join(folder, 'image.gltf'), gltf({ primitive: { material: 0 }, json: () => ({ images, materials, textures }) }));
    writeFileSync(join(folder, 'buffer.gltf'), gltf({ attributes: QUAD, json: () => ({ buffers: [{ byteLength: 9, uri: elsewhere('a.bin') }] }) }));
    writeFileSync(join(folder, 'quad.obj'), `mtllib ${elsewhere('a.mtl')}\nmtllib quad.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n`);
    writeFileSync(join(folder, 'quad.mtl'), `newmtl a\nmap_Kd ${elsewhere('color.png')}\nnorm //elsewhere.example/normal.png\n`);
    for (const files of [['image.gltf'], ['buffer.gltf'], ['quad.obj', 'quad.mtl']]) {
      await viewer.give('files', files.map((name) => join(folder, name)));
    }
    assert.match(await viewer.text('status'), /a\.mtl" is not among the files.*color\.png" is not among the files.*normal\.png" is not among the files/);
    await viewer.download('#save-model');
    await viewer.download('#save-picture');
    await viewer.click('#open-sample');
    const foreign = requests.filter((url) => !url.startsWith(server.address) && !/^(blob|data):/.test(url));
    assert.ok(requests.length > 0);
    // The browser itself checks for updates despite its options.
    const ofPage = asked.filter((line) => !/\b(google|googleapis|gstatic)\.com\b/.test(line));
    assert.deepEqual([foreign, ofPage], [[], []]);
    // Proves that the proxy sees such a request.
    await viewer.page.goto(elsewhere('page')).catch(() => {});
    assert.ok(asked.some((line) => line.includes('elsewhere.example')), asked.join());
  } finally {
    await chromium.close();
    proxy.close();
  }
});
