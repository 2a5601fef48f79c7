// The page with a recording, or at a server with --lan. Arguments: 'recording' or 'lan', PORT, CHROMIUM, FOLDER or TOKEN.

import { check, expect, launch, until, wait } from './checks.mjs';

const [what, port, chromium, more] = process.argv.slice(2);
const browser = await launch(chromium, ...(what === 'lan' ? ['--ignore-certificate-errors'] : []));
const page = await browser.newPage();
await page.setViewport({ width: 800, height: 600 });
const drawn = (before) => until(() => page.evaluate((n) => window.vibe?.stats.drawn > n, before), 'a picture of the organ', 120);
const shown = (id) => page.$eval('#' + id, (element) => element.textContent);

async function tryRecording() {
  await page.goto(`http://localhost:${port}/#size=240&rate=15`);
  const time = () => page.$eval('#seek', (element) => element.valueAsNumber);
  const goTo = (at) => page.$eval('#seek', (element, to) => {
    element.valueAsNumber = to;
    element.dispatchEvent(new Event('change'));
  }, at);
  await check('a recording has its line, which goes to any time', async () => {
    await drawn(0);
    await until(() => page.$eval('#timeline', (element) => !element.hidden), 'the line');
    await page.click('#control');
    await until(() => page.evaluate(() => window.vibe.drive.driving), 'control');
    if ((await shown('play')) === 'Pause') await page.click('#play');
    const duration = await page.$eval('#seek', (element) => Number(element.max));
    for (const share of [0.8, 0.2]) {
      const seen = await page.evaluate(() => window.vibe.stage.time);
      await goTo(share * duration);
      await until(async () => Math.abs((await time()) - share * duration) < 0.2, `${share} of the recording`);
      await until(() => page.evaluate((last) => window.vibe.stage.time !== last, seen), 'the organ of then');
    }
    await page.screenshot({ path: `${more}/recording.png` });
    return { duration };
  });
  await check('it plays and pauses', async () => {
    const begin = await time();
    await page.click('#play');
    await until(async () => (await time()) > begin + 0.5, 'playing');
    await page.click('#play');
    await until(async () => (await shown('play')) === 'Play', 'a pause');
  });
}

async function tryLan() {
  await check('a browser needs the token', async () => {
    await page.goto(`https://localhost:${port}/`);
    await wait(1500);
    expect((await shown('status')).startsWith('No connection'), await shown('status'));
  });
  await check('with the token it shows the session, and may enter a headset', async () => {
    await page.goto('about:blank');
    await page.goto(`https://localhost:${port}/#token=${more}&size=240&rate=15`);
    await drawn(2);
    expect(await page.evaluate(() => isSecureContext && 'xr' in navigator), 'no WebXR');
  });
}

await (what === 'lan' ? tryLan() : tryRecording());
await browser.close();
process.exit(0);
