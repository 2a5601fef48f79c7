// What the server sends to one page that draws at once, by kind: for benchmark/wire.py. Arguments: PORT SECONDS. Prints a line
// of JSON: the seconds, and for each kind the number of messages and their bytes.

import WebSocket from 'ws';

const [port, seconds] = process.argv.slice(2).map(Number);
const kPatience = 2; // after what is sent once has come [s]
let counts = {}, begin = 0;
const socket = new WebSocket(`ws://localhost:${port}/stream`, { origin: `http://localhost:${port}` });
socket.on('open', () => {
  socket.send(Buffer.from([7, 0]));
  socket.send(Buffer.from([1, 60]));
});

function measure() {
  counts = {};
  begin = Date.now();
  setTimeout(() => {
    console.log(JSON.stringify({ seconds: (Date.now() - begin) / 1000, counts }));
    process.exit(0);
  }, 1000 * seconds);
}

socket.on('message', (data) => {
  const count = (counts[data[0]] ??= { messages: 0, bytes: 0 });
  count.messages++;
  count.bytes += data.length;
  if (data[0] === 2 && begin === 0) setTimeout(measure, 1000 * kPatience);
  if (data[0] === 3) socket.send(Buffer.from([7, 1]));
});
