// The front end of part.py: draws what `values` says and hands back what is measured.
async function render({ model, el }) {
  const module = URL.createObjectURL(new Blob([model.get('_module')], { type: 'text/javascript' }));
  const { default: init, Page } = await import(module);
  URL.revokeObjectURL(module);
  const { buffer, byteOffset, byteLength } = model.get('_wasm');
  await init({ module_or_path: new Uint8Array(buffer, byteOffset, byteLength) });
  const canvas = Object.assign(document.createElement('canvas'), { width: 960, height: 640 });
  canvas.style.maxWidth = '100%';
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', 'A part lit by a laser, with speckle');
  el.append(canvas);

  const answer = (error, found) => {
    const { contrast, contrast_in_theory, size, size_in_theory, correlation } = found ?? {};
    const measured = { contrast, contrast_in_theory, size, size_in_theory, correlation };
    model.set('error', error);
    model.set('measured', found ? measured : {});
    model.save_changes();
    found?.free();
  };
  let page;
  try {
    page = await Page.open(canvas);
  } catch (error) {
    return answer(`this draws with WebGPU, but ${error.message ?? error}`);
  }
  const draw = async () => {
    try {
      for (const [name, value] of Object.entries(model.get('values'))) page.set(name, value);
      page.draw(true);
      answer('', await page.measure());
    } catch (error) {
      answer(error.message ?? String(error));
    }
  };
  model.on('change:values', draw);
  await draw();
}

export default { render };
