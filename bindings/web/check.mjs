// Holds the page to what it says: no console message, few bytes, speckle as theory has it, the same in motion.
// Usage: node check.mjs FOLDER [PICTURES]
import { readdir, stat } from 'node:fs/promises';
import { join } from 'node:path';
import { check, open } from './browser.mjs';

const [folder, pictures] = process.argv.slice(2);
const picture = (page, name, options) => pictures && page.screenshot({ path: join(pictures, name), ...options });
const near = (a, b, tolerance) => Math.abs(a / b - 1) <= tolerance;

/** Waits for the first picture, and for what is measured in it. */
const wait = (page, name) =>
  page.waitForFunction((name) => name in document.body.dataset || document.querySelector('.error'), { timeout: 60_000 }, name);

/** Sets values and returns what the picture then measures. */
const measured = (page, values) => page.evaluate(async (values) => {
  const { page, set } = window.tem00;
  for (const [name, value] of Object.entries(values)) set(name, value);
  page.draw(true);
  const { contrast, contrast_in_theory, size, size_in_theory, correlation } = await page.measure();
  return { contrast, contrast_in_theory, size, size_in_theory, correlation };
}, values);

await check([folder], async (browser, address, expect) => {
  const sizes = await Promise.all((await readdir(folder)).map(async (name) => (await stat(join(folder, name))).size));
  const bytes = sizes.reduce((sum, size) => sum + size, 0);
  expect(bytes <= 1e6, `${bytes} bytes in all, at most 1e6`);

  const start = performance.now();
  const wide = await open(browser, address, [1280, 900], expect);
  await wait(wide, 'drawn');
  const seconds = (performance.now() - start) / 1000;
  console.log(`first speckle after ${seconds.toFixed(1)} s`);
  await wait(wide, 'measured');
  await picture(wide, 'wide.png');

  // A wide spot on a plate: some thousand speckles.
  const still = await measured(wide, { part: 0, light: 1, line_width: 15, elevation: 80 });
  expect(near(still.contrast, still.contrast_in_theory, 0.02), `contrast ${still.contrast.toFixed(3)}, by theory ${still.contrast_in_theory.toFixed(3)}`);
  expect(near(still.size, still.size_in_theory, 0.03), `speckle of ${still.size.toFixed(2)} pixels, by theory ${still.size_in_theory.toFixed(2)}`);
  expect(still.correlation === 1, 'a part at rest keeps its speckle');
  const tilted = await measured(wide, { tilt: 0.5 });
  expect(near(tilted.contrast, still.contrast, 0.03), `tilted, the contrast is ${tilted.contrast.toFixed(3)}`);
  expect(tilted.correlation > 0.05 && tilted.correlation < 0.95, `half a mrad of tilt leaves γ = ${tilted.correlation.toFixed(2)}`);
  const [rms, worst] = await wide.evaluate(() => window.tem00.page.compare());
  expect(rms <= 3e-6 && worst <= 3e-5, `speckle of the card and of the library: ${rms.toExponential(1)} apart in rms, ${worst.toExponential(1)} at most`);
  const refused = await wide.evaluate(() => { try { window.tem00.page.set('f_number', 1000); } catch (error) { return error.message; } });
  expect(refused?.includes('`f_number` is 1000'), `a value beyond its range: ${refused}`);

  const narrow = await open(browser, address, [390, 844], expect);
  await wait(narrow, 'measured');
  const overflow = await narrow.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  expect(overflow <= 0, 'nothing is wider than a narrow screen');
  await picture(narrow, 'narrow.png', { fullPage: true });

  const without = await browser.newPage();
  await without.evaluateOnNewDocument(() => Object.defineProperty(navigator, 'gpu', { value: undefined }));
  await without.goto(address);
  const shown = await without.waitForFunction(() => document.querySelector('.instead')?.complete && document.querySelector('.error')?.textContent);
  const said = await shown.jsonValue();
  expect(said.includes('lacks it'), `without WebGPU: ${said}`);
});
