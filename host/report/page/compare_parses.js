// SPDX-License-Identifier: MIT
'use strict';

// Two parses of one scan, of which one was told more: what became of each object, by the parts that it has.

// The parts that both have, where one scan was parsed twice: of the other parse's numbers those of this; null for another scan.
// Segmentation comes before corrections, which group parts and leave out what is not there: the same file has the same
// parts in the same order, of as many points each, but for those that one of the two was told to leave out.
function commonParts(scene, other) {
  const file = path => String(path).replace(/^.*[\\/]/, '');
  if (file(scene.source) !== file(other.source) || scene.voxel_size_m !== other.voxel_size_m || !Array.isArray(other.primitives)) return null;
  const [fewer, more] = other.primitives.length < scene.primitives.length ? [other, scene] : [scene, other], common = new Map();
  let found = 0;
  for (const part of more.primitives) {
    const same = fewer.primitives[found];
    if (!same || same.points !== part.points || same.model !== part.model) continue;
    if (fewer === other) common.set(same.id, part.id);
    else common.set(part.id, same.id);
    ++found;
  }
  const leavesOut = (fewer.corrections || []).some(one => one.do === 'not_there' && one.held !== false);
  return found && found === fewer.primitives.length && (leavesOut || found === more.primitives.length) ? common : null;
}

// The parts of each object by this parse's numbers, with their points: Map of object to Map of part to points; one without any counts as one.
function pointsByObject(parsed, number = part => part.id) {
  const parts = new Map(parsed.primitives.map(part => [part.id, [number(part), Math.max(1, part.points)]]));
  return new Map(parsed.objects.map(object => [object, new Map((object.primitives || []).map(id => parts.get(id)).filter(part => part))]));
}

// " (correction 2)": those of some kinds that an object of the later parse follows; '' for none.
function followed(later, object, kinds) {
  const said = sentenceNumbers(later.corrections);
  const numbers = [...new Set((object.corrected || []).filter(n => kinds.includes(((later.corrections || [])[n - 1] || {}).do)).map(n => said[n - 1]))];
  return numbers.length ? ` (correction${numbers.length > 1 ? 's' : ''} ${listed(numbers.map(String))})` : '';
}

// Rows {first, last, verdict, text}: of the earlier parse and of the later one. verdict '' where its risks tell. partsOf: of all objects of
// both (pointsByObject); name(parse, object): what it is called; isSpotOf(correction, object): whether it is about an object
// of the earlier one.
function rowsByParts(earlier, later, partsOf, name, isSpotOf) {
  const shared = (a, b) => [...partsOf.get(a)].reduce((sum, [part, points]) => sum + (partsOf.get(b).has(part) ? points : 0), 0);
  const movable = side => side.objects.filter(object => !object.grounded), takenFirst = new Set(), takenLast = new Set();
  const pairs = bestPairs(movable(earlier).flatMap(a => movable(later).map(b => [shared(a, b), a, b])).filter(([points]) => points > 0), takenFirst, takenLast);
  const most = (objects, object) => objects.map(each => [shared(object, each), each]).filter(([points]) => points > 0)
    .sort(([p], [q]) => q - p).map(([, each]) => each)[0];
  const inside = (a, b) => [...partsOf.get(a).keys()].every(part => partsOf.get(b).has(part));
  const share = (side, from, to) => from.grounded ? 'part of the building' : inside(from, to) ? name(side, from) : `part of ${name(side, from)}`;
  const rows = pairs.map(([first, last]) => {
    const gained = earlier.objects.filter(each => each !== first && shared(each, last));
    const lost = later.objects.filter(each => each !== last && shared(each, first));
    const away = [...partsOf.get(first).keys()].some(part => !later.objects.some(each => partsOf.get(each).has(part)));
    const notes = [...gained.length ? [`with ${listed(gained.map(each => share(earlier, each, last)))}${followed(later, last, ['one_thing'])}`] : [],
      ...lost.length ? [`without what is now ${listed(lost.map(each => each.grounded ? 'part of the building' : name(later, each)))}${followed(later, last, ['apart'])}`] : [],
      ...away ? ['without what is not there'] : [],
      ...[['mass', 'of the mass that was given'], ['hollow', 'hollow, as was said'], ['name', 'named']].filter(([kind]) => followed(later, last, [kind])).map(([kind, what]) => what + followed(later, last, [kind]))];
    return {first, last, verdict: '', text: notes.join(', ')};
  });
  const gone = movable(earlier).filter(object => !takenFirst.has(object));
  const told = (object, kind) => (later.corrections || []).filter(one => one.do === kind && isSpotOf(one, object));
  const linked = (a, b) => a !== b && told(a, 'one_thing').some(one => told(b, 'one_thing').includes(one));
  // Of things that are one and fixed the largest, since a spot where both are may be of either.
  const points = object => shared(object, object), strapped = [];
  for (const object of gone.filter(each => told(each, 'fixed').length).sort((a, b) => points(b) - points(a)))
    if (!strapped.some(each => linked(each, object))) strapped.push(object);
  for (const first of gone) {
    const into = most(later.objects, first);
    if (!into) {
      const by = told(first, 'not_there')[0];
      rows.push({first, last: null, verdict: 'not there', text: by ? `(correction ${sentenceNumbers(later.corrections)[later.corrections.indexOf(by)]})` : ''});
    } else if (!into.grounded) {
      const by = followed(later, into, ['one_thing']);
      rows.push({first, last: null, verdict: by ? 'joined' : 'now part', text: by ? `to ${name(later, into)}${by}` : `of ${name(later, into)}`});
    } else if (strapped.includes(first)) {
      rows.push({first, last: null, verdict: 'fixed now', text: strapText(first)});
    } else {
      const withIt = strapped.filter(each => linked(each, first));
      rows.push(withIt.length ? {first, last: null, verdict: 'fixed now', text: `with ${listed(withIt.map(each => name(earlier, each)))}`} :
        {first, last: null, verdict: 'now part', text: 'of the building'});
    }
  }
  for (const last of movable(later).filter(object => !takenLast.has(object))) {
    const from = most(earlier.objects, last);
    rows.push({first: null, last, verdict: from ? 'parted' : 'new', text: from ? `from ${from.grounded ? 'the building' : name(earlier, from)}${followed(later, last, ['apart'])}` : ''});
  }
  return rows;
}
