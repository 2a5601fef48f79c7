// Pages for benchmark/soak.py. Arguments: PORT [CHROMIUM]. Each line of the input is how many steady pages there shall be, and
// 'rough' if others come, go, sleep and send rubbish beside them, and a page of Chromium visits; the answer is a line of JSON
// about the time since the line before, and about all visits.

import { request } from 'node:http';
import { connect } from 'node:net';
import { createInterface } from 'node:readline';
import WebSocket from 'ws';
import { launch, until } from './checks.mjs';

const port = Number(process.argv[2]), chromium = process.argv[3];
const steady = [];
let rough = null, visitor = Promise.resolve(), came = 0, frames = 0, longest = 0, bytes = 0, lost = 0, visits = 0, seen = 0, begin = Date.now();

function open(onMessage = () => {}) {
  const socket = new WebSocket(`ws://localhost:${port}/stream`, { origin: `http://localhost:${port}` });
  socket.on('error', () => {});
  socket.on('unexpected-response', () => socket.terminate());
  socket.on('message', onMessage);
  return socket;
}

function page() {
  let last = 0, first = true;
  const socket = open((data) => {
    bytes += data.length;
    if (data[0] !== 3) return;
    const now = Date.now();
    if (!first) longest = Math.max(longest, now - Math.max(last, begin));
    first = false;
    last = now;
    frames++;
    socket.send(Buffer.from([7, 1]));
  });
  socket.on('open', () => {
    socket.send(Buffer.from([7, 0]));
    socket.send(Buffer.from([1, 60]));
  });
  socket.on('close', () => (lost += steady.includes(socket) ? 1 : 0));
  return socket;
}

const any = (most) => Math.floor(most * Math.random());
const manners = [
  () => { const socket = open(); setTimeout(() => socket.close(), any(2000)); }, // comes and goes
  () => { const socket = open(); setTimeout(() => socket.terminate(), any(2000)); }, // falls silent
  () => { const socket = open(); socket.on('open', () => socket._socket.pause()); setTimeout(() => socket.terminate(), 4000); }, // sleeps
  () => { const socket = open(); socket.on('open', () => socket.send(Buffer.from(Array.from({ length: any(200) }, () => any(256))))); }, // rubbish
  () => { const socket = open(); socket.on('open', () => { for (let k = 0; k < 400; k++) socket.send(Buffer.from([1, 60])); }); }, // a flood
  () => { const socket = open(); socket.on('open', () => socket.send(Buffer.from([2]))); setTimeout(() => socket.terminate(), any(1500)); }, // takes the seat, and goes
  () => { const raw = connect(port, 'localhost', () => raw.write(Buffer.from(Array.from({ length: 300 }, () => any(256))))); raw.on('error', () => {}); setTimeout(() => raw.destroy(), 1500); },
  () => { const raw = connect(port, 'localhost', () => raw.write('GET /stream HTTP/1.1\r\nHost: loc')); raw.on('error', () => {}); setTimeout(() => raw.destroy(), 3000); }, // half a request
  () => request({ port, path: '/pattern' }, (answer) => answer.resume()).on('error', () => {}).end(),
];

/** A page of a browser that goes as soon as it shows the organ: drawing without a graphics card takes a core. */
async function visit() {
  visits++;
  const browser = await launch(chromium);
  try {
    const page = await browser.newPage();
    await page.goto(`http://localhost:${port}/`);
    await until(() => page.evaluate(() => window.vibe?.stats.firstPicture > 0), 'a picture', 60);
    seen++;
  } catch (error) {
    console.error(String(error));
  } finally {
    await browser.close();
  }
}

function tell() {
  const seconds = (Date.now() - begin) / 1000, pages = Math.max(1, steady.length);
  console.log(JSON.stringify({ seconds, pages: steady.length, came, lost, visits, seen, frames_per_second: frames / seconds / pages, longest_gap_ms: longest, bytes_per_second: bytes / seconds / pages }));
  came = frames = longest = bytes = lost = 0;
  begin = Date.now();
}

for await (const line of createInterface({ input: process.stdin })) {
  if (line === '0') await visitor; // its connections are gone, too
  tell();
  const [count, manner] = line.split(' ');
  while (steady.length > Number(count)) steady.pop().close();
  while (steady.length < Number(count)) steady.push(page());
  clearInterval(rough);
  rough = manner === 'rough' ? setInterval(() => (came++, manners[any(manners.length)]()), 250) : null;
  if (rough && chromium) visitor = visit();
}
process.exit(0);
