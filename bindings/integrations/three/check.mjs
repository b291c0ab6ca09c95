// The laser spot in three.js: it is lit, and its speckle has its contrast. Usage: node check.mjs FOLDER [PICTURE]
import { check, open } from './browser.mjs';

const [folder, picture] = process.argv.slice(2);
await check([folder], async (browser, address, expect) => {
  const page = await open(browser, address, [560, 620], expect);
  await page.waitForFunction(() => 'done' in document.body.dataset, { timeout: 60_000 });
  const { middle, mean, contrast, pixels } = await page.evaluate(() => window.numbers);
  // The wall in the middle of the picture: 0.8/π · 2 P / (π w²) · exp(−2 r²/w²) · cos, at r from the axis of the light.
  const [x, along] = [Math.hypot(0.1, 0.33), (0.1 ** 2 + 0.3 * 0.33) / Math.hypot(0.1, 0.3)];
  const axis = 0.8 / Math.PI * 2 * 5e-3 / (Math.PI * 0.03 ** 2);
  const wall = axis * Math.exp(-2 * (x ** 2 - along ** 2) / 0.03 ** 2) * 0.3 / Math.hypot(0.1, 0.3);
  expect(Math.abs(middle / wall - 1) < 0.01, `the wall has ${middle.toFixed(3)} W/(m² sr), by theory ${wall.toFixed(3)}`);
  // A speckle covers some nine pixels.
  const scatter = Math.sqrt(18 / pixels);
  expect(Math.abs(mean - 1) < 3 * scatter, `mean ${mean.toFixed(3)} on ${pixels} pixels`);
  expect(Math.abs(contrast - 1) < 3 * scatter, `contrast ${contrast.toFixed(3)}, within ${(3 * scatter).toFixed(3)} of 1`);
  if (picture) await page.screenshot({ path: picture });
});
