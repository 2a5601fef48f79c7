// How soon a page shows the organ, and how old what it shows is: for benchmark/opening.py. Arguments: PORT CHROMIUM TIMES
// SECONDS. One line of JSON for each opening in a browser that has nothing in its store, then one about the ages.

import { launch, until, wait } from './checks.mjs';

const [port, chromium, times, seconds] = process.argv.slice(2);
const kKinds = { 1: 'scene', 2: 'topology', 3: 'frame', 4: 'folds' };
const browser = await launch(chromium);

/** Notes when the first message of each kind comes, and how old each frame then is. */
function noteFirst() {
  window.first = {};
  window.came = new Map();
  const Plain = window.WebSocket;
  window.WebSocket = class extends Plain {
    constructor(address) {
      super(address);
      this.addEventListener('message', ({ data }) => {
        const now = performance.now(), kind = new Uint8Array(data, 0, 1)[0];
        window.first[kind] ??= now;
        if (kind !== 3) return;
        const time = new DataView(data).getFloat64(8, true);
        window.came.set(time, performance.timeOrigin + now - 1000 * time);
      });
    }
  };
}

async function open() {
  const context = await browser.createBrowserContext(), page = await context.newPage();
  await page.setViewport({ width: 850, height: 600 });
  await page.evaluateOnNewDocument(noteFirst);
  await page.goto(`http://localhost:${port}/`);
  await until(() => page.evaluate(() => window.vibe?.stats.firstPicture > 0), 'a picture', 120);
  return { context, page };
}

const timesOf = (page) => page.evaluate((kinds) => {
  const all = { picture: window.vibe.stats.firstPicture };
  for (const { name, responseEnd } of performance.getEntriesByType('resource'))
    if (/\.js$|\/pattern$/.test(name)) all[name.endsWith('pattern') ? 'pattern' : 'script'] = responseEnd;
  for (const [kind, name] of Object.entries(kinds)) all[name] = window.first[kind];
  return all;
}, kKinds);

/** Of pictures that are finished: the time to draw each, how old its state was then, and when it came [ms]. */
const agesOf = (page) => page.evaluate(() => {
  const { stage } = window.vibe, draw = stage.draw.bind(stage), gl = stage.renderer.getContext();
  const found = (window.found = { edge: 0, draw: [], age: [], came: [], begin: performance.now() });
  stage.draw = () => {
    if (!stage.dirty) return;
    const begin = performance.now();
    draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4)); // waits until it is drawn
    const end = performance.now();
    found.edge = stage.endoscope.target.width;
    found.draw.push(end - begin);
    found.age.push(performance.timeOrigin + end - 1000 * stage.time);
    found.came.push(window.came.get(stage.time));
  };
});

for (let k = 0; k < Number(times); k++) {
  const { context, page } = await open();
  console.log(JSON.stringify(await timesOf(page)));
  await context.close();
}
const { page } = await open();
await wait(2000);
await agesOf(page);
await wait(1000 * Number(seconds));
console.log(JSON.stringify(await page.evaluate(() => ({ ...window.found, seconds: (performance.now() - window.found.begin) / 1000 }))));
await browser.close();
process.exit(0);
