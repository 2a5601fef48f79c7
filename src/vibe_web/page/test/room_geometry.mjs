// What can be seen from where in the room of a headset, for random heads and joints of an open page.

// Of the joints, in their order [m], [rad]: those of the hand, of a shaft that gives way, and those that follow.
const kShaft = 0.05, kRanges = [
  [0, 0.3], [-3.14, 3.14], [-1.57, 2.86], [-1.74, 1.74], [0, 0.03], [-50, 50], [0, 0.018], ...Array.from({ length: 14 }, () => [-kShaft, kShaft]),
  [0, 2.2], [-1.6, 1.6], [0, 0.018], [-1.6, 1.6], [0, 0.018], [-0.005, 0.015],
];

/** Helpers of the page: random numbers with a seed, and joints within their ranges. */
export const prepare = (page) => page.evaluate((ranges) => {
  let state = 1;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647, between = (low, high) => low + (high - low) * random();
  const joints = () => window.vibe.stage.robot.names.map((_, k) => between(...ranges[k]));
  window.some = { between, joints, heads: (eye) => Array.from({ length: 60 }, () => eye.clone().set(eye.x + between(-0.3, 0.3), eye.y + between(-0.3, 0.3), eye.z + between(-0.3, 0.3))) };
}, kRanges);

/** Of random heads and joints, how often a part of the model or of the furniture may stand before the monitor or the readings. */
export const covered = (page, upright) => page.evaluate((upright) => {
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
export const letters = (page) => page.evaluate(() => {
  const { room } = window.vibe.headset(), Vector = room.position.constructor, { readings } = room;
  const { width, height } = readings.geometry.parameters, half = [width / 2, height / 2];
  const capital = (0.72 * parseFloat(readings.pen.font) * height) / readings.canvas.height;
  room.updateMatrixWorld(true);
  const heads = window.some.heads(room.localToWorld(new Vector(0, room.monitor.position.y, 0))), angles = [];
  for (const [x, y] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) for (const head of heads) {
    const [foot, top] = [0, capital].map((up) => readings.localToWorld(new Vector(x * half[0], y * half[1] + up, 0)).sub(head));
    angles.push((foot.angleTo(top) * 180) / Math.PI);
  }
  return Math.min(...angles);
});

/** Of random joints, how far apart both eyes see a place of the wall on the monitor, at most [degrees]: sideways and upwards. */
export const disparities = (page, base, turn) => page.evaluate((base, turn) => {
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
