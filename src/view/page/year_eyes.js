// Eyes of the year: their Daylight Glare Probability (DGP) at the hour shown, in the picture and as a
// list. DGPs belong to the windows as they were operated, so other states of windows have none.
'use strict';

// EN 17037: upper limits of the DGP, and what it is called below them.
const glareLevels = [[0.35, 'imperceptible', '#3fb950'], [0.40, 'perceptible', '#e3c341'], [0.45, 'disturbing', '#f0883e'],
  [Infinity, 'intolerable', '#f85149']];
const glareLevelOf = (dgp) => glareLevels.find(([limit]) => dgp <= limit);

class YearEyes {
  constructor(year) { this.year = year; this.all = []; }

  async begin(about, numbers) {
    if (!about.eyes.length) return;
    const glare = new Float32Array(await numbers('year/glare')), count = about.hours.length;
    this.all = about.eyes.map((eye, k) => ({...eye, dgp: glare.subarray(2 * k * count, (2 * k + 1) * count),
      lx: glare.subarray((2 * k + 1) * count, (2 * k + 2) * count)}));
  }
  get isKnown() { return this.year.hour !== undefined && this.year.states.every((s) => s < 0); }
  // Returns {dgp, lx, level, colour} of an eye at the hour shown, or null.
  glareOf(eye) {
    if (!this.isKnown) return null;
    const dgp = eye.dgp[this.year.hour], [, level, colour] = glareLevelOf(dgp);
    return {dgp, lx: eye.lx[this.year.hour], level, colour};
  }

  // Draws each eye as a disc with its number, and an arrow of 0.5 m along its line of sight.
  draw(g, toScreen, labels) {
    if (!this.year.isShown) return;
    this.all.forEach((eye, k) => {
      const at = toScreen(eye.position), ahead = toScreen(add(eye.position, eye.direction, 0.5)), glare = this.glareOf(eye);
      if (!at) return;
      const colour = glare ? glare.colour : '#9aa0a8';
      for (const [style, width] of [['#000', 5], [colour, 3]]) {
        g.strokeStyle = style;
        g.lineWidth = width;
        if (ahead) this.arrow(g, at, ahead);
      }
      g.strokeStyle = '#000';
      g.lineWidth = 1;
      g.fillStyle = colour;
      g.beginPath();
      g.arc(...at, 9, 0, 7);
      g.fill();
      g.stroke();
      g.fillStyle = '#000';
      g.fillText(`${k + 1}`, at[0], at[1] + 4);
      g.lineWidth = 3;
      if (glare) labels.place(`DGP ${glare.dgp.toFixed(2)}`, at[0], at[1] - 14, glare.colour);
    });
  }
  arrow(g, [x0, y0], [x1, y1]) {
    const length = Math.hypot(x1 - x0, y1 - y0);
    if (length < 12) return;  // looks along the line of sight of the picture
    const u = (x1 - x0) / length, v = (y1 - y0) / length;
    g.beginPath();
    g.moveTo(x0, y0);
    g.lineTo(x1, y1);
    g.moveTo(x1 - 7 * u + 4 * v, y1 - 7 * v - 4 * u);
    g.lineTo(x1, y1);
    g.lineTo(x1 - 7 * u - 4 * v, y1 - 7 * v + 4 * u);
    g.stroke();
  }

  // Lists the eyes with their glare.
  show(list) {
    list.hidden = !this.all.length;
    list.replaceChildren(...this.all.map((eye, k) => {
      const row = document.createElement('div'), name = document.createElement('span'), value = document.createElement('span');
      const glare = this.glareOf(eye);
      row.className = 'result';
      name.textContent = `eye ${k + 1}`;
      name.title = `at ${eye.position.map((v) => Number(v.toFixed(2))).join(', ')}`;
      value.textContent = glare ? `DGP ${glare.dgp.toFixed(2)}, ${glare.level}, ${yearLx(glare.lx)} lx`
        : this.year.hour === undefined ? 'no daylight' : 'known by schedule only';
      if (glare) value.style.color = glare.colour;
      row.append(name, value);
      return row;
    }));
  }
}
