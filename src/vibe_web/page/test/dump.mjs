// Writes the endoscope's picture of the page as raw bytes (RGBA, rows from below) into each file that is named on a line of
// the input; the exposure is found anew for each. Arguments: PORT CHROMIUM SIZE.

import { writeFileSync } from 'node:fs';
import { createInterface } from 'node:readline';
import { launch, until, wait } from './checks.mjs';

const [port, chromium, size] = process.argv.slice(2);
const browser = await launch(chromium);
const page = await browser.newPage();
await page.setViewport({ width: 300, height: 300 });
await page.goto(`http://localhost:${port}/#size=${size}&view=endoscope&rate=2`);
console.log('ready');
for await (const file of createInterface({ input: process.stdin })) {
  await until(() => page.evaluate(() => window.vibe.stage.organ.mucosa.uniforms.pattern.value !== null), 'the pattern');
  await wait(2500); // folds and heat come five times a second
  const data = await page.evaluate(() => {
    const { stage } = window.vibe;
    stage.endoscope.exposure.time = NaN;
    stage.refresh();
    stage.draw();
    let text = '';
    for (const byte of stage.pictureBytes().bytes) text += String.fromCharCode(byte);
    return btoa(text);
  });
  writeFileSync(file, Buffer.from(data, 'base64'));
  console.log(file);
}
await browser.close();
