// SPDX-License-Identifier: MIT
'use strict';

// The first page on paper: what to do, with boxes to tick, in words for whoever walks through the room with it.

// shown: with its picture.
function sheetLine(scene, object, todo, more = [], shown = true) {
  const what = [sizeText(object), placeInShort(scene, scene.boxes.get(object.id))].filter(text => text).join(', at ');
  const badge = object.unsafety_category ? categoryText(object) : 'not judged';
  const picture = shown && pictureOf(scene, object.id);
  return element('li', {}, [element('span', {className: 'box'}), ...picture ? [picture] : [], element('div', {}, [
    element('strong', {text: `${capital(objectName(scene, object.id))}${object.name ? ` (object ${object.id})` : ''}, ${badge}: `}), `${todo} `,
    element('small', {text: [what, ...more].filter(text => text).map(text => text.replace(/[.;]$/, '')).join('. ') + '.'})])]);
}

// What was said to be fixed, and so is at no risk while its strap holds.
function fixedLine(scene, one) {
  const [was, hold] = (one.was || '').split(/, to be held with /), place = placeInShort(scene, correctedBox(scene, one));
  const named = nameToldWith(scene, one), who = [named, was && `${was} before`].filter(text => text);
  return element('li', {}, [element('span', {className: 'box'}), element('div', {}, [
    element('strong', {text: capital(who.length > 1 ? `${who[0]} (${who[1]})` : was ? `${was} (before)` : named || 'What was fixed')}),
    `${place ? `, where: ${place}` : ''}: ${hold ? `strap for ${hold.replace(/ at least$/, '')}, at least` : 'its strap or bracket'}.`])]);
}

// What is not judged, for whoever knows what is furniture.
function greyLine(scene) {
  const found = listedPieces(scene);
  return element('li', {}, [element('span', {className: 'box'}), element('div', {}, [element('strong', {text: 'What is counted as the building is not judged. '}),
    'Is there a shelf or cabinet among it? Check that it is screwed to the wall. ',
    element('small', {text: found.length ? `These pieces of the building may be things: ${found.slice(0, listedFurniture).map(one => `${one.letter}: ${furnitureText(scene, one)}`).join('; ')}` +
      `${found.length > listedFurniture ? `; and ${found.length - listedFurniture} others` : ''}.` : ''})])]);
}

// What it does and how often, in one line.
function dangerText(scene, object) {
  const name = causesOf(object)[0];
  return name ? `${upsetText(scene, object).replace(/\.$/, '')}; sets free ${number(twoDigits(releaseOf(object)), 'J')}: ${severityText(releaseOf(object))}` : '';
}

// The thresholds that categories have (docs/output.md).
const slight_J = 1, serious_J = 15, deadly_J = 79;

// What such an energy does.
function severityText(joules) {
  return joules >= deadly_J ? 'can kill' : joules >= serious_J ? 'can injure badly' : joules >= slight_J ? 'can injure slightly' : 'does no harm';
}

function setsFreeText(object) {
  const joules = mostReleased(object);
  return joules > 0 ? `It may set free up to ${number(twoDigits(joules), 'J')}: ${severityText(joules)}` : '';
}

// What to buy for it: "brackets: 2, at 1.7 m"; '' where none are told.
function bracketText(object) {
  const {sentence = '', hold_N: force, hold_height_m: height} = object.advice;
  return force > 0 && / strap| bracket/.test(sentence) ? `Brackets: ${/ two straps /.test(sentence) ? 2 : 1}, at ${metres(height)}` : '';
}

// The note on how little floor people walk on, where nothing but walks upsets what comes first.
function fewWalksText(scene) {
  const first = numberedOnes(scene)[0];
  if (!first || causesOf(first).join() !== 'human') return '';
  return scene.notes.find(note => /^People walk on only /.test(note)) || '';
}

function sheetYears(scene, object) {
  const once = onceIn(scene, object);
  return once && `Upset by an earthquake ${once}`;
}

// What was said by hand: of this parse, and since.
function correctionLines(scene, parts) {
  const unsaved = parts.corrections.list.filter(entry => entry.isNew).map(entry => `Noted, but not in these figures yet: ${entry.text}`);
  return [...sentencesOf(scene.corrections).map(ones => givenText(scene, ones)), ...unsaved];
}

function fillSheet(scene) {
  const sheet = document.getElementById('sheet'), node = (name, text, className = '') => element(name, {text, className});
  const act = urgentOnes(scene, true), unsure = urgentOnes(scene, false), calm = calmOnes(scene).filter(isAdvised);
  const list = (title, lines, left) => lines.length ? [node('h2', title), element('ol', {className: 'todo'}, lines),
    ...left > 0 ? [node('p', `And ${plural(left, 'more object')}: see the table.`, 'hint')] : []] : [];
  const doubtful = doubtfulOnes(scene), nearly = nearlyOnes(scene), unseen = unseenOnes(scene), tall = tallOnes(scene);
  const look = piece => piece && `first look whether it is ${piece}, which is to be fastened as a whole then. `;
  const stood = object => stoodText(object) && `${stoodText(object)} `;
  const doing = object => [object, look(pieceText(scene, object)) + stood(object) + object.advice.action, [bracketText(object), dangerText(scene, object), sheetYears(scene, object)], true];
  const lines = ones => ones.map(one => sheetLine(scene, ...one));
  const order = looksOf(scene);
  const looks = [...unsure.slice(0, listedObjects).map(doing),
    ...doubtful.slice(0, listedDoubts).map(object => [object, `look whether it stands firm. ${doubtText(object)}`, [setsFreeText(object), sheetYears(scene, object)], false]),
    ...[...nearly.slice(0, listedDoubts), ...tall.slice(0, listedDoubts)].map(object => [object, object.advice.action, [], false])]
    .sort(([a], [b]) => order.indexOf(a) - order.indexOf(b));
  const holds = unseen.slice(0, listedUnseen).map(object => sheetLine(scene, object, 'go and look what holds it.', [], false));
  const kinds = disturbanceKinds.filter(kind => scene.disturbances.includes(kind.name));
  sheet.replaceChildren(
    node('p', 'This is no safety certificate. What follows was estimated from one scan: what was not seen is inferred, masses and friction are guessed, and what ' +
      'belongs together may have been told apart wrongly. Look before you act, and before you rely on it.', 'certificate'),
    ...[coarseText(scene), fewWalksText(scene)].filter(text => text).map(text => node('p', text, 'warning')),
    ...list('To act on, from the top', lines(act.map(doing)), 0),
    ...!act.length && !nothingJudged(scene) ? [node('p', 'Of what was judged nothing was found that surely has to be fastened or moved.')] : [],
    ...list('Already fixed: check the straps', (scene.corrections || []).filter(one => one.do === 'fixed' && one.held !== false).map(one => fixedLine(scene, one)), 0),
    ...scene.objects.some(object => object.grounded) ? list('Not judged, as part of the building', [greyLine(scene)], 0) : [],
    ...list('To look at', lines(looks), unsure.length + doubtful.length + nearly.length + tall.length - looks.length),
    ...list('Less urgent', lines(calm.map(doing)), 0),
    ...list('Not judged, since the scan does not show what holds these: go and look', holds, unseen.length - holds.length),
    node('p', `Reckoned with: ${listed(kinds.map(kind => oneEventText(scene, kind))) || 'nothing'}.${scene.below_hazard.length ? ` \u201cAt most\u201d: ${curveText(scene)}.` : ''} Places are in metres east (E) of the plan\u2019s left edge and north (N) of its lower edge. A joule (J) lifts 1 kg by 10 cm; what lands with less than ${slight_J} J is harmless, from ${serious_J} J on it injures badly, from ${deadly_J} J on it can kill. ` +
      'Straps must hold what is said at least: no safety margin is in it. Unsure: it may be less, or a piece of another thing.', 'hint'));
}
