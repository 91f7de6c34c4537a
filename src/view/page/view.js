// The page: asks for layers as they get finer, shows them, and sends what users do.
'use strict';

const $ = (id) => document.getElementById(id);
const app = {
  state: null, camera: null, layers: {}, pictureShown: null, isSending: false, isMovePending: false,
  movedAt: 0, dimmers: [], isFirst: true, drag: null, failures: 0,
};
window.app = app;

async function request(path, options) {
  const response = await fetch(path, options);
  if (!response.ok) throw new Error((await response.text()).trim() || `status ${response.status}`);
  return response;
}
const getJson = async (path) => (await request(path)).json();
const post = async (path, body) =>
  (await request(path, {method: 'POST', body: JSON.stringify(body ?? {})})).json();
function say(text) { $('hint').textContent = text; }

// Colour times setting of every luminaire.
const factors = () => app.dimmers.map((d) => d.isOn ? d.colour.map((c) => c * d.level) : [0, 0, 0]);
const areDimmed = () => factors().some((f) => f.some((v) => v !== 1));
const measurements = new Measurements(post, getJson, factors, () => { drawMeasured(); drawOverlay(); });

// Of all light as it is set; null where it is not known yet.
function currentPicture() {
  const {whole} = app.layers;
  if (!whole) return null;
  if (!areDimmed()) return whole;
  if (app.dimmers.length === 1) return sumOf([whole], factors());
  const views = app.state.layers, all = app.dimmers.map((_, i) => app.layers[`dimmer${i}`]);
  const first = all[0];
  const isThere = all.every((l, i) => l && l.width === first.width && l.height === first.height &&
    views[`dimmer${i}`].view === views.dimmer0.view);
  return isThere ? sumOf(all, factors()) : null;
}

const scaleOf = () => (app.state.is_photometric ? 1 : 179);
const unitOf = (kind) => ({illuminance: 'lx', luminance: 'cd/m²', error: '%'})[kind];

// As what is beside it, up to the same value.
function drawSide(picture, kind, pixels, from, to, mostBeside) {
  if (kind === 'picture') {
    drawPicture(picture, Number($('stops').value), $('filmic').checked, pixels, from, to);
    return null;
  }
  const map = valuesOf(kind, picture, app.layers.albedo, app.layers.error, scaleOf());
  const most = kind !== $('show').value ? roundUp(quantile(map.values, 0.98)) : mostBeside ?? mostOf(map);
  drawValues(map, most, $('log').checked, pixels, from, to);
  return {map, most};
}
const mostOf = (map) => Number($('most').value) > 0 ? Number($('most').value)
  : roundUp(quantile(map.values, 0.98));

function draw() {
  const picture = currentPicture() ?? app.pictureShown;
  if (!picture) return;
  app.pictureShown = picture;
  if (app.isFirst) {
    setStops(autoStops(picture));
    app.isFirst = false;
  }
  const canvas = $('picture'), {width, height} = picture;
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  const g = canvas.getContext('2d'), image = g.createImageData(width, height);
  const kind = $('show').value, beside = $('beside').value;
  const split = beside ? Math.round(width * $('split-at').value / 1000) : width;
  app.map = drawSide(picture, kind, image.data, 0, split);
  app.besideText = '';
  if (split < width) {
    const isError = beside === 'error', second = isError ? picture : fitted(app.layers.second, width, height);
    const side = second && drawSide(second, isError ? 'error' : kind, image.data, split, width, app.map?.most);
    app.besideText = isError ? `standard error, to ${side.most} %` : second ? `by ${beside}` : `${beside}: to come`;
  }
  g.putImageData(image, 0, 0);
  if (app.map) drawLegend($('legend'), app.map.most, $('log').checked, unitOf(kind));
  drawOverlay();
}

// Of another size: by the nearest pixels.
function fitted(layer, width, height) {
  if (!layer || (layer.width === width && layer.height === height)) return layer;
  const data = new Float32Array(3 * width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const i = indexIn(layer, x, y, width, height);
      data.set(layer.data.subarray(i, i + 3), 3 * (y * width + x));
    }
  return {width, height, channels: 3, data};
}

// The canvases fill the stage as far as the picture's shape allows.
function layOut() {
  if (!app.state) return;
  const stage = $('stage').getBoundingClientRect(), [w, h] = app.state.size;
  const scale = Math.min(stage.width / w, stage.height / h);
  for (const id of ['picture', 'overlay'])
    Object.assign($(id).style, {width: `${w * scale}px`, height: `${h * scale}px`});
  Object.assign($('overlay'), {width: Math.round(w * scale), height: Math.round(h * scale)});
  drawOverlay();
}

function drawOverlay() {
  const canvas = $('overlay'), g = canvas.getContext('2d');
  g.clearRect(0, 0, canvas.width, canvas.height);
  if (!app.camera) return;
  const aspect = app.state.size[0] / app.state.size[1];
  if ($('lines').checked && app.map && $('show').value !== 'picture') drawLines(g, canvas);
  if ($('beside').value) {
    const x = canvas.width * $('split-at').value / 1000;
    g.fillStyle = '#ffd166';
    g.fillRect(x - 1, 0, 2, canvas.height);
    g.font = '12px system-ui, "DejaVu Sans", sans-serif';
    g.textAlign = 'left';
    g.lineWidth = 3;
    g.strokeStyle = '#000';
    g.strokeText(app.besideText, x + 8, 18);
    g.fillText(app.besideText, x + 8, 18);
  }
  measurements.draw(g, (p) => {
    const at = app.camera.project(p.slice(0, 3), aspect);
    return at && [at[0] * canvas.width, at[1] * canvas.height];
  });
  if (app.drag?.tool === 'grid' && app.drag.to) {
    const [a, b] = [app.drag.from, app.drag.to];
    g.strokeStyle = '#ffd166';
    g.lineWidth = 1.5;
    g.strokeRect(a[0] * canvas.width, a[1] * canvas.height, (b[0] - a[0]) * canvas.width,
      (b[1] - a[1]) * canvas.height);
  }
}

function drawLines(g, canvas) {
  const block = Math.max(1, Math.round(app.map.map.width / 160)), map = smoothed(app.map.map, block);
  const [sx, sy] = [block * canvas.width / app.map.map.width, block * canvas.height / app.map.map.height];
  g.font = '11px system-ui, "DejaVu Sans", sans-serif';
  app.lines = {};
  // Of what is left of the split.
  g.save();
  g.beginPath();
  g.rect(0, 0, $('beside').value ? canvas.width * $('split-at').value / 1000 : canvas.width, canvas.height);
  g.clip();
  for (const level of $('levels').value.split(/[,;\s]+/).map(Number).filter((v) => v > 0)) {
    const segments = linesAt(map, level);
    app.lines[level] = segments.length;
    for (const [style, width] of [['#000a', 3], ['#fff', 1.2]]) {
      g.strokeStyle = style;
      g.lineWidth = width;
      g.beginPath();
      for (const [x0, y0, x1, y1] of segments) {
        g.moveTo(x0 * sx, y0 * sy);
        g.lineTo(x1 * sx, y1 * sy);
      }
      g.stroke();
    }
    if (!segments.length) continue;
    const [x, y] = segments[Math.floor(segments.length / 2)];
    g.fillStyle = '#fff';
    g.strokeStyle = '#000';
    g.lineWidth = 3;
    g.strokeText(level, x * sx, y * sy);
    g.fillText(level, x * sx, y * sy);
  }
  g.restore();
}

function drawMeasured() {
  const list = $('measured');
  list.replaceChildren(...measurements.all.map((item) => {
    const row = document.createElement('div'), name = document.createElement('span');
    row.className = 'result';
    name.textContent = `${item.label}: ${measurements.text(item)}`;
    const csv = document.createElement('a');
    csv.textContent = 'CSV';
    csv.download = 'measured.csv';
    csv.href = `measured.csv?number=${item.number}&dimmers=${dimmersText()}`;
    const gone = document.createElement('button');
    gone.textContent = '×';
    gone.title = 'Remove';
    gone.onclick = () => measurements.remove(item);
    row.append(name, csv, gone);
    return row;
  }));
}

const dimmersText = () => (areDimmed() ? factors().map((f) => f.map((v) => +v.toPrecision(6)).join(',')).join(';') : '');
function updateLinks() {
  const set = `dimmers=${encodeURIComponent(dimmersText())}`;
  $('save-png').href = `picture?format=png&${set}&stops=${$('stops').value}&tone_map=${$('filmic').checked ? 'filmic' : 'none'}`;
  $('save-hdr').href = `picture?format=hdr&${set}`;
  $('save-exr').href = `picture?format=exr&${set}`;
}

function setStops(stops) {
  $('stops').value = stops.toFixed(1);
  $('stops-value').textContent = `${Number($('stops').value).toFixed(1)}`;
}

// Layers that have changed since; whether any has.
async function fetchLayers(state) {
  const wanted = ['whole', 'albedo', 'error'];
  if ($('beside').value && $('beside').value !== 'error') wanted.push('second');
  if (areDimmed()) state.dimmers.forEach((_, i) => wanted.push(`dimmer${i}`));
  let hasChanged = false;
  for (const name of wanted) {
    const now = state.layers[name];
    if (!now || app.layers[name]?.version === now.version) continue;
    const response = await request(`layer?name=${name}`);
    app.layers[name] = layerOf(await response.arrayBuffer());
    hasChanged = true;
  }
  if (!state.layers.second) delete app.layers.second;
  return hasChanged;
}

function tell(state) {
  const error = state.layers.whole?.error;
  const parts = [state.failure || state.stage];
  if (state.progress > 0 && state.progress < 1) parts.push(`${Math.round(100 * state.progress)} %`);
  if (error > 0) parts.push(`error ${(100 * error).toPrecision(2)} %`);
  if (state.seconds_to_first > 0) parts.push(`first picture after ${Math.round(1000 * state.seconds_to_first)} ms`);
  $('status').textContent = parts.join(' · ');
  $('dimmers-note').textContent = areDimmed() && app.dimmers.length > 1 && !currentPicture()
    ? 'pictures by each luminaire are being made' : '';
}

async function tick() {
  let wait = 1000;
  try {
    const state = await getJson('state');
    if (!app.state) begin(state);
    app.state = state;
    const [w, h] = state.size;
    if (app.laidOut !== `${w}x${h}`) { app.laidOut = `${w}x${h}`; layOut(); }
    if (await fetchLayers(state)) draw();
    if (await measurements.poll()) wait = 200;
    tell(state);
    if (state.stage !== 'done') wait = Math.min(wait, 250);
    if (state.seconds_to_first === 0 || performance.now() - app.movedAt < 1500) wait = 25;
    app.failures = 0;
  } catch (error) {
    $('status').textContent = ++app.failures > 2 ? 'troffer view has ended' : String(error.message);
    if (app.failures > 20) return;
  }
  setTimeout(tick, wait);
}

// One message at a time is under way; the newest place is sent after it.
async function sendCamera(extra) {
  app.movedAt = performance.now();
  app.isMovePending = true;
  drawOverlay();
  if (app.isSending) return;
  app.isSending = true;
  while (app.isMovePending) {
    app.isMovePending = false;
    try { await post('camera', {...app.camera.message(), ...extra}); } catch (error) { say(error.message); }
  }
  app.isSending = false;
}

const sendExtras = () => {
  const beside = $('beside').value;
  app.movedAt = performance.now();
  return post('extras', {wants_dimmers: areDimmed() && app.dimmers.length > 1,
    second: beside === 'error' ? '' : beside});
};

function begin(state) {
  document.title = `${state.file.split('/').pop()} – troffer view`;
  $('file').textContent = state.file.split('/').pop();
  $('file').title = state.file;
  app.home = state.camera;
  app.camera = new RoomCamera(state.camera, state.up, state.bounds);
  const cameras = state.cameras.length ? state.cameras : [state.camera];
  $('camera').replaceChildren(...cameras.map((c, i) => new Option(c.name || `camera ${i + 1}`, i)));
  $('camera').onchange = () => {
    app.camera = new RoomCamera(cameras[$('camera').value], state.up, state.bounds);
    sendCamera();
  };
  makeDimmers(state);
  makeTime(state);
  updateLinks();
}

const tool = () => document.querySelector('input[name=tool]:checked').value;
const hints = {
  orbit: 'Drag to turn about the room, wheel to come nearer, shift and drag to move.',
  walk: 'Drag to look around; W A S D to walk, Q and E for down and up.',
  point: 'Click where illuminance is to be measured.',
  grid: 'Drag from one corner of a rectangle on a surface to the other.',
};
function placeOf(event) {
  const r = $('overlay').getBoundingClientRect();
  return [(event.clientX - r.left) / r.width, (event.clientY - r.top) / r.height]
    .map((v) => Math.max(0, Math.min(1, v)));
}

function onMove(event) {
  const {drag} = app;
  if (!drag) return;
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
  const {drag} = app, at = placeOf(event);
  app.drag = null;
  if (!drag) return;
  try {
    if (drag.tool === 'point') await measurements.pick(...at);
    if (drag.tool === 'grid') await measurements.grid(drag.from, at, Number($('along').value) || 8, Number($('above').value) || 0);
  } catch (error) { say(error.message); }
  drawOverlay();
}

const steps = {w: [0, 0, 1], s: [0, 0, -1], a: [-1, 0, 0], d: [1, 0, 0], q: [0, -1, 0], e: [0, 1, 0],
  ArrowUp: [0, 0, 1], ArrowDown: [0, 0, -1], ArrowLeft: [-1, 0, 0], ArrowRight: [1, 0, 0]};
function onKey(event) {
  const step = steps[event.key];
  if (!step || !app.camera || event.ctrlKey || event.metaKey) return;
  event.preventDefault();
  app.camera.walk(...scaled(step, (event.shiftKey ? 0.05 : 0.02) * app.camera.size));
  sendCamera();
}

function listen() {
  const overlay = $('overlay');
  overlay.onpointerdown = (event) => {
    if (!app.camera) return;
    overlay.setPointerCapture(event.pointerId);
    app.drag = {tool: tool(), from: placeOf(event), at: placeOf(event)};
  };
  overlay.onpointermove = onMove;
  overlay.onpointerup = onUp;
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
  $('stops').oninput = () => { setStops(Number($('stops').value)); updateLinks(); draw(); };
  $('auto').onclick = () => { if (app.pictureShown) setStops(autoStops(app.pictureShown)); updateLinks(); draw(); };
  $('filmic').onchange = () => { updateLinks(); draw(); };
  $('show').onchange = () => {
    const isPicture = $('show').value === 'picture';
    $('exposing').hidden = !isPicture;
    $('false-colour').hidden = isPicture;
    document.querySelectorAll('.unit').forEach((u) => { u.textContent = unitOf($('show').value) ?? ''; });
    draw();
  };
  for (const id of ['most', 'log', 'lines', 'levels']) $(id).onchange = draw;
  $('beside').onchange = async () => {
    $('split-at').hidden = !$('beside').value;
    try { await sendExtras(); } catch (error) { say(error.message); }
    draw();
  };
  $('split-at').oninput = draw;
  $('close').onclick = async () => { await post('close'); $('status').textContent = 'troffer view has ended'; };
  window.onresize = layOut;
}

listen();
tick();
