// SPDX-License-Identifier: MIT
'use strict';

// Another parse of the same room beside this one: which objects became safer.

// The scene in a scene.json or a report.html; throws an Error that says what is wrong.
async function readScene(name, text) {
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
  // A report has them packed.
  if (typeof scene.primitives === 'string') scene.primitives = await unpacked(scene.primitives);
  return scene;
}

// The largest risk and its error; of disturbances that both parses reckoned with.
function comparedRisk(object, names) {
  const name = names.reduce((worst, next) => (object.risk_J[next] || 0) > (object.risk_J[worst] || 0) ? next : worst, names[0]);
  return {risk: object.risk_J[name] || 0, error: riskError(object, name) || 0, category: object.unsafety_category, categoryText: object.seen_enough === false ? 'not known' : categoryText(object), unknown: object.seen_enough === false};
}

// 'safer', 'less safe', 'alike' within two standard errors, 'not told apart' where these exceed the risks themselves or span
// categories, or 'unknown'.
function verdict(before, after) {
  if (before.unknown || after.unknown) return 'unknown';
  const change = after.risk - before.risk, most = Math.max(before.risk, after.risk), doubt = 2 * Math.hypot(before.error, after.error);
  if (Math.abs(change) <= Math.max(doubt, 0.01 * most)) {
    if (before.category !== after.category) return 'not told apart';
    return Math.abs(change) > 0.01 * most && doubt > most && before.category !== 'none' ? 'not told apart' : 'alike';
  }
  return change < 0 ? 'safer' : 'less safe';
}

// Whether a spot of a correction lies within a box of the view, or near it; spots lie in the frame of the parse that was told.
function spotWithin(scene, told, one, box) {
  const margin = 2 * scene.voxel_size_m;
  return !!box && one.held !== false && (one.at_m || []).some(spot => otherPlace(scene, told, spot).every((value, k) => value >= box[k][0] - margin && value <= box[k][1] + margin));
}

// What holds what is fixed now.
function strapText(object) {
  const hold = (object.advice || {}).hold_N;
  return `which holds only while its strap does${hold > 0 ? ` (${forceText(hold)} at least)` : ''}`;
}

// Rows for the table: {mine, theirs, before, after, verdict, text}, what changed most first; names: the disturbances; sameScan.
function compareScenes(scene, other, otherIsBefore) {
  const reckoned = objects => new Set(objects.flatMap(object => Object.keys(object.risk_J || {})));
  const theirs = reckoned(other.objects), names = scene.disturbances.filter(name => theirs.has(name));
  other.when = otherIsBefore ? 'before' : 'after';
  const later = otherIsBefore ? scene : other, earlier = otherIsBefore ? other : scene, common = commonParts(scene, other);
  const risks = (first, last) => ({before: first && comparedRisk(first, names), after: last && comparedRisk(last, names)});
  let rows;
  if (common) {
    const partsOf = new Map([...pointsByObject(scene), ...pointsByObject(other, part => common.has(part.id) ? common.get(part.id) : `their ${part.id}`)]);
    const isSpotOf = (one, object) => spotWithin(scene, later, one, comparedBox(scene, earlier, object));
    rows = rowsByParts(earlier, later, partsOf, (side, object) => sideName(scene, side, object), isSpotOf).map(({first, last, ...row}) => {
      const risk = risks(first, last);
      return {...row, ...risk, mine: otherIsBefore ? last : first, theirs: otherIsBefore ? first : last, verdict: row.verdict || verdict(risk.before, risk.after)};
    });
  } else {
    const matched = matchObjects(scene, other, earlier, box => (later.corrections || []).some(one => one.do === 'fixed' && spotWithin(scene, later, one, box)));
    const both = matched.filter(row => row.mine && row.theirs), match = new Map(both.map(row => [row.mine, row.theirs.id]));
    const stayed = new Map(both.filter(row => row.as === 'same' || row.as === 'apart').flatMap(row => [[row.mine, row.theirs], [row.theirs, row.mine]]));
    rows = matched.map(row => {
      const [first, last] = otherIsBefore ? [row.theirs, row.mine] : [row.mine, row.theirs], risk = risks(first, last);
      const [side, far] = row.mine ? [scene, other] : [other, scene];
      const of = row.as === 'alone' ? mayBePartOf(scene, side, far, row.mine || row.theirs, object => stayed.get(object)) : null;
      return {...row, ...risk, ...outcome(scene, other, row, risk, first, match), ...of && {
        text: `${last ? 'or was part of' : 'or now part of'} ${of.grounded ? 'the building' : sideName(scene, far, of)}`}};
    });
  }
  const change = row => Math.abs((row.after ? row.after.risk : 0) - (row.before ? row.before.risk : 0));
  rows.sort((p, q) => verdicts.indexOf(p.verdict) - verdicts.indexOf(q.verdict) || change(q) - change(p));
  return {rows, names, sameScan: !!common};
}

// In the order of the table.
const verdicts = ['less safe', 'new', 'moved', 'perhaps moved', 'safer', 'fixed now', 'gone', 'joined', 'now part', 'parted', 'not there', 'told apart differently',
  'unknown', 'not told apart', 'alike'];

// "object 9", and of the other parse "object 9 before".
function sideName(scene, side, object) {
  if (side === scene) return objectName(scene, object.id);
  return `${object.name || (object.grounded ? 'the building' : `object ${object.id}`)} ${side.when}`;
}

// Of a row of two scans: what became of it, in a word, and a text on it.
function outcome(scene, other, row, risk, first, match) {
  const {mine: a, theirs: b, far} = row;
  if (row.as === 'fixed') return {verdict: 'fixed now', text: strapText(first)};
  if (row.as === 'alone') return {verdict: risk.before ? 'gone' : 'new', text: ''};
  if (row.as === 'perhaps') return {verdict: 'perhaps moved', text: `looks like ${sideName(scene, other, b)}, ${metres(far)} away`};
  if (row.as === 'apart') return {verdict: 'told apart differently', text: row.piece ? 'a piece of something else there' : `other ${listed(row.differs) || 'extent'}`};
  const held = heldAlike(scene, other, a, b, match), became = verdict(risk.before, risk.after);
  if (row.as === 'moved' || far && !held) return {verdict: 'moved', text: `by ${metres(far)}`};
  if (!held) return {verdict: 'told apart differently', text: 'what holds it'};
  if (!far) return {verdict: became, text: ''};
  return became === 'safer' || became === 'less safe' ? {verdict: became, text: `moved by ${metres(far)}`} : {verdict: 'moved', text: `by ${metres(far)}`};
}

// What became of a row, as the table has it.
function becameText({verdict: became, text}) {
  if (['joined', 'now part', 'parted', 'not there', 'gone', 'new'].includes(became)) return [became, text].filter(part => part).join(' ');
  if (became === 'fixed now' && text) return `${became}, ${text}`;
  const words = {alike: 'as before', unknown: 'not known', 'not told apart': 'unsure'}[became] || became;
  return words + (text ? `: ${text}` : '');
}

// Where two scans have hardly anything in one place: of the objects of the one that has fewer.
const fewStay = 0.2;
function strangersText(rows, sameScan) {
  if (sameScan) return '';
  const both = rows.filter(row => row.mine && row.theirs && !['perhaps moved', 'moved'].includes(row.verdict)).length;
  const count = side => rows.filter(row => row[side]).length, fewer = Math.min(count('mine'), count('theirs'));
  if (!rows.some(row => row.mine && row.theirs)) return 'No object of one is where one of the other is: is this another room, or another frame? ';
  return fewer > 2 && both < fewStay * fewer ? 'Hardly anything is where it was: is this another room, or another frame? ' : '';
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

  async read(name, text) {
    try {
      this.other = await readScene(name, text);
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
    const {rows, names, sameScan} = compareScenes(this.scene, this.other, this.order.value === 'before');
    const count = what => rows.filter(row => row.verdict === what).length;
    const line = strangersText(rows, sameScan);
    const always = sameScan ? ['safer', 'less safe', 'alike'] : ['safer', 'less safe', 'alike', 'moved', 'new', 'gone'];
    const counts = [...always, ...verdicts.filter(what => !always.includes(what) && count(what))].map(what =>
      `${count(what)} ${{alike: 'as before within the errors', unknown: 'not known', 'not told apart': 'unsure', 'now part': 'now part of others'}[what] || what}`).join(', ') + '.';
    const risk = side => !side ? '\u2013' : side.unknown ? 'not known' : number(side.risk) + within(side.error);
    const category = side => !side ? '\u2013' : side.categoryText;
    const body = rows.map(row => {
      const id = row.mine ? row.mine.id : null;
      const name = row.mine ? objectName(this.scene, id) : sideName(this.scene, this.other, row.theirs);
      return element('tr', {className: row.verdict.replace(/ /g, '-')}, [
        element('th', {scope: 'row'}, [id === null ? name : element('button', {type: 'button', text: name, onclick: () => this.choose(id)})]),
        element('td', {className: 'text', text: row.theirs ? row.theirs.name || 'object ' + row.theirs.id : '\u2013'}),
        ...[row.before, row.after].map(side => element('td', {className: 'text', text: category(side)})),
        ...[row.before, row.after].map(side => element('td', {text: risk(side)})), element('td', {className: 'text', text: becameText(row)})]);
    });
    const head = ['Object here', this.other.when === 'before' ? 'Before' : 'After', 'Category before', 'Category after', 'Risk before (J)', 'Risk after (J)', 'Became'].map((text, i) =>
      element('th', {scope: 'col', text, className: i === 4 || i === 5 ? '' : 'text'}));
    const stranger = line ? [element('p', {className: 'warning', text: line.trim()})] : [];
    const banner = sameScan ? element('p', {className: 'hint', text: 'The same scan: what changed follows from the corrections.'}) :
      element('p', {className: 'warning', text: 'The two scans may have been told apart differently; \u00b1 does not cover that: look at both pictures before believing a change.'});
    const how = sameScan ? 'Objects are the same that have the most points in common. ' : 'Objects are the same where their boxes overlap by a tenth or more, and size, mass and what holds them are alike within the errors: only of these ' +
      'is said whether they became safer. Moved: of equal size and mass, elsewhere, both ends of their boxes by more than the voxels. Perhaps moved: of a like shape, elsewhere. Gone, or now part: the other thing has parts as large in its place, or has grown by as much. Gone and new may also be one thing that was moved and then told apart otherwise, or what one of the parses took for part of the building. ';
    this.out.replaceChildren(banner, ...stranger, element('p', {className: 'counts', text: counts}),
      element('div', {className: 'scroll', tabIndex: 0, role: 'region', 'aria-label': 'Objects of both parses'}, [
        element('table', {}, [element('thead', {}, [element('tr', {}, head)]), element('tbody', {}, body)])]),
      element('p', {className: 'hint', text: `${how}Risk is the largest of ${listed(names.map(causeOf)) || 'none that both parses have'}, in joules per event; a change within two standard errors is none, and unsure where these ` +
        `exceed the risks or the category is another. Objects have the colours of ${this.name} now, whose numbers are beside theirs.`}));
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
