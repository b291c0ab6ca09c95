// The widget on a model like that of a notebook, made by part.py: JSON on standard input. Usage: python model.py | node check.mjs FOLDER
import { text } from 'node:stream/consumers';
import { check, open } from './browser.mjs';

const [folder] = process.argv.slice(2);
const state = JSON.parse(await text(process.stdin));
await check([folder], async (browser, address, expect) => {
  const page = await open(browser, `${address}empty.html`, [1000, 700], expect);
  const [first, moved, wrong] = await page.evaluate(async (state) => {
    const { default: widget } = await import('./part.js');
    const wasm = await (await fetch('tem00_web_bg.wasm')).arrayBuffer();
    const values = { ...state, _wasm: new DataView(wasm) };
    const listeners = [];
    let saved;
    const model = {
      get: (name) => values[name],
      set: (name, value) => { values[name] = value; },
      save_changes: () => saved?.(),
      on: (_, listener) => listeners.push(listener),
    };
    await widget.render({ model, el: document.body });
    const change = (changes) => new Promise((done) => {
      saved = () => done({ measured: values.measured, error: values.error });
      values.values = { ...values.values, ...changes };
      listeners.forEach((listener) => listener());
    });
    return [{ measured: values.measured, error: values.error }, await change({ tilt: 0.5 }), await change({ tilt: 50 })];
  }, state);
  const { contrast, contrast_in_theory } = first.measured;
  expect(Math.abs(contrast / contrast_in_theory - 1) < 0.03, `contrast ${contrast}, by theory ${contrast_in_theory}`);
  expect(moved.measured.correlation < 0.95, `half a mrad of tilt leaves γ = ${moved.measured.correlation}`);
  expect(wrong.error.includes('`tilt` is 50'), `a value beyond its range: ${wrong.error}`);
});
