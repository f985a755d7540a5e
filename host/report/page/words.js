// SPDX-License-Identifier: MIT
'use strict';

// What happens to objects, in words for someone who has read nothing about it.

// What there is to say of each disturbance, in their order; of the page's data.
const disturbanceKinds = [];
const disturbanceNames = () => disturbanceKinds.map(kind => kind.name);

function kindOf(name) {
  return disturbanceKinds.find(kind => kind.name === name) ||
    {name, cause: name, event: 'event', strength: 'speed', legend: name, scale: 1, unit: ''};
}

const capital = text => text.charAt(0).toUpperCase() + text.slice(1);

function causeOf(name) {
  return kindOf(name).cause;
}

// "a", "a and b", "a, b and c"
function listed(words, last = 'and') {
  return words.length < 2 ? words.join('') : `${words.slice(0, -1).join(', ')} ${last} ${words[words.length - 1]}`;
}

// What an object is called: by its name where it has one.
function objectName(scene, id) {
  const object = scene.objectById.get(id);
  return object && object.name ? object.name : object && object.grounded ? 'the building' : id < 0 ? 'no object' : `object ${id}`;
}

function objectList(ids) {
  const shown = ids.slice(0, 5).map(String);
  if (ids.length > 5) shown.push(`${ids.length - 5} more`);
  return (ids.length === 1 ? 'object ' : 'objects ') + listed(shown);
}

// A chance per event as "1 in 40 walks".
function chanceText(name, chance) {
  const {event} = kindOf(name);
  if (chance === null || chance === undefined) return '';
  if (chance <= 0) return `no ${event}`;
  if (chance >= 0.95) return `nearly every ${event}`;
  if (chance > 0.4) return `${Math.round(10 * chance)} in 10 ${event}s`;
  if (chance < 1e-4) return `less than 1 in 10,000 ${event}s`;
  return `1 in ${Math.round(twoDigits(1 / chance)).toLocaleString('en')} ${event}s`;
}

// The largest of an object's risks: 0 where it has none.
function largestRisk(object) {
  return Math.max(0, ...Object.keys(object.risk_J).map(name => object.risk_J[name] || 0));
}

// What can upset it, the largest risk first; what adds less than a twentieth of that is left out.
function causesOf(object) {
  const least = largestRisk(object) / 20;
  return Object.keys(object.risk_J).filter(name => object.risk_J[name] > 0 && object.risk_J[name] >= least)
    .sort((a, b) => object.risk_J[b] - object.risk_J[a]);
}

// What it sets free on average when its largest risk comes true; where it has none, on the easiest way out of its place.
function releaseOf(object) {
  const name = causesOf(object)[0], chance = name && (object.fall_chance || {})[name];
  return chance > 0 ? object.risk_J[name] / chance : object.release_J;
}

function upsetText(scene, object) {
  if (object.seen_enough === false) return 'Its risk is not known: nothing was seen to hold it.';
  const names = causesOf(object);
  if (!names.length) return 'Upset by none of the disturbances.';
  const chances = names.map(name => ({name, text: chanceText(name, (object.fall_chance || {})[name])})).filter(({text}) => text)
    .map(({name, text}) => text + peaksText(scene, name));
  if (!chances.length) return `At risk from ${listed(names.map(causeOf))}.`;
  return `Upset by ${listed(chances, 'or')}.`;
}

// Of which earthquakes a chance is: " around 0.31 g"; '' of other disturbances.
function peaksText(scene, name) {
  const {key} = kindOf(name).figure || {}, peak = (scene.events || {})[key];
  return key === 'pga_m_s2' && peak > 0 ? ` ${scene.events.pga_spread > 0 ? 'around' : 'with a peak of'} ${twoDigits(peak / 9.80665)} g` : '';
}

// Between which peaks two of three of the earthquakes lie, g; null where all have the same.
function usualPeaks({pga_m_s2: peak, pga_spread: spread}) {
  return spread > 0 ? [-1, 1].map(sign => twoDigits(peak / 9.80665 * Math.exp(sign * spread))) : null;
}

// What one event of a kind is: "one earthquake of about 3 m/s² (0.31 g, very strong shaking, intensity VII; two of three from 0.19 to 0.5 g)".
function oneEventText(scene, kind) {
  const {key, follows, unit} = kind.figure, events = scene.events || {}, value = events[key];
  if (!follows || value === undefined) return kind.one_event;
  const usual = key === 'pga_m_s2' ? usualPeaks(events) : null, shaking = shakingText(key, value);
  return kind.one_event + follows + number(value, unit) +
    (usual ? shaking.replace(/\)$/, `; two of three from ${usual[0]} to ${usual[1]} g)`) : shaking);
}

// What overturns it slowly, in the figures of statics; '' where it can't tip.
function overturningText(object) {
  const o = object.overturning;
  if (!o || o.tilt_deg === null) return '';
  const about = (value, error) => {
    if (!(error > 0)) return twoDigits(value);
    const digits = Math.min(3, Math.max(0, -Math.floor(Math.log10(error))));
    return `${value.toFixed(digits)} \u00b1 ${error.toFixed(digits)}`;
  };
  const hand = typeof o.hand_push_N === 'number' && o.hand_push_N > 1.05 * o.push_N ?
    ` or of ${about(o.hand_push_N, o.hand_push_error_N)} N at ${metres(o.hand_height_m)} above what it stands on, where a hand pushes` : '';
  const gust = typeof o.gust_m_s === 'number' ? `, or in gusts of ${about(o.gust_m_s, o.gust_error_m_s)} m/s` : '';
  const push = `a steady push of ${about(o.push_N, o.push_error_N)} N at its top (the weight of ${twoDigits(o.push_N / 9.80665)} kg)${hand}${gust}`, slides = o.shake_g < 0.999 * Math.tan(o.tilt_deg * Math.PI / 180);
  return `Goes over once it leans ${about(o.tilt_deg, o.tilt_error_deg)}\u00b0, or at ${push}` +
    (o.slide_N < o.push_N ? `, if ${twoDigits(o.slide_N)} N don't slide it before` : '') +
    `; begins to ${slides ? 'slide' : 'rock'} where the ground shakes with ${twoDigits(o.shake_g)} g${shakingText('pga_g', o.shake_g)}.`;
}

// What the ground's peak means to people: [its upper end in g, words, intensity], from weak to strong; of the page's data.
const shakings = [];

// " (0.3 g, very strong shaking, intensity VII)" for a figure of the key pga_m_s2, the same without g for one of pga_g; '' for others.
function shakingText(key, value) {
  if (key !== 'pga_g' && key !== 'pga_m_s2') return '';
  const inG = key === 'pga_g' ? value : value / 9.80665, found = shakings.find(([end]) => end === null || inG <= end);
  if (!found) return '';
  return ` (${key === 'pga_g' ? '' : `${twoDigits(inG)} g, `}${found[1]}, intensity ${found[2]})`;
}

// A mass is a guess from the volume, unless it was given.
function massText(scene, object) {
  const mass = number(object.mass_kg, 'kg') + within(object.mass_error_kg), density = number(scene.density_kg_m3, 'kg/m\u00b3');
  if (massIsGiven(scene, object)) return `${mass}, as given by hand`;
  if (object.mass_model === 'solid' || !object.mass_model) return `${mass}, if it is solid throughout, of ${density}`;
  if (object.mass_model === 'closed') return `${mass}, if of boards at ${density} around contents`;
  if (object.mass_model === 'kind') return `${mass}, as things of its ${object.name ? 'name' : 'size'} weigh`;
  return `${mass}, ${object.mass_model}`;
}

function metres(length) {
  return length < 0.995 ? `${Math.max(1, Math.round(100 * length))} cm` : `${length.toFixed(1)} m`;
}

// "8 \u00d7 20 \u00d7 21 cm", the height last; '' where it is not known.
function sizeText(object) {
  const size = object.size_m;
  if (!size || !size.every(value => value > 0)) return '';
  const centimetres = size.every(value => value < 0.995);
  const shown = value => centimetres ? Math.max(1, Math.round(100 * value)) : value.toFixed(2);
  return `${size.map(shown).join(' \u00d7 ')} ${centimetres ? 'cm' : 'm'}`;
}

const compassNames = ['north', 'north-east', 'east', 'south-east', 'south', 'south-west', 'west', 'north-west'];

function compassOf(degrees) {
  return compassNames[Math.round(((degrees % 360) + 360) % 360 / 45) % 8];
}

// Which way a vector of the input's frame points, seen from above; '' for no way.
function wayOf(scene, vector) {
  const [x, y] = viewPlace(scene, vector);
  return Math.hypot(x, y) > 1e-3 ? compassOf(Math.atan2(x, y) * 180 / Math.PI) : '';
}

// " to the north", as it falls; '' for no way.
function fallsTo(scene, object) {
  const way = wayOf(scene, object.fall.lands_m.map((value, k) => value - (object.center_of_mass_m[k] || 0)));
  return way ? ` to the ${way}` : '';
}

function landsText(scene, fall) {
  const below = scene.objectById.get(fall.lands_on);
  return !below ? 'to what lies below' : below.grounded ? 'to the floor or what is fixed to it' : `onto ${objectName(scene, below.id)}`;
}

// Whether the program told where it falls.
function fallKnown(object) {
  return !!object.fall && object.fall.falls && object.fall.lands_m.every(value => value !== null);
}

// Who passes where it lands, and how hard it lands: a sentence of its own; '' where it lands softly.
function hitsText(object) {
  const fall = object.fall;
  if (!(fall.hits_J > 0)) return '';
  const joules = value => number(twoDigits(value), 'J');
  const people = 100 * fall.people_share, stopped = fall.leans_on >= 0 && fall.hits_J < 0.9 * releaseOf(object);
  // Risk and category are of what is not stopped, and of all ways that events upset it.
  const energy = stopped ? `${joules(fall.hits_J)}, and ${joules(releaseOf(object))} if that gives way` : joules(releaseOf(object) || fall.hits_J);
  if (typeof fall.people_share !== 'number') return ` It would land with ${energy}.`;
  const who = people <= 0 ? 'nobody passes who walks' : `${people < 0.5 ? 'less than 1' : Math.round(people)} of 100 people pass who walk`;
  return ` It would land where ${who} through the room, with ${energy}.`;
}

// What happens then. Why it stands as it does where nothing is known of its fall.
function happensText(scene, object) {
  if (!fallKnown(object)) return object.why.sentence;
  const fall = object.fall, to = fallsTo(scene, object);
  const flat = object.mode === 'tip' && !(fall.leans_on >= 0) && !(fall.drop_m > 0);
  const verb = flat ? `It falls flat${to}` : object.mode === 'tip' ? `It tips over${to}` : object.mode === 'slide' ? `It slides off${to}` : `It comes down${to}`;
  const goes = fall.takes_along.length, end = goes ? ` and takes ${objectList(fall.takes_along)} along.` : '.';
  const against = scene.objectById.get(fall.leans_on);
  const how = against ? `, against ${against.grounded ? 'a wall or what is fixed to it' : objectName(scene, against.id)}${goes ? ',' : ''}` :
    fall.drop_m > 0 ? `, falls ${metres(fall.drop_m)} ${landsText(scene, fall)}` : '';
  return verb + how + end + hitsText(object);
}

// What a simulator made of the scene (topple verify): how many stay, and which moved.
function verifiedText(verified) {
  const free = verified.objects.filter(object => object.free), moved = free.filter(object => !object.stays);
  const text = `In ${verified.simulator}, ${free.length - moved.length} of ${plural(free.length, 'object')} stayed for ` +
    `${number(verified.simulated_s, 's')}` + (verified.cut_short ? `, when ${verified.cut_short}` : '');
  return text + (moved.length ? `; ${moved.length === 1 ? 'this' : 'these'} moved: ${objectList(moved.map(object => object.id))}.` : '.');
}

function verifiedObjectText(verified, id) {
  const object = verified.objects.find(other => other.id === id);
  if (!object || !object.free) return '';
  if (object.stays) return `Stayed in ${verified.simulator}.`;
  return `Moved in ${verified.simulator}: by ${metres(object.moved_m)}, turned by ${Math.round(object.turned_deg)}\u00b0.`;
}

// What is to be held at least, rounded up as the program's sentences have it: "154 N", "2.8 N".
function forceText(newtons) {
  const steps = newtons < 10 ? 10 : 1;
  return `${(Math.ceil(newtons * steps - 1e-9) / steps).toFixed(newtons < 10 ? 1 : 0)} N`;
}
