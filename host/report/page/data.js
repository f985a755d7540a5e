// SPDX-License-Identifier: MIT
'use strict';

// The scene as it was inlined, its records as typed arrays, and what is looked up by id.
async function loadScene() {
  const scene = JSON.parse(document.getElementById('data').textContent);
  if (!window.DecompressionStream) {
    throw new Error('This browser is too old for this report: it can\u2019t inflate data. Chromium 80, Firefox 113 and Safari 16.4 can.');
  }
  const view = scene.view, surface = view.surface;
  const records = Object.entries({cell: Uint16Array, aux: Int8Array, photo: Uint8Array})
    .flatMap(([name, Type]) => [view.voxels, view.points, surface].filter(owner => owner[name]).map(owner => [owner, name, Type]));
  await Promise.all(records.map(async ([owner, name, Type]) => { owner[name] = recordsOf(await inflated(owner[name]), Type, 4); }));
  surface.index = vertexNumbers(await inflated(surface.index));
  for (const bulk of ['primitives', 'contacts', 'swc_energy', 'drawings']) {
    scene[bulk] = await unpacked(scene[bulk]);
  }
  for (const name of Object.keys(view.fields)) {
    view.fields[name].arrow = new Float32Array(bytesOf(view.fields[name].arrow).buffer);
  }
  scene.coloured = !!(view.voxels.photo || surface.photo || view.points.photo);
  view.walks.shade = bytesOf(view.walks.shade);
  view.walks.floor_mm = new Int16Array(bytesOf(view.walks.floor_mm).buffer);
  scene.verified = JSON.parse(document.getElementById('verified').textContent);
  scene.objectById = new Map(scene.objects.map(object => [object.id, object]));
  scene.colourFrom = new Map();  // objects that have another's colour: of which number
  const reckoned = new Set(scene.objects.flatMap(object => Object.keys(object.risk_J)));
  disturbanceKinds.push(...scene.disturbance_kinds);
  shakings.push(...scene.shakings);
  scene.disturbances = [...new Set([...disturbanceNames(), ...reckoned])].filter(name => reckoned.has(name));
  return scene;
}

// Of zlib's format in base64.
async function inflated(base64) {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// JSON in that format.
async function unpacked(base64) {
  return JSON.parse(new TextDecoder().decode(await inflated(base64)));
}

// Undoes deflated() of host/report/embedded.h: channel by channel the steps from record to record, low bytes before high ones.
function recordsOf(bytes, Type, channels) {
  const wide = Type.BYTES_PER_ELEMENT === 2, out = new Type(bytes.length / Type.BYTES_PER_ELEMENT), count = out.length / channels;
  for (let c = 0, base = 0; c < channels; ++c, base += count * Type.BYTES_PER_ELEMENT) {
    for (let i = 0, value = 0, at = c; i < count; ++i, at += channels) {
      const low = bytes[base + i];
      if (wide) {
        const step = low | bytes[base + count + i] << 8;
        value = value + (step >>> 1 ^ -(step & 1)) & 65535;
      } else {
        value = value + low & 255;
      }
      out[at] = value;
    }
  }
  return out;
}

// Of triangles' corners that tell how many vertices back they are, 0 for one that is new: low bytes, then high ones.
function vertexNumbers(bytes) {
  const count = bytes.length / 2, out = new Uint32Array(count);
  for (let i = 0, next = 0; i < count; ++i) {
    const back = bytes[i] | bytes[count + i] << 8;
    out[i] = back ? next - back : next++;
  }
  return out;
}

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const noColour = [168, 172, 178];

// Of a part, or of an object, which may have taken that of the same thing in another parse.
function colourOf(scene, id) {
  return id >= 0 && scene.colours[id] ? scene.colours[id] : noColour;
}
function objectColour(scene, id) {
  return colourOf(scene, scene.colourFrom.has(id) ? scene.colourFrom.get(id) : id);
}

function colourSwatch(colour) {
  return element('span', {className: 'swatch', style: {background: css(colour)}});
}
function objectSwatch(scene, id) {
  const swatch = colourSwatch(objectColour(scene, id));
  swatch.dataset.object = id;
  return swatch;
}

// Share 0 to 1 of the way along colours.
function colourAlong(colours, share) {
  const at = Math.min(Math.max(share, 0), 1) * (colours.length - 1), low = Math.min(Math.floor(at), colours.length - 2);
  return colours[low].map((value, c) => Math.round(value + (colours[low + 1][c] - value) * (at - low)));
}

const categories = ['none', 'low', 'medium', 'high'];
const harmlessColour = [222, 226, 230];

// That of its category, by which one acts; what may move and was not seen enough to have one has a colour of its own.
function categoryColour(scene, category) {
  if (!category) return scene.unranked_colour;
  const ramp = scene.unsafety_ramp;
  return {none: harmlessColour, low: ramp[0], medium: ramp[2], high: ramp[ramp.length - 1]}[category];
}

// What whoever reaches for things, a child say, upsets, by what that sets free each time (severityText()).
function reachCategory(object) {
  const chance = (object.fall_chance || {}).reach;
  if (!(chance > 0)) return 'none';
  const joules = object.risk_J.reach / chance;
  return joules >= serious_J ? 'high' : joules >= slight_J ? 'medium' : 'low';
}

function css(colour) {
  return 'rgb(' + colour.join(',') + ')';
}

// Three digits, without powers of ten as far as people write numbers so; a dash for what has no value.
function number(value, unit) {
  if (value === null || value === undefined) return '\u2013';
  const size = Math.abs(value);
  const rounded = Number(value.toPrecision(3));
  const text = size === 0 ? '0' : size < 1e-6 ? 'under 0.000001' : size >= 1e12 ? value.toExponential(1).replace('e+', 'e')
    : rounded.toLocaleString('en', {maximumSignificantDigits: size < 0.001 ? 1 : 3});
  return unit ? text + '\u00a0' + unit : text;
}

const twoDigits = value => Number(value.toPrecision(2));

// What one standard error adds to a figure.
function within(error) {
  return error > 0 ? ' \u00b1 ' + number(twoDigits(error)) : '';
}

function plural(count, noun) {
  return count.toLocaleString('en') + ' ' + noun + (count === 1 ? '' : 's');
}

// Says a text in the page's element of that id, which is hidden where there is none.
function sayIn(id, text) {
  const node = document.getElementById(id);
  node.textContent = text;
  node.hidden = !text;
}

// An element with text (never markup) and children.
function element(name, properties, children) {
  const node = document.createElement(name);
  for (const key of Object.keys(properties || {})) {
    if (key === 'text') node.textContent = properties[key];
    else if (key === 'style') Object.assign(node.style, properties[key]);
    else if (key in node) node[key] = properties[key];
    else node.setAttribute(key, properties[key]);
  }
  for (const child of children || []) node.append(child);
  return node;
}
