// A year of daylight: the sensors of a calculation by `troffer annual`, in false colours at an hour
// of the year. The program looks up every value; nothing is calculated here.
'use strict';

const twoDigits = (v) => String(v).padStart(2, '0');
const monthNames = ['January', 'February', 'March', 'April', 'May', 'June', 'July', 'August', 'September', 'October',
  'November', 'December'];

class YearOfDaylight {
  // get(path): JSON. numbers(path): a buffer. changed(): redraws the picture's marks.
  constructor(get, numbers, changed) {
    Object.assign(this, {get, numbers, changed});
    this.eyes = new YearEyes(this);
    this.about = null;  // description by the program
    this.values = null;  // of all sensors in the hour shown, lx
    this.kept = new Map();  // values of hours by request
    this.seen = null;  // per sensor: 1 if the view shows it
    this.chosen = null;  // {index, values, errors}: the sensor clicked, once its year is there
    this.wanted = null;  // index of the sensor clicked last
    this.choices = 0;
    this.day = this.step = 0;
    this.isAsking = this.isAskPending = false;
  }

  async begin() {
    const about = await this.get('year'), places = new Float64Array(await this.numbers('year/points'));
    this.sensors = Array.from({length: about.sensors}, (_, i) => ({
      position: [...places.subarray(6 * i, 6 * i + 3)], normal: [...places.subarray(6 * i + 3, 6 * i + 6)]}));
    for (const grid of about.grids) this.layTiles(this.sensors.slice(grid.first, grid.first + grid.count));
    this.stepsOfDay = 24 * about.steps_per_hour;
    this.days = about.has_leap_day ? 366 : 365;
    // Index of each step's hour among the hours with the sun up.
    this.hourOfStep = new Map(about.hours.map((h, i) => [Math.round(h * about.steps_per_hour - 0.5), i]));
    this.states = about.groups.map(() => -1);
    await this.eyes.begin(about, this.numbers);
    this.about = about;
    // The first view is noon on 21 March, or the first hour of a shorter period.
    const first = Math.floor(about.hours[0] * about.steps_per_hour);
    const noon = (this.dayOf(3, 21) + 0.5) * this.stepsOfDay;
    this.go(this.hourOfStep.has(noon) ? noon : first);
  }
  // Gives sensors of a grid tiles: squares as wide as the distance to the nearest neighbour.
  layTiles(sensors) {
    const some = sensors.filter((_, i) => i % Math.ceil(sensors.length / 100) === 0), steps = [];
    for (const s of some) {
      let nearest = null, least = Infinity;
      for (const other of sensors) {
        const step = add(other.position, s.position, -1), distance = lengthOf(step);
        if (other !== s && distance > 1e-6 && distance < least) [nearest, least] = [step, distance];
      }
      if (nearest) steps.push(nearest);
    }
    steps.sort((a, b) => lengthOf(a) - lengthOf(b));
    const step = steps[Math.floor(steps.length / 2)];
    for (const s of sensors) {
      const level = step && add(step, s.normal, -dot(step, s.normal));
      if (!step || lengthOf(level) < 0.5 * lengthOf(step)) continue;  // no plane: a dot
      const u = scaled(unit(level), 0.47 * lengthOf(step)), v = scaled(cross(unit(s.normal), unit(u)), lengthOf(u));
      s.tile = [[1, 1], [1, -1], [-1, -1], [-1, 1]].map(([a, b]) => add(add(s.position, u, a), v, b));
    }
  }

  // Times. A step of the year is a step of the weather file; it stands for its middle.
  get yearStep() { return this.day * this.stepsOfDay + this.step; }
  get hour() { return this.hourOfStep.get(this.yearStep); }  // undefined: the sun is down
  get anyYear() { return this.days === 366 ? 2016 : 2015; }
  dayOf(month, day) { return Math.round((Date.UTC(this.anyYear, month - 1, day) - Date.UTC(this.anyYear, 0, 1)) / 864e5); }
  dateOf(day) { return new Date(Date.UTC(this.anyYear, 0, 1 + day)); }
  clockOf(step) {
    const minutes = Math.round((step + 0.5) * 1440 / this.stepsOfDay);
    return `${twoDigits(Math.floor(minutes / 60))}:${twoDigits(minutes % 60)}`;
  }
  get when() {
    const date = this.dateOf(this.day);
    return `${date.getUTCDate()} ${monthNames[date.getUTCMonth()]}, ${this.clockOf(this.step)}`;
  }
  // Goes to a step of the year; the last one is followed by the first.
  go(step) {
    const all = this.days * this.stepsOfDay, at = ((step % all) + all) % all;
    [this.day, this.step] = [Math.floor(at / this.stepsOfDay), at % this.stepsOfDay];
    this.update();
  }
  // Returns the next step with the sun up on the same day, or its first one.
  nextLightStep() {
    const from = this.day * this.stepsOfDay;
    for (let k = 1; k <= this.stepsOfDay; ++k) {
      const step = from + (this.step + k) % this.stepsOfDay;
      if (this.hourOfStep.has(step)) return step;
    }
    return this.yearStep;
  }

  // Part of a request that selects light and states.
  get asked() { return `part=${this.part}&states=${this.states.join(',')}`; }
  get part() { return $('year-part').value; }
  stateOf(group, hour) { return this.states[group] >= 0 ? this.states[group] : this.about.groups[group].schedule[hour]; }

  // Fetches the values of the hour. Only one request runs at a time; the newest hour follows it.
  async update() {
    this.isAskPending = true;
    this.changed();
    if (this.isAsking) return;
    this.isAsking = true;
    try {
      while (this.isAskPending) {
        this.isAskPending = false;
        this.values = await this.valuesNow();
        this.failure = '';
        this.changed();
      }
    } catch (error) {
      this.values = null;
      this.failure = error.message;
      this.changed();
    } finally {
      this.isAsking = false;
    }
  }
  async valuesNow() {
    const {hour} = this;
    if (hour === undefined) return new Float32Array(this.about.sensors);
    const key = `year/hour?number=${hour}&${this.asked}`;
    if (!this.kept.has(key)) {
      if (this.kept.size * this.about.sensors > 5e6) this.kept.clear();  // 20 MB
      this.kept.set(key, new Float32Array(await this.numbers(key)));
    }
    return this.kept.get(key);
  }
  // Fetches the year of a sensor. Answers may arrive late: only that of the last choice counts.
  async choose(index) {
    const choice = ++this.choices;
    this.wanted = index;
    let chosen = null;
    if (index !== null) {
      const all = new Float32Array(await this.numbers(`year/sensor?number=${index}&${this.asked}`));
      const count = this.about.hours.length;
      chosen = {index, values: all.subarray(0, count), errors: all.length > count ? all.subarray(count) : null};
    }
    if (choice !== this.choices) return;
    this.chosen = chosen;
    this.changed();
  }
  // A sensor that stays chosen gets the year of other states.
  async changeAsked() {
    this.update();
    if (this.wanted !== null) await this.choose(this.wanted);
  }
  async look(view) {
    this.seenOf = view;
    this.seen = new Uint8Array(await this.numbers('year/seen'));
    this.changed();
  }

  // Figures of the hour over all sensors.
  statistics() {
    const known = [...this.values ?? []].filter(Number.isFinite);
    if (!known.length) return null;
    const sum = known.reduce((a, b) => a + b, 0);
    return {mean: sum / known.length, least: known.reduce((a, b) => Math.min(a, b)),
      most: known.reduce((a, b) => Math.max(a, b)), share: known.filter((v) => v >= 300).length / known.length};
  }
  colourOf(lx, most, isLog) {
    const t = positionOf(lx, most, isLog);
    return !Number.isFinite(lx) ? [70, 70, 70] : t > 1.0001 ? [255, 255, 255] : colours[Math.round(256 * Math.max(0, t))];
  }
  get isShown() { return this.about !== null && $('year-on').checked; }

  // Draws the sensors that the view shows, far ones first. Labels go to the sensor under the pointer
  // and the chosen one, and to as many others as fit if asked for.
  draw(g, toScreen, depthOf, labels, pointed) {
    this.marks = [];
    if (!this.isShown || !this.values) return;
    const most = mostOfYear(), isLog = $('year-log').checked, isThrough = $('year-through').checked;
    this.sensors.forEach((s, index) => {
      if (!isThrough && this.seen && !this.seen[index]) return;
      const at = toScreen(s.position);
      if (at) this.marks.push({at, index, depth: depthOf(s.position)});
    });
    this.marks.sort((a, b) => b.depth - a.depth);
    for (const {at, index} of this.marks) {
      const corners = this.sensors[index].tile?.map(toScreen);
      g.fillStyle = `rgb(${this.colourOf(this.values[index], most, isLog)})`;
      g.beginPath();
      if (corners?.every((c) => c)) corners.forEach((c) => g.lineTo(...c));
      else g.arc(at[0], at[1], 5, 0, 7);
      g.closePath();
      g.globalAlpha = 0.88;
      g.fill();
      g.globalAlpha = 1;
    }
    this.eyes.draw(g, toScreen, labels);
    this.label(g, labels, pointed);
  }
  label(g, labels, pointed) {
    const under = pointed && this.nearest(pointed, g.canvas), mine = this.marks.find((m) => m.index === this.chosen?.index);
    if (mine) {
      g.strokeStyle = '#fff';
      g.lineWidth = 2;
      g.beginPath();
      g.arc(mine.at[0], mine.at[1], 8, 0, 7);
      g.stroke();
    }
    g.strokeStyle = '#000';
    g.lineWidth = 3;
    const wanted = [under, mine].filter((m) => m);
    if ($('year-values').checked) wanted.push(...this.marks);
    for (const m of wanted) labels.place(yearLx(this.values[m.index]), m.at[0], m.at[1] + 4, '#fff');
  }
  // Returns the nearest mark within reach, in pixels, of a place, given as shares of the canvas.
  nearest([x, y], canvas, reach = 24) {
    let best = null, least = reach;
    for (const m of this.marks ?? []) {
      const distance = Math.hypot(m.at[0] - x * canvas.width, m.at[1] - y * canvas.height);
      if (distance <= least) [best, least] = [m, distance];
    }
    return best;
  }
  async pick(place, canvas) {
    if (!this.isShown) return;
    const mark = this.nearest(place, canvas);
    await this.choose(mark ? mark.index : null);
  }
}

const yearLx = (lx) => (lx >= 10 ? lx.toFixed(0) : lx > 0 ? lx.toPrecision(2) : '0');
// Upper end of the scale, lx. It stays when the hour changes.
function mostOfYear() {
  const asked = Number($('year-most').value);
  return asked > 0 ? asked : 1;
}
