// The picture for the documentation, written to the folder in the environment variable PICTURES, if any.

import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';

import { browser, serve, Viewer } from './page.mjs';

/** The size limit of a picture on a page of documentation. */
const MOST_BYTES = 300_000;

test('a picture of the page', async () => {
  const [server, chromium] = [await serve(), await browser()];
  try {
    // As the page opens: at the fault of its sample.
    const viewer = await Viewer.open(chromium, `${server.address}#`, { viewport: { width: 960, height: 540 }, colorScheme: 'dark' });
    await viewer.page.$eval('#view', (view) => view.blur());
    await viewer.settled();
    const png = await viewer.page.screenshot();
    assert.ok(png.length < MOST_BYTES, `${png.length} bytes`);
    if (process.env.PICTURES) writeFileSync(join(process.env.PICTURES, 'viewer.png'), png);
  } finally {
    await chromium.close();
    server.close();
  }
});
