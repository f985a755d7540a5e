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

// Pairs [this object, the other's], what overlaps most first; each is in one pair. Those left over are in pairs with null.
function matchObjects(scene, other) {
  const movable = objects => objects.filter(object => !object.grounded);
  const mine = movable(scene.objects), theirs = movable(other.objects);
  const boxes = new Map([...mine.map(o => [o, comparedBox(scene, scene, o)]), ...theirs.map(o => [o, comparedBox(scene, other, o)])]);
  const couples = [];
  for (const a of mine) {
    for (const b of theirs) {
      const share = overlap(boxes.get(a), boxes.get(b));
      if (share > 0.1) couples.push([share, a, b]);
    }
  }
  couples.sort((p, q) => q[0] - p[0] || p[1].id - q[1].id || p[2].id - q[2].id);
  const taken = new Set(), pairs = [];
  for (const [, a, b] of couples) {
    if (taken.has(a) || taken.has(b)) continue;
    taken.add(a).add(b);
    pairs.push([a, b]);
  }
  for (const a of mine) if (!taken.has(a)) pairs.push([a, null]);
  for (const b of theirs) if (!taken.has(b)) pairs.push([null, b]);
  return pairs;
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

// Rows for the table: {mine, theirs, before, after, verdict}, what changed most first.
function compareScenes(scene, other, otherIsBefore) {
  const reckoned = objects => new Set(objects.flatMap(object => Object.keys(object.risk_J || {})));
  const theirs = reckoned(other.objects), names = scene.disturbances.filter(name => theirs.has(name));
  const rows = matchObjects(scene, other).map(([a, b]) => {
    const [first, last] = otherIsBefore ? [b, a] : [a, b];
    const before = first && comparedRisk(first, names), after = last && comparedRisk(last, names);
    const later = otherIsBefore ? scene : other;
    const gone = () => fixedBy(later.corrections, scene, later, comparedBox(scene, otherIsBefore ? other : scene, first)) ? 'fixed now' : 'gone';
    return {mine: a, theirs: b, before, after, verdict: !first ? 'new' : !last ? gone() : verdict(before, after)};
  });
  const change = row => Math.abs((row.after ? row.after.risk : 0) - (row.before ? row.before.risk : 0));
  const order = ['less safe', 'new', 'safer', 'fixed now', 'gone', 'unknown', 'alike'];
  rows.sort((p, q) => order.indexOf(p.verdict) - order.indexOf(q.verdict) || change(q) - change(p));
  return {rows, names};
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
      `${count('new')} new, ${count('gone')} gone` + (count('fixed now') ? `, ${count('fixed now')} fixed now` : '') + (count('unknown') ? `, ${count('unknown')} not known` : '') + '.';
    const risk = side => !side ? '\u2013' : side.unknown ? 'not known' : number(side.risk) + within(side.error);
    const body = rows.map(row => {
      const id = row.mine ? row.mine.id : null;
      const name = row.mine ? objectName(this.scene, id) : `their ${row.theirs.name || 'object ' + row.theirs.id}`;
      const words = row.verdict === 'alike' ? 'as before' : row.verdict;
      return element('tr', {className: row.verdict.replace(' ', '-')}, [
        element('th', {scope: 'row'}, [id === null ? name : element('button', {type: 'button', text: name, onclick: () => this.choose(id)})]),
        element('td', {className: 'text', text: row.theirs ? row.theirs.name || 'object ' + row.theirs.id : '\u2013'}),
        element('td', {text: risk(row.before)}), element('td', {text: risk(row.after)}), element('td', {className: 'text', text: words})]);
    });
    const head = ['Object here', `In ${this.name}`, 'Risk before (J)', 'Risk after (J)', 'Became'].map((text, i) =>
      element('th', {scope: 'col', text, className: i === 2 || i === 3 ? '' : 'text'}));
    this.out.replaceChildren(element('p', {text: line + counts}),
      element('div', {className: 'scroll', tabIndex: 0, role: 'region', 'aria-label': 'Objects of both parses'}, [
        element('table', {}, [element('thead', {}, [element('tr', {}, head)]), element('tbody', {}, body)])]),
      element('p', {className: 'hint', text: `Objects are the same where their boxes overlap by a tenth or more. Risk is the largest of ` +
        `${listed(names.map(causeOf)) || 'none that both parses have'}, in joules per event; a change within two standard errors is none. They have the colours of ${this.name} now, whose numbers are beside theirs.`}));
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
