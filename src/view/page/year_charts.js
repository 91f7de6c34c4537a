// Charts of one sensor: its illuminance over a day, and over all days and hours of the year.
'use strict';

const chartFont = '11px system-ui, "DejaVu Sans", sans-serif';
const chartLeft = 44, chartRight = 8, chartTop = 6, chartBottom = 18;
const chartWidth = (canvas) => canvas.width - chartLeft - chartRight;
const chartHeight = (canvas) => canvas.height - chartTop - chartBottom;

function drawHours(g, canvas) {
  g.textAlign = 'center';
  for (let h = 0; h <= 24; h += 6)
    g.fillText(`${h}`, chartLeft + chartWidth(canvas) * h / 24, canvas.height - 5);
}

// Draws the day of the chosen sensor, with its hour marked.
function drawDay(canvas, year) {
  const g = canvas.getContext('2d'), {values} = year.chosen, count = year.stepsOfDay;
  g.clearRect(0, 0, canvas.width, canvas.height);
  const day = Array.from({length: count}, (_, k) => {
    const hour = year.hourOfStep.get(year.day * count + k);
    return hour === undefined ? 0 : values[hour];
  });
  const most = roundUp(Math.max(...day.filter(Number.isFinite), 100));
  const x = (k) => chartLeft + chartWidth(canvas) * (k + 0.5) / count;
  const y = (v) => chartTop + chartHeight(canvas) * (1 - v / most);
  g.font = chartFont;
  g.lineWidth = 1;
  for (const share of [0, 0.5, 1]) {
    g.strokeStyle = '#3a3d42';
    g.beginPath();
    g.moveTo(chartLeft, y(share * most));
    g.lineTo(canvas.width - chartRight, y(share * most));
    g.stroke();
    g.fillStyle = '#9aa0a8';
    g.textAlign = 'right';
    g.fillText(`${Number((share * most).toPrecision(2))}`, chartLeft - 4, y(share * most) + 4);
  }
  drawHours(g, canvas);
  g.strokeStyle = '#ffd166';
  g.lineWidth = 1.6;
  g.beginPath();
  day.forEach((v, k) => { if (Number.isFinite(v)) g.lineTo(x(k), y(v)); });
  g.stroke();
  g.fillStyle = '#fff';
  g.beginPath();
  if (Number.isFinite(day[year.step])) g.arc(x(year.step), y(day[year.step]), 4, 0, 7);
  g.fill();
}

// Draws the year of the chosen sensor on the scale of the picture: days to the right, hours upward.
function drawCarpet(canvas, year, most, isLog) {
  const g = canvas.getContext('2d'), {values} = year.chosen;
  const width = chartWidth(canvas), height = chartHeight(canvas), image = g.createImageData(width, height);
  for (let py = 0; py < height; ++py)
    for (let px = 0; px < width; ++px) {
      const hour = year.hourOfStep.get(carpetStep(year, (px + 0.5) / width, (py + 0.5) / height));
      const colour = hour === undefined ? [17, 19, 22] : year.colourOf(values[hour], most, isLog);
      image.data.set([...colour, 255], 4 * (py * width + px));
    }
  g.clearRect(0, 0, canvas.width, canvas.height);
  g.putImageData(image, chartLeft, chartTop);
  g.fillStyle = '#9aa0a8';
  g.font = chartFont;
  g.textAlign = 'right';
  for (const h of [0, 12, 24]) g.fillText(`${h}`, chartLeft - 4, chartTop + height * (1 - h / 24) + 4);
  g.textAlign = 'center';
  for (let m = 0; m < 12; ++m)
    g.fillText(monthNames[m][0], chartLeft + width * (year.dayOf(m + 1, 15) + 0.5) / year.days, canvas.height - 5);
  g.strokeStyle = '#fff';
  g.lineWidth = 1;
  const x = chartLeft + width * (year.day + 0.5) / year.days;
  const y = chartTop + height * (1 - (year.step + 0.5) / year.stepsOfDay);
  g.strokeRect(Math.round(x) - 3.5, Math.round(y) - 3.5, 7, 7);
}

// Returns the step of the year at a place of the chart: shares of its sides from the top left.
function carpetStep(year, x, y) {
  const within = (v, count) => Math.max(0, Math.min(count - 1, Math.floor(v * count)));
  return within(x, year.days) * year.stepsOfDay + within(1 - y, year.stepsOfDay);
}
function carpetStepAt(canvas, year, event) {
  const r = canvas.getBoundingClientRect(), scale = canvas.width / r.width;
  return carpetStep(year, ((event.clientX - r.left) * scale - chartLeft) / chartWidth(canvas),
    ((event.clientY - r.top) * scale - chartTop) / chartHeight(canvas));
}
