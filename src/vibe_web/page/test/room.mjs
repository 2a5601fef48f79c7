// The room of an emulated headset. Arguments: PORT CHROMIUM FOLDER; pictures go into the folder.

import { check, emulateHeadset, expect, launch, until, wait } from './checks.mjs';

const [port, chromium, folder] = process.argv.slice(2);
const kPicture = 120; // edge of the endoscope's picture [px]
// Of the joints, in their order [m], [rad]: those of the hand, of a shaft that gives way, and those that follow.
const kShaft = 0.05, kRanges = [
  [0, 0.3], [-3.14, 3.14], [-1.57, 2.86], [-1.74, 1.74], [0, 0.03], [-50, 50], [0, 0.018], ...Array.from({ length: 14 }, () => [-kShaft, kShaft]),
  [0, 2.2], [-1.6, 1.6], [0, 0.018], [-1.6, 1.6], [0, 0.018], [-0.005, 0.015],
];

const browser = await launch(chromium);
const errors = [];

async function openPage(prepare, more = '') {
  const page = await browser.newPage();
  await page.setViewport({ width: 800, height: 400 });
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
  await prepare(page);
  await page.goto(`http://localhost:${port}/#size=${kPicture}&rate=10${more}`);
  await until(() => page.evaluate(() => window.vibe?.stats.drawn > 2 && window.vibe.stage.robot.ranges.length > 0), 'a picture of the organ', 120);
  return page;
}

const save = (page, name) => page.screenshot({ path: `${folder}/${name}.png` });
const driving = (page) => page.evaluate(() => window.vibe.drive.driving);
const insertion = (page) => page.evaluate(() => window.vibe.drive.operator.joints[0]);
const said = (page) => page.evaluate(() => window.vibe.headset().says());

async function rest(page) {
  for (let last = NaN; ; last = await insertion(page)) {
    await wait(700);
    if ((await insertion(page)) === last) return last;
  }
}

async function enter(page, button = '#headset') {
  await page.bringToFront();
  await page.click(button);
  await until(() => page.evaluate(() => window.vibe.stage.renderer.xr.isPresenting && window.vibe.headset().placed), 'a headset');
}

/** Helpers of the page: random numbers with a seed, and joints within their ranges. */
const prepare = (page) => page.evaluate((ranges) => {
  let state = 1;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647, between = (low, high) => low + (high - low) * random();
  const joints = () => window.vibe.stage.robot.names.map((_, k) => between(...ranges[k]));
  window.some = { between, joints, heads: (eye) => Array.from({ length: 60 }, () => eye.clone().set(eye.x + between(-0.3, 0.3), eye.y + between(-0.3, 0.3), eye.z + between(-0.3, 0.3))) };
}, kRanges);

/** Of random heads and joints, how often a part of the model or of the furniture may stand before the monitor or the readings. */
const covered = (page, upright) => page.evaluate((upright) => {
  const { stage } = window.vibe, { room } = window.vibe.headset(), { robot, organ } = stage, Vector = organ.centre.constructor;
  const place = room.model.position.clone(), turn = room.model.quaternion.clone();
  if (upright) room.model.position.add(new Vector(0, 0.13, 0.1)), room.model.rotation.set(-Math.PI / 2, 0, -Math.PI / 2);
  const corners = (frame, low, high) => [0, 1, 2, 3, 4, 5, 6, 7].map((k) => new Vector(...[0, 1, 2].map((d) => (k >> d & 1 ? high : low).getComponent(d))).applyMatrix4(frame.matrixWorld));
  const quad = (plane, half) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => new Vector(x * half[0], y * half[1], 0).applyMatrix4(plane.matrixWorld));
  room.updateMatrixWorld(true);
  const screens = [quad(room.monitor, [0.43, 0.43]), quad(room.readings, [0.26, 0.43])];
  const furniture = [], vertices = room.furniture.geometry.getAttribute('position'), monitor = room.monitor.position.z;
  for (let k = 0; k < vertices.count; k++) if (vertices.getZ(k) > monitor) furniture.push(new Vector().fromBufferAttribute(vertices, k).applyMatrix4(room.matrixWorld));
  const low = new Vector(Infinity, Infinity, Infinity), high = low.clone().negate();
  for (let i = 0; i < organ.particles.length; i += 3) for (const [box, edge] of [[low, 'min'], [high, 'max']]) box[edge](new Vector().fromArray(organ.particles, i));
  const eye = room.localToWorld(new Vector(0, room.monitor.position.y, 0)), heads = window.some.heads(eye);
  /** Whether a plane through the eye and a side of the screen has all points beyond it. */
  const aside = (head, screen, points) => screen.some((corner, k) => {
    const normal = corner.clone().sub(head).cross(screen[(k + 1) % 4].clone().sub(head));
    return points.every((point) => normal.dot(point.clone().sub(head)) > 0);
  });
  let count = 0;
  const judge = (points) => heads.forEach((head) => (count += screens.some((screen) => !aside(head, screen, points))));
  judge(furniture);
  judge(corners(organ.root, low, high));
  for (let k = 0; k < 25; k++) {
    robot.setJoints(window.some.joints());
    room.updateMatrixWorld(true);
    for (const { frame, box } of robot.ranges) judge(corners(frame, box.min, box.max));
  }
  room.model.position.copy(place);
  room.model.quaternion.copy(turn);
  stage.refresh();
  return count;
}, upright);

/** From random heads, the smallest capital letter of the readings [degrees]. */
const letters = (page) => page.evaluate((capital, half) => {
  const { room } = window.vibe.headset(), Vector = room.position.constructor, { readings } = room;
  room.updateMatrixWorld(true);
  const heads = window.some.heads(room.localToWorld(new Vector(0, room.monitor.position.y, 0))), angles = [];
  for (const [x, y] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) for (const head of heads) {
    const [foot, top] = [0, capital].map((up) => readings.localToWorld(new Vector(x * half[0], y * half[1] + up, 0)).sub(head));
    angles.push((foot.angleTo(top) * 180) / Math.PI);
  }
  return Math.min(...angles);
}, 0.021, [0.26, 0.43]);

/** Of random joints, how far apart both eyes see a place of the wall on the monitor, at most [degrees]: sideways and upwards. */
const disparities = (page, base, turn) => page.evaluate((base, turn) => {
  const { stage } = window.vibe, { robot, organ, endoscope } = stage, half = stage.lens.field_of_view / 2, most = [0, 0];
  const { camera } = endoscope, Matrix = camera.matrixWorld.constructor, Vector = organ.centre.constructor;
  const onMonitor = (place) => { // of a lens that maps angles to lengths
    const across = Math.hypot(place.x, place.y), angle = Math.atan2(across, -place.z);
    return angle > half ? null : [place.x, place.y].map((part) => (0.4 * (angle / half) * part) / (across || 1));
  };
  for (let k = 0; k < 10; k++) {
    robot.setJoints(window.some.joints());
    endoscope.meeting = 0; // at once
    stage.refresh();
    stage.drawEndoscope(true);
    const { meeting } = endoscope, ownBase = meeting / 60, ownTurn = 1 / 60;
    const left = camera.matrixWorld.clone().multiply(new Matrix().makeRotationY(-ownTurn)).multiply(new Matrix().makeTranslation(-ownBase, 0, 0));
    const right = base === undefined ? camera.matrixWorld : left.clone().multiply(new Matrix().makeTranslation(base, 0, 0)).multiply(new Matrix().makeRotationY(turn));
    const [toLeft, toRight] = [left, right].map((lens) => lens.clone().invert().multiply(organ.root.matrixWorld));
    for (let i = 0; i < organ.particles.length; i += 3) {
      const place = new Vector().fromArray(organ.particles, i), seen = place.clone().applyMatrix4(toLeft);
      const [one, other] = [onMonitor(seen), onMonitor(place.applyMatrix4(toRight))];
      if (seen.length() < meeting / 4 || !one || !other) continue;
      [0, 1].forEach((d) => (most[d] = Math.max(most[d], (Math.atan(Math.abs(one[d] - other[d]) / 1.5) * 180) / Math.PI)));
    }
  }
  stage.refresh();
  return most;
}, base, turn);

let page;
await check('entering takes control, and the room says so', async () => {
  page = await openPage(emulateHeadset);
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
  expect(moved > 0.01 && Math.abs(moved + lost - 0.02) < 0.001, JSON.stringify({ moved, lost }));
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
  expect(lost > 0.005 && Math.abs(told - lost) < 0.001 && Math.abs(moved + lost - 0.06) < 0.001, JSON.stringify({ moved, lost, urgent }));
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
  const other = await openPage(async () => {}, '&view=instructor');
  await page.bringToFront(); // else it hides, and is silent
  const head = () => other.evaluate(() => {
    const { driver } = window.vibe.stage;
    return driver.visible && driver.children.every(({ visible }) => visible) ? driver.children[0].position.toArray() : null;
  });
  const found = await until(head, 'head and hands');
  await other.bringToFront();
  await wait(300);
  await save(other, 'instructor');
  await page.bringToFront();
  await other.close();
  const right = await page.evaluate(() => {
    const { xr } = window.vibe.stage.renderer, camera = xr.getCamera();
    return window.vibe.stage.body.worldToLocal(camera.position.clone().setFromMatrixPosition(camera.matrixWorld)).toArray();
  });
  expect(Math.hypot(...found.map((x, k) => x - right[k])) < 0.01, JSON.stringify({ found, right }));
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
  const other = await openPage(emulateHeadset);
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
