// SPDX-License-Identifier: MIT
'use strict';

// The words that the page doesn't explain where they stand.
const glossary = {
  object: ['object', 'What moves as one body: all parts that are fixed to each other.'],
  ground: ['building (ground)', 'Floor, walls, ceiling and what is built in, with all that is fixed to them, or is counted as such: object 0. It is not judged.'],
  north: ['north', 'One of the room\u2019s own directions, as the compass of the view and the plan have it; not the earth\u2019s.'],
  part: ['part (primitive)', 'Pieces of surface that meet convexly, and the solid behind them: about one convex part of a thing. Objects are made of parts.'],
  support: ['support', 'That one object carries another; also the area that carries it.'],
  occluded: ['occluded', 'Hidden behind something from all places that the scan was taken from. What is solid there is inferred.'],
  barrier: ['energy barrier', 'The least energy, in joules, that moves an object out of its place for good: over its edge, or off what carries it. ' +
    'One joule lifts 1 kg by 10 cm.'],
  release: ['release', 'The energy, in joules, that the object sets free when it then falls. From about 40 J on injuries need more than first aid.'],
  instability: ['instability S(W)', 'How much energy S an object can release, once a disturbance has given it the energy W.'],
  disturbance: ['disturbance', 'What can upset things: people who walk by and touch them, wind, earthquakes.'],
  event: ['event', 'One happening of a disturbance: a walk through the room, a gale, an earthquake.'],
  risk: ['risk', 'The chance that one event upsets the object, times the energy that it then releases: joules to be expected per event.'],
  unsafety: ['unsafety', 'The risk as a mark from 1 to 10 within this scene: 10 is the largest risk that is here, even where that is harmless. It orders; act by the category.'],
  category: ['category', 'How unsafe an object is by itself, whatever else is in the scene: none, low, medium or high, by how likely ' +
    'one event makes it fall and how hard it then lands, at the worse end of the errors. Unsure: the better end says less. Act by it.'],
  advice: ['advice', 'What would bring the risk below what is tolerated. Where the category is none there is no need to act, whatever the risk.'],
  overturning: ['overturning', 'Tipping over an edge of the foot, once the centre of mass is beyond it.'],
  pose: ['pose', 'A way to stand or lie at rest. Between two poses lies a pass: the lowest that a body must be lifted to go from one to the other.'],
  basin: ['basin', 'All orientations from which a body comes back to the same pose.'],
  fragility: ['fragility', 'The chance that an object falls, by how strong the earthquake is.'],
  pga: ['peak (PGA), g', 'The strongest acceleration of the ground in an earthquake, as a multiple of gravity: things rattle at 0.05 g, buildings are damaged from about 0.2 g.'],
  error: ['\u00b1', 'One standard error: two times in three the true figure lies within it.'],
};

// The words of a term as a link to where it is explained; hovering says it at once.
function term(key, text) {
  return element('a', {className: 'term', href: '#word-' + key, title: glossary[key][1], text: text || glossary[key][0],
    onclick: () => { document.getElementById('about').open = true; }});
}

function fillGlossary() {
  const list = document.getElementById('glossary');
  for (const [key, [word, meaning]] of Object.entries(glossary)) {
    list.append(element('dt', {id: 'word-' + key, text: word, tabIndex: -1}), element('dd', {text: meaning}));
  }
}
