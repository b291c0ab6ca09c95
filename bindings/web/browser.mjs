// A headless Chromium, CHROMIUM's, on a software adapter, and a server of files for it on the loopback interface.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { extname, join } from 'node:path';
import puppeteer from 'puppeteer-core';

const TYPES = { '.html': 'text/html', '.css': 'text/css', '.js': 'text/javascript', '.wasm': 'application/wasm', '.png': 'image/png' };
const FLAGS = ['--no-sandbox', '--enable-unsafe-webgpu', '--use-webgpu-adapter=swiftshader', '--enable-features=Vulkan',
  '--use-vulkan=swiftshader', '--use-angle=vulkan'];

/** Serves the files of `folders`, the first that has one, and calls `judge(browser, address, expect)`; ends the process. */
export async function check(folders, judge) {
  const server = createServer(async (request, response) => {
    const name = request.url === '/' ? 'index.html' : request.url.slice(1);
    for (const folder of folders) {
      const body = await readFile(join(folder, name)).catch(() => undefined);
      if (body) return response.writeHead(200, { 'content-type': TYPES[extname(name)] ?? 'text/plain' }).end(body);
    }
    response.writeHead(404).end();
  });
  await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
  let [passed, failed] = [0, 0];
  const expect = (holds, text) => {
    console.log(`${holds ? 'ok  ' : 'FAIL'} ${text}`);
    holds ? (passed += 1) : (failed += 1);
  };
  const browser = await puppeteer.launch({ executablePath: process.env.CHROMIUM, headless: true, args: FLAGS });
  try {
    await judge(browser, `http://127.0.0.1:${server.address().port}/`, expect);
  } finally {
    await browser.close();
    server.close();
  }
  console.log(`${passed} passed, ${failed} failed`);
  process.exit(failed ? 1 : 0);
}

/** Opens a page whose messages on the console, and errors, are failures. */
export async function open(browser, address, [width, height], expect) {
  const page = await browser.newPage();
  await page.setViewport({ width, height });
  page.on('console', (message) => expect(false, `console: ${message.text()}`));
  page.on('pageerror', (error) => expect(false, `error: ${error.message}`));
  await page.goto(address);
  return page;
}
