// SPDX-License-Identifier: MIT
'use strict';

// Where things are in the view's frame, z up: metres.

function viewPlace(scene, v) {
  return scene.view.view_from_input.map(row => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
}

const middleOf = ({low, high}) => low.map((value, k) => (value + high[k]) / 2);
const extentOf = ({low, high}) => low.map((value, k) => high[k] - value);

// The records that the solids are drawn from: their surface, else their voxels, else the scan.
function drawnRecords(view) {
  return [view.surface, view.voxels].find(solids => solids.count) || view.points;
}

// Widens a box by another one.
function grow(box, other) {
  for (let k = 0; k < 3; ++k) {
    box.low[k] = Math.min(box.low[k], other.low[k]);
    box.high[k] = Math.max(box.high[k], other.high[k]);
  }
}

// The box of what is drawn, {low, high}, by the number of a group's part (which: 0) or object (1).
function boxesBy(view, which) {
  const {cell, count} = drawnRecords(view), boxes = new Map();
  const groups = view.groups.map(() => ({low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity]}));
  for (let i = 0; i < 4 * count; i += 4) {
    const {low, high} = groups[cell[i + 3]];
    for (let k = 0; k < 3; ++k) {
      if (cell[i + k] < low[k]) low[k] = cell[i + k];
      if (cell[i + k] > high[k]) high[k] = cell[i + k];
    }
  }
  const place = (value, k) => view.origin_m[k] + view.step_m[k] * value;
  groups.forEach(({low, high}, g) => {
    if (!(low[0] <= high[0])) return;
    const key = view.groups[g][which], box = {low: low.map(place), high: high.map(place)};
    if (boxes.has(key)) grow(boxes.get(key), box);
    else boxes.set(key, box);
  });
  return boxes;
}

// The box that the plan shows: of all, and no object that can move, nor what may be furniture, lies outside.
function planBoxOf(scene) {
  const {low, high} = scene.boxes.get(null), out = {low: [...low], high: [...high]};
  for (const object of scene.objects) if (!object.grounded && scene.boxes.has(object.id)) grow(out, scene.boxes.get(object.id));
  for (const one of listedPieces(scene)) if (one.letter) grow(out, one.box);
  return out;
}

// Of all that is drawn: of the records' 2nd to 98th hundredths, since scans have strays.
function wholeBox(view) {
  const {cell, count} = drawnRecords(view), box = {low: [-0.5, -0.5, -0.5], high: [0.5, 0.5, 0.5]};
  if (!count) return box;
  const stride = Math.max(1, Math.floor(count / 20000));
  for (let k = 0; k < 3; ++k) {
    const values = [];
    for (let i = 0; i < count; i += stride) values.push(cell[4 * i + k]);
    values.sort((a, b) => a - b);
    const at = share => view.origin_m[k] + view.step_m[k] * values[Math.floor(share * (values.length - 1))];
    box.low[k] = at(0.02);
    box.high[k] = at(0.98);
  }
  return box;
}

// The height of the floor: the middle one of those that people walk on; where there is none, of the lowest that the scan has.
function floorOf(scene, boxes) {
  const {walks} = scene.view, heights = [];
  walks.shade.forEach((shade, at) => { if (shade) heights.push(walks.corner_m[2] + walks.floor_mm[at] / 1000); });
  if (!heights.length) return {height_m: boxes.get(null).low[2], known: false};
  heights.sort((a, b) => a - b);
  return {height_m: heights[heights.length >> 1], known: true};
}

// Of an object's middle, in metres from the plan's south-west corner, and how high it reaches; null where it is not drawn.
function planPlace(scene, object) {
  return boxPlace(scene, scene.boxes.get(object.id));
}

function boxPlace(scene, box) {
  if (!box) return null;
  const middle = k => (box.low[k] + box.high[k]) / 2 - scene.planBox.low[k], {height_m} = scene.floor;
  // What stands on the floor ends there, whatever strays below it.
  const from = box.low[2] - height_m;
  return {east: middle(0), north: middle(1), from: from > -0.15 && from < 1.5 * scene.voxel_size_m ? 0 : from, to: box.high[2] - height_m};
}

// "1.20 E, 0.45 N, 0.76 to 1.20 m high" of a box's middle; '' for none.
function placeInShort(scene, box) {
  const place = boxPlace(scene, box);
  return place ? `${metreText(place.east)} E, ${metreText(place.north)} N, ${metreText(place.from)} to ${metreText(place.to)} m high` : '';
}

const metreText = value => (Math.abs(value) < 0.005 ? 0 : value).toFixed(2).replace('-', '\u2212');

// "Held by object 3; 1.20 m east of the plan's left edge, 0.45 m north of its lower edge; 0.76 to 1.20 m above the floor"; '' where it is not drawn.
function placeText(scene, object) {
  const place = planPlace(scene, object);
  if (!place) return '';
  const held = heldText(scene, object, place);
  return capital(`${held ? held + '; ' : ''}${onPlan(place)}; ` +
    `${metreText(place.from)} to ${metreText(place.to)} m above ${scene.floor.known ? 'the floor' : 'the lowest that was scanned'}`);
}

function onPlan({east, north}) {
  return `${metreText(east)} m east of the plan\u2019s left edge, ${metreText(north)} m north of its lower edge`;
}

// What carries it, the nearest word for what is fixed.
function heldText(scene, object, place) {
  const on = object.grounded || object.seen_enough === false ? [] : object.why.stands_on || [];
  if (!on.length) return '';
  const low = place.from < 0.15;
  return 'held by ' + listed(on.map(id => scene.objectById.get(id).grounded ? (low && scene.floor.known ? 'the floor' : 'what is built in') : objectName(scene, id)));
}

// The same for a table: east and north, then heights.
function placeCell(scene, object) {
  const place = planPlace(scene, object);
  if (!place || object.grounded) return ['\u2013'];
  return [`${metreText(place.east)} E, ${metreText(place.north)} N,`, `${metreText(place.from)}\u2013${metreText(place.to)} up`]
    .map(text => element('span', {className: 'whole', text: text + ' '}));
}

// How far around it nobody should stay: where its middle lands, and half its longest side beyond. null where that is not known, and
// where the building stops it: nobody stays in its wall.
function keepClear(scene, object) {
  if (object.grounded || !fallKnown(object) || (scene.objectById.get(object.fall.leans_on) || {}).grounded) return null;
  const from = viewPlace(scene, object.center_of_mass_m.map(value => value || 0)), to = viewPlace(scene, object.fall.lands_m);
  const box = scene.boxes.get(object.id), size = object.size_m && object.size_m.every(value => value > 0) ? object.size_m : box && extentOf(box);
  if (!size) return null;
  return Math.hypot(to[0] - from[0], to[1] - from[1]) + Math.max(...size) / 2;
}

function keepClearText(scene, object) {
  const distance = keepClear(scene, object);
  if (distance === null) return '';
  const way = fallsTo(scene, object);
  return `Keep ${metres(Math.ceil(distance * 10) / 10)} clear${way}, measured from its middle: that far it reaches when it lands${object.fall.leans_on >= 0 ? ', should what stops it give way' : ''}.`;
}
