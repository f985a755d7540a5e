// SPDX-License-Identifier: MIT
'use strict';

// The scene as it was inlined, its records as typed arrays, and what is looked up by id.
function loadScene() {
  const scene = JSON.parse(document.getElementById('data').textContent);
  const view = scene.view;
  for (const records of [view.voxels, view.points]) {
    records.cell = new Uint16Array(bytesOf(records.cell));
    records.aux = new Int8Array(bytesOf(records.aux));
    if (records.photo) records.photo = new Uint8Array(bytesOf(records.photo));
  }
  const surface = view.surface;
  surface.cell = new Uint16Array(bytesOf(surface.cell));
  surface.aux = new Int8Array(bytesOf(surface.aux));
  if (surface.photo) surface.photo = new Uint8Array(bytesOf(surface.photo));
  surface.index = vertexNumbers(new Uint16Array(bytesOf(surface.index)));
  for (const name of Object.keys(view.fields)) {
    view.fields[name].arrow = new Float32Array(bytesOf(view.fields[name].arrow));
  }
  scene.coloured = !!(view.voxels.photo || surface.photo || view.points.photo);
  view.walks.shade = new Uint8Array(bytesOf(view.walks.shade));
  view.walks.floor_mm = new Int16Array(bytesOf(view.walks.floor_mm));
  scene.verified = JSON.parse(document.getElementById('verified').textContent);
  scene.objectById = new Map(scene.objects.map(object => [object.id, object]));
  const reckoned = new Set(scene.objects.flatMap(object => Object.keys(object.risk_J)));
  disturbanceKinds.push(...scene.disturbance_kinds);
  scene.disturbances = [...new Set([...disturbanceNames(), ...reckoned])].filter(name => reckoned.has(name));
  return scene;
}

// Of triangles' corners that tell how many vertices back they are, 0 for one that is new.
function vertexNumbers(back) {
  const out = new Uint32Array(back.length);
  let next = 0;
  for (let i = 0; i < back.length; ++i) out[i] = back[i] ? next - back[i] : next++;
  return out;
}

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;
}

const noColour = [168, 172, 178];

function colourOf(scene, id) {
  return id >= 0 && scene.colours[id] ? scene.colours[id] : noColour;
}

// Share 0 to 1 of the way along colours.
function colourAlong(colours, share) {
  const at = Math.min(Math.max(share, 0), 1) * (colours.length - 1), low = Math.min(Math.floor(at), colours.length - 2);
  return colours[low].map((value, c) => Math.round(value + (colours[low + 1][c] - value) * (at - low)));
}

// What may move and was not ranked has a colour of its own.
function riskColour(scene, unsafety) {
  if (unsafety === null) return scene.unranked_colour;
  return colourAlong(scene.unsafety_ramp, (unsafety - 1) / 9);
}

function css(colour) {
  return 'rgb(' + colour.join(',') + ')';
}

// Three digits, short; a dash for what has no value.
function number(value, unit) {
  if (value === null || value === undefined) return '\u2013';
  const size = Math.abs(value);
  let text;
  if (size === 0) text = '0';
  else if (size >= 10000 || size < 0.001) text = value.toExponential(1).replace('e+', 'e');
  else text = String(Number(value.toPrecision(3)));
  return unit ? text + '\u00a0' + unit : text;
}

// What one standard error adds to a figure.
function within(error) {
  return error > 0 ? ' \u00b1 ' + number(Number(error.toPrecision(2))) : '';
}

function plural(count, noun) {
  return count.toLocaleString('en') + ' ' + noun + (count === 1 ? '' : 's');
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
