// Pictures of the page, for benchmark/take_page.py. Arguments: PORT CHROMIUM FOLDER.

import { launch, until, wait } from './checks.mjs';

const [port, chromium, folder] = process.argv.slice(2);
const kSizes = { web: [1280, 800], web_narrow: [400, 860] }; // [px]
const browser = await launch(chromium);
for (const [name, [width, height]] of Object.entries(kSizes)) {
  const page = await browser.newPage();
  await page.setViewport({ width, height });
  await page.goto(`http://localhost:${port}/#size=480&rate=5`);
  await until(() => page.evaluate(() => window.vibe?.stats.firstPicture > 0 && window.vibe.stage.counts.calls >= 9), 'a picture', 200);
  await wait(6000); // folds and heat come later
  await page.screenshot({ path: `${folder}/${name}.png` });
  await page.close();
}
await browser.close();
process.exit(0);
