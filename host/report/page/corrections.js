// SPDX-License-Identifier: MIT
'use strict';

// What the user says of parts that the program took otherwise, for a second parse to keep to: a file
// topple.corrections/1. Parts are told by places on their surfaces, since each parse numbers them anew.
const mostSpots = 100;  // of a correction, which its reader takes

class Corrections {
  // The scene may bring those that it was parsed with. changed(): the list is another.
  constructor(scene, changed) {
    this.scene = scene;
    this.changed = changed;
    // What the user said: of one correction of the file or more each, and in words.
    this.list = sentencesOf(scene.corrections).map(ones => ({ones: ones.map(asInFile), text: givenText(scene, ones)}));
    this.saved = true;
    this.spots = new Map();
    scene.view.groups.forEach(([primitive], g) => {
      const spot = scene.view.spots[g];
      if (primitive >= 0 && spot && spot.length) this.spots.set(primitive, spot);
    });
  }

  // Those of the parts that can be told again.
  told(parts) {
    return parts.filter(part => this.spots.has(part));
  }

  // Where parts are told by.
  at(parts) {
    return this.told(parts).map(part => this.spots.get(part));
  }

  // What is said of parts, of however many: in as many corrections as it takes.
  of(kind, parts, more = {}) {
    return chunks(this.at(parts)).map(at_m => ({do: kind, at_m, ...more}));
  }

  // That parts are one thing: each correction begins with the spot that all share.
  oneThing(parts, more = {}) {
    const [first, ...others] = this.at(parts);
    return chunks(others, mostSpots - 1).map(at_m => ({do: 'one_thing', at_m: [first, ...at_m], ...more}));
  }

  // That no part is in one object with any of the others.
  apart(parts, others, more = {}) {
    return this.of('apart', parts, more).flatMap(one => chunks(this.at(others)).map(from_m => ({...one, from_m})));
  }

  // One step; text: what it says; about: {kind, parts, others} that it is said of, others: what they are apart from.
  add(ones, text, about) {
    this.list.push({ones, text, about, isNew: true});
    this.saved = false;
    this.changed();
  }

  remove(entry) {
    this.list = this.list.filter(other => other !== entry);
    this.saved = false;
    this.changed();
  }

  document() {
    return {schema: 'topple.corrections/1', corrections: this.list.flatMap(({ones}) => ones)};
  }

  save() {
    const url = URL.createObjectURL(new Blob([JSON.stringify(this.document(), null, 1) + '\n'], {type: 'application/json'}));
    element('a', {href: url, download: 'corrections.json'}).click();
    setTimeout(() => URL.revokeObjectURL(url), 60000);
    this.saved = true;
    this.changed();
  }

  // That which made this report, with the corrections and into a folder beside the one of this parse, which stays to compare with; for
  // a POSIX shell. It goes on from what this parse keeps for the next.
  command() {
    const words = [], given = this.scene.command;
    let out = '', cache = !given.some(word => /^--(cache|no-cache|tile)(=|$)/.test(word));
    for (let n = 0; n < given.length; ++n) {
      const word = given[n], joined = word.match(/^(?:--output=|-o=?)(.+)$/);
      if (word === '--corrections') ++n;  // these go on from those
      else if (word.startsWith('--corrections=')) continue;
      else if (word === '-o' || word === '--output') out = given[++n] || '';
      else if (joined) out = joined[1];
      else words.push(word);
    }
    out = out.replace(/\/+$/, '');
    const quoted = word => /^[\w./@%+=:,-]+$/.test(word) ? word : `'${word.replace(/'/g, `'\\''`)}'`;
    const counted = out.match(/^(.*)-(\d+)$/), next = counted ? `${counted[1]}-${Number(counted[2]) + 1}` : `${out}-2`;
    const made = out ? ['-o', next, ...cache ? ['--cache', `${out}/parse.cache`] : []] : [];
    // The shell is to find the home folder: browsers save there.
    return [...[...words, ...made, '--corrections'].map(quoted), '~/Downloads/corrections.json'].join(' ');
  }
}

// A list in pieces of so many.
function chunks(list, most = mostSpots) {
  const out = [];
  for (let n = 0; n < list.length; n += most) out.push(list.slice(n, n + most));
  return out;
}

// A correction of scene.json without what became of it.
function asInFile(one) {
  const out = {};
  for (const key of ['do', 'at_m', 'from_m', 'wall_m', 'kg', 'name', 'was']) if (one[key] !== undefined) out[key] = one[key];
  return out;
}

// Corrections of a file by what was said with each, in lists: one sentence about several parts may take several entries, one after the
// other. They share their line `was`, and are of one kind and value at other spots, or apart after one_thing; as host/objects/told_sentences.cpp has it.
function sentencesOf(corrections) {
  const out = [], key = value => JSON.stringify(value), alike = (a, b, names) => names.every(name => key(a[name]) === key(b[name]));
  const goesOn = (before, one) => one.was && one.was === before.was && (one.do !== before.do ? before.do === 'one_thing' && one.do === 'apart' :
    alike(before, one, ['wall_m', 'kg', 'name']) && !alike(before, one, ['at_m', 'from_m']));
  for (const one of corrections || []) {
    const last = out[out.length - 1];
    if (last && goesOn(last[last.length - 1], one)) last.push(one);
    else out.push([one]);
  }
  return out;
}

// The number, from 1 on, of what was said by each correction: as many as there are corrections.
function sentenceNumbers(corrections) {
  return sentencesOf(corrections).flatMap((ones, n) => ones.map(() => n + 1));
}

// Of a sentence's corrections that the scene was parsed with: where, what it said, and what became of it, as
// "Bookcase at 1.56 m east, 0.35 m north (before: object 16, to be held with 3958 N at least): counted as fixed, ..".
function givenText(scene, ones) {
  const one = ones[0], missed = ones.find(each => each.outcome && each.outcome !== 'held'), alone = ones.some(each => each.do !== one.do);
  const things = (one.objects || []).filter(id => scene.objectById.has(id) && !scene.objectById.get(id).grounded);
  const named = nameToldWith(scene, one), at = correctedPlace(scene, one);
  const what = {
    one_thing: 'one thing', apart: 'apart from others', fixed: 'counted as fixed; this holds only while its strap does', not_there: 'counted as not there',
    hollow: `hollow, walls of ${metres(one.wall_m || 0)}`, mass: number(one.kg, 'kg'), friction: `friction ${number(one.coefficient)}`, name: `called \u201c${one.name}\u201d`,
  }[one.do] || one.do;
  const who = things.length ? listed(things.map(id => objectName(scene, id))) : named || (one.at_m.length > 1 ? 'parts' : 'what is');
  return `${capital(who)}${at ? ` at ${at}` : ''}${one.was ? ` (before: ${one.was})` : ''}: ${alone ? 'a thing by itself' : what}${missed ? ` (of this parse: ${missed.outcome})` : ''}`;
}

// What is called so at one of the spots of a correction; '' for none.
function nameToldWith(scene, one) {
  const same = other => other.do === 'name' && other.at_m.some(a => one.at_m.some(b => a.every((value, k) => value === b[k])));
  return one.name || ((scene.corrections || []).find(same) || {}).name || '';
}

// The box of a correction's spots in the view; null without any.
function correctedBox(scene, one) {
  if (!one.at_m || !one.at_m.length) return null;
  const spots = one.at_m.map(spot => viewPlace(scene, spot)), ends = of => [0, 1, 2].map(k => of(...spots.map(spot => spot[k])));
  return {low: ends(Math.min), high: ends(Math.max)};
}

// The middle of a correction's spots on the plan: "1.56 m east, 0.35 m north".
function correctedPlace(scene, one) {
  if (!one.at_m || !one.at_m.length) return '';
  const {low} = scene.planBox, middle = k => one.at_m.reduce((sum, spot) => sum + viewPlace(scene, spot)[k], 0) / one.at_m.length - low[k];
  return `${metreText(middle(0))} m east, ${metreText(middle(1))} m north`;
}

// Whether a correction gave the object's mass.
function massIsGiven(scene, object) {
  return (object.corrected || []).some(n => {
    const one = (scene.corrections || [])[n - 1];
    return one && one.do === 'mass' && one.held;
  });
}
