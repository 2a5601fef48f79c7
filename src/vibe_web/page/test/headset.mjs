// The page and an emulated headset of a session: draws, triangles and pictures, and 30 s of the handle. For
// benchmark/headset.py. Arguments: PORT CHROMIUM FOLDER SECONDS. Prints a line of JSON.

import { emulateHeadset, launch, leftOut, until, wait } from './checks.mjs';

const [port, chromium, folder, seconds] = process.argv.slice(2);
const kSettle = 6000; // folds and heat come later than the first picture [ms]
// A page that draws for longer than 0.3 s is silent meanwhile, and released: while the hand moves, pictures are small, and
// the picture around the viewer hides the model [px].
const kWide = { width: 1000, height: 500 }, kSmall = { width: 200, height: 100 }, kEdge = 320, kSmallEdge = 64;
const browser = await launch(chromium), page = await browser.newPage();
await page.setViewport(kWide);
await emulateHeadset(page);
await page.goto(`http://localhost:${port}/#size=${kEdge}`);
await until(() => page.evaluate(() => window.vibe?.stats.firstPicture > 0 && window.vibe.stage.counts.calls >= 9), 'a picture', 200);
await wait(kSettle);

const save = (name) => page.screenshot({ path: `${folder}/${name}.png` });
const joints = () => page.evaluate(() => window.vibe.drive.operator?.joints);

const size = (edge) => page.evaluate((px) => {
  const { stage } = window.vibe;
  stage.fixedSize = stage.size = px;
  stage.makeEndoscope();
}, edge);

/** The most draws and triangles of pictures in two seconds. */
const counts = () => page.evaluate(async () => {
  const { stage } = window.vibe, most = { calls: 0, triangles: 0 };
  for (const end = performance.now() + 2000; performance.now() < end; await new Promise((resolve) => setTimeout(resolve, 20)))
    if (stage.counts.triangles > most.triangles) Object.assign(most, stage.counts);
  return most;
});

async function rest() {
  for (let last = ''; ; await wait(1000)) {
    const now = await joints();
    if (JSON.stringify(now) === last) return now;
    last = JSON.stringify(now);
  }
}

await page.evaluate(() => setInterval(() => window.vibe.stage.refresh(), 50)); // a simulator may pause
const told = { page: await counts(), picture: await leftOut(page) };
await save('page');
await page.click('#control');
await until(() => page.evaluate(() => window.vibe.drive.driving), 'control of the scope');
await page.click('#headset');
await until(() => page.evaluate(() => window.vibe.stage.renderer.xr.isPresenting), 'a headset');
await wait(3000);
told.eyes = await counts();
await save('stereo_begin');
const nextView = () => page.evaluate(() => window.vibe.headset().nextView());
await size(kSmallEdge);
await nextView();
await page.setViewport(kSmall);
await wait(1000);
told.begin = await rest();
// in by 45 mm and to the right, with some way back, and held for a while at the end
told.hand = await page.evaluate(async (seconds) => {
  const { right } = window.device.controllers, pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms)), kAhead = -0.3;
  const hold = (way, turn) => {
    right.position.set(0.2, 1.2, kAhead - way);
    right.quaternion.set(0, 0, Math.sin(-turn / 2), Math.cos(turn / 2));
  };
  hold(0, 0);
  right.updateButtonValue('squeeze', 1);
  await pause(1000);
  let way = 0, turn = 0;
  for (let begin = performance.now(), at = 0; at < 1; await pause(14)) {
    at = Math.min(1, (performance.now() - begin) / (1000 * seconds));
    way = 0.045 * at + 0.01 * Math.sin(4 * Math.PI * at);
    turn = 0.8 * at + 0.1 * Math.sin(6 * Math.PI * at);
    hold(way, turn);
  }
  await pause(3000);
  right.updateButtonValue('squeeze', 0);
  return { insertion: way, rotation: turn };
}, Number(seconds));
told.end = await rest();
told.frames = await page.evaluate(() => window.vibe.headset().period);
await size(kEdge);
await page.setViewport(kWide);
await nextView();
await nextView();
await wait(3000);
await save('stereo_end');
await nextView();
await wait(2000);
await save('stereo_around');
console.log(JSON.stringify(told));
await browser.close();
process.exit(0);
