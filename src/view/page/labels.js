// Places text over the picture without overlaps, and chooses the levels of isolines.
'use strict';

// Places labels one by one. A label that would cover an earlier one is left out.
class LabelBoard {
  constructor(g) {
    this.g = g;
    this.boxes = [];
    g.font = '11px system-ui, "DejaVu Sans", sans-serif';
    g.textAlign = 'center';
    g.strokeStyle = '#000';
    g.lineWidth = 3;
    g.lineJoin = 'round';
  }
  // Draws a label centred at x with its baseline at y. Returns false if there is no room.
  place(text, x, y, colour) {
    const half = this.g.measureText(text).width / 2 + 3;
    const box = [x - half, y - 11, x + half, y + 4];
    const {width, height} = this.g.canvas;
    if (box[0] < 0 || box[2] > width || box[1] < 0 || box[3] > height) return false;
    if (this.boxes.some((b) => box[0] < b[2] && b[0] < box[2] && box[1] < b[3] && b[1] < box[3])) return false;
    this.boxes.push(box);
    this.g.fillStyle = colour;
    this.g.strokeText(text, x, y);
    this.g.fillText(text, x, y);
    return true;
  }
}

// Returns levels of isolines on a scale from 0 to `most`: 1, 2, 3, 5 and 7.5 times powers of ten
// within its last decade. Lighting requirements use these steps.
function levelsUpTo(most) {
  const power = 10 ** Math.floor(Math.log10(most) + 1e-9), levels = [];
  for (const decade of [power / 10, power])
    for (const m of [1, 2, 3, 5, 7.5]) levels.push(m * decade);
  return levels.filter((v) => v >= 0.0999 * most && v <= 1.0001 * most).map((v) => +v.toPrecision(3));
}

// Returns the user's levels, or suitable ones for the scale if the field is empty.
function levelsOf(text, most) {
  const levels = text.split(/[,;\s]+/).map(Number).filter((v) => v > 0);
  return levels.length ? levels : levelsUpTo(most);
}
