// SPDX-License-Identifier: MIT
'use strict';

// What of the building may be furniture that a wall's surface was found to go on in, and so is not judged.

// How far before a wall the front of furniture stands: no less than what is a wall's own roughness, no more than things along a wall are deep.
const furnitureDepth_m = [0.12, 0.9], furnitureHeight_m = 0.4, furnitureWidth_m = 0.3;
const listedFurniture = 6;

// Upright pieces of the building that have other upright pieces of it behind them, seen from the room's middle: the largest first, as
// {part, parts, box, size_m}, but for what was said to be fixed. parts: those that lie between its front and that wall.
function mayBeFurniture(scene) {
  const pieces = scene.primitives.filter(part => (scene.objectById.get(part.object) || {}).grounded && scene.partBoxes.has(part.id))
    .map(part => ({part: part.id, box: scene.partBoxes.get(part.id)}));
  const whole = scene.boxes.get(null), extent = (box, k) => extentOf(box)[k], faces = [];
  for (const piece of pieces) {
    const {box} = piece, across = extent(box, 0) < extent(box, 1) ? 0 : 1, along = 1 - across;
    if (extent(box, 2) < 2 * furnitureDepth_m[0] || extent(box, across) > furnitureDepth_m[1]) continue;
    const middle = k => (box.low[k] + box.high[k]) / 2, out = Math.sign(middle(across) - (whole.low[across] + whole.high[across]) / 2) || 1;
    faces.push({...piece, across, along, out, middle: middle(across), front: out > 0 ? box.low[across] : box.high[across], back: out > 0 ? box.high[across] : box.low[across]});
  }
  const upright = faces.filter(({box, along}) => extent(box, 2) >= furnitureHeight_m && extent(box, along) >= furnitureWidth_m), top = Math.max(...faces.map(({box}) => box.high[2]));
  const found = [], strapped = (scene.corrections || []).filter(one => one.do === 'fixed' && one.held !== false).flatMap(one => one.at_m.map(spot => viewPlace(scene, spot)));
  for (const one of upright) {
    if (strapped.some(at => at.every((value, k) => value >= one.box.low[k] - scene.voxel_size_m && value <= one.box.high[k] + scene.voxel_size_m))) continue;
    // Where it goes up as far as walls do it is one, before another.
    if (extent(one.box, 2) > 2.2 && one.box.high[2] > top - 0.1) continue;
    const before = other => one.out * (other.back - one.front), shared = other => Math.min(one.box.high[one.along], other.box.high[one.along]) - Math.max(one.box.low[one.along], other.box.low[one.along]);
    const walls = faces.filter(other => other !== one && other.across === one.across && other.out === one.out && one.out * (other.middle - one.middle) > furnitureDepth_m[0] / 2 &&
      before(other) >= furnitureDepth_m[0] && before(other) <= furnitureDepth_m[1] && shared(other) >= 0.1);
    if (!walls.length) continue;
    const wall = Math.max(...walls.map(before)), margin = 2 * scene.voxel_size_m, low = [...one.box.low], high = [...one.box.high];
    if (one.out > 0) high[one.across] = one.front + wall;
    else low[one.across] = one.front - wall;
    const inside = ({box}) => box.low.every((value, k) => value >= low[k] - margin && box.high[k] <= high[k] + margin);
    found.push({part: one.part, parts: pieces.filter(piece => piece.part === one.part || inside(piece)).map(piece => piece.part), box: {low, high},
      size_m: extentOf({low, high}), face_m2: extent(one.box, one.along) * extent(one.box, 2)});
  }
  found.sort((a, b) => b.face_m2 - a.face_m2 || a.part - b.part);
  // What lies within one that is listed is of that.
  return found.filter((one, n) => !found.slice(0, n).some(larger => larger.parts.includes(one.part)));
}

// Those that are listed, A, B, C, ...: on the page, in print, on the plan and in the printed picture.
function listedPieces(scene) {
  if (!scene.furniture) scene.furniture = mayBeFurniture(scene).map((one, n) => ({...one, letter: n < listedFurniture ? String.fromCharCode(65 + n) : ''}));
  return scene.furniture;
}

// "0.40 \u00d7 2.60 \u00d7 1.90 m, at 1.20 E, 3.00 N, 0.00 to 1.90 m high"
function furnitureText(scene, {box, size_m: size}) {
  return [sizeText({size_m: size}), placeInShort(scene, box)].join(', at ');
}

// On the page: how to tell that it is no building. tick(parts, box): chooses them.
function fillFurniture(panel, scene, tick) {
  const found = listedPieces(scene);
  if (!scene.objects.some(object => object.grounded)) return;
  const group = cardGroup(`Counted as the building${found.length ? ` (${found.length} may be furniture)` : ''}`, [element('p', {className: 'hint', text:
    'What is palest in the view is not judged: it is counted as the building, or as fixed to it. If you see furniture in grey, tick its parts below the view and say \u201ca thing by itself\u201d.' +
    (found.length ? ` ${found.length === 1 ? 'This stands' : 'These stand'} before a wall, and may be furniture:` : '')})]);
  panel.append(group);
  if (!found.length) return;
  group.append(element('ul', {className: 'furniture'}, found.slice(0, listedFurniture).map(one => element('li', {}, [element('strong', {text: `${one.letter}: `}), `${furnitureText(scene, one)} `,
    element('button', {type: 'button', text: one.parts.length > 1 ? `tick its ${one.parts.length} parts` : 'tick it', onclick: () => tick(one.parts, one.box)})]))),
  ...found.length > listedFurniture ? [element('p', {className: 'hint', text: `And ${found.length - listedFurniture} smaller.`})] : []);
}
