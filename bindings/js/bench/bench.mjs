// `npm run bench`: times every engine in Node.js (processor time) and in headless Chromium (wall time), in nanoseconds per triangle.

import { fileURLToPath } from 'node:url';
import { open } from '../tests/browser/open.mjs';
import { measure } from './engines.mjs';

const ROUNDS = 9;

/** The processor time of all threads of the process, in milliseconds. */
function processorTime() {
  const { user, system } = process.cpuUsage();
  return (user + system) / 1000;
}

async function inChromium() {
  const { browser, page } = await open(fileURLToPath(new URL('engines.mjs', import.meta.url)));
  const times = await page.evaluate((rounds) => tested.measure(rounds, () => performance.now()), ROUNDS);
  await browser.close();
  return times;
}

function print(where, times) {
  console.log(`\n${where}: least / median, medians in times of darboux/tangents`);
  const unit = times['darboux/tangents'].median;
  for (const [name, { least, median }] of Object.entries(times)) {
    console.log(`${name.padEnd(36)} ${least.toFixed(0).padStart(6)} / ${median.toFixed(0).padStart(5)} ${(median / unit).toFixed(2).padStart(7)}`);
  }
}

print(`Node.js ${process.version}, processor time`, await measure(ROUNDS, processorTime));
print('Chromium, wall time', await inChromium());
