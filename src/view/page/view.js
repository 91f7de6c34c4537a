// Main script of the page: fetches layers as they are refined, shows them, and sends what users do.
'use strict';

const $ = (id) => document.getElementById(id);
const app = {
  state: null, camera: null, layers: {}, pictureShown: null, isSending: false, isMovePending: false,
  movedAt: 0, dimmers: [], isFirst: true, drag: null, pinch: null, pointed: null, failures: 0, scales: {},
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

// Returns colour times setting of every luminaire.
const factors = () => app.dimmers.map((d) => d.isOn ? d.colour.map((c) => c * d.level) : [0, 0, 0]);
const areDimmed = () => factors().some((f) => f.some((v) => v !== 1));
const measurements = new Measurements(post, getJson, factors, () => { drawMeasured(); drawOverlay(); });

// Returns the picture as the dimmers are set; null if unknown. The sum of the dimmers' own layers
// is finer than the layer "dimmed", which arrives sooner after a move.
function currentPicture() {
  const {whole, dimmed} = app.layers;
  if (!areDimmed()) return whole ?? null;
  if (app.dimmers.length === 1) return whole ? sumOf([whole], factors()) : null;
  const views = app.state.layers, all = app.dimmers.map((_, i) => app.layers[`dimmer${i}`]);
  const first = all[0];
  const isThere = all.every((l, i) => l && l.width === first.width && l.height === first.height &&
    views[`dimmer${i}`]?.view === views.dimmer0.view);
  if (isThere && !(views.dimmed?.view > views.dimmer0.view)) return sumOf(all, factors());
  return dimmed ?? null;
}

// True if a layer belongs to the current view. The first pictures after a move have no albedo and
// error layers, and those of another view would give wrong figures.
const isOfView = (name) => app.state.layers[name]?.view === app.state.view;

const scaleOf = () => (app.state.is_photometric ? 1 : 179);
const unitOf = (kind) => ({illuminance: 'lx', luminance: 'cd/m²', error: '%'})[kind];

function drawSide(picture, kind, pixels, from, to) {
  const lacks = {illuminance: 'albedo', error: 'error'}[kind];
  if (kind === 'picture' || (lacks && !isOfView(lacks))) {
    drawPicture(picture, Number($('stops').value), $('filmic').checked, pixels, from, to);
    return null;
  }
  const map = valuesOf(kind, picture, app.layers.albedo, app.layers.error, scaleOf());
  const most = mostOf(kind, map);
  drawValues(map, most, $('log').checked, pixels, from, to);
  return {map, most, kind};
}

// Returns the upper end of the scale: the user's, or a round value that 2 % of the pixels exceed
// while all luminaires are on. It stays until the user asks for a new one, so that a dimmed room
// looks dimmer.
function mostOf(kind, map) {
  const asked = Number($('most').value);
  if (kind === $('show').value && asked > 0) return asked;
  const kept = app.scales[kind];
  if (kept && kept.isFine) return kept.most;
  const isWhole = !areDimmed() || kind === 'error';
  const source = isWhole ? map : valuesOf(kind, app.layers.whole, app.layers.albedo, null, scaleOf());
  const most = roundUp(quantile(source.values, 0.98));
  app.scales[kind] = {most, isFine: app.state.layers.whole?.error > 0};
  return most;
}

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
    const side = second && drawSide(second, isError ? 'error' : kind, image.data, split, width);
    app.besideText = isError ? (side ? `estimated error, up to ${side.most} %` : 'estimated error: not known yet')
      : second ? `method ${beside}` : `method ${beside}: not ready yet`;
  }
  g.putImageData(image, 0, 0);
  if (app.map) drawLegend($('legend'), app.map.most, $('log').checked, unitOf(kind));
  $('scale-note').textContent = kind !== 'picture' && !app.map ? 'Values appear when the picture has been refined.' : '';
  drawOverlay();
}

// Resizes an image by nearest pixels.
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

// Fits the canvases into the stage, with the picture's aspect ratio.
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
  const toScreen = (p) => {
    const at = app.camera.project(p.slice(0, 3), aspect);
    return at && [at[0] * canvas.width, at[1] * canvas.height];
  };
  const labels = new LabelBoard(g);
  const depthOf = (p) => dot(add(p, app.camera.eye, -1), app.camera.forward);
  year.draw(g, toScreen, depthOf, labels, app.pointed);
  measurements.draw(g, toScreen, labels, app.pointed);
  if ($('lines').checked && app.map) drawLines(g, canvas, labels);
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
  if (app.drag?.tool === 'grid' && app.drag.to) {
    const [a, b] = [app.drag.from, app.drag.to];
    g.strokeStyle = '#ffd166';
    g.lineWidth = 1.5;
    g.strokeRect(a[0] * canvas.width, a[1] * canvas.height, (b[0] - a[0]) * canvas.width,
      (b[1] - a[1]) * canvas.height);
  }
}

// Places a line's label at the free spot nearest to the middle of its segments.
function drawLines(g, canvas, labels) {
  const block = Math.max(1, Math.round(app.map.map.width / 160)), map = smoothed(app.map.map, block);
  const [sx, sy] = [block * canvas.width / app.map.map.width, block * canvas.height / app.map.map.height];
  app.lines = {};
  // Only the part left of the split shows this map.
  g.save();
  g.beginPath();
  g.rect(0, 0, $('beside').value ? canvas.width * $('split-at').value / 1000 : canvas.width, canvas.height);
  g.clip();
  for (const level of levelsOf($('levels').value, app.map.most)) {
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
    const middle = Math.floor(segments.length / 2);
    g.strokeStyle = '#000';
    g.lineWidth = 3;
    for (let k = 0; k < segments.length; ++k) {
      const n = (middle + (k % 2 ? -(k + 1) / 2 : k / 2) + segments.length) % segments.length;
      if (labels.place(`${level}`, segments[n][0] * sx, segments[n][1] * sy + 4, '#fff')) break;
    }
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
    gone.setAttribute('aria-label', `Remove ${item.label}`);
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

// Fetches the layers that have changed. Returns true if any has.
async function fetchLayers(state) {
  const wanted = ['whole', 'albedo', 'error'];
  if ($('beside').value && $('beside').value !== 'error') wanted.push('second');
  if (areDimmed()) wanted.push('dimmed', ...state.dimmers.map((_, i) => `dimmer${i}`));
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

function showStatus(state) {
  const error = state.layers.whole?.error;
  const parts = [state.failure ? `There is no picture: ${state.failure}` : state.stage === 'done' ? 'Finished' : state.stage];
  if (state.progress > 0 && state.progress < 1) parts.push(`${Math.round(100 * state.progress)} %`);
  if (error > 0 && !areDimmed()) parts.push(`estimated error ${(100 * error).toPrecision(2)} %`);
  $('status').textContent = parts.join(' · ');
  $('dimmers-note').textContent = areDimmed() && app.dimmers.length > 1 && !currentPicture()
    ? 'The picture with these settings is being rendered.' : '';
}

// Reports that the program has ended and how to start it again, and disables all controls.
function showEnd() {
  app.hasEnded = true;
  const file = app.state?.file ?? 'SCENE';
  $('status').textContent = 'troffer view has ended.';
  $('again').textContent = `troffer view ${/[^\w./-]/.test(file) ? `'${file}'` : file}`;
  $('ended').hidden = false;
  document.querySelector('aside').inert = true;
  $('overlay').inert = true;
  document.body.classList.add('has-ended');
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
    if (year.about && year.seenOf !== state.view && isOfView('whole')) await year.look(state.view);
    showStatus(state);
    if (state.stage !== 'done') wait = Math.min(wait, 250);
    if (state.seconds_to_first === 0 || performance.now() - app.movedAt < 1500) wait = 25;
    app.failures = 0;
  } catch (error) {
    if (++app.failures > 2) showEnd();
    else $('status').textContent = String(error.message);
  }
  if (!app.hasEnded) setTimeout(tick, wait);
}

// Only one message is sent at a time; the newest camera follows it.
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

async function sendExtras() {
  const beside = $('beside').value;
  app.movedAt = performance.now();
  await post('extras', {dimmers: app.dimmers.length > 1 ? dimmersText() : '', second: beside === 'error' ? '' : beside});
}

function begin(state) {
  document.title = `${state.file.split('/').pop()} – troffer view`;
  $('file').textContent = state.file.split('/').pop();
  $('file').title = state.file;
  $('notice').textContent = state.notice;
  $('notice').hidden = !state.notice;
  app.home = state.camera;
  app.camera = new RoomCamera(state.camera, state.up, state.bounds);
  const cameras = state.cameras.length ? state.cameras : [state.camera];
  $('camera').replaceChildren(...cameras.map((c, i) => new Option(c.name || `camera ${i + 1}`, i)));
  $('camera').onchange = () => {
    const index = Number($('camera').value);
    app.camera = new RoomCamera(cameras[index], state.up, state.bounds);
    sendCamera(state.cameras.length ? {index} : {});
  };
  makeDimmers(state);
  makeTime(state);
  makeYear(state);
  updateLinks();
}

function listen() {
  listenToPointers();
  listenToYear();
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
  $('fit').onclick = () => { $('most').value = ''; app.scales = {}; draw(); };
  $('beside').onchange = async () => {
    $('split-at').hidden = !$('beside').value;
    try { await sendExtras(); } catch (error) { say(error.message); }
    draw();
  };
  $('split-at').oninput = draw;
  $('close').onclick = async () => { await post('close'); showEnd(); };
  window.onresize = layOut;
}
