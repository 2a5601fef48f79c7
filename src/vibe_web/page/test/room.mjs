// The room of an emulated headset. Arguments: PORT CHROMIUM FOLDER; pictures go into the folder.

import { check, emulateHeadset, errors, expect, launch, openPage, rest, until, wait } from './checks.mjs';
import { covered, disparities, letters, prepare } from './room_geometry.mjs';

const [port, chromium, folder] = process.argv.slice(2);
const kPicture = 120; // edge of the endoscope's picture [px]
const browser = await launch(chromium);

async function open(prepare, more = '') {
  const page = await openPage(browser, `${port}/#size=${kPicture}&rate=10${more}`, [800, 400], 2, prepare);
  await until(() => page.evaluate(() => window.vibe.stage.robot.ranges.length > 0), 'the robot', 120);
  return page;
}

const save = (page, name) => page.screenshot({ path: `${folder}/${name}.png` });
const driving = (page) => page.evaluate(() => window.vibe.drive.driving);
const said = (page) => page.evaluate(() => window.vibe.headset().says());

async function enter(page, button = '#headset') {
  await page.bringToFront();
  await page.click(button);
  await until(() => page.evaluate(() => window.vibe.stage.renderer.xr.isPresenting && window.vibe.headset().placed), 'a headset');
}

let page;
await check('entering takes control, and the room says so', async () => {
  page = await open(emulateHeadset);
  await prepare(page);
  await enter(page);
  await until(() => driving(page), 'control of the scope');
  await until(async () => (await said(page)).now.startsWith('You drive'), 'the word of it');
  await wait(2000);
  await save(page, 'headset');
});

for (const [name, height] of [['seated', 1.2], ['standing', 1.7]])
  await check(`nothing stands before the monitor, and letters are large enough: ${name}`, async () => {
    await page.evaluate((y) => window.device.position.set(0, y, 0), height);
    await wait(1500);
    await page.evaluate(() => window.vibe.headset().recentre());
    const found = { covered: await covered(page, false), upright: await covered(page, true), letters: await letters(page) };
    expect(found.covered === 0 && found.upright > 0 && found.letters >= 0.5, JSON.stringify(found));
    return found;
  });

await check('around the viewer nothing but readings is beside the picture', async () => {
  const seen = [];
  for (let k = 0; k < 2; k++) {
    await page.evaluate(() => window.vibe.headset().nextView());
    await wait(1500);
    await save(page, k === 0 ? 'around' : 'middle');
    seen.push(await page.evaluate(() => window.vibe.headset().room.children.filter(({ visible }) => visible).length), await letters(page));
  }
  await page.evaluate(() => window.vibe.headset().nextView());
  expect(seen[0] === 2 && seen[2] === 2 && seen[1] >= 0.5 && seen[3] >= 0.5, JSON.stringify(seen));
  return seen;
});

await check('one lens for both eyes; two lenses can be fused', async () => {
  const pictures = () => page.evaluate(() => new Set(window.vibe.headset().room.monitor.eyes.map(({ material }) => material.map.uuid)).size);
  expect((await pictures()) === 1, 'two pictures without being asked for');
  await page.evaluate(() => window.vibe.headset().buttons()[2].act());
  await until(async () => (await pictures()) === 2, 'two pictures');
  await wait(1500);
  await save(page, 'two_lenses');
  const found = { two: await disparities(page), before: await disparities(page, 0.004, 0) };
  await page.evaluate(() => window.vibe.headset().buttons()[2].act());
  expect(found.two[0] <= 1 && found.two[1] <= 0.3 && found.before[0] > 1, JSON.stringify(found));
  return found;
});

await check('a controller holds the handle and drives', async () => {
  const begin = await rest(page);
  await page.evaluate(async () => {
    const { right } = window.device.controllers;
    const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
    right.position.set(0.2, 1.2, -0.3);
    await pause(500);
    right.updateButtonValue('squeeze', 1);
    await pause(1000);
    for (let k = 1; k <= 40; k++) {
      right.position.set(0.2, 1.2, -0.3 - 0.0005 * k); // forwards: in
      await pause(50);
    }
  });
  const moved = (await rest(page)) - begin;
  await save(page, 'handle');
  const counts = { calls: 0, triangles: 0 }; // with new pictures of the lens
  for (let k = 0; k < 40; k++, await wait(50)) {
    const { calls, triangles } = await page.evaluate(() => window.vibe.stage.counts);
    if (triangles > counts.triangles) Object.assign(counts, { calls, triangles });
  }
  const lost = await page.evaluate(() => window.vibe.headset().grips.behind[0] / 1000);
  await page.evaluate(() => window.device.controllers.right.updateButtonValue('squeeze', 0));
  expect(moved > 0.01 && Math.abs(Math.abs(0.02 - moved) - lost) < 0.001, JSON.stringify({ moved, lost }));
  expect(counts.calls <= 2 * 25 && counts.triangles <= 2 * 120000, JSON.stringify(counts)); // both eyes
  return { moved, lost, counts };
});

await check('what a slow picture leaves undone is told', async () => {
  const begin = await rest(page);
  await page.evaluate(async () => {
    const { right } = window.device.controllers, pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
    right.position.set(0.2, 1.2, -0.3);
    await pause(500);
    right.updateButtonValue('squeeze', 1);
    await pause(1000);
    for (let k = 1; k <= 4; k++) {
      right.position.set(0.2, 1.2, -0.3 - 0.015 * k); // forwards: in, 60 mm
      for (const end = performance.now() + 900; performance.now() < end; );
      await pause(100);
    }
    await pause(1000);
  });
  const moved = (await rest(page)) - begin, { urgent } = await said(page);
  const lost = await page.evaluate(() => window.vibe.headset().grips.behind[0] / 1000);
  await page.evaluate(() => window.device.controllers.right.updateButtonValue('squeeze', 0));
  const told = Number(/: (\d+) mm of the hand were not followed/.exec(urgent)?.[1] ?? 0) / 1000;
  expect(lost > 0.005 && Math.abs(told - lost) < 0.001 && Math.abs(Math.abs(0.06 - moved) - lost) < 0.001, JSON.stringify({ moved, lost, urgent }));
  return { moved, lost, urgent };
});

await check('the hand beside the handle works the device', async () => {
  const helix = () => page.evaluate(() => window.vibe.drive.operator.joints[4]), inside = await helix();
  await page.evaluate(() => {
    const { left, right } = window.device.controllers;
    right.updateButtonValue('squeeze', 1);
    left.updateAxes('thumbstick', 0, -1);
  });
  await until(async () => (await helix()) > inside + 0.002, 'the helix');
  await page.evaluate(() => {
    const { left, right } = window.device.controllers;
    left.updateAxes('thumbstick', 0, 0);
    right.updateButtonValue('squeeze', 0);
  });
  return { way: (await helix()) - inside };
});

await check('who looks on sees head and hands', async () => {
  const other = await open(undefined, '&view=instructor');
  await page.bringToFront(); // else it hides, and is silent
  const head = () => other.evaluate(() => {
    const { driver } = window.vibe.stage;
    return driver.visible && driver.children.every(({ visible }) => visible) ? driver.children[0].position.toArray() : null;
  });
  const found = await until(head, 'head and hands');
  await page.evaluate(() => (window.device.position.x += 0.2)); // to the right: to the patient's feet
  const moved = await until(async () => (await head())[2] < found[2] - 0.1 && wait(500).then(head), 'motion of the head');
  await other.bringToFront();
  await wait(300);
  await save(other, 'instructor');
  await page.bringToFront();
  await other.close();
  const way = moved.map((x, k) => x - found[k]);
  expect(Math.hypot(way[0], way[1], way[2] + 0.2) < 0.01, JSON.stringify({ found, moved })); // in true size
  return found;
});

await check('control is given back and taken in the room', async () => {
  const point = (button) => page.evaluate((button) => { // at the middle of a button, from the hand
    const { readings } = window.vibe.headset().room, Vector = readings.position.constructor, { x, y, width, height } = readings.placeOf(button);
    const to = readings.localToWorld(new Vector((x + width / 2) / 1000 - 0.26, 0.43 - (y + height / 2) / 1000, 0));
    const { right } = window.device.controllers, from = new Vector(right.position.x, right.position.y, right.position.z), ahead = to.sub(from).normalize();
    const turn = readings.quaternion.clone().setFromUnitVectors(new Vector(0, 0, -1), ahead);
    right.quaternion.set(turn.x, turn.y, turn.z, turn.w);
  }, button);
  const press = async () => {
    await until(() => page.evaluate(() => window.vibe.headset().grips.pointed.some(Boolean)), 'the button');
    await page.evaluate(() => window.device.controllers.right.updateButtonValue('trigger', 1));
    await wait(1000);
    await page.evaluate(() => window.device.controllers.right.updateButtonValue('trigger', 0));
  };
  await point(0);
  await press();
  await until(async () => !(await driving(page)) && (await said(page)).now.startsWith('Nobody drives'), 'that nobody drives');
  await save(page, 'pointing');
  await press();
  await until(() => driving(page), 'control of the scope');
});

await check('a hand pinches the handle and drives', async () => {
  const begin = await rest(page);
  await page.evaluate(async () => {
    const { device } = window, pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));
    device.primaryInputMode = 'hand';
    const { right } = device.hands;
    right.position.set(0.2, 1.2, -0.3);
    await pause(1000);
    right.updatePinchValue(1);
    await pause(500);
    for (let k = 1; k <= 40; k++) {
      right.position.set(0.2, 1.2, -0.3 - 0.0005 * k); // forwards: in
      await pause(50);
    }
  });
  await save(page, 'hands');
  const moved = (await rest(page)) - begin;
  await page.evaluate(() => window.device.hands.right.updatePinchValue(0));
  expect(moved > 0.01, `moved by ${moved} m`);
  return { moved };
});

await check('who enters while another page drives is told so in the room', async () => {
  const other = await open(emulateHeadset);
  await enter(other);
  await until(async () => (await said(other)).now === 'Another page drives.', 'that another page drives');
  await other.close();
  await page.bringToFront();
});

await check('in the real room nothing but the floor is left out', async () => {
  await page.evaluate(() => window.vibe.stage.renderer.xr.getSession().end());
  await until(() => page.evaluate(() => !window.vibe.stage.renderer.xr.isPresenting), 'the page');
  await enter(page, '#passthrough');
  await wait(2000);
  await save(page, 'real_room');
  const seen = await page.evaluate(() => {
    const { renderer } = window.vibe.stage, { room } = window.vibe.headset();
    return { floor: room.floor.visible, furniture: room.furniture.visible, alpha: renderer.getClearAlpha() };
  });
  expect(!seen.floor && seen.furniture && seen.alpha === 0, JSON.stringify(seen));
  return seen;
});

await check('nothing was wrong in the console', async () => expect(errors.length === 0, errors.join('\n')));
await browser.close();
process.exit(0);
