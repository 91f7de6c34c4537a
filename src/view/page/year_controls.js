// Controls of the year of daylight: date and hour, states of window groups, scale, play.
'use strict';

const year = new YearOfDaylight(getJson, async (path) => (await request(path)).arrayBuffer(),
  () => { showYear(); drawOverlay(); });
window.year = year;

const yearScales = {total: 2000, direct: 20000};  // lx

async function makeYear(state) {
  if (!state.has_year) return;
  $('year-section').hidden = false;
  try {
    await year.begin();
  } catch (error) {
    $('year-note').textContent = error.message;
    $('year-note').hidden = false;
    return;
  }
  const {about} = year, notes = $('year-note');
  notes.textContent = about.notes.map((n) => `${n[0].toUpperCase()}${n.slice(1)}.`).join(' ');
  notes.hidden = !notes.textContent;
  $('year-place').textContent = `${about.sensors} sensors${about.place ? `, weather of ${about.place}` : ''}`;
  $('year-day').max = year.days - 1;
  $('year-step').max = year.stepsOfDay - 1;
  $('year-follow-row').hidden = !state.has_time;
  $('year-groups').replaceChildren(...about.groups.map((group, g) => {
    const row = document.createElement('label'), name = document.createElement('span'), list = document.createElement('select');
    row.className = 'group';
    name.textContent = name.title = group.name;
    list.setAttribute('aria-label', `State of ${group.name}`);
    list.append(new Option('schedule', -1), ...group.states.map((s, k) => new Option(s, k)));
    list.onchange = () => {
      year.states[g] = Number(list.value);
      year.changeAsked().catch((error) => say(error.message));
    };
    row.append(name, list);
    return row;
  }));
  showYear();
}

// Shows date, state of windows, figures and charts of the hour.
function showYear() {
  const {about} = year;
  if (!about) return;
  const {hour} = year, isDark = hour === undefined;
  $('year-when').textContent = year.when;
  $('year-day').value = year.day;
  $('year-step').value = year.step;
  about.groups.forEach((group, g) => {
    const option = $('year-groups').children[g]?.lastChild.options[0];
    if (option) option.textContent = isDark ? 'schedule' : `${group.states[group.schedule[hour]]} (schedule)`;
  });
  const s = year.statistics(), isHidden = year.isShown && year.seen && !$('year-through').checked && !year.seen.some((v) => v);
  $('year-figures').textContent = year.failure ? year.failure : isDark ? 'No daylight at this hour.' : !s ? 'Loading …'
    : `mean ${yearLx(s.mean)} lx, minimum ${yearLx(s.least)}, maximum ${yearLx(s.most)}; ${Math.round(100 * s.share)} % of sensors from 300 lx on`;
  $('year-hidden').hidden = !isHidden;
  year.eyes.show($('year-eyes'));
  drawLegend($('year-legend'), mostOfYear(), $('year-log').checked, 'lx');
  showSensor();
}

function showSensor() {
  const {chosen, hour} = year;
  $('year-sensor').hidden = !chosen;
  $('year-click').hidden = Boolean(chosen);
  if (!chosen) return;
  const grid = year.about.grids.find((g) => chosen.index < g.first + g.count);
  const at = year.sensors[chosen.index].position.map((v) => Number(v.toFixed(2))).join(', ');
  const lx = hour === undefined ? 0 : chosen.values[hour], error = hour === undefined ? 0 : chosen.errors?.[hour];
  $('year-sensor-name').textContent = `${grid.name}, sensor ${chosen.index - grid.first + 1} at ${at}`;
  $('year-sensor-value').textContent = `${yearLx(lx)}${error > 0 ? ` ± ${error.toPrecision(2)}` : ''} lx`;
  drawDay($('year-chart'), year);
  drawCarpet($('year-carpet'), year, mostOfYear(), $('year-log').checked);
}

// Plays the hours with daylight of one day, over and over.
function playDay() {
  clearInterval(year.timer);
  year.isPlaying = !year.isPlaying;
  $('year-play').textContent = year.isPlaying ? 'stop' : 'play the day';
  if (year.isPlaying) year.timer = setInterval(() => { year.go(year.nextLightStep()); }, 350);
}

// Relights the picture for the hour, once the controls rest.
function followYear() {
  clearTimeout(year.follow);
  if ($('year-follow-row').hidden || !$('year-follow').checked) return;
  year.follow = setTimeout(async () => {
    const zone = year.about.zone_hours, minutes = Math.round(60 * Math.abs(zone));
    const offset = `${zone < 0 ? '-' : '+'}${twoDigits(Math.floor(minutes / 60))}:${twoDigits(minutes % 60)}`;
    try {
      await post('time', {time: `${year.dateOf(year.day).toISOString().slice(0, 10)}T${year.clockOf(year.step)}${offset}`});
      const state = await getJson('state');
      makeDimmers(state);
      makeTime(state);
      app.movedAt = performance.now();
    } catch (error) { say(error.message); }
  }, 200);
}

// Left and right go by hours, up and down by days.
const yearKeys = () => ({ArrowLeft: -1, ArrowRight: 1, ArrowUp: year.stepsOfDay, ArrowDown: -year.stepsOfDay,
  PageUp: 30 * year.stepsOfDay, PageDown: -30 * year.stepsOfDay});
function onYearKey(event) {
  const by = yearKeys()[event.key];
  if (!by || !year.about || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  year.go(year.yearStep + by);
  followYear();
}

function listenToYear() {
  const go = (step) => { year.go(step); followYear(); };
  $('year-day').oninput = () => go(Number($('year-day').value) * year.stepsOfDay + year.step);
  $('year-step').oninput = () => go(year.day * year.stepsOfDay + Number($('year-step').value));
  for (const id of ['year-day', 'year-step']) $(id).onkeydown = onYearKey;
  document.addEventListener('keydown', (event) => { if (event.target === document.body) onYearKey(event); });
  $('year-play').onclick = playDay;
  $('year-part').onchange = () => {
    $('year-most').value = yearScales[year.part];
    year.changeAsked().catch((error) => say(error.message));
  };
  $('year-fit').onclick = () => {
    if (year.values) $('year-most').value = roundUp(quantile(year.values, 0.98));
    showYear();
    drawOverlay();
  };
  for (const id of ['year-on', 'year-most', 'year-log', 'year-through', 'year-values'])
    $(id).onchange = () => { showYear(); drawOverlay(); };
  $('year-follow').onchange = followYear;
  $('year-carpet').onclick = (event) => go(carpetStepAt($('year-carpet'), year, event));
  $('year-close').onclick = () => year.choose(null);
}
