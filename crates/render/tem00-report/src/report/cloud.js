"use strict";
// Turns the points of each cloud: with the pointer, the fingers, the keys and buttons.
for (const view of document.querySelectorAll("svg.cloud")) {
  const parts = Array.from(view.querySelectorAll("[data-p]"), (part) => ({
    part,
    kind: part.getAttribute("class"),
    places: part.dataset.p.split(" ").map(Number),
  }));
  const start = {
    azimuth: Number(view.dataset.azimuth),
    elevation: Number(view.dataset.elevation),
    zoom: 1,
  };
  const turn = { ...start };

  const draw = () => {
    const [a, e] = [turn.azimuth, turn.elevation].map((degrees) => (degrees * Math.PI) / 180);
    const [ca, sa, ce, se] = [Math.cos(a), Math.sin(a), Math.cos(e), Math.sin(e)];
    const place = (p, i) => {
      const across = turn.zoom * (p[i] * ca + p[i + 1] * sa);
      const up = turn.zoom * (p[i + 2] * ce + (p[i + 1] * ca - p[i] * sa) * se);
      return `${(across / 10).toFixed(1)} ${(-up / 10).toFixed(1)}`;
    };
    for (const { part, kind, places } of parts) {
      if (kind === "label") {
        part.setAttribute("transform", `translate(${place(places, 0)})`);
        continue;
      }
      let d = "";
      for (let i = 0; i < places.length; i += 3)
        d += kind === "dots" ? `M${place(places, i)}h0` : `${i % 6 ? "L" : "M"}${place(places, i)}`;
      part.setAttribute("d", d);
    }
  };
  let due = false;
  const change = (by) => {
    turn.azimuth = (((turn.azimuth + (by.azimuth ?? 0)) % 360) + 360) % 360;
    turn.elevation = Math.min(90, Math.max(0, turn.elevation + (by.elevation ?? 0)));
    turn.zoom = Math.min(20, Math.max(0.5, turn.zoom * (by.zoom ?? 1)));
    if (due) return;
    due = true;
    requestAnimationFrame(() => {
      due = false;
      draw();
    });
  };
  const look = (azimuth, elevation) =>
    change({
      azimuth: azimuth - turn.azimuth,
      elevation: elevation - turn.elevation,
      zoom: 1 / turn.zoom,
    });

  const fingers = new Map();
  const gap = () => {
    const [a, b] = [...fingers.values()];
    return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
  };
  view.addEventListener("pointerdown", (event) => {
    view.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, event);
  });
  view.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) return;
    const before = fingers.size === 2 ? gap() : 0;
    fingers.set(event.pointerId, event);
    if (fingers.size === 1)
      change({
        azimuth: (last.clientX - event.clientX) / 2,
        elevation: (event.clientY - last.clientY) / 2,
      });
    else if (before > 0) change({ zoom: gap() / before });
  });
  for (const end of ["pointerup", "pointercancel"])
    view.addEventListener(end, (event) => fingers.delete(event.pointerId));

  const keys = {
    ArrowLeft: () => change({ azimuth: 5 }),
    ArrowRight: () => change({ azimuth: -5 }),
    ArrowUp: () => change({ elevation: 5 }),
    ArrowDown: () => change({ elevation: -5 }),
    "+": () => change({ zoom: 1.25 }),
    "-": () => change({ zoom: 0.8 }),
    Home: () => look(start.azimuth, start.elevation),
  };
  view.tabIndex = 0;
  view.classList.add("turns");
  view.addEventListener("keydown", (event) => {
    if (!keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });

  const buttons = document.createElement("div");
  buttons.className = "buttons";
  for (const [text, act] of [
    ["default view", keys.Home],
    ["from above", () => look(0, 90)],
    ["along the scan", () => look(0, 0)],
    ["along the line", () => look(90, 0)],
    ["larger", keys["+"]],
    ["smaller", keys["-"]],
  ]) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = text;
    button.addEventListener("click", act);
    buttons.append(button);
  }
  const help = document.createElement("p");
  help.className = "help";
  help.textContent = "Drag to turn, pinch to enlarge; with the keyboard: arrows, + and −, Home.";
  view.after(buttons, help);
}
