// Keys, fingers and focus of Chromium in random order: what the page holds is held, and nothing when all has come up. Arguments:
// PORT CHROMIUM SEQUENCES. The mouse stands for a finger.

import { check, expect, launch, openPage, until, violations, wait } from './checks.mjs';

const [port, chromium, sequences] = process.argv.slice(2);
const kHeld = { w: 87, ArrowUp: 0x01000013, ' ': 32, 3: 51, g: 71, Shift: 0x01000020 }, kOthers = ['Control', 'Alt', 'Tab', 'Enter'];
const kButtonKey = 82, kSelector = '#move button[data-key="82"]'; // closes the arm
const browser = await launch(chromium);
const page = await openPage(browser, `${port}/#size=64&rate=1`, [700, 300]); // draws little, and hears soon
await page.click('#control');
await until(() => page.evaluate(() => window.vibe.drive.driving), 'control');
const held = () => page.evaluate(() => window.vibe.drive.hands.held().keys);
/** Of what has the focus: a button that Enter or Space holds, a stick with arrow keys. */
const ownKeys = () => page.evaluate(() => Object.values(document.activeElement.dataset).map(Number));
const middle = async (selector) => {
  const { x, y, width, height } = await (await page.$(selector)).boundingBox();
  return [x + width / 2, y + height / 2];
};
const kSwap = await middle('#swap'), kButton = await middle(kSelector), kCanvas = [100, 200];
const down = new Set();
let finger = false, most = 0; // keys held at once

let seed = 1;
const pick = (most) => (seed = (16807 * seed) % 2147483647) % most; // the same in every run (Lehmer)

async function act() {
  const keys = [...Object.keys(kHeld), ...kOthers], key = keys[pick(keys.length)], what = pick(8);
  if (what < 5) {
    if (down.delete(key)) return page.keyboard.up(key);
    down.add(key);
    return page.keyboard.down(key);
  }
  if (finger) {
    finger = false;
    return page.mouse.up();
  }
  if (what === 5) return page.mouse.click(...kSwap);
  if (what === 6) return page.evaluate(() => dispatchEvent(new Event('blur')));
  await page.mouse.move(...(pick(2) ? kButton : kCanvas));
  finger = true;
  return page.mouse.down();
}

async function rest() {
  for (const key of down) await page.keyboard.up(key);
  down.clear();
  if (finger) await page.mouse.up();
  finger = false;
}

/** What is held and should not be, or ''. */
async function stuck(count) {
  for (let k = 0; k < count; k++) {
    for (let event = 0; event < 10; event++) {
      await act();
      const keys = await held(), physical = [...[...down].map((key) => kHeld[key]), ...(finger ? [kButtonKey] : []), ...(down.size ? await ownKeys() : [])];
      most = Math.max(most, keys.length);
      if (!keys.every((key) => physical.includes(key))) return `sequence ${k}: ${keys} held beside ${[...down]}`;
    }
    await rest();
    if ((await held()).length > 0) return `sequence ${k}: ${await held()} stay held`;
  }
  return '';
}

await check('random presses end', async () => {
  const found = await stuck(Number(sequences));
  expect(!found, found);
  expect(most > 1, 'nothing was ever held');
  await until(() => page.evaluate(() => window.vibe.drive.operator.keys.length === 0), 'a server that holds nothing', 5);
  return { sequences, most };
});

await check('a page that hears of no end is found out', async () => {
  await page.evaluate(() => (window.vibe.drive.hands.keyUp = () => {}));
  expect(await stuck(20), 'not found');
  await rest();
  await page.evaluate(() => {
    delete window.vibe.drive.hands.keyUp;
    window.vibe.drive.hands.letGo(); // what it has not heard of
  });
});

await check('a button of the page is held by Enter and Space', async () => {
  await page.keyboard.press('Escape'); // which closes the drawer
  await page.focus(kSelector);
  for (const key of ['Enter', ' ']) {
    await page.keyboard.down(key);
    await until(() => page.evaluate((own) => window.vibe.drive.operator.keys.includes(own), kButtonKey), 'the key at the server');
    await page.keyboard.up(key);
    await until(() => page.evaluate(() => window.vibe.drive.operator.keys.length === 0), 'its end');
  }
});

await check('fingers reach all of the suturing device, and all buttons', async () => {
  const keys = await page.$$eval('#bend button, #move button', (all) => all.map(({ dataset }) => Number(dataset.key)));
  const missing = [...'EQXZRF GNTCI'].filter((key) => !keys.includes(key.charCodeAt(0)));
  expect(missing.length === 0, `no button for ${missing}`); // the scope's joints have the sticks
});

await check('accessibility of a small page (axe), and room for fingers', async () => {
  const found = await violations(page);
  expect(found.length === 0, found.join('\n'));
  const sizes = () => page.$$eval('button, .stick', (all) => all.map((each) => each.getBoundingClientRect()).filter(({ width }) => width).map(({ width, height }) => Math.min(width, height)));
  const [over, beside] = [await sizes(), (await page.click('#numbers'), await sizes())];
  await page.keyboard.press('Escape');
  expect(Math.min(...over, ...beside) >= 44, `${Math.min(...over)}, ${Math.min(...beside)} px`);
  return { over: over.length, beside: beside.length };
});

await check('a tab that is left lets go, and wants a new press', async () => {
  await page.focus('#canvas');
  await page.keyboard.down('w');
  expect((await held()).length === 1, 'not held');
  const other = await browser.newPage();
  await wait(500);
  expect((await held()).length === 0, 'held in the background');
  await other.close();
  await page.bringToFront();
  await wait(500);
  expect((await held()).length === 0, 'held again by itself');
  await page.keyboard.up('w');
});
await browser.close();
process.exit(0);
