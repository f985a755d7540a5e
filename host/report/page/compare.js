// SPDX-License-Identifier: MIT
'use strict';

// Another parse of the same room beside this one: which objects became safer.

// The scene in a scene.json or a report.html; throws an Error that says what is wrong.
function readScene(name, text) {
  let json = text;
  if (/^\s*</.test(text)) {
    const inlined = text.match(/<script type="application\/json" id="data">([^]*?)<\/script>/);
    if (!inlined) throw new Error(`${name} is a web page, but no report of topple.`);
    json = inlined[1];
  }
  let scene;
  try {
    scene = JSON.parse(json);
  } catch (error) {
    throw new Error(`${name} is neither a report.html nor a scene.json: ${error.message}`);
  }
  if (!scene || !String(scene.schema).startsWith('topple.scene/') || !Array.isArray(scene.objects)) {
    throw new Error(`${name} is no scene of topple: it has no objects, or not the schema topple.scene/1.`);
  }
  return scene;
}

// Where a point of the other scene lies in this scene's view.
function otherPlace(scene, other, point) {
  return viewPlace(scene, point.map((value, k) => value + ((other.offset_m || [])[k] || 0) - ((scene.offset_m || [])[k] || 0)));
}

// The box of an object in this scene's view: its size along the room's axes, about its middle of mass; null where it has none.
function comparedBox(scene, other, object) {
  const {size_m: size, center_of_mass_m: middle} = object;
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

// By how much two sizes along one axis may differ and yet be the same: a voxel at each end, and what is not known of their feet.
function sizeError(scene, other, a, b) {
  return scene.voxel_size_m + other.voxel_size_m + 2 * Math.hypot(a.footprint_error_m || 0, b.footprint_error_m || 0);
}

// What tells two objects apart that are to be the same, whatever disturbs them: 'size', 'mass', both or none. turned: one may be turned by a quarter.
function unlike(scene, other, a, b, turned) {
  const known = [a, b].every(object => Array.isArray(object.size_m) && object.size_m.every(Number.isFinite));
  const error = sizeError(scene, other, a, b), sides = object => object.size_m.slice(0, 2).sort((p, q) => p - q).concat(object.size_m[2]);
  const [one, two] = known ? turned ? [sides(a), sides(b)] : [a.size_m, b.size_m] : [[], []], out = [];
  if (!known || one.some((value, k) => Math.abs(value - two[k]) > Math.max(error, 0.05 * Math.max(value, two[k])))) out.push('size');
  const heavier = Math.max(a.mass_kg, b.mass_kg);
  if (!(Math.abs(a.mass_kg - b.mass_kg) <= Math.max(2 * Math.hypot(a.mass_error_kg || 0, b.mass_error_kg || 0), 0.1 * heavier))) out.push('mass');
  return out;
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

// What became of each object that can move, in one parse or the other: {mine, theirs, as, differs}. as: 'same' where place, size and
// mass are alike; 'moved' where size and mass are, elsewhere; 'apart' where what overlaps has another extent, so that the
// scans may have been told apart differently; 'fixed' and 'alone'. isFixed(object, box): of one of the earlier parse.
function matchObjects(scene, other, earlier, isFixed) {
  const movable = objects => objects.filter(object => !object.grounded);
  const mine = movable(scene.objects), theirs = movable(other.objects), takenA = new Set(), takenB = new Set(), rows = [];
  const boxes = new Map([...mine.map(o => [o, comparedBox(scene, scene, o)]), ...theirs.map(o => [o, comparedBox(scene, other, o)])]);
  const leftA = () => mine.filter(a => !takenA.has(a)), leftB = () => theirs.filter(b => !takenB.has(b));
  const scored = score => leftA().flatMap(a => leftB().map(b => [score(a, b), a, b])).filter(([value]) => value > 0);
  const overlapping = (a, b) => { const share = overlap(boxes.get(a), boxes.get(b)); return share > 0.1 ? share : 0; };
  const take = (as, score) => rows.push(...bestPairs(scored(score), takenA, takenB).map(([a, b]) =>
    ({mine: a, theirs: b, as, differs: as === 'apart' ? unlike(scene, other, a, b) : []})));
  take('same', (a, b) => unlike(scene, other, a, b).length ? 0 : overlapping(a, b));
  for (const object of earlier === scene ? leftA() : leftB()) {
    if (!isFixed(object, boxes.get(object))) continue;
    (earlier === scene ? takenA : takenB).add(object);
    rows.push({mine: earlier === scene ? object : null, theirs: earlier === scene ? null : object, as: 'fixed', differs: []});
  }
  // Not where something else overlaps one of them, which may be it.
  const free = new Set([...leftA().filter(a => !leftB().some(b => overlapping(a, b))), ...leftB().filter(b => !leftA().some(a => overlapping(a, b)))]);
  take('moved', (a, b) => free.has(a) && free.has(b) && boxes.get(a) && boxes.get(b) && !unlike(scene, other, a, b, true).length ? 1 / (1e-3 + shift(scene, other, a, b)) : 0);
  take('apart', overlapping);
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

// How far apart the middles of two objects are.
function shift(scene, other, a, b) {
  const at = otherPlace(scene, other, b.center_of_mass_m), from = otherPlace(scene, scene, a.center_of_mass_m);
  return Math.hypot(...at.map((value, k) => value - from[k]));
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

// The largest risk and its error; of disturbances that both parses reckoned with.
function comparedRisk(object, names) {
  const name = names.reduce((worst, next) => (object.risk_J[next] || 0) > (object.risk_J[worst] || 0) ? next : worst, names[0]);
  return {risk: object.risk_J[name] || 0, error: riskError(object, name) || 0, unknown: object.seen_enough === false};
}

// 'safer', 'less safe', 'alike' within two standard errors, or 'unknown'.
function verdict(before, after) {
  if (before.unknown || after.unknown) return 'unknown';
  const change = after.risk - before.risk;
  if (Math.abs(change) <= Math.max(2 * Math.hypot(before.error, after.error), 0.01 * Math.max(before.risk, after.risk))) return 'alike';
  return change < 0 ? 'safer' : 'less safe';
}

// Whether a later parse was told that what stood in an object's place is fixed to the building.
function fixedBy(corrections, scene, other, box) {
  const margin = 2 * scene.voxel_size_m;
  return !!box && (corrections || []).some(one => one.do === 'fixed' && one.held !== false && (one.at_m || []).some(spot => {
    const at = otherPlace(scene, other, spot);
    return at.every((value, k) => value >= box[k][0] - margin && value <= box[k][1] + margin);
  }));
}

// Rows for the table: {mine, theirs, before, after, verdict, note}, what changed most first.
function compareScenes(scene, other, otherIsBefore) {
  const reckoned = objects => new Set(objects.flatMap(object => Object.keys(object.risk_J || {})));
  const theirs = reckoned(other.objects), names = scene.disturbances.filter(name => theirs.has(name));
  const later = otherIsBefore ? scene : other, earlier = otherIsBefore ? other : scene;
  const matched = matchObjects(scene, other, earlier, (object, box) => fixedBy(later.corrections, scene, later, box));
  const match = new Map(matched.filter(row => row.mine && row.theirs).map(row => [row.mine, row.theirs.id]));
  const rows = matched.map(row => {
    const [first, last] = otherIsBefore ? [row.theirs, row.mine] : [row.mine, row.theirs];
    const before = first && comparedRisk(first, names), after = last && comparedRisk(last, names);
    return {...row, before, after, ...outcome(scene, other, row, before, after, first, match)};
  });
  const change = row => Math.abs((row.after ? row.after.risk : 0) - (row.before ? row.before.risk : 0));
  const order = ['less safe', 'new', 'moved', 'safer', 'fixed now', 'gone', 'told apart differently', 'unknown', 'alike'];
  rows.sort((p, q) => order.indexOf(p.verdict) - order.indexOf(q.verdict) || change(q) - change(p));
  return {rows, names};
}

// Of a row: what became of it, in a word, and a note on it.
function outcome(scene, other, row, before, after, first, match) {
  if (row.as === 'fixed') {
    const hold = (first.advice || {}).hold_N;
    return {verdict: 'fixed now', note: `which holds only while its strap does${hold > 0 ? ` (${forceText(hold)} at least)` : ''}`};
  }
  if (row.as === 'alone') return {verdict: before ? 'gone' : 'new', note: ''};
  if (row.as === 'apart') return {verdict: 'told apart differently', note: row.piece ? 'a piece of something else there' : `other ${listed(row.differs) || 'extent'}`};
  const {mine: a, theirs: b} = row, moved = shift(scene, other, a, b), far = sizeError(scene, other, a, b);
  const held = heldAlike(scene, other, a, b, match), became = verdict(before, after);
  if (row.as === 'moved' || moved > far && !held) return {verdict: 'moved', note: `by ${metres(moved)}`};
  if (!held) return {verdict: 'told apart differently', note: 'what holds it'};
  if (moved <= far) return {verdict: became, note: ''};
  return became === 'safer' || became === 'less safe' ? {verdict: became, note: `moved by ${metres(moved)}`} : {verdict: 'moved', note: `by ${metres(moved)}`};
}

class ComparePanel {
  // recolour(): objects have other colours.
  constructor(scene, choose, say, recolour) {
    this.recolour = recolour;
    this.scene = scene;
    this.choose = choose;
    this.say = say;
    this.file = document.getElementById('compare-file');
    this.out = document.getElementById('compare-result');
    this.order = document.getElementById('compare-order');
    this.file.addEventListener('change', () => {
      const file = this.file.files[0];
      if (file) file.text().then(text => this.read(file.name, text));
    });
    this.order.addEventListener('change', () => this.show());
  }

  read(name, text) {
    try {
      this.other = readScene(name, text);
      this.name = name;
      this.show();
    } catch (error) {
      this.other = null;
      this.out.replaceChildren(element('p', {className: 'warning', text: error.message}));
      this.say(error.message);
    }
  }

  show() {
    if (!this.other) return;
    const {rows, names} = compareScenes(this.scene, this.other, this.order.value === 'before');
    const count = what => rows.filter(row => row.verdict === what).length;
    const line = rows.some(row => row.mine && row.theirs) ? '' :
      'No object of one is where one of the other is: are both of the same room, in the same frame? ';
    const counts = `${count('safer')} safer, ${count('less safe')} less safe, ${count('alike')} as before within the errors, ` +
      `${count('moved')} moved, ${count('new')} new, ${count('gone')} gone` + ['fixed now', 'told apart differently'].filter(count).map(what => `, ${count(what)} ${what}`).join('') +
      (count('unknown') ? `, ${count('unknown')} not known` : '') + '.';
    const risk = side => !side ? '\u2013' : side.unknown ? 'not known' : number(side.risk) + within(side.error);
    const body = rows.map(row => {
      const id = row.mine ? row.mine.id : null;
      const name = row.mine ? objectName(this.scene, id) : `their ${row.theirs.name || 'object ' + row.theirs.id}`;
      const words = {alike: 'as before', unknown: 'not known'}[row.verdict] || row.verdict;
      return element('tr', {className: row.verdict.replace(/ /g, '-')}, [
        element('th', {scope: 'row'}, [id === null ? name : element('button', {type: 'button', text: name, onclick: () => this.choose(id)})]),
        element('td', {className: 'text', text: row.theirs ? row.theirs.name || 'object ' + row.theirs.id : '\u2013'}),
        element('td', {text: risk(row.before)}), element('td', {text: risk(row.after)}), element('td', {className: 'text', text: words + (row.note ? `: ${row.note}` : '')})]);
    });
    const head = ['Object here', `In ${this.name}`, 'Risk before (J)', 'Risk after (J)', 'Became'].map((text, i) =>
      element('th', {scope: 'col', text, className: i === 2 || i === 3 ? '' : 'text'}));
    this.out.replaceChildren(element('p', {className: 'warning', text: 'The two scans may have been told apart differently; \u00b1 does not cover that: look at both pictures before believing a change.'}),
      element('p', {className: 'counts', text: line + counts}),
      element('div', {className: 'scroll', tabIndex: 0, role: 'region', 'aria-label': 'Objects of both parses'}, [
        element('table', {}, [element('thead', {}, [element('tr', {}, head)]), element('tbody', {}, body)])]),
      element('p', {className: 'hint', text: `Objects are the same where their boxes overlap by a tenth or more, and size, mass and what holds them are alike within the errors: only of these ` +
        `is said whether they became safer. Moved: of equal size and mass, elsewhere. Gone and new may also be one thing that was moved and then told apart otherwise, or what one of the parses took for part of the building. Risk is the largest of ` +
        `${listed(names.map(causeOf)) || 'none that both parses have'}, in joules per event; a change within two standard errors is none. Objects have the colours of ${this.name} now, whose numbers are beside theirs.`}));
    this.say(line + counts);
    this.takeColours(rows);
  }

  // What is the same thing has the colour that it has in the other report; what is not, one that none of those has.
  takeColours(rows) {
    const {scene} = this, taken = new Map(rows.filter(row => row.mine && row.theirs && scene.colours[row.theirs.id]).map(row => [row.mine.id, row.theirs.id]));
    const used = new Set([...taken.values(), ...rows.filter(row => row.theirs).map(row => row.theirs.id)]);
    const free = scene.colours.map((colour, id) => id).filter(id => !used.has(id));
    for (const {mine} of rows) {
      if (!mine || taken.has(mine.id)) continue;
      const own = free.includes(mine.id) ? mine.id : free[0];
      if (own === undefined) continue;
      taken.set(mine.id, own);
      free.splice(free.indexOf(own), 1);
    }
    scene.colourFrom = taken;
    this.recolour();
  }
}
