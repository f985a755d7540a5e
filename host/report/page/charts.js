// SPDX-License-Identifier: MIT
'use strict';

function svgElement(name, attributes, text) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const key of Object.keys(attributes)) node.setAttribute(key, attributes[key]);
  if (text !== undefined) node.textContent = text;
  return node;
}

// say(x, y, anchor, text, style): writes into a drawing.
function svgTexts(svg) {
  return (x, y, anchor, text, style = '') => svg.append(svgElement('text', {x, y, 'text-anchor': anchor, class: style}, text));
}

// An empty chart with its axes; margins: left, right, top, bottom. x(share), y(share) of the axes.
function chart(label, width, height, [left, right, top, bottom]) {
  const svg = svgElement('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': label});
  svg.append(svgElement('path', {class: 'axis', d: `M${left} ${top}V${height - bottom}H${width - right}`}));
  return {svg, say: svgTexts(svg), x: share => left + (width - left - right) * share, y: share => height - bottom - (height - top - bottom) * share};
}

// The curve through points [x, y].
function curve(points) {
  return svgElement('path', {class: 'curve', d: 'M' + points.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L')});
}

// Two numbers in as few digits, from three on, as tell one from the other.
function distinctNumbers(low, high) {
  if (number(low) !== number(high)) return [number(low), number(high)];
  for (let digits = 4; digits < 16; ++digits) {
    const texts = [low, high].map(value => String(Number(value.toPrecision(digits))));
    if (texts[0] !== texts[1]) return texts;
  }
  return [String(low), String(high)];
}

// Fig. 7d: the best energy of a partition so far, over the sampler's iterations.
function energyChart(energies) {
  const points = [];
  energies.forEach((value, i) => { if (value !== null) points.push([i + 1, value]); });
  if (points.length < 2) return null;
  const yLow = Math.min(...points.map(p => p[1]));
  let yHigh = Math.max(...points.map(p => p[1]));
  if (yHigh - yLow < 1e-12) yHigh = yLow + 1;
  const [lowText, highText] = distinctNumbers(yLow, yHigh);
  const width = 330, height = 200, right = 10, top = 26, bottom = 34;
  const left = Math.max(46, 12 + 6.5 * Math.max(lowText.length, highText.length));
  const {svg, say, x, y} = chart('Energy over the sampler\u2019s iterations', width, height, [left, right, top, bottom]);
  svg.append(curve(points.map(([at, energy]) => [x((at - 1) / Math.max(energies.length - 1, 1)), y((energy - yLow) / (yHigh - yLow))])));
  say(left - 5, top + 9, 'end', highText);
  say(left - 5, height - bottom, 'end', lowText);
  say(left, height - bottom + 14, 'start', '1');
  say(width - right, height - bottom + 14, 'end', energies.length.toLocaleString('en'));
  say((left + width - right) / 2, height - 6, 'middle', 'iteration');
  say(left, 12, 'start', 'energy (no unit)');  // above all lines
  return svg;
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
    element('strong', {className: 'value', text: number(total, 's')}),
    element('p', {className: 'hint', text: 'Without writing the output, of which this page is a part.'}));
  return bars;
}
