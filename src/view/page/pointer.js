// Moves the camera by mouse, touch and keys.
'use strict';

const tool = () => document.querySelector('input[name=tool]:checked').value;
const hints = {
  orbit: 'Drag to orbit the room. Scroll or pinch to move closer. Hold Shift or use two fingers to move sideways.',
  walk: 'Drag to look around. Press W A S D or the arrow keys to walk, Q and E to move down and up.',
  point: 'Click a surface to measure its illuminance.',
  grid: 'Drag from one corner of a flat surface to the opposite corner to measure a grid.',
};
function placeOf(event) {
  const r = $('overlay').getBoundingClientRect();
  return [(event.clientX - r.left) / r.width, (event.clientY - r.top) / r.height]
    .map((v) => Math.max(0, Math.min(1, v)));
}

// Two fingers: their distance zooms, their midpoint moves the camera sideways.
class Pinch {
  constructor(points) { this.set(points); }
  set([a, b]) {
    this.middle = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
    this.distance = Math.max(Math.hypot(a[0] - b[0], a[1] - b[1]), 0.01);
  }
  move(points, camera) {
    const {middle, distance} = this;
    this.set(points);
    const nearer = Math.max(-0.5, Math.min(0.5, 1 - distance / this.distance));
    camera.walk(-(this.middle[0] - middle[0]) * camera.reach, (this.middle[1] - middle[1]) * camera.reach, 0);
    camera.dolly(nearer);
  }
}

const pointers = new Map();

function onDown(event) {
  if (!app.camera) return;
  $('overlay').setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, placeOf(event));
  if (pointers.size === 2) {
    app.drag = null;
    app.pinch = new Pinch([...pointers.values()]);
  } else if (pointers.size === 1) {
    app.drag = {tool: tool(), from: placeOf(event), at: placeOf(event)};
  }
}

function onMove(event) {
  if (pointers.has(event.pointerId)) pointers.set(event.pointerId, placeOf(event));
  if (app.pinch) {
    if (pointers.size < 2) return;  // the finger that stays down does not turn the camera
    app.pinch.move([...pointers.values()], app.camera);
    sendCamera();
    return;
  }
  const {drag} = app;
  if (!drag) {
    app.pointed = placeOf(event);
    if (measurements.all.length || year.isShown) drawOverlay();
    return;
  }
  const at = placeOf(event), [dx, dy] = [at[0] - drag.at[0], at[1] - drag.at[1]];
  drag.at = at;
  if (drag.tool === 'grid') {
    drag.to = at;
    drawOverlay();
    return;
  }
  if (drag.tool === 'point') return;
  if (event.shiftKey) app.camera.walk(-dx * app.camera.reach, dy * app.camera.reach, 0);
  else if (drag.tool === 'orbit') app.camera.orbit(-4 * dx, 2.5 * dy);
  else app.camera.turn(-1.5 * dx, 1.2 * dy);
  sendCamera();
}

async function onUp(event) {
  pointers.delete(event.pointerId);
  if (app.pinch) {
    if (pointers.size === 0) app.pinch = null;
    return;
  }
  const {drag} = app, at = placeOf(event);
  app.drag = null;
  if (!drag) return;
  try {
    const isClick = Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) < 0.005;
    if (isClick && (drag.tool === 'orbit' || drag.tool === 'walk')) await year.pick(at, $('overlay'));
    if (drag.tool === 'point') await measurements.pick(...at);
    if (drag.tool === 'grid') await measurements.grid(drag.from, at, Number($('along').value) || 8, Number($('above').value) || 0);
  } catch (error) { say(error.message); }
  drawOverlay();
}

const steps = {w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], q: [0, -1, 0], e: [0, 1, 0],
  ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1], ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0]};
function onKey(event) {
  const step = steps[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!step || !app.camera || event.ctrlKey || event.metaKey) return;
  event.preventDefault();
  app.camera.walk(...scaled(step, (event.shiftKey ? 0.05 : 0.02) * app.camera.size));
  sendCamera();
}

function listenToPointers() {
  const overlay = $('overlay');
  overlay.onpointerdown = onDown;
  overlay.onpointermove = onMove;
  overlay.onpointerup = overlay.onpointercancel = onUp;
  overlay.onpointerleave = () => { app.pointed = null; drawOverlay(); };
  overlay.onkeydown = onKey;
  overlay.addEventListener('wheel', (event) => {
    event.preventDefault();
    if (!app.camera) return;
    app.camera.dolly(-Math.sign(event.deltaY) * 0.1);
    sendCamera();
  }, {passive: false});
  for (const radio of document.querySelectorAll('input[name=tool]'))
    radio.onchange = () => {
      say(hints[tool()]);
      overlay.classList.toggle('picking', tool() === 'point' || tool() === 'grid');
    };
  say(hints.orbit);
}
