// The server as the clients of another WebSocket library (ws) see it. Arguments: PORT.

import { request } from 'node:http';
import { connect } from 'node:net';
import WebSocket from 'ws';
import { check, expect, until, wait } from './checks.mjs';

const port = Number(process.argv[2]);
const kW = 'W'.charCodeAt(0);

function open(options = {}) {
  const socket = new WebSocket(`ws://localhost:${port}/stream`, { origin: `http://localhost:${port}`, ...options });
  const client = { socket, counts: {}, last: {}, closed: 0, status: 0, bytes: 0 };
  socket.binaryType = 'nodebuffer';
  socket.on('message', (data) => {
    client.counts[data[0]] = (client.counts[data[0]] ?? 0) + 1;
    client.last[data[0]] = data;
    client.bytes += data.length;
  });
  socket.on('close', (code) => (client.closed = code));
  socket.on('unexpected-response', (_, response) => {
    client.status = response.statusCode;
    socket.terminate();
  });
  socket.on('error', () => {});
  return client;
}

const isOpen = (client) => until(() => client.socket.readyState === WebSocket.OPEN, 'an open stream');
const text = (client, kind) => JSON.parse(client.last[kind].subarray(1).toString());

function drive(client, number, keys = [kW], grant = text(client, 13).grant) {
  const bytes = Buffer.alloc(28 + 4 * keys.length);
  bytes.writeUInt8(4, 0);
  bytes.writeUInt8(keys.length, 1);
  bytes.writeUInt32LE(grant, 4);
  bytes.writeUInt32LE(number, 8);
  keys.forEach((key, k) => bytes.writeUInt32LE(key, 28 + 4 * k));
  client.socket.send(bytes);
}

const timeOf = (client) => client.last[3].readDoubleLE(8); // of the last frame [s]
const insertion = (client) => text(client, 10).joints[0];
async function rest(client) {
  for (let last = NaN; ; last = insertion(client)) {
    await wait(600);
    if (insertion(client) === last) return last;
  }
}

const watcher = open();

await check('all that a page needs comes by itself', async () => {
  await isOpen(watcher);
  await until(() => [1, 2, 3, 4, 5, 6, 7, 8, 10].every((kind) => kind in watcher.last), 'a message of each kind');
  expect(text(watcher, 1).robot.visuals.length > 10, 'no robot');
});

await check('foreign pages, other hosts and other paths are refused', async () => {
  const foreign = open({ origin: 'http://evil.example' }), other = open({ headers: { Host: 'evil.example' }, origin: undefined });
  await until(() => foreign.status && other.status, 'answers');
  expect(foreign.status === 403 && other.status === 403, `answered ${foreign.status}, ${other.status}`);
  for (const path of ['/../package.json', '/%2e%2e/package.json', '//etc/passwd', '/none'])
    await new Promise((resolve, reject) => request({ port, path, host: 'localhost' }, ({ statusCode }) => (statusCode === 404 ? resolve() : reject(new Error(`${path}: ${statusCode}`)))).end());
});

await check('oversized, unknown and too many messages end a stream', async () => {
  const large = open(), unknown = open(), many = open();
  await Promise.all([large, unknown, many].map(isOpen));
  large.socket.send(Buffer.alloc(4000, 6));
  unknown.socket.send(Buffer.from([99]));
  for (let k = 0; k < 600; k++) many.socket.send(Buffer.from([1, 60]));
  await until(() => large.closed && unknown.closed && many.closed, 'the end of these streams');
  expect(large.closed === 1009 && unknown.closed === 1007 && many.closed === 1008, `closed with ${large.closed}, ${unknown.closed}, ${many.closed}`);
});

await check('rubbish instead of HTTP and half of a request harm nobody', async () => {
  for (const rubbish of [Buffer.alloc(20000, 0x41), Buffer.from('GET /stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n')])
    connect(port, 'localhost').on('error', () => {}).end(rubbish);
  const before = watcher.counts[3];
  await until(() => watcher.counts[3] > before + 5, 'more frames');
});

await check('a client that reads nothing holds up nobody', async () => {
  const asleep = open();
  await isOpen(asleep);
  await until(() => asleep.counts[3], 'a frame');
  asleep.socket.pause();
  const before = watcher.counts[3], begin = Date.now();
  await until(() => watcher.counts[3] > before + 120, 'two seconds of frames');
  const seconds = (Date.now() - begin) / 1000;
  asleep.socket.terminate();
  return { frames_per_second: 120 / seconds };
});

await check('a client gets the rate that it asks for', async () => {
  const slow = open();
  await isOpen(slow);
  slow.socket.send(Buffer.from([1, 5]));
  await wait(500);
  const mine = slow.counts[3] ?? 0, begin = Date.now();
  await wait(2000);
  const rate = ((slow.counts[3] ?? 0) - mine) / ((Date.now() - begin) / 1000);
  slow.socket.terminate();
  expect(rate > 0 && rate < 7, `${rate} frames per second`);
  return { rate };
});

await check('more pages than there is room for are refused', async () => {
  const pages = Array.from({ length: 24 }, () => open()); // one looks already
  try {
    await until(() => pages.some(({ status }) => status > 0), 'a refusal');
    expect(pages.every(({ status }) => status === 0 || status === 503), pages.map(({ status }) => status).join());
  } finally {
    for (const { socket } of pages) socket.terminate();
    await wait(500);
  }
});

await check('a page that has not drawn what it has gets no more, and then what is newest', async () => {
  const page = open();
  await isOpen(page);
  page.socket.send(Buffer.from([7, 0]));
  await wait(1000);
  const before = page.counts[3]; // at least two, and those that were sent before the server had heard
  await wait(1000);
  expect(page.counts[3] === before && before >= 2, `${before}, then ${page.counts[3]} frames`);
  page.socket.send(Buffer.from([7, before]));
  await until(() => page.counts[3] === before + 2, 'two more frames');
  expect(timeOf(watcher) - timeOf(page) < 0.5, `${timeOf(watcher) - timeOf(page)} s behind`);
  await wait(500);
  expect(page.counts[3] === before + 2, `${page.counts[3] - before} more frames`);
  page.socket.terminate();
});

const driver = open();
await check('one page drives, and only as long as it speaks', async () => {
  await isOpen(driver);
  driver.socket.send(Buffer.from([2]));
  await until(() => 13 in driver.last, 'the seat');
  watcher.socket.send(Buffer.from([2]));
  await until(() => 12 in watcher.last, 'a refusal for the second page');
  await until(() => text(driver, 10).driving, 'driving');
  const begin = await rest(driver);
  drive(driver, 1); // once: the key counts as held until the silence is too long
  await until(() => insertion(driver) > begin, 'motion');
  const end = await rest(driver), way = end - begin;
  // 0.03 m/s for 0.3 s and a ramp; a machine under load sees the silence a little later
  expect(way > 0.003 && way < 0.03, `moved by ${way} m`);
  return { way };
});

await check('messages that are old, or of another grant, move nothing', async () => {
  const begin = await rest(driver);
  drive(driver, 1); // was obeyed before
  drive(driver, 9, [kW], (text(driver, 13).grant ^ 1) >>> 0);
  await until(() => 12 in driver.last, 'a refusal');
  expect((await rest(driver)) === begin, 'it moved');
});

await check('a driver that goes leaves its place', async () => {
  drive(driver, 20);
  driver.socket.terminate();
  await until(() => text(watcher, 10).seat === 0, 'a free seat');
  watcher.socket.send(Buffer.from([2]));
  await until(() => 13 in watcher.last, 'the seat');
  watcher.socket.send(Buffer.from([3]));
  await until(() => text(watcher, 10).seat === 0, 'a free seat again');
});

await check('bytes on the wire', async () => {
  const bytes = watcher.bytes, frames = watcher.counts[3], begin = Date.now();
  await wait(2000);
  const seconds = (Date.now() - begin) / 1000;
  const perFrame = watcher.last[3].length;
  expect(watcher.counts[2] === 1, `${watcher.counts[2]} topologies`);
  expect(60 * perFrame < 1.5e6, `${perFrame} bytes per frame`);
  return { bytes_per_second: (watcher.bytes - bytes) / seconds, frames_per_second: (watcher.counts[3] - frames) / seconds, bytes_per_frame: perFrame };
});

process.exit(0);
