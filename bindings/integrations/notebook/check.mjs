// Runs part.ipynb in JupyterLab in the same browser. Usage: node check.mjs FOLDER [FOLDER FOR PICTURES]
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

/** Runs a cell of the notebook, with other code if it is given, and returns what it shows. */
const run = (page, index, code) => page.evaluate(async (index, code) => {
  const { shell, commands } = window.jupyterapp;
  const { content } = shell.currentWidget;
  const cell = content.widgets[index];
  if (code) cell.model.sharedModel.setSource(code);
  content.activeCellIndex = index;
  await commands.execute('notebook:run-cell');
  return cell.outputArea.node.querySelector('.jp-OutputArea-output')?.innerText ?? '';
}, index, code);

/** Runs the last cell until it shows what the widget answers, for a minute and a half. */
async function answer(page, expected) {
  let text = '';
  for (let tries = 0; tries < 90 && !expected.test(text); tries += 1) {
    text = await run(page, 2);
    await setTimeout(1000);
  }
  const number = (name) => Number(text.match(new RegExp(`'${name}': ([\\d.]+)`))?.[1]);
  return { contrast: number('contrast'), inTheory: number('contrast_in_theory'), correlation: number('correlation'), text };
}

await check([], async (browser, _, expect) => {
  const page = await browser.newPage();
  await page.setViewport({ width: 1200, height: 1000 });
  await page.goto(`${await address}/tree/part.ipynb`);
  await page.waitForFunction(() => window.jupyterapp?.shell.currentWidget?.sessionContext?.isReady);
  await run(page, 0);
  const first = await answer(page, /'correlation': 1/);
  expect(Math.abs(first.contrast / first.inTheory - 1) < 0.03, `contrast ${first.contrast}, by theory ${first.inTheory}`);
  await run(page, 1);
  const moved = await answer(page, /'correlation': 0/);
  expect(moved.correlation < 0.95, `half a mrad of tilt leaves γ = ${moved.correlation}`);
  if (pictures) await page.screenshot({ path: join(pictures, 'notebook.png') });
  await run(page, 1, 'part.set(tilt=50)');
  const wrong = await answer(page, /`tilt` is 50/);
  expect(wrong.text.includes('`tilt` is 50'), `a value beyond its range: ${wrong.text}`);
});
