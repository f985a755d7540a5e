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
    // Steps: one or two corrections of the file each, and what they say for the user.
    this.list = (scene.corrections || []).map(one => ({ones: [asInFile(one)], text: givenText(scene, one)}));
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

  // Where parts are told by, as many as a correction may have: of more the first ones.
  at(parts) {
    return this.told(parts).slice(0, mostSpots).map(part => this.spots.get(part));
  }

  // The same of the parts that are nearest to others.
  near(parts, others) {
    const from = this.at(others);
    const distance = part => Math.min(...from.map(spot => Math.hypot(...spot.map((value, k) => value - this.spots.get(part)[k]))));
    const distances = new Map(this.told(parts).map(part => [part, distance(part)]));
    return this.at([...distances.keys()].sort((a, b) => distances.get(a) - distances.get(b) || a - b));
  }

  // One step; text: what it says.
  add(ones, text) {
    this.list.push({ones, text});
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

  // For a POSIX shell.
  command() {
    const source = this.scene.source || 'INPUT', safe = /^[\w./@%+=:,-]+$/.test(source) ? source : `'${source.replace(/'/g, `'\\''`)}'`;
    // What was reckoned with is asked for again, or the second report would be of another question.
    const kinds = this.scene.disturbances || [], all = ['human', 'wind', 'earthquake'];
    const asked = all.every(kind => kinds.includes(kind)) || !kinds.length ? '' : ` --disturbance ${kinds.join(',')}`;
    return `topple parse ${safe}${asked} --corrections corrections.json -o OUT`;
  }
}

// A correction of scene.json without what became of it.
function asInFile(one) {
  const out = {};
  for (const key of ['do', 'at_m', 'from_m', 'wall_m', 'kg', 'name']) if (one[key] !== undefined) out[key] = one[key];
  return out;
}

// Of a correction that the scene was parsed with: what it said, and what became of it.
function givenText(scene, one) {
  const places = one.objects && one.objects.length ? listed(one.objects.map(id => objectName(scene, id))) : plural(one.at_m.length, 'place');
  const what = {
    one_thing: 'one thing', apart: 'apart from others', fixed: 'fixed to the wall', not_there: 'not there',
    hollow: `hollow, walls of ${metres(one.wall_m || 0)}`, mass: number(one.kg, 'kg'), name: `called \u201c${one.name}\u201d`,
  }[one.do] || one.do;
  return `${capital(places)}: ${what} (of this parse: ${one.outcome || 'given'})`;
}

// Whether a correction gave the object's mass.
function massIsGiven(scene, object) {
  return (object.corrected || []).some(n => {
    const one = (scene.corrections || [])[n - 1];
    return one && one.do === 'mass' && one.held;
  });
}
