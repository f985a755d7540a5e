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

// The chance that it falls in an earthquake of this peak, g, if half of them upset it at `median`.
function chanceOfFall(f, pga, median = f.pga_g) {
  if (median === null || median === undefined) return countedChance(f, pga);
  if (f.pga_dispersion !== null) return belowNormal(Math.log(pga / median) / f.pga_dispersion);
  return countedChance(f, pga * f.pga_g / median);
}

// Between the steps that were counted, straight over the peak's logarithm.
function countedChance({counted}, pga) {
  const after = counted.findIndex(step => step.pga_g > pga);
  if (after === 0) return counted[0].chance >= 0.5 ? counted[0].chance : 0;
  if (after < 0) return counted[counted.length - 1].chance;
  const low = counted[after - 1], high = counted[after];
  return low.chance + Math.log(pga / low.pga_g) / Math.log(high.pga_g / low.pga_g) * (high.chance - low.chance);
}

// How many of 100.
function hundredText(chance) {
  const share = Math.round(100 * chance);
  return share >= 100 ? 'nearly all' : share < 1 ? 'fewer than 1' : `about ${share}`;
}

// Of earthquakes that all peak as those of the risk do in the middle; and what the chance that its risk is of is over. '' where nothing is known of it.
function fragilityText(scene, object) {
  const f = object.fragility;
  if (!f || !f.counted || !f.counted.length) return '';
  const events = scene.events || {}, peak = events.pga_m_s2, strongest = f.counted[f.counted.length - 1];
  const at = peak > 0 ? peak / 9.80665 : twoDigits(strongest.pga_g), chance = chanceOfFall(f, at);
  // Friction is a guess: on what does not let it slide it may go over earlier.
  const firm = typeof f.firm_pga_g === 'number' ? chanceOfFall(f, at, f.firm_pga_g) : chance;
  const text = `Of 100 earthquakes that all peak at ${twoDigits(at)} g${shakingText('pga_g', at)} ${hundredText(chance)} would upset it` +
    (firm > chance + 0.02 ? `, and on a floor where it can\u2019t slide ${hundredText(firm)}.` : '.');
  const half = f.pga_g === null ? ` None of the shakings that were tried, up to ${twoDigits(strongest.pga_g)} g, upsets it in half of the cases.`
    : Math.abs(Math.log(f.pga_g / at)) < 0.1 ? '' : ` Half of those that peak at ${twoDigits(f.pga_g)} g${shakingText('pga_g', f.pga_g)} would.`;
  const kind = disturbanceKinds.find(({figure}) => figure.key === 'pga_m_s2'), usual = usualPeaks(events);
  const scattered = kind && usual && (object.fall_chance || {})[kind.name] > 0 ? ` Its risk is reckoned with earthquakes around ${twoDigits(at)} g, two of three from ${usual[0]} to ` +
    `${usual[1]} g: of all these ${chanceText(kind.name, object.fall_chance[kind.name])}.` : '';
  return text + half + scattered;
}

// "once in about 500 years": how often an earthquake upsets it where it stands, at most if the curve begins too late for it; '' without a curve.
function onceIn(scene, object) {
  const years = (object.fragility || {}).return_years;
  if (typeof years !== 'number') return '';
  return `once in ${scene.below_hazard.includes(object.id) ? 'at most' : 'about'} ${twoDigits(years).toLocaleString('en')} years`;
}

function curveText(scene) {
  return `the curve of the hazard begins at ${number(scene.events.hazard_from_g)} g, and weaker earthquakes count as none`;
}

function yearsText(scene, object) {
  const once = onceIn(scene, object);
  return once && `An earthquake upsets it ${once}${scene.below_hazard.includes(object.id) ? `: ${curveText(scene)}` : ''}.`;
}

// The curve; null where nothing was counted.
function fragilityChart(object) {
  const f = object.fragility;
  if (!f || !f.counted || f.counted.length < 2) return null;
  const height = 120, left = 40, bottom = 26, low = Math.log(f.counted[0].pga_g), high = Math.log(f.counted[f.counted.length - 1].pga_g);
  const {svg, say, x: along, y} = chart('Chance of falling over the peak acceleration of an earthquake', 300, height, [left, 8, 8, bottom]);
  const x = pga => along((Math.log(pga) - low) / (high - low));
  if (f.pga_g !== null && f.pga_dispersion !== null) {
    const peaks = [...Array(61).keys()].map(n => Math.exp(low + (high - low) * n / 60));
    svg.append(curve(peaks.map(pga => [x(pga), y(belowNormal(Math.log(pga / f.pga_g) / f.pga_dispersion))])));
  }
  for (const step of f.counted) svg.append(svgElement('circle', {class: 'counted', cx: x(step.pga_g).toFixed(1), cy: y(step.chance).toFixed(1), r: 2}));
  say(left - 4, y(1) + 6, 'end', '100 %');
  say(left - 4, y(0), 'end', '0');
  for (const pga of [0.1, 0.3, 1, 3]) say(x(pga), height - bottom + 12, 'middle', `${pga}${pga === 3 ? ' g' : ''}`);
  return svg;
}
