// Pictures as floats: sums of layers, exposure, false colours, isolines.
'use strict';

// Parses a layer from the program: four 32-bit words, then floats, row by row from the top.
function layerOf(buffer) {
  const [width, height, channels, version] = new Uint32Array(buffer, 0, 4);
  return {width, height, channels, version, data: new Float32Array(buffer, 16)};
}

// Returns Σ factor × layer for layers of one size; factors are [r, g, b].
function sumOf(layers, factors) {
  const {width, height} = layers[0];
  const data = new Float32Array(width * height * 3);
  layers.forEach((layer, n) => {
    const [r, g, b] = factors[n];
    if (r === 0 && g === 0 && b === 0) return;
    const from = layer.data;
    for (let i = 0; i < data.length; i += 3) {
      data[i] += r * from[i];
      data[i + 1] += g * from[i + 1];
      data[i + 2] += b * from[i + 2];
    }
  });
  return {width, height, channels: 3, data};
}

const luminanceOf = (r, g, b) => 0.2126 * r + 0.7152 * g + 0.0722 * b;

// Returns the index of pixel (x, y), in a picture of the given size, in another layer.
function indexIn(layer, x, y, width, height) {
  const u = Math.min(layer.width - 1, Math.floor((x + 0.5) * layer.width / width));
  const v = Math.min(layer.height - 1, Math.floor((y + 0.5) * layer.height / height));
  return (v * layer.width + u) * layer.channels;
}

// Returns one number per pixel. luminance: cd/m². illuminance: π L / ρ by channel, exact for matte
// surfaces that do not emit; NaN where the reflectance is nearly 0. error: % of the luminance.
// scale: cd/m² per unit of the picture.
function valuesOf(kind, picture, albedo, error, scale) {
  const {width, height, data} = picture;
  const values = new Float32Array(width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const i = 3 * (y * width + x);
      const l = luminanceOf(data[i], data[i + 1], data[i + 2]);
      let v = l * scale;
      if (kind === 'illuminance') {
        v = NaN;
        if (albedo) {
          const a = indexIn(albedo, x, y, width, height), rho = albedo.data;
          if (luminanceOf(rho[a], rho[a + 1], rho[a + 2]) > 0.02)
            v = Math.PI * scale * luminanceOf(data[i] / Math.max(rho[a], 1e-3),
              data[i + 1] / Math.max(rho[a + 1], 1e-3), data[i + 2] / Math.max(rho[a + 2], 1e-3));
        }
      } else if (kind === 'error') {
        v = error && l > 0 ? 100 * error.data[indexIn(error, x, y, width, height)] / l : NaN;
      }
      values[i / 3] = v;
    }
  return {width, height, values};
}

// Returns a quantile of the finite values, estimated from a sample of them.
function quantile(values, share) {
  const some = [];
  const step = Math.max(1, Math.floor(values.length / 4000));
  for (let i = 0; i < values.length; i += step) if (Number.isFinite(values[i])) some.push(values[i]);
  if (!some.length) return 0;
  some.sort((a, b) => a - b);
  return some[Math.min(some.length - 1, Math.floor(share * some.length))];
}

// Rounds up to 1, 2 or 5 times a power of ten.
function roundUp(v) {
  if (!(v > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(v));
  return [1, 2, 5, 10].find((m) => m * power >= v * 0.999) * power;
}

// Returns the stops that bring the mean logarithm of luminance to mid-grey, without the darkest and
// brightest twentieth, as --exposure auto does.
function autoStops(picture) {
  const logs = [];
  const d = picture.data, step = 3 * Math.max(1, Math.floor(d.length / 60000));
  for (let i = 0; i + 2 < d.length; i += step) {
    const l = luminanceOf(d[i], d[i + 1], d[i + 2]);
    if (l > 0 && Number.isFinite(l)) logs.push(Math.log2(l));
  }
  if (!logs.length) return 0;
  logs.sort((a, b) => a - b);
  const cut = Math.floor(logs.length / 20), kept = logs.slice(cut, logs.length - cut || undefined);
  return Math.log2(0.18) - kept.reduce((a, b) => a + b, 0) / kept.length;
}

// Table of Hable's curve, as in the program, and the sRGB curve, over the square root of light.
const hable = (x) => (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
function displayTable(isFilmic) {
  const size = 4096, most = isFilmic ? 4 : 1, table = new Uint8Array(size + 1);
  for (let i = 0; i <= size; ++i) {
    const linear = most * (i / size) ** 2;
    const v = isFilmic ? Math.min(1, hable(2.9275228 * linear) / hable(11.2)) : linear;
    table[i] = Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055));
  }
  return (linear) => linear > 0 ? table[Math.min(size, Math.round(size * Math.sqrt(linear / most)))] : 0;
}
const displays = {true: displayTable(true), false: displayTable(false)};

function drawPicture(picture, stops, isFilmic, pixels, from, to) {
  const gain = 2 ** stops, display = displays[isFilmic], {width, height, data} = picture;
  for (let y = 0; y < height; ++y)
    for (let x = from; x < to; ++x) {
      const i = y * width + x;
      for (let c = 0; c < 3; ++c) pixels[4 * i + c] = display(gain * data[3 * i + c]);
      pixels[4 * i + 3] = 255;
    }
}

// Palette of reports. Its lightness (CIE L*) rises evenly, so that equal steps of value look equal.
const colourNodes = [[38, 20, 84], [52, 70, 140], [36, 117, 142], [42, 157, 120], [122, 192, 74], [214, 214, 40],
  [252, 246, 178]];
const colours = Array.from({length: 257}, (_, n) => {
  const at = n / 256 * (colourNodes.length - 1), k = Math.min(Math.floor(at), colourNodes.length - 2);
  return [0, 1, 2].map((c) => Math.round(colourNodes[k][c] + (at - k) * (colourNodes[k + 1][c] - colourNodes[k][c])));
});
// Scale from 0 to `most`, or over three decades below it.
function positionOf(value, most, isLog) {
  return isLog ? 1 + Math.log10(Math.max(value, 1e-30) / most) / 3 : value / most;
}

function drawValues(map, most, isLog, pixels, from, to) {
  for (let y = 0; y < map.height; ++y)
    for (let x = from; x < to; ++x) {
      const i = y * map.width + x, v = map.values[i];
      const t = positionOf(v, most, isLog);
      const colour = !Number.isFinite(v) ? [70, 70, 70] : t > 1.0001 ? [255, 255, 255]
        : colours[Math.round(256 * Math.max(0, t))];
      pixels.set(colour, 4 * i);
      pixels[4 * i + 3] = 255;
    }
}

function drawLegend(canvas, most, isLog, unit) {
  const g = canvas.getContext('2d'), {width} = canvas, bar = width - 40;
  g.clearRect(0, 0, width, canvas.height);
  for (let x = 0; x < bar; ++x) {
    g.fillStyle = `rgb(${colours[Math.round(256 * x / (bar - 1))]})`;
    g.fillRect(20 + x, 2, 1, 16);
  }
  g.fillStyle = '#e4e6ea';
  g.font = '11px system-ui, "DejaVu Sans", sans-serif';
  g.textAlign = 'center';
  // `most` is 1, 2 or 5 times a power of ten unless the user chose it, so its fifths or quarters
  // are round.
  const parts = isLog ? 3 : Number(most.toPrecision(1)) / 10 ** Math.floor(Math.log10(most)) === 2 ? 4 : 5;
  for (let k = 0; k <= parts; ++k) {
    const v = isLog ? most * 10 ** (k - 3) : most * k / parts;
    g.fillText(`${Number(v.toPrecision(3))}`, 20 + bar * k / parts, 31);
  }
  g.fillText(unit, width / 2, 43);
}

// Returns means over blocks, so that isolines follow the light and not the noise.
function smoothed(map, block) {
  const width = Math.floor(map.width / block), height = Math.floor(map.height / block);
  const values = new Float32Array(width * height);
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      let sum = 0, n = 0;
      for (let b = 0; b < block; ++b)
        for (let a = 0; a < block; ++a) {
          const v = map.values[(y * block + b) * map.width + x * block + a];
          if (Number.isFinite(v)) { sum += v; ++n; }
        }
      values[y * width + x] = n ? sum / n : NaN;
    }
  return {width, height, values};
}

// Returns segments [x0, y0, x1, y1] between the middles of a map's pixels, by marching squares.
function linesAt(map, level) {
  const {width, height, values} = map, segments = [];
  for (let y = 0; y + 1 < height; ++y)
    for (let x = 0; x + 1 < width; ++x) {
      const i = y * width + x;
      const corners = [values[i], values[i + 1], values[i + width + 1], values[i + width]];
      if (!corners.every(Number.isFinite)) continue;
      const at = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]], crossings = [];
      for (let e = 0; e < 4; ++e) {
        const a = corners[e], b = corners[(e + 1) % 4];
        if ((a < level) === (b < level)) continue;
        const t = (level - a) / (b - a), [p, q] = [at[e], at[(e + 1) % 4]];
        crossings.push([p[0] + t * (q[0] - p[0]) + 0.5, p[1] + t * (q[1] - p[1]) + 0.5]);
      }
      for (let k = 0; k + 1 < crossings.length; k += 2)
        segments.push([...crossings[k], ...crossings[k + 1]]);
    }
  return segments;
}
