// SPDX-License-Identifier: MIT
'use strict';

// What of the building may be a thing, and so is not judged among the objects: those that would matter, which endanger most first, with
// parts and box. The first have letters: on the page, in print, on the plan and in the printed picture.
const listedFurniture = 6;
function listedPieces(scene) {
  if (scene.furniture) return scene.furniture;
  const boxOf = one => one.primitives.map(part => scene.partBoxes.get(part)).filter(box => box)
    .reduce((all, box) => (grow(all, box), all), {low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity]});
  scene.furniture = (scene.possible_things || []).filter(one => one.unsafety_category && one.unsafety_category !== 'none')
    .map((one, n) => ({...one, parts: one.primitives, box: boxOf(one), letter: n < listedFurniture ? String.fromCharCode(65 + n) : ''}));
  return scene.furniture;
}

// "0.40 \u00d7 2.60 \u00d7 1.90 m, at 1.20 E, 3.00 N, 0.00 to 1.90 m high: 45 % likely a thing; then 35 J upset it: high"
function furnitureText(scene, {box, size_m: size, probability, barrier_J: barrier, unsafety_category: category}) {
  return `${[sizeText({size_m: size}), placeInShort(scene, box)].join(', at ')}: ${Math.round(100 * probability)} % likely a thing; then ${number(barrier)} J upset it: ${category}`;
}

// On the page: how to tell that it is no building. tick(parts, box): chooses them.
function fillFurniture(panel, scene, tick) {
  const found = listedPieces(scene);
  if (!scene.objects.some(object => object.grounded)) return;
  const group = cardGroup(`Counted as the building${found.length ? ` (${found.length} may be ${found.length === 1 ? 'a thing' : 'things'})` : ''}`, [element('p', {className: 'hint', text:
    'What is palest in the view is not judged: it is counted as the building, or as fixed to it. If you see furniture in grey, tick its parts below the view and say \u201ca thing by itself\u201d.' +
    (found.length ? ` ${found.length === 1 ? 'This' : 'These'} may be ${found.length === 1 ? 'a thing' : 'things'}:` : '')})]);
  panel.append(group);
  if (!found.length) return;
  group.append(element('ul', {className: 'furniture'}, found.slice(0, listedFurniture).map(one => element('li', {}, [element('strong', {text: `${one.letter}: `}), `${furnitureText(scene, one)} `,
    element('button', {type: 'button', text: one.parts.length > 1 ? `tick its ${one.parts.length} parts` : 'tick it', onclick: () => tick(one.parts, one.box)})]))),
  ...found.length > listedFurniture ? [element('p', {className: 'hint', text: `And ${found.length - listedFurniture} others.`})] : []);
}
