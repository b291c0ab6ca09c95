// Opens the page in a headless Chromium and holds it to what it says: no console message, a first picture in time, speckle
// as theory has it, the same in motion. Usage: node check.mjs FOLDER [PICTURES]; puppeteer-core beside it, the browser's path
// in CHROMIUM.
import { createServer } from 'node:http';
import { readFile, readdir, stat } from 'node:fs/promises';
import { extname, join } from 'node:path';
import puppeteer from 'puppeteer-core';

const [folder, pictures] = process.argv.slice(2);
const TYPES = { '.html': 'text/html', '.css': 'text/css', '.js': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png' };
const server = createServer(async (request, response) => {
  const name = request.url === '/' ? 'index.html' : request.url.slice(1);
  try {
    const body = await readFile(join(folder, name));
    response.writeHead(200, { 'content-type': TYPES[extname(name)] ?? 'text/plain' }).end(body);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
const address = `http://127.0.0.1:${server.address().port}/`;
const failures = [];
const expect = (holds, text) => {
  console.log(`${holds ? 'ok  ' : 'FAIL'} ${text}`);
  if (!holds) failures.push(text);
};

async function open(browser, width, height) {
  const page = await browser.newPage();
  await page.setViewport({ width, height });
  page.on('console', (message) => failures.push(`console: ${message.text()}`) && console.log('console:', message.text()));
  page.on('pageerror', (error) => failures.push(`error: ${error.message}`) && console.log('error:', error.message));
  const start = performance.now();
  await page.goto(address);
  await page.waitForFunction(() => 'drawn' in document.body.dataset || document.querySelector('.error'), { timeout: 60_000 });
  const seconds = (performance.now() - start) / 1000;
  await page.waitForFunction(() => 'measured' in document.body.dataset || document.querySelector('.error'), { timeout: 60_000 });
  return [page, seconds];
}

/** Sets values, waits for the picture, and returns what it measures. */
const measured = (page, values) => page.evaluate(async (values) => {
  const { page, set } = window.tem00;
  for (const [name, value] of Object.entries(values)) set(name, value);
  page.draw(true);
  const { contrast, contrast_in_theory, size, size_in_theory, correlation, pixels } = await page.measure();
  return { contrast, contrast_in_theory, size, size_in_theory, correlation, pixels };
}, values);
const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;

const flags = ['--no-sandbox', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan',
  '--use-vulkan=swiftshader', '--use-angle=vulkan'];
const executablePath = process.env.CHROMIUM;
const browser = await puppeteer.launch({ executablePath, headless: true, args: flags });
try {
  const sizes = await Promise.all((await readdir(folder)).map(async (name) => (await stat(join(folder, name))).size));
  const bytes = sizes.reduce((sum, size) => sum + size, 0);
  expect(bytes <= 1e6, `${bytes} bytes in all, at most 1e6`);

  const [wide, seconds] = await open(browser, 1280, 900);
  expect(seconds <= 5, `first speckle after ${seconds.toFixed(1)} s, at most 5`);
  if (pictures) await wide.screenshot({ path: join(pictures, 'wide.png') });

  // A wide spot on a plate: some ten thousand speckles.
  const still = await measured(wide, { part: 0, light: 1, line_width: 15, elevation: 80 });
  console.log(still);
  expect(near(still.contrast / still.contrast_in_theory, 1, 0.02), `contrast ${still.contrast.toFixed(3)}, by theory ${still.contrast_in_theory.toFixed(3)}`);
  expect(near(still.size / still.size_in_theory, 1, 0.03), `speckle of ${still.size.toFixed(2)} pixels, by theory ${still.size_in_theory.toFixed(2)}`);
  expect(still.correlation === 1, 'a part at rest keeps its speckle');
  const tilted = await measured(wide, { tilt: 0.5 });
  console.log(tilted);
  expect(near(tilted.contrast / still.contrast, 1, 0.02), `tilted, the contrast is ${tilted.contrast.toFixed(3)}`);
  expect(tilted.correlation > 0.05 && tilted.correlation < 0.95, `half a mrad of tilt leaves γ = ${tilted.correlation.toFixed(2)}`);
  const [rms, worst] = await wide.evaluate(() => window.tem00.page.compare());
  expect(rms <= 3e-6 && worst <= 3e-5, `speckle of the card and of the library: ${rms.toExponential(1)} apart in rms, ${worst.toExponential(1)} at most`);
  const refused = await wide.evaluate(() => { try { window.tem00.page.set('f_number', 1000); } catch (error) { return error.message; } });
  expect(refused?.includes('`f_number` is 1000'), `a value beyond its range: ${refused}`);

  const [narrow] = await open(browser, 390, 844);
  const overflow = await narrow.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  expect(overflow <= 0, 'nothing is wider than a narrow screen');
  if (pictures) await narrow.screenshot({ path: join(pictures, 'narrow.png'), fullPage: true });
} finally {
  await browser.close();
  server.close();
}
console.log(`${failures.length} failures`);
process.exit(failures.length ? 1 : 0);
