// What the page says when the simulator or the server stops, and when clocks are set. Arguments: PORT CHROMIUM, and the processes of
// the simulator and the server.

import { check, expect, launch, openPage, until, wait } from './checks.mjs';

const [port, chromium, simulator, server] = process.argv.slice(2);
const browser = await launch(chromium);
const open = () => openPage(browser, `${port}/#size=64&rate=5`, [700, 300]);
const page = await open();
const shown = (id, of = page) => of.$eval('#' + id, ({ textContent }) => textContent);
const held = () => page.evaluate(() => [...window.vibe.drive.hands.held().keys, ...window.vibe.drive.operator.keys]);
const takes = (of) => of.evaluate(() => document.getElementById('control').click());
const drives = (of) => until(() => of.evaluate(() => window.vibe.drive.driving), 'control');

/** Stops a process while something is done. @return how long the page took to say it [s] */
async function whileStopped(process_, sentence, act = async () => {}) {
  const begin = Date.now();
  process.kill(Number(process_), 'SIGSTOP');
  try {
    await until(async () => (await shown('trouble')).startsWith(sentence), sentence, 30);
    const seconds = (Date.now() - begin) / 1000;
    await act();
    return seconds;
  } finally {
    process.kill(Number(process_), 'SIGCONT');
  }
}

await check('a clock that is set moves no delay', async () => {
  const ahead = () => page.evaluate(() => window.vibe.stream.now - performance.now());
  const before = await ahead();
  await page.evaluate(() => {
    const now = Date.now.bind(Date);
    Date.now = () => now() + 30000;
  });
  await wait(1500);
  expect(Math.abs((await ahead()) - before) < 1000, `${(await ahead()) - before} ms`);
});

await check('a simulator that stops is told', async () => {
  const seconds = await whileStopped(simulator, 'No states');
  await until(async () => !(await shown('trouble')).startsWith('No states'), 'states again');
  return { seconds };
});

await check('a server that stops is told; what was held is let go, and wants a new press', async () => {
  await takes(page);
  await drives(page);
  await page.focus('#canvas');
  await page.keyboard.down('w');
  await until(async () => (await held()).length > 1, 'a key at the server');
  const seconds = await whileStopped(server, 'Nothing has come', async () => {
    expect((await page.evaluate(() => window.vibe.drive.hands.held().keys)).length === 0, 'still held');
  });
  await until(async () => !(await shown('trouble')).startsWith('Nothing has come'), 'an answer');
  await until(async () => (await held()).length === 0, 'keys that are let go');
  await wait(1000);
  expect((await held()).length === 0, 'held again by itself');
  await page.keyboard.up('w');
  await page.keyboard.down('w');
  await until(async () => (await held()).length > 1, 'a key that is pressed anew');
  await page.keyboard.up('w');
  return { seconds };
});

await check('a refusal stands until the place is free', async () => {
  const other = await open();
  await takes(other);
  await until(async () => (await shown('status', other)).startsWith('Another page drives'), 'a refusal');
  await takes(page); // gives back
  await until(async () => (await shown('status', other)) === 'Connected', 'its end');
  await takes(other);
  await drives(other);
  await other.close();
});
await browser.close();
process.exit(0);
