// SPDX-License-Identifier: MIT
'use strict';

// Which objects of two scans of a room are the same: by the boxes of what can move.

// Where a point of the other scene lies in this scene's view.
function otherPlace(scene, other, point) {
  return viewPlace(scene, point.map((value, k) => value + ((other.offset_m || [])[k] || 0) - ((scene.offset_m || [])[k] || 0)));
}

// The box of an object in this scene's view, about its middle: its size along the room's axes; null where it has none. Earlier
// versions wrote no middle: that of its mass is near it.
function comparedBox(scene, other, object) {
  const {size_m: size, box_middle_m: own, center_of_mass_m: ofMass} = object, middle = Array.isArray(own) ? own : ofMass;
  if (!Array.isArray(size) || !Array.isArray(middle) || ![...size, ...middle].every(Number.isFinite)) return null;
  const at = otherPlace(scene, other, middle);
  // A voxel at least: thin things that moved by less are still the same.
  return at.map((value, k) => {
    const half = Math.max(size[k], scene.voxel_size_m, 0.01) / 2;
    return [value - half, value + half];
  });
}

// Share of the two boxes together that both have.
function overlap(a, b) {
  if (!a || !b) return 0;
  const volume = box => box.reduce((product, [low, high]) => product * (high - low), 1);
  const both = a.reduce((product, [low, high], k) => product * Math.max(0, Math.min(high, b[k][1]) - Math.max(low, b[k][0])), 1);
  return both / (volume(a) + volume(b) - both);
}

// Share of the first box that lies in the second.
function shareWithin(a, b) {
  if (!a || !b) return 0;
  return a.reduce((share, [low, high], k) => share * Math.max(0, Math.min(high, b[k][1]) - Math.max(low, b[k][0])) / (high - low), 1);
}

// How far a box moved, at least: along each axis both of its ends went the same way by so much. An end that a scan saw and the other
// did not, or that was completed otherwise, moves nothing.
function leastShift(a, b) {
  return Math.hypot(...a.map(([low, high], k) => {
    const ends = [b[k][0] - low, b[k][1] - high];
    return ends[0] * ends[1] > 0 ? Math.min(...ends.map(Math.abs)) : 0;
  }));
}

// How far it was carried: its middle on the plan, and what it stands with in height.
function shift(a, b) {
  const middle = box => [(box[0][0] + box[0][1]) / 2, (box[1][0] + box[1][1]) / 2, box[2][0]], to = middle(b);
  return Math.hypot(...middle(a).map((value, k) => to[k] - value));
}

// What no error may exceed, as a share of the larger: beyond it any two things would be alike.
const mostDoubt = 1 / 3;

// By how much two sizes along one axis may differ and yet be the same: a voxel at each end, and what is not known of their feet.
function sizeError(scene, other, a, b) {
  return scene.voxel_size_m + other.voxel_size_m + 2 * Math.hypot(a.footprint_error_m || 0, b.footprint_error_m || 0);
}

// The sides of both, those on the plan by length where one may be turned by a quarter; null where they are not known.
function sidesOf(a, b, turned) {
  if (![a, b].every(object => Array.isArray(object.size_m) && object.size_m.every(Number.isFinite))) return null;
  const sides = ({size_m: size}) => turned ? size.slice(0, 2).sort((p, q) => p - q).concat(size[2]) : size, two = sides(b);
  return sides(a).map((value, k) => [value, two[k]]);
}

// What tells two objects apart that are to be the same, whatever disturbs them: 'size', 'mass', both or none. elsewhere: their places
// do not speak for it, so that their sides must: each is known to a third. One may be turned by a quarter.
function unlike(scene, other, a, b, elsewhere) {
  const sides = sidesOf(a, b, elsewhere), error = sizeError(scene, other, a, b), out = [];
  const fits = ([one, two]) => {
    const larger = Math.max(one, two);
    return !(elsewhere && error > mostDoubt * larger) && Math.abs(one - two) <= Math.max(error, 0.05 * larger);
  };
  if (!sides || !sides.every(fits)) out.push('size');
  const heavier = Math.max(a.mass_kg, b.mass_kg), doubt = 2 * Math.hypot(a.mass_error_kg || 0, b.mass_error_kg || 0);
  if (!(Math.abs(a.mass_kg - b.mass_kg) <= Math.max(Math.min(doubt, mostDoubt * heavier), 0.1 * heavier))) out.push('mass');
  return out;
}

// How alike two shapes are, from 0 to 1: 0 where a side differs by more than a third, or one's solid is more than twice the other's.
function likeness(scene, other, a, b) {
  const sides = sidesOf(a, b, true), volume = (side, object) => {
    const parts = new Set(object.primitives);
    return (side.primitives || []).reduce((sum, part) => sum + (parts.has(part.id) ? part.volume_m3 : 0), 0);
  };
  if (!sides) return 0;
  const ratio = ([p, q]) => Math.min(p, q) / Math.max(p, q), solids = ratio([volume(scene, a), volume(other, b)]), ratios = sides.map(ratio);
  if (!ratios.every(value => value >= 1 - mostDoubt) || !(solids >= 0.5)) return 0;
  return ratios.reduce((product, value) => product * value, solids);
}

// Takes pairs from the best on, each object once: [score, a, b].
function bestPairs(scored, takenA, takenB) {
  scored.sort((p, q) => q[0] - p[0] || p[1].id - q[1].id || p[2].id - q[2].id);
  const pairs = [];
  for (const [, a, b] of scored) {
    if (takenA.has(a) || takenB.has(b)) continue;
    takenA.add(a);
    takenB.add(b);
    pairs.push([a, b]);
  }
  return pairs;
}

// What became of each object that can move, in one parse or the other: {mine, theirs, as, differs, far}. as: 'same' where place, size and
// mass are alike, or 'moved' where they are elsewhere; 'apart' where what overlaps has another extent, so that the scans may have
// been told apart differently; 'perhaps' where only the shapes are alike, elsewhere; 'fixed' and 'alone'. far: metres that it was carried, 0 where it was
// not. isFixed(box): of one of the earlier parse.
function matchObjects(scene, other, earlier, isFixed) {
  const movable = objects => objects.filter(object => !object.grounded);
  const mine = movable(scene.objects), theirs = movable(other.objects), takenA = new Set(), takenB = new Set(), rows = [];
  const boxes = new Map([...mine.map(o => [o, comparedBox(scene, scene, o)]), ...theirs.map(o => [o, comparedBox(scene, other, o)])]);
  const leftA = () => mine.filter(a => !takenA.has(a)), leftB = () => theirs.filter(b => !takenB.has(b));
  const scored = score => leftA().flatMap(a => leftB().map(b => [score(a, b), a, b])).filter(([value]) => value > 0);
  const overlapping = (a, b) => { const share = overlap(boxes.get(a), boxes.get(b)); return share > 0.1 ? share : 0; };
  const carried = (a, b) => leastShift(boxes.get(a), boxes.get(b)) > sizeError(scene, other, a, b);
  const take = (as, score) => rows.push(...bestPairs(scored(score), takenA, takenB).map(([a, b]) => {
    const far = carried(a, b) ? shift(boxes.get(a), boxes.get(b)) : 0, perhaps = as === 'apart' && far && likeness(scene, other, a, b);
    return {mine: a, theirs: b, as: perhaps ? 'perhaps' : as, far, differs: as === 'apart' ? unlike(scene, other, a, b) : []};
  }));
  take('same', (a, b) => unlike(scene, other, a, b).length ? 0 : overlapping(a, b));
  for (const object of earlier === scene ? leftA() : leftB()) {
    if (!isFixed(boxes.get(object))) continue;
    (earlier === scene ? takenA : takenB).add(object);
    rows.push({mine: earlier === scene ? object : null, theirs: earlier === scene ? null : object, as: 'fixed', differs: []});
  }
  // Not where something else overlaps one of them, which may be it.
  const free = new Set([...leftA().filter(a => !leftB().some(b => overlapping(a, b))), ...leftB().filter(b => !leftA().some(a => overlapping(a, b)))]);
  const elsewhere = (a, b) => boxes.get(a) && boxes.get(b) && carried(a, b);
  take('moved', (a, b) => free.has(a) && free.has(b) && elsewhere(a, b) && !unlike(scene, other, a, b, true).length ? 1 / (1e-3 + shift(boxes.get(a), boxes.get(b))) : 0);
  take('apart', overlapping);
  // Of shapes about as alike the nearer.
  take('perhaps', (a, b) => elsewhere(a, b) ? likeness(scene, other, a, b) / (1 + shift(boxes.get(a), boxes.get(b))) : 0);
  // Pieces of what was told apart otherwise.
  const split = rows.filter(row => row.as === 'apart');
  for (const [left, taken, key, of] of [[leftA(), takenA, 'mine', 'theirs'], [leftB(), takenB, 'theirs', 'mine']]) {
    for (const object of left) {
      const row = split.find(each => shareWithin(boxes.get(object), boxes.get(each[of])) > 0.5);
      if (!row) continue;
      taken.add(object);
      rows.push({mine: null, theirs: null, [key]: object, as: 'apart', differs: ['size'], piece: true});
    }
  }
  for (const a of leftA()) rows.push({mine: a, theirs: null, as: 'alone', differs: []});
  for (const b of leftB()) rows.push({mine: null, theirs: b, as: 'alone', differs: []});
  return rows;
}

// Of an object that only one of the two scans has, the one of the other scan that it may be part of there, or null: what has parts in
// its place that are as large together, or what stands where it stood, but has gained as much solid and reaches further. side, far: the
// scenes of the object and of the other; stayed(other): what an object of the other scene is in the object's, where it stands there, too.
function mayBePartOf(scene, side, far, object, stayed) {
  const solids = (of, has) => (of.primitives || []).reduce((sum, part) => sum + (has(part) ? part.volume_m3 || 0 : 0), 0);
  const of = whose => part => part.object === whose.id, own = solids(side, of(object)), place = comparedBox(scene, side, object), found = [];
  if (!place || !(own > 0)) return null;
  const slack = side.voxel_size_m + far.voxel_size_m;
  const inPlace = part => otherPlace(scene, far, part.center_of_mass_m).every((value, k) => value >= place[k][0] - slack && value <= place[k][1] + slack);
  const reachesOn = (box, before) => !!box && !!before && box.some(([low, high], k) => low < before[k][0] - slack || high > before[k][1] + slack);
  for (const other of far.objects) {
    const before = other.grounded ? null : stayed(other);
    const solid = [solids(far, part => of(other)(part) && inPlace(part))];
    if (before && reachesOn(comparedBox(scene, far, other), comparedBox(scene, side, before))) solid.push(solids(far, of(other)) - solids(side, of(before)));
    const alike = Math.max(...solid.map(value => value > 0 ? Math.min(value, own) / Math.max(value, own) : 0));
    if (alike >= 0.5) found.push([alike, other]);
  }
  found.sort(([p, a], [q, b]) => q - p || a.id - b.id);
  return found.length ? found[0][1] : null;
}

// Whether two objects stand on the same: on the building, or on what was matched.
function heldAlike(scene, other, a, b, match) {
  const grounded = new Set(other.objects.filter(object => object.grounded).map(object => object.id));
  const on = object => (object.why || {}).stands_on || [];
  const one = new Set(on(a).map(id => { const below = scene.objectById.get(id); return !below || below.grounded ? -1 : match.get(below); }));
  const two = new Set(on(b).map(id => grounded.has(id) ? -1 : id));
  // An edge of a neighbour may hold it in one scan and not in the other.
  return [...one].some(id => two.has(id)) || !one.size && !two.size;
}
