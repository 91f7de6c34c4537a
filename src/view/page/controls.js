// Controls for luminaires and the time of day, and the messages that they send.
'use strict';

// Shows a change at once if the layers are loaded. The program gets the newest settings, one
// message at a time: it needs them for the first picture after a move.
async function onDimmer() {
  draw();
  drawMeasured();
  updateLinks();
  app.areSettingsPending = true;
  if (app.isSendingSettings) return;
  app.isSendingSettings = true;
  try {
    while (app.areSettingsPending) {
      app.areSettingsPending = false;
      await sendExtras();
    }
    if (areDimmed() && app.dimmers.length > 1 && measurements.needsDimmers(app.dimmers.length))
      await measurements.again((m) => m.rows && m.rows.length !== app.dimmers.length);
    if (await fetchLayers(app.state)) draw();
  } finally {
    app.isSendingSettings = false;
  }
}

function makeDimmers(state) {
  app.dimmers = state.dimmers.map((d) => ({...d, isOn: true, level: 1, colour: [1, 1, 1]}));
  $('dimmers').replaceChildren(...app.dimmers.map((d, i) => {
    const row = document.createElement('label');
    row.className = 'dimmer';
    row.innerHTML = '<input type="checkbox" checked><span></span><input type="range" min="0" max="1" step="0.01" value="1"><output>100 %</output><input type="color" value="#ffffff">';
    const [on, name, level, shown, colour] = row.children;
    name.textContent = d.name || `light ${i}`;
    name.title = d.power > 0 ? `${d.name}: ${d.power.toPrecision(4)} ${state.is_photometric ? 'lm' : 'W'}` : d.name;
    [on, level, colour].forEach((input) => input.setAttribute('aria-label', `${d.name} ${input.type}`));
    const change = () => {
      d.isOn = on.checked;
      d.level = Number(level.value);
      // The new colour has the same luminance.
      const c = [1, 3, 5].map((k) => (parseInt(colour.value.slice(k, k + 2), 16) / 255) ** 2.2);
      const l = luminanceOf(...c);
      d.colour = colour.value === '#ffffff' || !(l > 0) ? [1, 1, 1] : c.map((v) => v / l);
      shown.textContent = `${Math.round(100 * d.level)} %`;
      onDimmer().catch((error) => say(error.message));
    };
    on.onchange = level.oninput = colour.oninput = change;
    return row;
  }));
}

function makeTime(state) {
  $('time-section').hidden = !state.has_time;
  if (!state.has_time) return;
  const parts = /^(\d{4}-\d\d-\d\d)T(\d\d):(\d\d)(:[\d.]+)?(.*)$/.exec(state.time);
  if (!parts) return;
  $('date').value = parts[1];
  $('minutes').value = 60 * parts[2] + Number(parts[3]);
  const text = () => {
    const m = Number($('minutes').value), two = (v) => String(v).padStart(2, '0');
    return `${two(Math.floor(m / 60))}:${two(m % 60)}`;
  };
  const show = () => { $('clock').textContent = `${text()} ${parts[5]}`; };
  let timer = 0;
  const send = () => {
    show();
    clearTimeout(timer);
    timer = setTimeout(async () => {
      try {
        await post('time', {time: `${$('date').value}T${text()}${parts[5]}`});
        makeDimmers(await getJson('state'));
        await measurements.again();
        app.movedAt = performance.now();
      } catch (error) { say(error.message); }
    }, 150);
  };
  $('date').onchange = $('minutes').oninput = send;
  show();
}
