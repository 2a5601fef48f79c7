// The page with a recording, at a server with --lan, or where nothing is shown. Arguments: 'recording', 'lan' or 'nothing', PORT,
// CHROMIUM, FOLDER or TOKEN, and of a recording the process of its player.

import { check, expect, launch, until, violations } from './checks.mjs';

const [what, port, chromium, more, player] = process.argv.slice(2);
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
    await until(async () => (await shown('play')) === 'Play', 'a pause'); // one that plays on would leave where it was sent
    const duration = await page.$eval('#seek', (element) => Number(element.max));
    expect((await shown('trouble')) === '', await shown('trouble')); // control was asked for
    for (const share of [0.8, 0.2]) {
      const seen = await page.evaluate(() => window.vibe.stage.time);
      await goTo(share * duration);
      await until(async () => Math.abs((await time()) - share * duration) < 0.2, `${share} of the recording`);
      await until(() => page.evaluate((last) => window.vibe.stage.time !== last, seen), 'the organ of then');
    }
    await page.screenshot({ path: `${more}/recording.png` });
    return { duration };
  });
  await check('it plays, at another speed, and pauses', async () => {
    await goTo(0);
    await until(async () => (await time()) < 0.1, 'the begin');
    await page.select('#rate', '4');
    await page.click('#play');
    await until(async () => (await time()) > 0.5, 'playing');
    await page.click('#play');
    await until(async () => (await shown('play')) === 'Play', 'a pause');
    for (const speed of ['4', '0.1']) {
      await page.select('#rate', speed);
      await until(() => page.evaluate((wanted) => window.vibe.replay()?.rate === Number(wanted), speed), `the speed ${speed}`);
      expect((await page.$eval('#rate', ({ value }) => value)) === speed, 'the player keeps the speed');
    }
    await until(async () => (await shown('clock')).startsWith(await page.$eval('#state dd', ({ textContent }) => textContent)), 'two times that agree');
  });
  await check('events are on the line, and the arrows go to them', async () => {
    const marks = await page.$$eval('#marks i', (all) => all.map(({ title }) => title)); // a recording may have none
    await goTo(0);
    await until(async () => (await time()) < 0.1, 'the begin');
    await page.focus('#seek');
    await page.keyboard.press('ArrowRight');
    await until(async () => Math.abs((await time()) - 1) < 0.2, 'a second later');
    return { marks };
  });
  await check('accessibility of the line (axe)', async () => {
    const found = await violations(page);
    expect(found.length === 0, found.join('\n'));
  });
  await check('a player that rests and hangs is told, and one that has ended leaves no line', async () => {
    const trouble = (sentence) => until(async () => (await shown('trouble')).startsWith(sentence), `'${sentence}'`);
    const line = () => page.$eval('#timeline', ({ hidden }) => !hidden);
    expect((await shown('trouble')) === '' && (await line()), 'not at rest');
    process.kill(Number(player), 'SIGSTOP');
    try {
      await trouble('No states');
      expect(await line(), 'one that hangs may go on');
    } finally {
      process.kill(Number(player), 'SIGCONT');
    }
    await until(async () => (await shown('trouble')) === '', 'word of the player');
    process.kill(Number(player), 'SIGINT');
    await trouble('Nothing publishes');
    expect(!(await line()), 'the line of a recording that is closed');
  });
}

async function tryLan() {
  await check('a browser needs the token', async () => {
    await page.goto(`https://localhost:${port}/`);
    await until(async () => (await shown('status')).startsWith('The token is missing'), 'the reason');
  });
  await check('with the token it shows the session, and may enter a headset', async () => {
    await page.goto('about:blank');
    await page.goto(`https://localhost:${port}/#token=${more}&size=240&rate=15`);
    await drawn(2);
    expect(await page.evaluate(() => isSecureContext && 'xr' in navigator), 'no WebXR');
  });
}

async function tryNothing() {
  await check('a page says that nothing is published', async () => {
    await page.goto(`http://localhost:${port}/`);
    await until(async () => (await shown('trouble')).startsWith('Nothing publishes'), 'the sentence');
  });
  await check('a browser without WebGL says so', async () => {
    await page.evaluateOnNewDocument(() => (HTMLCanvasElement.prototype.getContext = () => null));
    await page.goto(`http://localhost:${port}/`);
    await until(async () => (await shown('status')).includes('WebGL'), 'the sentence');
  });
}

await { lan: tryLan, recording: tryRecording, nothing: tryNothing }[what]();
await browser.close();
process.exit(0);
