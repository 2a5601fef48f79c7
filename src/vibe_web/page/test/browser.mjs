// The page in Chromium, without a display and without a graphics card. Arguments: PORT CHROMIUM FOLDER; pictures go into
// the folder.

import { readdirSync, statSync, writeFileSync } from 'node:fs';
import { check, emulateHeadset, errors, expect, insertion, launch, leftOut, openPage, rest, until, violations, wait } from './checks.mjs';

const [port, chromium, folder] = process.argv.slice(2);
const kPicture = 240; // edge of the endoscope's picture [px]

const browser = await launch(chromium);
const open = (rate) => openPage(browser, `${port}/#size=${kPicture}&rate=${rate}`, [850, 600], 2);
const save = (page, name) => page.screenshot({ path: `${folder}/${name}.png` });
const operator = (page) => page.evaluate(() => window.vibe.drive.operator);

/** Mean and deviation of the grey levels of the endoscope's picture within this share of its radius, and beyond it. */
const levels = (page) => page.evaluate(() => {
  const { size, bytes } = window.vibe.stage.pictureBytes();
  const inside = [], corners = [];
  for (let y = 0; y < size; y++)
    for (let x = 0; x < size; x++) {
      const at = 4 * (y * size + x), grey = (bytes[at] + bytes[at + 1] + bytes[at + 2]) / 3;
      const share = Math.hypot(x - size / 2, y - size / 2) / (size / 2);
      if (share < 0.9) inside.push(grey);
      if (share > 1.05) corners.push(grey);
    }
  const mean = inside.reduce((a, b) => a + b) / inside.length;
  return { mean, deviation: Math.sqrt(inside.reduce((a, b) => a + (b - mean) ** 2, 0) / inside.length), corner: Math.max(...corners) };
});

/** A key that is pressed before the page has the focus is let go when that comes. */
async function toFront(page) {
  await page.bringToFront();
  await until(() => page.evaluate(() => document.hasFocus() && !document.hidden), 'the focus');
}

async function takeControl(page) {
  await toFront(page);
  if (!(await page.evaluate(() => window.vibe.drive.driving))) await page.click('#control');
  await until(async () => (await operator(page))?.driving && page.evaluate(() => window.vibe.drive.driving), 'control of the scope');
}

let page;
await check('the page shows the organ', async () => {
  page = await open(15);
  await until(() => page.evaluate(() => window.vibe.stage.counts.calls >= 10), 'the robot');
  await wait(1000);
  await save(page, 'organ');
  const numbers = await page.evaluate(() => ({ ...window.vibe.stage.counts, first_picture_ms: window.vibe.stats.firstPicture }));
  expect(numbers.calls <= 25 && numbers.triangles <= 120000, JSON.stringify(numbers)); // three pictures of the scene
  return numbers;
});

await check('the endoscope sees a round, lit and exposed picture', async () => {
  await page.click('#swap');
  await wait(1500);
  await save(page, 'endoscope');
  const seen = await levels(page);
  expect(seen.corner === 0, `corners at ${seen.corner}`);
  expect(seen.mean > 50 && seen.mean < 200 && seen.deviation > 10, JSON.stringify(seen));
  return seen;
});

await check('what is left out of the picture is not in it', async () => {
  const found = await leftOut(page);
  expect(found.differ === 0 && found.control > 0, JSON.stringify(found));
  return found;
});

await check('nothing was wrong in the console', async () => expect(errors.length === 0, errors.join('\n')));

await check('accessibility (axe)', async () => {
  const found = await violations(page);
  expect(found.length === 0, found.join('\n'));
});

await check('a key drives', async () => {
  await takeControl(page);
  const begin = await rest(page);
  await page.keyboard.down('w');
  await until(async () => (await insertion(page)) > begin + 0.01, 'motion');
  await page.keyboard.up('w');
  const end = await rest(page);
  await save(page, 'driving');
  return { joints: (await operator(page)).joints, way: end - begin };
});

await check('a finger drives', async () => {
  const begin = await rest(page);
  const key = await page.$('#keys button[data-key="87"]');
  await key.scrollIntoView();
  const { x, y, width, height } = await key.boundingBox();
  await page.touchscreen.touchStart(x + width / 2, y + height / 2);
  await until(async () => (await insertion(page)) > begin + 0.005, 'motion');
  await page.touchscreen.touchEnd();
  const end = await rest(page);
  return { way: end - begin };
});

await check('a picture and a video are saved', async () => {
  const session = await page.createCDPSession();
  await session.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: folder });
  const saved = (ending) => readdirSync(folder).find((name) => name.startsWith('vibe-') && name.endsWith(ending));
  await page.click('#picture');
  await until(() => saved('.png'), 'a picture');
  await page.click('#video');
  const times = new Set();
  await until(async () => times.add(await page.evaluate(() => window.vibe.stage.time)).size > 5, 'frames to record');
  await page.click('#video');
  await until(() => saved('.webm'), 'a video');
  const sizes = { picture: statSync(`${folder}/${saved('.png')}`).size, video: statSync(`${folder}/${saved('.webm')}`).size };
  expect(sizes.picture > 20000 && sizes.video > 5000, JSON.stringify(sizes)); // six pictures have about 20 kB
  return sizes;
});

await check('a gamepad drives', async () => {
  const begin = await rest(page);
  await page.evaluate(() => {
    const buttons = Array.from({ length: 17 }, () => ({ pressed: false, value: 0 }));
    window.pad = { index: 0, id: 'pad', mapping: 'standard', axes: [0, 0, 0, 1], buttons };
    navigator.getGamepads = () => [window.pad];
  });
  await wait(1000);
  expect((await insertion(page)) === begin, 'a stick that was not in the middle drives');
  await page.evaluate(() => (window.pad.axes[3] = 0));
  await wait(500);
  await page.evaluate(() => (window.pad.axes[3] = 1)); // the right stick towards the person: back
  await until(async () => (await insertion(page)) < begin - 0.005, 'motion');
  await page.evaluate(() => (navigator.getGamepads = () => []));
  await rest(page);
  return { joints: (await operator(page)).joints };
});

await check('a page that hangs lets go', async () => {
  const begin = await rest(page), watcher = await open(2); // which draws little, and answers soon
  await takeControl(page); // again, if the other page has taken long to open
  await page.keyboard.down('w');
  await until(async () => (await insertion(page)) > begin, 'motion');
  void page.evaluate(() => { for (const end = Date.now() + 4000; Date.now() < end; ); });
  const end = await rest(watcher);
  expect(end - begin < 0.06, `moved by ${end - begin} m`);
  await wait(3000);
  await page.keyboard.up('w');
  await page.close();
  await watcher.close();
});

await check('nothing was wrong in the console at the end', async () => expect(errors.length === 0, errors.join('\n')));
writeFileSync(`${folder}/errors.txt`, errors.join('\n'));
await browser.close();
process.exit(0);
