// Measures points and grids: requests them, polls for values, and shows them for the settings of
// the luminaires.
'use strict';

class Measurements {
  // ask(path, body) posts; get(path) reads; changed() redraws.
  constructor(ask, get, factors, changed) {
    Object.assign(this, {ask, get, factors, changed});
    this.all = [];
  }
  async pick(x, y) { await this.begin({kind: 'point'}, 'pick', {x, y}); }
  async grid(a, b, along, above) {
    await this.begin({kind: 'grid'}, 'grid', {x0: a[0], y0: a[1], x1: b[0], y1: b[1], along, above});
  }
  async begin(item, path, body) {
    const answer = await this.ask(path, body);
    // `rows` holds values by luminaires from here on.
    Object.assign(item, answer, {rows: null});
    item.label = item.kind === 'grid' ? `grid ${answer.columns} × ${answer.rows}` : answer.name || 'point';
    this.all.push(item);
    this.changed();
  }
  // Fetches available values. Returns true while some are missing.
  async poll() {
    let isWaiting = false;
    for (const item of this.all) {
      if (item.rows) continue;
      const answer = await this.get(`measured?number=${item.number}`);
      if (answer.is_done) {
        item.rows = answer.values;
        item.failure = answer.failure;
        this.changed();
      } else {
        isWaiting = true;
      }
    }
    return isWaiting;
  }
  // Measures all points again, by single luminaires or under another light.
  async again(which = () => true) {
    for (const item of this.all.filter(which)) {
      const {number} = await this.ask('measure', {number: item.number});
      Object.assign(item, {number, rows: null});
    }
    this.changed();
  }
  needsDimmers(count) { return this.all.some((m) => m.rows && m.rows.length !== count); }

  // Returns [lx, standard error] of every point; null if unknown.
  values(item) {
    if (!item.rows || !item.rows.length) return null;
    const factors = this.factors(), isWhole = item.rows.length !== factors.length;
    if (isWhole && factors.some((f) => f.some((v) => v !== 1))) return null;
    return item.rows[0].map((_, p) => {
      let lx = 0, variance = 0;
      item.rows.forEach((row, n) => {
        const [value, error, r, g, b] = row[p], f = isWhole ? [1, 1, 1] : factors[n];
        const all = luminanceOf(r, g, b);
        const share = all > 0 ? luminanceOf(f[0] * r, f[1] * g, f[2] * b) / all : 0;
        lx += share * value;
        variance += (share * error) ** 2;
      });
      return [lx, Math.sqrt(variance)];
    });
  }
  remove(item) {
    this.all = this.all.filter((m) => m !== item);
    this.changed();
  }
  text(item) {
    if (item.failure) return item.failure;
    const values = this.values(item);
    if (!values) return 'measuring …';
    const lx = values.map((v) => v[0]), mean = lx.reduce((a, b) => a + b, 0) / lx.length;
    if (item.kind === 'point') return `${lxText(lx[0])} ± ${values[0][1].toPrecision(2)} lx`;
    const least = Math.min(...lx);
    return `mean ${lxText(mean)} lx, minimum ${lxText(least)}, uniformity ${(mean > 0 ? least / mean : 0).toFixed(2)}`;
  }
  // Draws marks at all points, and as many values as fit. The value nearest to the pointer (shares
  // of the canvas) is placed first, so that every value of a dense grid can be read.
  draw(g, toScreen, labels, pointed) {
    const marks = [];
    for (const item of this.all) {
      const values = this.values(item);
      item.points.forEach((point, i) => {
        const at = toScreen(point);
        if (!at) return;
        const isPoint = item.kind === 'point';
        marks.push({at, isPoint, text: !values ? '' :
          lxText(values[i][0]) + (isPoint ? ` ± ${values[i][1].toPrecision(2)} lx` : '')});
        g.fillStyle = '#ffd166';
        g.strokeStyle = '#000';
        g.lineWidth = 2;
        g.beginPath();
        g.arc(at[0], at[1], isPoint ? 4 : 2, 0, 7);
        g.stroke();
        g.fill();
      });
    }
    const reach = 14, away = (m) => Math.hypot(m.at[0] - pointed[0] * g.canvas.width, m.at[1] - pointed[1] * g.canvas.height);
    const rank = (m) => (pointed && away(m) < reach ? 0 : m.isPoint ? 1 : 2);
    g.strokeStyle = '#000';
    g.lineWidth = 3;
    marks.sort((a, b) => rank(a) - rank(b));
    this.shown = marks.filter((m) => m.text && labels.place(m.text, m.at[0], m.at[1] - 6, '#ffd166')).length;
  }
}

const lxText = (lx) => (lx >= 100 ? lx.toFixed(0) : lx.toPrecision(3));
