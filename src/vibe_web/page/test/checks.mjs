// What the tests of the page share: each check prints one line of JSON, which web_test.py reads.

import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import { transformSync } from 'esbuild';
import puppeteer from 'puppeteer-core';

/** Chromium without a display and without a graphics card. */
export const launch = (chromium, ...more) =>
  puppeteer.launch({
    executablePath: chromium, headless: true, protocolTimeout: 300000,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-dev-shm-usage', '--window-size=800,600', ...more],
  });

export const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Until a condition holds, however slow the machine is. */
export async function until(condition, what, seconds = 60) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const value = await condition();
    if (value) return value;
    if (Date.now() > end) throw new Error(`not within ${seconds} s: ${what}`);
    await wait(50);
  }
}

/** What pages have complained of. */
export const errors = [];

/** A page that has drawn more than `drawn` pictures of the organ. @param prepare  before it is opened */
export async function openPage(browser, address, [width, height], drawn = 0, prepare = async () => {}) {
  const page = await browser.newPage();
  await page.setViewport({ width, height });
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => message.type() === 'error' && errors.push(message.text()));
  await prepare(page);
  await page.goto(`http://localhost:${address}`);
  await until(() => page.evaluate((n) => window.vibe?.stats.drawn > n, drawn), 'a picture of the organ', 120);
  return page;
}

export const insertion = (page) => page.evaluate(() => window.vibe.drive.operator.joints[0]);

/** Until the scope stands still; how far it is in then. */
export async function rest(page) {
  for (let last = NaN; ; last = await insertion(page)) {
    await wait(700);
    if ((await insertion(page)) === last) return last;
  }
}

export async function check(name, body) {
  let problem = '', detail;
  try {
    detail = await body();
  } catch (error) {
    problem = String(error?.stack ?? error);
  }
  console.log(JSON.stringify({ name, ok: !problem, problem, detail }));
}

export function expect(condition, what) {
  if (!condition) throw new Error(what);
}

/** A module of the page that needs no browser. */
export function load(name) {
  const source = readFileSync(new URL(`../src/${name}.ts`, import.meta.url), 'utf8');
  return import('data:text/javascript,' + encodeURIComponent(transformSync(source, { loader: 'ts', format: 'esm' }).code));
}

/** What axe finds wrong with the accessibility of the page. */
export async function violations(page) {
  await page.evaluate(readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8'));
  return page.evaluate(async () => (await window.axe.run()).violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`));
}

/** A headset that is none (Meta's iwer): before the page is opened. */
export async function emulateHeadset(page) {
  await page.evaluateOnNewDocument(readFileSync(fileURLToPath(new URL('../node_modules/iwer/build/iwer.min.js', import.meta.url)), 'utf8'));
  await page.evaluateOnNewDocument(() => {
    window.device = new window.IWER.XRDevice(window.IWER.metaQuest3);
    window.device.installRuntime();
    window.device.stereoEnabled = true;
    window.device.position.set(0, 1.6, 0);
  });
}

/**
 * Draws the endoscope's picture of this state, turned and bent in several ways: as always, with all triangles, and with
 * too many left out; returns the bytes in which the first two differ, and at least the last two.
 */
export const leftOut = (page) => page.evaluate(() => {
  const { stage } = window.vibe, { robot } = stage, seen = Object.getPrototypeOf(stage.organ.natural), { findSides } = seen;
  const joints = robot.names.map((name) => robot.positions.get(name));
  const draw = (sides) => {
    seen.findSides = sides;
    stage.refresh();
    stage.drawEndoscope();
    return stage.pictureBytes().bytes;
  };
  const differing = (one, other) => one.reduce((sum, byte, k) => sum + (byte !== other[k]), 0);
  let differ = 0, control = Infinity;
  for (const by of [[0, 0, 0], [0.9, 0.3, 0], [2, -0.2, 0.3], [-1, 0, -0.4]]) {
    robot.setJoints(joints.map((joint, k) => joint + (by[k - 1] ?? 0)));
    const usual = draw(findSides), all = draw(function () { this.sides.fill(0); });
    differ += differing(usual, all);
    control = Math.min(control, differing(all, draw(function (part, matrix, unseen) {
      for (const k of [0, 4, 8, 12]) matrix.elements[k] *= 1.25; // as if the picture were narrower
      findSides.call(this, part, matrix, unseen);
    })));
  }
  seen.findSides = findSides;
  robot.setJoints(joints);
  stage.refresh();
  return { differ, control };
});
