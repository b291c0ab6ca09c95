// Runs part.ipynb in JupyterLab, in the same browser. Usage: node lab.mjs FOLDER [FOLDER FOR PICTURES]
import { spawn } from 'node:child_process';
import { join } from 'node:path';
import { setTimeout } from 'node:timers/promises';
import { check } from './browser.mjs';

const [folder, pictures] = process.argv.slice(2);
const lab = spawn('jupyter', ['lab', '--no-browser', `--ServerApp.root_dir=${folder}`, '--ip=127.0.0.1', '--port=0',
  '--IdentityProvider.token=', '--LabApp.expose_app_in_browser=True', ...(process.getuid() ? [] : ['--allow-root'])]);
process.on('exit', () => lab.kill());
const address = new Promise((found, failed) => {
  let said = '';
  lab.on('exit', () => failed(new Error(said)));
  lab.stderr.on('data', (text) => {
    said += text;
    const [url] = said.match(/http:\/\/127\.0\.0\.1:\d+\/lab/) ?? [];
    if (url) found(url);
  });
});

/** Runs a cell of the notebook and returns what it shows. */
const run = (page, index) => page.evaluate(async (index) => {
  const { shell, commands } = window.jupyterapp;
  const { content } = shell.currentWidget;
  content.activeCellIndex = index;
  await commands.execute('notebook:run-cell');
  return content.widgets[index].outputArea.node.innerText;
}, index);

/** Runs the last cell until it shows what the widget has measured, other than before, for half a minute. */
async function measured(page, before = '') {
  let text;
  for (let tries = 0; tries < 150; tries += 1) {
    text = await run(page, 2);
    if (text.includes('contrast') && text !== before) break;
    await setTimeout(200);
  }
  return text;
}

await check([], async (browser, _, expect) => {
  const page = await browser.newPage();
  await page.setViewport({ width: 1200, height: 1000 });
  await page.goto(`${await address}/tree/part.ipynb`);
  await page.waitForFunction(() => window.jupyterapp?.shell.currentWidget?.sessionContext?.isReady);
  await run(page, 0);
  await page.waitForSelector('.jp-OutputArea canvas');
  const first = await measured(page);
  expect(/'correlation': 1/.test(first), `JupyterLab draws: ${first}`);
  await run(page, 1);
  const moved = await measured(page, first);
  expect(Number(moved.match(/'correlation': ([\d.]+)/)[1]) < 0.95, `and moves: ${moved}`);
  if (pictures) await page.screenshot({ path: join(pictures, 'notebook.png') });
});
