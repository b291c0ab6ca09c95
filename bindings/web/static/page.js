// The settings as controls, the mouse, the measured numbers. What they mean is in the WebAssembly
// module.
import init, { Page, settings } from './tem00_web.js';

const $ = (id) => document.getElementById(id);
const canvas = $('picture');

function say(text, isError = false) {
  $('message').textContent = text;
  $('message').classList.toggle('error', isError);
}

/** Without WebGPU: a sentence and a picture. */
function instead(reason) {
  document.querySelector('table').remove();
  const picture = new Image();
  picture.src = 'instead.png';
  picture.alt = 'A step gauge under a red laser line, with speckle';
  picture.className = 'instead';
  canvas.replaceWith(picture);
  $('settings').remove();
  say(
    `This page draws with WebGPU, but ${reason}. The picture shows what it would draw; ` +
      'a recent Chrome, Edge, Firefox or Safari shows it live.',
    true,
  );
}

/** A control for each setting that is not moved by the mouse. */
function controls(list, onChange) {
  const form = $('settings');
  const shown = new Map();
  for (const { name, label, min, max, start, choices } of list) {
    if (name === 'zoom_x' || name === 'zoom_y' || name === 'seed') continue;
    const box = document.createElement('label');
    const output = document.createElement('output');
    let input;
    if (choices.length > 0 && choices[0] !== 'off') {
      input = document.createElement('select');
      choices.forEach((choice, value) =>
        input.add(new Option(choice, value, false, value === start)));
      box.className = 'choice';
      input.addEventListener('change', () => onChange(name, Number(input.value)));
      box.append(label, input);
    } else if (choices.length > 0) {
      input = document.createElement('input');
      Object.assign(input, { type: 'checkbox', checked: start === 1 });
      box.className = 'switch';
      input.addEventListener('change', () => onChange(name, input.checked ? 1 : 0));
      box.append(label, input);
    } else {
      // A slider of ratios where the range spans decades.
      const ratio = min > 0 && max / min > 20;
      const to = ratio ? Math.log : (x) => x;
      const from = ratio ? Math.exp : (x) => x;
      input = document.createElement('input');
      const step = (to(max) - to(min)) / 400;
      Object.assign(input, { type: 'range', min: to(min), max: to(max), step });
      input.value = to(start);
      const show = (value) => {
        output.value = value.toFixed(max - min > 200 ? 0 : 2);
        input.setAttribute('aria-valuetext', `${output.value}, ${label}`);
      };
      input.addEventListener('input', () => {
        const value = Math.min(max, Math.max(min, from(Number(input.value))));
        show(value);
        onChange(name, value);
      });
      show(start);
      shown.set(name, (value) => { input.value = to(value); show(value); });
      box.append(label, output, input);
    }
    form.append(box);
  }
  const rest = document.createElement('button');
  Object.assign(rest, { type: 'button', textContent: 'Part at rest' });
  rest.addEventListener('click', () => {
    for (const name of ['slide', 'lift', 'tilt']) {
      shown.get(name)(0);
      onChange(name, 0);
    }
  });
  form.append(rest);
  return shown;
}

async function start() {
  if (!navigator.gpu) return instead('this browser lacks it, or has switched it off');
  await init();
  let page;
  try {
    page = await Page.open(canvas);
  } catch (error) {
    return instead(error.message ?? String(error));
  }
  const list = JSON.parse(settings());
  const values = Object.fromEntries(list.map(({ name, start }) => [name, start]));
  const range = Object.fromEntries(list.map(({ name, min, max }) => [name, [min, max]]));
  let waiting = false;
  let idle;
  let measuring = Promise.resolve();

  const set = (name, value) => {
    try {
      page.set(name, value);
      values[name] = value;
      ask();
    } catch (error) {
      say(error.message ?? String(error), true);
    }
  };
  const shown = controls(list, set);
  const turn = (name, step) => {
    const [min, max] = range[name];
    let value = values[name] + step;
    if (name === 'azimuth') value = ((value + 540) % 360) - 180;
    value = Math.min(max, Math.max(min, value));
    shown.get(name)?.(value);
    set(name, value);
  };

  /** Asks for a picture at once, and for a fine one when nothing changes any more. */
  function ask() {
    if (!waiting) requestAnimationFrame(() => draw(false));
    waiting = true;
    clearTimeout(idle);
    idle = setTimeout(() => draw(true), 150);
  }
  function draw(fine) {
    waiting = false;
    try {
      page.draw(fine);
      say('');
    } catch (error) {
      say(error.message ?? String(error), true);
      return;
    }
    if (fine) measuring = measuring.then(measure);
  }
  async function measure() {
    const found = await page.measure().catch((error) => say(error.message ?? String(error), true));
    const names = ['contrast', 'contrast_in_theory', 'size', 'size_in_theory', 'correlation'];
    for (const name of names) {
      const value = found?.[name];
      $(name).textContent = Number.isFinite(value) ? value.toFixed(2) : '–';
    }
    found?.free();
    document.body.dataset.measured = '';
  }

  let last;
  canvas.addEventListener('pointerdown', (event) => {
    last = event;
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener('pointerup', () => { last = undefined; });
  canvas.addEventListener('pointermove', (event) => {
    if (!last) return;
    turn('azimuth', -0.4 * (event.clientX - last.clientX));
    turn('elevation', 0.4 * (event.clientY - last.clientY));
    last = event;
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    const box = canvas.getBoundingClientRect();
    if (values.zoom === 1) {
      set('zoom_x', Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
      set('zoom_y', Math.min(1, Math.max(0, (event.clientY - box.top) / box.height)));
    }
    turn('zoom', values.zoom * (event.deltaY < 0 ? 0.25 : -0.2));
  }, { passive: false });
  const keys = {
    ArrowLeft: ['azimuth', 3], ArrowRight: ['azimuth', -3],
    ArrowUp: ['elevation', 3], ArrowDown: ['elevation', -3],
    '+': ['zoom', 1], '-': ['zoom', -1],
  };
  canvas.addEventListener('keydown', (event) => {
    if (!(event.key in keys)) return;
    event.preventDefault();
    turn(...keys[event.key]);
  });
  page.draw(false);
  await page.drawn();
  document.body.dataset.drawn = '';
  ask();
  window.tem00 = { page, set };
}

start().catch((error) => say(error.message ?? String(error), true));
