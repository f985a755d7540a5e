// SPDX-License-Identifier: MIT
'use strict';

// What is said of an object as a whole, whichever of its parts it is said at, and once only.
const ofAllOfAnObject = ['hollow', 'mass', 'friction', 'name'];

// Which parts are chosen to be put right, and what is said of them: the panel below the view. Parts are chosen by
// Ctrl-click (one) and Shift-click (all of an object) in the view, or in the list; where none is, all of the chosen object's are meant.
class PartsPanel {
  // changed(): what is marked in the view is another. say(text): for screen readers.
  constructor(scene, changed, say) {
    this.scene = scene;
    this.changed = changed;
    this.say = say;
    this.object = null;
    this.marked = new Set();
    this.corrections = new Corrections(scene, () => this.fillList());
    this.partsOf = new Map();
    for (const part of scene.primitives) this.partsOf.set(part.object, [...this.partsOf.get(part.object) || [], part]);
    for (const parts of this.partsOf.values()) parts.sort((a, b) => b.volume_m3 - a.volume_m3 || a.id - b.id);
    this.owner = new Map(scene.primitives.map(part => [part.id, part.object]));
    this.makeActions();
    this.fillList();
    this.fill();
    addEventListener('beforeunload', event => { if (!this.corrections.saved) event.preventDefault(); });
  }

  // The object whose parts are listed, or null. What was ticked of others is so no longer: what is said next is about this one.
  choose(id) {
    if (id !== null && id !== this.object && [...this.marked].some(part => this.owner.get(part) !== id)) this.marked.clear();
    this.object = id;
    this.fill();
  }

  togglePart(part) {
    if (!this.owner.has(part)) return;
    const on = !this.marked.has(part);
    if (on) this.marked.add(part);
    else this.marked.delete(part);
    this.say(`Part ${part} of ${objectName(this.scene, this.owner.get(part))} ${on ? 'chosen' : 'no longer chosen'}. ${this.marked.size} in all.`);
    this.fill();
    this.changed();
  }

  // Beside the object that is chosen as a whole, if another one is.
  toggleObject(id) {
    if (!this.marked.size && this.object !== null && this.object !== id)
      for (const part of this.partsOf.get(this.object) || []) this.marked.add(part.id);
    const parts = (this.partsOf.get(id) || []).map(part => part.id), on = !parts.every(part => this.marked.has(part));
    for (const part of parts) {
      if (on) this.marked.add(part);
      else this.marked.delete(part);
    }
    this.say(`All ${plural(parts.length, 'part')} of ${objectName(this.scene, id)} ${on ? 'chosen' : 'no longer chosen'}.`);
    this.fill();
    this.changed();
  }

  // That two objects are one thing; where that was said, it is undone.
  join(id, other) {
    const said = this.joinOf(id, other);
    if (said) return this.undo(said);
    this.take(this.partsOfBoth(id, other));
    this.note('one_thing', {}, 'one thing');
  }

  partsOfBoth(id, other) {
    return [id, other].flatMap(each => (this.partsOf.get(each) || []).map(part => part.id));
  }

  // What said that two objects are one thing, if anything did.
  joinOf(id, other) {
    const both = this.partsOfBoth(id, other);
    return this.corrections.list.find(({about}) => about && about.kind === 'one_thing' && about.parts.length === both.length && both.every(part => about.parts.includes(part)));
  }

  undo(entry) {
    this.corrections.remove(entry);
    this.say(`Undone: ${entry.text}.`);
  }

  // Why something can't be said of parts beside what was said before: as the program would find it; '' where it can.
  contradiction(kind, parts, others = []) {
    const some = (a, b) => a.some(part => b.includes(part)), ofBuilding = list => list.some(part => (this.scene.objectById.get(this.owner.get(part)) || {}).grounded);
    const first = text => `You said ${text}: undo that first.`, alike = (a, b) => a.length === b.length && a.every(part => b.includes(part));
    for (const {about} of this.corrections.list) {
      if (!about || !some([...about.parts, ...about.others], parts)) continue;
      const same = about.kind === kind && alike(about.parts, parts);
      if (same && ['one_thing', 'fixed', 'not_there', 'apart'].includes(kind)) return 'That is noted already.';
      if (about.kind === kind && ofAllOfAnObject.includes(kind) && some(about.parts, parts)) return first('otherwise of this already');
      if (about.kind === 'not_there' && some(about.parts, parts)) return first('that this is not there');
      if (about.kind === 'apart' && (kind === 'one_thing' && some(about.parts, parts) && some(about.others, parts) ||
        kind === 'fixed' && some(about.parts, parts) && ofBuilding(about.others))) return first('that these are a thing by themselves');
      if (kind === 'apart' && about.kind === 'one_thing' && some(about.parts, parts) && some(about.parts, others)) return first('that these are one thing');
      if (kind === 'apart' && about.kind === 'fixed' && some(about.parts, parts) && ofBuilding(others)) return first('that these are fixed to the wall');
    }
    return '';
  }

  // Objects that are to be one thing and don't hang together as scanned: a warning that names what each touches; '' where they do.
  looseText(owners) {
    const touched = id => new Set(contactsOf(this.scene, id).filter(contact => !contact.own && contact.object >= 0).map(contact => contact.object));
    const reached = new Set([owners[0]]);
    for (const id of reached) for (const other of touched(id)) if (owners.includes(other)) reached.add(other);
    const left = owners.filter(id => !reached.has(id)), names = ids => listed(ids.map(id => objectName(this.scene, id)));
    if (!left.length) return '';
    const touches = id => `${objectName(this.scene, id)} touches ${names([...touched(id)].sort((a, b) => a - b)) || 'nothing'}`;
    return `Noted, but ${names([...reached])} and ${names(left)} don\u2019t touch as scanned: ${listed([owners[0], ...left].map(touches))}. Undo it if another one was meant.`;
  }

  // These and no others.
  take(parts) {
    this.marked = new Set(parts.filter(part => this.owner.has(part)));
    this.say(`${plural(this.marked.size, 'part')} chosen.`);
    this.fill();
    this.changed();
  }

  clear() {
    this.marked.clear();
    this.fill();
    this.changed();
  }

  // What is meant: the chosen parts, else all of the object.
  parts() {
    if (this.marked.size) return [...this.marked].sort((a, b) => a - b);
    return (this.partsOf.get(this.object) || []).map(part => part.id);  // the largest first
  }

  // "part 3 of object 2", "parts 3 and 5 of the building, and object 4", "objects 2 and 4"
  meant() {
    const parts = this.parts(), owners = this.ownersOf(parts), own = id => this.partsOf.get(id).map(part => part.id);
    const isWhole = id => own(id).every(part => parts.includes(part)), whole = owners.filter(isWhole), some = owners.filter(id => !isWhole(id));
    const pieces = some.map(id => `${objectList(own(id).filter(part => parts.includes(part)).sort((a, b) => a - b)).replace('object', 'part')} of ${objectName(this.scene, id)}`);
    return [...pieces, ...whole.length ? [this.namesOf(whole)] : []].join(', and ');
  }

  // What the buttons are for: "object 9", "5 ticked parts of the building"
  aimText() {
    const owners = this.ownersOf(this.parts());
    if (!this.marked.size) return objectName(this.scene, this.object);
    return `${plural(this.marked.size, 'ticked part')}${owners.length === 1 ? ` of ${objectName(this.scene, owners[0])}` : ''}`;
  }

  ownersOf(parts) {
    return [...new Set(parts.map(part => this.owner.get(part)))].sort((a, b) => a - b);
  }

  // "objects 2 and 4", "the building and object 4"
  namesOf(ids) {
    const plain = ids.every(id => objectName(this.scene, id) === `object ${id}`);
    return plain ? objectList(ids) : listed(ids.map(id => objectName(this.scene, id)));
  }

  makeActions() {
    const box = document.getElementById('mend-actions');
    const number = (id, text, unit, value, step) => {
      const field = element('input', {type: 'number', id, min: 0, step, value, className: 'short'});
      return [element('label', {htmlFor: id, text}), field, element('span', {text: unit, className: 'unit'})];
    };
    const act = (kind, text, how) => element('button', {type: 'button', text, onclick: how, 'data-do': kind});
    const value = id => Number(document.getElementById(id).value);
    const form = (fields, button) => {
      const node = element('form', {className: 'row'}, [...fields, button]);
      node.addEventListener('submit', event => { event.preventDefault(); button.click(); });
      return node;
    };
    box.append(
      element('p', {id: 'mend-for'}),
      element('div', {className: 'row'}, [
        act('one_thing', 'one thing', () => this.note('one_thing', {}, 'one thing')),
        act('apart', 'a thing by itself', () => this.standAlone()),
        act('fixed', 'fixed to the wall', () => this.note('fixed', {}, 'fixed to the wall')),
        act('not_there', 'not there', () => this.note('not_there', {}, 'not there'))]),
      form([element('label', {htmlFor: 'mend-name', text: 'name'}), element('input', {id: 'mend-name', type: 'text', maxLength: 60, autocomplete: 'off'})],
        act('name', 'set name', () => {
          const name = document.getElementById('mend-name').value.trim();
          if (!name) this.refuse('Write a name first.');
          else this.note('name', {name}, `called \u201c${name}\u201d`);
        })),
      form(number('mend-kg', 'mass', 'kg', '', 'any'), act('mass', 'set mass', () => {
        const kg = value('mend-kg');
        if (!(kg > 0) || !isFinite(kg)) this.refuse('Write a mass above 0 kg first.');
        else this.note('mass', {kg}, `${kg} kg`);
      })),
      form(number('mend-friction', 'friction', '', '', 'any'), act('friction', 'set friction', () => {
        const coefficient = value('mend-friction');
        if (!(coefficient > 0 && coefficient <= 10)) this.refuse('Write a coefficient of friction first: above 0, mostly 0.2 to 1.');
        else this.note('friction', {coefficient}, `friction ${coefficient}`);
      })),
      form(number('mend-wall', 'walls', 'cm', '2', 'any'), act('hollow', 'hollow', () => {
        const cm = value('mend-wall');
        if (!(cm > 0) || !isFinite(cm)) this.refuse('Write how thick the walls are, above 0 cm.');
        else this.note('hollow', {wall_m: Math.round(cm * 100) / 10000}, `hollow, walls of ${cm} cm`);
      })));
    document.getElementById('mend-clear').addEventListener('click', () => this.clear());
    document.getElementById('mend-save').addEventListener('click', () => { this.corrections.save(); this.say('corrections.json was saved.'); });
    document.getElementById('mend-copy').addEventListener('click', () => {
      const copied = navigator.clipboard ? navigator.clipboard.writeText(this.corrections.command()) : Promise.reject();
      copied.then(() => this.say('Copied.'), () => getSelection().selectAllChildren(document.getElementById('mend-command')));
    });
  }

  refuse(text) {
    document.getElementById('mend-note').textContent = text;
  }

  note(kind, more, what) {
    const parts = this.parts(), meant = this.meant();
    if (!this.corrections.told(parts).length) return this.refuse(`Of ${meant || 'this'} no surface is drawn, by which it could be found again.`);
    if (kind === 'one_thing' && this.corrections.told(parts).length < 2) return this.refuse('Choose at least two parts, or two objects, first.');
    if (kind === 'one_thing' && new Set(parts.map(part => this.owner.get(part))).size < 2)
      return this.refuse('These are one thing already: Shift-click the other one, too.');
    const against = this.contradiction(kind, parts);
    if (against) return this.refuse(against);
    const told = {...more, was: this.wasText(kind, parts)};
    this.corrections.add(kind === 'one_thing' ? this.corrections.oneThing(parts, told) : this.corrections.of(kind, this.enoughOf(kind, parts), told),
      `${capital(meant)}: ${what}`, {kind, parts, others: []});
    this.done();
    if (kind === 'one_thing') this.refuse(this.looseText([...new Set(parts.map(part => this.owner.get(part)))]));
  }

  // What is to be known of it after the next parse, which has other numbers: a line.
  wasText(kind, parts) {
    const owners = this.ownersOf(parts), holds = owners.map(id => ((this.scene.objectById.get(id) || {}).advice || {}).hold_N || 0);
    const hold = kind === 'fixed' && Math.max(0, ...holds) > 0 ? `, to be held with ${forceText(Math.max(...holds))} at least` : '';
    return (owners.some(id => (this.scene.objectById.get(id) || {}).grounded) ? this.meant() : objectList(owners)) + hold;
  }

  // What is said of all of an object is said at a few of its parts.
  enoughOf(kind, parts) {
    if (!ofAllOfAnObject.includes(kind)) return parts;
    const owners = [...new Set(parts.map(part => this.owner.get(part)))], each = Math.max(1, Math.floor(mostSpots / owners.length));
    return owners.flatMap(owner => this.corrections.told(parts.filter(part => this.owner.get(part) === owner)).slice(0, each));
  }

  // One thing, and not one with any other part of the objects that it is in now.
  standAlone() {
    const parts = this.parts(), meant = this.meant(), owners = new Set(parts.map(part => this.owner.get(part)));
    const rest = this.scene.primitives.filter(part => owners.has(part.object) && !parts.includes(part.id)).map(part => part.id);
    if (!this.corrections.told(rest).length) return this.refuse(`${capital(meant)} is by itself already: choose some of its parts.`);
    if (!this.corrections.told(parts).length) return this.refuse(`Of ${meant} no surface is drawn, by which it could be found again.`);
    const against = this.contradiction('apart', parts, rest);
    if (against) return this.refuse(against);
    const told = {was: meant};
    this.corrections.add([...this.corrections.oneThing(parts, told), ...this.corrections.apart(parts, rest, told)], `${capital(meant)}: a thing by itself`,
      {kind: 'apart', parts, others: rest});
    // It stays chosen, so that it can be named at once.
    this.done(true);
  }

  // kept: what is chosen stays so.
  done(kept = false) {
    for (const id of ['mend-name', 'mend-kg']) document.getElementById(id).value = '';
    this.say(`Noted: ${this.corrections.list[this.corrections.list.length - 1].text}.`);
    if (!kept) this.clear();
  }

  // The list of parts, and what is chosen of them.
  fill() {
    const list = document.getElementById('mend-parts'), parts = this.partsOf.get(this.object) || [];
    const focused = list.contains(document.activeElement) ? document.activeElement.value : null, top = list.scrollTop;
    // First what was chosen of other objects.
    const others = [...this.marked].filter(id => this.owner.get(id) !== this.object).sort((a, b) => a - b)
      .map(id => this.scene.primitives.find(part => part.id === id));
    list.replaceChildren(...[...others, ...parts].map(part => this.partBox(part)));
    list.scrollTop = top;
    const again = focused !== null && list.querySelector(`input[value="${focused}"]`);
    if (again) again.focus();
    const meant = this.meant(), any = this.parts().length > 0;
    document.getElementById('mend-meant').textContent = !any ? 'Nothing is chosen.'
      : `Chosen: ${meant}${this.marked.size ? '' : ', all of it'}.`;
    document.getElementById('mend-for').textContent = any ? `For: ${this.aimText()}` : '';
    document.getElementById('mend-clear').hidden = !this.marked.size;
    document.getElementById('mend-note').textContent = '';
    list.hidden = !list.childNodes.length;
    for (const control of document.querySelectorAll('#mend-actions button')) control.disabled = !any;
    document.querySelector('#mend-actions [data-do=one_thing]').disabled = this.parts().length < 2;
  }

  partBox(part) {
    const other = this.owner.get(part.id) !== this.object;
    const box = element('input', {type: 'checkbox', value: part.id, checked: this.marked.has(part.id), onchange: () => this.togglePart(part.id)});
    return element('label', {className: 'check'}, [box,
      colourSwatch(colourOf(this.scene, part.id)),
      element('span', {}, [`${part.name || `part ${part.id}`}${other ? ` of ${objectName(this.scene, part.object)}` : ''}, ${shapeText(part)}`,
        element('small', {className: 'place', text: placeInShort(this.scene, this.scene.partBoxes.get(part.id))})]),
      element('span', {className: 'pm', text: part.volume_m3 === null ? '' : number(part.volume_m3 * 1000, 'l')})]);
  }

  // The corrections so far.
  fillList() {
    const {list, saved} = this.corrections, out = document.getElementById('mend-list');
    out.replaceChildren(...list.map(entry => element('li', {}, [entry.text + ' ',
      element('button', {type: 'button', text: 'undo', 'aria-label': `undo: ${entry.text}`, onclick: () => {
        this.undo(entry);
        document.getElementById('mend-list-heading').focus();
      }})])));
    document.getElementById('mend-result').hidden = !list.length && saved;
    document.getElementById('mend-list-heading').textContent = plural(list.length, 'correction');
    document.getElementById('mend-command').textContent = this.corrections.command();
    for (const button of document.querySelectorAll('button[data-join]'))
      button.textContent = joinText(this.joinOf(Number(button.dataset.of), Number(button.dataset.join)));
  }
}

function shapeText(part) {
  return {plane: 'flat', quadric: 'round', merged: 'of several faces'}[part.model] || part.model;
}
