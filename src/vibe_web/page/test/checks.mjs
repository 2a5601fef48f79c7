// What the tests of the page share: each check prints one line of JSON, which web_test.py reads.

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
