// SPDX-License-Identifier: MIT
'use strict';

function svgElement(name, attributes, text) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const key of Object.keys(attributes)) node.setAttribute(key, attributes[key]);
  if (text !== undefined) node.textContent = text;
  return node;
}

// A round number at or above `value`.
function niceCeiling(value) {
  if (!(value > 0)) return 1;
  const power = Math.pow(10, Math.floor(Math.log10(value)));
  for (const step of [1, 1.5, 2, 3, 4, 5, 7.5, 10]) {
    if (step * power >= value * (1 - 1e-9)) return step * power;
  }
  return 10 * power;
}

// A line over `points` [[x, y], ...] in a frame with its four end values. y starts at 0 unless `low`.
function lineChart(points, options) {
  const width = 330, height = options.height || 170, left = 46, right = 10, top = 10, bottom = 34;
  const xLow = options.xLow || 0;
  const xHigh = options.xHigh !== undefined ? options.xHigh : niceCeiling(Math.max(...points.map(p => p[0])));
  let yLow = 0, yHigh = niceCeiling(Math.max(...points.map(p => p[1])));
  if (options.fitY) {
    yLow = Math.min(...points.map(p => p[1]));
    yHigh = Math.max(...points.map(p => p[1]));
    if (yHigh - yLow < 1e-12) yHigh = yLow + 1;
  }
  const x = value => left + (width - left - right) * (value - xLow) / Math.max(xHigh - xLow, 1e-12);
  const y = value => height - bottom - (height - top - bottom) * (value - yLow) / (yHigh - yLow);
  const svg = svgElement('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': options.label});
  svg.append(svgElement('path', {class: 'axis', d: `M${left} ${top}V${height - bottom}H${width - right}`}));
  const path = points.map((p, i) => `${i ? 'L' : 'M'}${x(p[0]).toFixed(1)} ${y(p[1]).toFixed(1)}`).join('');
  if (!options.fitY && points.length) {
    const first = x(points[0][0]).toFixed(1), last = x(points[points.length - 1][0]).toFixed(1);
    svg.append(svgElement('path', {class: 'area', d: `${path}V${y(0)}H${first}Z`}));
  }
  svg.append(svgElement('path', {class: 'curve', d: path}));
  const say = (px, py, anchor, text) => svg.append(svgElement('text', {x: px, y: py, 'text-anchor': anchor}, text));
  say(left - 5, top + 9, 'end', number(yHigh));
  say(left - 5, height - bottom, 'end', number(yLow));
  say(left, height - bottom + 14, 'start', number(xLow));
  say(width - right, height - bottom + 14, 'end', number(xHigh));
  say((left + width - right) / 2, height - 6, 'middle', options.xLabel);
  if (options.yLabel) say(left + 6, top + 9, 'start', options.yLabel);
  return svg;
}

// S(W): what can be released after absorbing W (Eq. 6), a step function that starts at 0.
function instabilityChart(object) {
  const steps = object.instability.filter(step => step.W_J !== null && step.S_J !== null);
  if (!steps.length) return null;
  const end = niceCeiling(Math.max(steps[steps.length - 1].W_J * 1.15, 1e-6));
  const points = [[0, 0]];
  for (const step of steps) {
    points.push([step.W_J, points[points.length - 1][1]], [step.W_J, step.S_J]);
  }
  points.push([end, points[points.length - 1][1]]);
  return lineChart(points, {
    xHigh: end, xLabel: 'absorbed W (J)', yLabel: 'can release S(W) (J)',
    label: 'Energy that can be released, over energy absorbed',
  });
}

function energyChart(energies) {
  const points = [];
  energies.forEach((value, i) => { if (value !== null) points.push([i + 1, value]); });
  if (points.length < 2) return null;
  return lineChart(points, {
    xLow: 1, xHigh: energies.length, xLabel: 'sweep', fitY: true, height: 190,
    label: 'Energy after each sweep of the sampler',
  });
}

function timingBars(timings) {
  const names = Object.keys(timings);
  const longest = Math.max(...names.map(name => timings[name] || 0), 1e-9);
  const bars = element('div', {className: 'bars'});
  for (const name of names) {
    const fill = element('div', {className: 'fill', style: {width: 100 * (timings[name] || 0) / longest + '%'}});
    bars.append(element('span', {text: name}), element('div', {className: 'track'}, [fill]),
      element('span', {className: 'value', text: number(timings[name], 's')}));
  }
  const total = names.reduce((sum, name) => sum + (timings[name] || 0), 0);
  bars.append(element('strong', {text: 'in all'}), element('span'),
    element('strong', {className: 'value', text: number(total, 's')}));
  return bars;
}
