// What the page says when the simulator or the server stops, when clocks are set, and when a recording is over. Arguments: PORT
// CHROMIUM, and the processes of the simulator and the server.

import { spawn } from 'node:child_process';

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

await check('a recording whose player was killed is over when a simulator sends states', async () => {
  const line = () => page.$eval('#timeline', ({ hidden }) => !hidden);
  const player = spawn('rostopic', ['pub', '-r', '10', '/replay/status', 'vibe_msgs/ReplayStatus', '{duration: 10, time: 2, rate: 1, mark_times: [1, 1.5], marks: [a, b]}']);
  try {
    await until(line, 'a line');
    await takes(page);
    await drives(page);
    await wait(1000);
    expect(await page.evaluate(() => !window.vibe.drive.operator.driving), 'a recording is driven');
    const before = await page.evaluate(() => {
      let time = NaN;
      window.vibe.stream.send = (bytes) => (time = new DataView(bytes).getFloat64(16, true));
      document.getElementById('earlier').click();
      delete window.vibe.stream.send;
      return time;
    });
    expect(before === 1.5, `from 2 s the event before is sought at ${before} s`); // half a second ago
  } finally {
    player.kill('SIGKILL'); // it stays registered
  }
  await until(async () => !(await line()), 'no line');
  await until(() => page.evaluate(() => window.vibe.drive.operator.driving), 'a simulator that can be driven');
  expect(await page.$eval('body', ({ classList }) => classList.contains('driving')), 'the page shows no buttons');
  const fresh = await open();
  expect(await fresh.$eval('#timeline', ({ hidden }) => hidden), 'a page that is opened later has a line');
  await fresh.close();
  await takes(page); // gives back
  await until(() => page.evaluate(() => !window.vibe.drive.driving), 'a free place');
});

await check('a page whose place is gone sends nothing more', async () => {
  await takes(page);
  await drives(page);
  const sent = () => page.evaluate(() => new Promise((resolve) => {
    const { stream } = window.vibe, { send } = Object.getPrototypeOf(stream);
    let count = 0;
    stream.send = function (bytes) {
      count += new Uint8Array(bytes.buffer ?? bytes)[0] === 4;
      send.call(this, bytes);
    };
    setTimeout(() => (delete stream.send, resolve(count)), 1000);
  }));
  expect((await sent()) > 0, 'nothing was ever sent');
  await page.evaluate(() => window.vibe.stream.send(Uint8Array.of(3))); // as if it had been silent for long
  await until(() => page.evaluate(() => window.vibe.drive.operator.seat === 0), 'a free place');
  expect((await sent()) === 0, 'it goes on to send');
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
