// SPDX-License-Identifier: MIT
'use strict';

// How likely an object is to fall in an earthquake, over its peak acceleration: counted, and fitted.

// The chance that a standard normal variate is below z (Abramowitz and Stegun 7.1.26).
function belowNormal(z) {
  const t = 1 / (1 + 0.3275911 * Math.abs(z) / Math.SQRT2);
  const tail = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 + t * 1.061405429)))) *
    Math.exp(-z * z / 2) / 2;
  return z > 0 ? 1 - tail : tail;
}

// '' where nothing is known of it.
function fragilityText(object) {
  const f = object.fragility;
  if (!f || !f.counted || !f.counted.length) return '';
  const round = value => Number(value.toPrecision(2)), strongest = f.counted[f.counted.length - 1];
  const rate = f.return_years === null || f.return_years === undefined ? '' :
    ` Where it stands, it falls once in ${round(f.return_years)} years on average.`;
  // Friction is a guess: on what does not let it slide it may go over earlier.
  const slides = typeof f.firm_pga_g === 'number' && !(f.pga_g !== null && f.pga_g < 1.1 * f.firm_pga_g) ?
    ` as long as it can slide; where it can't, half of those with peaks of ${round(f.firm_pga_g)} g do` : '';
  if (f.pga_g === null) {
    return strongest.chance > 0 ?
      `Of earthquakes with peaks of ${round(strongest.pga_g)} g${shakingText('pga_g', strongest.pga_g)}, ${Math.round(100 * strongest.chance)} % turn it over or move it off${slides}.${rate}` :
      `No earthquake with peaks of up to ${round(strongest.pga_g)} g${shakingText('pga_g', strongest.pga_g)} turns it over or moves it off${slides}.`;
  }
  const speed = f.pgv_m_s === null ? '' : ` or peak velocities of ${round(f.pgv_m_s)} m/s`;
  const less = f.pga_dispersion === null && f.counted.length && f.pga_g <= f.counted[0].pga_g ? ', and perhaps less,' : '';
  return `Half of all earthquakes with peaks of ${round(f.pga_g)} g${shakingText('pga_g', f.pga_g)}${less}${speed} turn it over or move it off${slides}.${rate}`;
}

// The curve; null where nothing was counted.
function fragilityChart(object) {
  const f = object.fragility;
  if (!f || !f.counted || f.counted.length < 2) return null;
  const width = 300, height = 120, left = 40, right = 8, top = 8, bottom = 26;
  const low = Math.log(f.counted[0].pga_g), high = Math.log(f.counted[f.counted.length - 1].pga_g);
  const x = pga => left + (Math.log(pga) - low) / (high - low) * (width - left - right);
  const y = chance => height - bottom - chance * (height - top - bottom);
  const svg = svgElement('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img',
    'aria-label': 'Chance of falling over the peak acceleration of an earthquake'});
  svg.append(svgElement('path', {class: 'axis', d: `M${left} ${top}V${height - bottom}H${width - right}`}));
  if (f.pga_g !== null && f.pga_dispersion !== null) {
    const points = [];
    for (let n = 0; n <= 60; n++) {
      const pga = Math.exp(low + (high - low) * n / 60);
      points.push(`${x(pga).toFixed(1)} ${y(belowNormal(Math.log(pga / f.pga_g) / f.pga_dispersion)).toFixed(1)}`);
    }
    svg.append(svgElement('path', {class: 'curve', d: 'M' + points.join('L')}));
  }
  for (const step of f.counted) svg.append(svgElement('circle', {class: 'counted', cx: x(step.pga_g).toFixed(1), cy: y(step.chance).toFixed(1), r: 2}));
  const say = (px, py, anchor, text) => svg.append(svgElement('text', {x: px, y: py, 'text-anchor': anchor}, text));
  say(left - 4, y(1) + 6, 'end', '100 %');
  say(left - 4, y(0), 'end', '0');
  for (const pga of [0.1, 0.3, 1, 3]) say(x(pga), height - bottom + 12, 'middle', `${pga}${pga === 3 ? ' g' : ''}`);
  return svg;
}
