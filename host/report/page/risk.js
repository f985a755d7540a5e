// SPDX-License-Identifier: MIT
'use strict';

// The first panel: what is at risk, from what, what happens then, and what to do about it.

const listedObjects = 8, listedDoubts = 4, listedLooks = 12, listedUnseen = 4, unfoldedCards = 3;

// A number that is the higher the more it is to be acted on: by category, within one above none first what is certain to be in it.
function urgencyOf(object) {
  const category = categories.indexOf(object.unsafety_category);
  return 2 * category + Number(category > 0 && Boolean(object.unsafety_certain));
}

// In the order in which one acts: by that, and then by risk.
function byUrgency(scene, wanted) {
  return scene.objects.filter(object => !object.grounded && largestRisk(object) > 0 && wanted(object))
    .sort((a, b) => urgencyOf(b) - urgencyOf(a) || largestRisk(b) - largestRisk(a) || a.id - b.id);
}

// What can fall and is to be acted on first.
function riskiest(scene) {
  return byUrgency(scene, object => !isDoubtful(object) && !isNearly(object)).slice(0, listedObjects);
}

// What is to be acted on, and what would be if one were sure of it: of medium or high category, the most urgent first.
function urgentOnes(scene, sure) {
  return byUrgency(scene, object => !isDoubtful(object) && !isNearly(object) && object.seen_enough !== false && /medium|high/.test(object.unsafety_category) &&
    sure === !(isUnsure(object) || object.piece_of >= 0 || stoodText(object)));
}

// What is to be looked at before anybody acts.
function looksOf(scene) {
  const unsure = [...urgentOnes(scene, false), ...doubtfulOnes(scene)];
  return [...byUrgency(scene, object => unsure.includes(object)), ...nearlyOnes(scene), ...tallOnes(scene)];
}

// What has its number in the views and on the plan.
function numberedOnes(scene) {
  return [...urgentOnes(scene, true), ...looksOf(scene), ...calmOnes(scene)].slice(0, listedLooks);
}

// What is at risk, and neither of those.
function calmOnes(scene) {
  const others = [...urgentOnes(scene, true), ...looksOf(scene)];
  return riskiest(scene).filter(object => object.seen_enough !== false && !others.includes(object));
}

// "3 things to act on, 8 to look at, 6 not judged"; grave: how many of those to look at are of the worst category.
function headlineText(act, look, unseen, building = 0, grave = 0) {
  const begin = act ? [`${plural(act, 'thing')} to act on`, ...look ? [`${look} to look at`] : []]
    : grave ? [`${plural(look, 'thing')} to look at, ${grave === look ? 'which' : grave} may be dangerous`]
      : ['Nothing to act on', ...look ? [`${look} to look at`] : []];
  return [...begin,
    ...building ? [`${building} in the building to check`] : [], ...unseen ? [`${unseen} not judged`] : []].join(', ');
}

function isGrave(object) {
  return object.unsafety_category === categories[categories.length - 1];
}

function headlineOf(scene) {
  if (!scene.objects.some(object => !object.grounded)) return 'Nothing here can move';
  const unseen = unseenOnes(scene).length;
  if (nothingJudged(scene)) return `Nothing was judged: the scan does not show what holds ${unseen === 1 ? 'the one thing' : `the ${unseen} things`} here`;
  const possible = (scene.possible_things || []).filter(one => categories.indexOf(one.unsafety_category) >= categories.indexOf('medium'));
  const looks = looksOf(scene);
  return headlineText(urgentOnes(scene, true).length, looks.length, unseen, possible.length, looks.filter(isGrave).length);
}

// Of the notes those that change what one may believe at all: units and poses in doubt, what is no scan, or a coarse one.
function believeTexts(scene) {
  const heavy = /^(It all extends|The points extend over|The (places of )?poses|Two directions may be up|Up could not|Nothing in the (input|scan))|askew|doubled|no scan: /;
  return [...scene.notes.filter(note => heavy.test(note)), coarseText(scene)].filter(text => text);
}

// Nothing upsets it as measured, and yet its category is above none: that of the worse end of its errors.
function isNearly(object) {
  return !object.grounded && object.seen_enough !== false && !isDoubtful(object) && !object.unsafety_certain && categories.indexOf(object.unsafety_category) > 0 &&
    Object.keys(object.risk_J).every(name => !(((object.fall_chance || {})[name] || 0) >= 1e-4));
}

// Those, the worst category and the hardest fall first.
function nearlyOnes(scene) {
  const level = object => categories.indexOf(object.unsafety_category);
  return scene.objects.filter(isNearly).sort((a, b) => level(b) - level(a) || b.release_J - a.release_J || a.id - b.id);
}

// What nothing in this run upsets, but is to be seen fastened, as its action says: what may set free most first.
function tallOnes(scene) {
  return scene.objects.filter(object => !object.grounded && object.unsafety_category === 'none' && / tall and heavy: /.test((object.advice || {}).action))
    .sort((a, b) => mostReleased(b) - mostReleased(a) || a.id - b.id);
}

// Whether no object has a risk that anything is known of: then a list without risks says nothing.
function nothingJudged(scene) {
  return !scene.objects.some(object => !object.grounded && object.seen_enough !== false);
}

// What may move, and nothing was seen to hold it: the largest first.
function unseenOnes(scene) {
  const bulk = object => Array.isArray(object.size_m) ? object.size_m.reduce((product, side) => product * (side || 0), 1) : 0;
  return scene.objects.filter(object => !object.grounded && object.seen_enough === false).sort((a, b) => bulk(b) - bulk(a) || a.id - b.id);
}

// At risk as scanned, but the scan hardly shows what holds it. What is of category none even at the worse end of its errors needs no look.
function doubtfulOnes(scene) {
  return byUrgency(scene, object => isDoubtful(object) && object.unsafety_category !== 'none');
}

// Which disturbances the run left out, and which of them found nothing to act on: notes of the page's own.
function missingTexts(scene) {
  // Whether there is wind in a room its scan doesn't tell: a note says what was taken.
  const lines = [], left = disturbanceKinds.filter(kind => !kind.may_be_left_out && !scene.disturbances.includes(kind.name)).map(kind => kind.name);
  if (scene.objects.length && left.length) {
    lines.push(`This run left out ${listed(left.map(causeOf))}: risks from there are not known. ` +
      `Parse with ${listed(left)} among the disturbances to have them.`);
  }
  if (scene.disturbances.includes('human') && !scene.view.walks.shade.some(shade => shade > 0)) {
    lines.push('No floor was found on which people could walk, so their walks put nothing at risk here.');
  }
  return lines;
}

// Of a scan whose points are so far apart that feet are badly seen: which of the objects listed stand on too little for it; '' of others.
// The program's note has the limit.
function coarseText(scene) {
  const found = scene.notes.map(note => note.match(/^The points are about (\d+) mm apart: .* what stands on less than (\d+) mm /)).find(match => match);
  if (!found) return '';
  const narrow = Number(found[2]) / 1000, centimetres = text => `${Math.round(Number(text) / 10)} cm`;
  const narrowOnes = numberedOnes(scene).filter(object => object.size_m && object.size_m[2] > 0 && Math.min(object.size_m[0], object.size_m[1]) < narrow).sort((a, b) => a.id - b.id);
  return `Coarse scan (points ${centimetres(found[1])} apart): unsure of all things narrower than ${centimetres(found[2])}` +
    `${narrowOnes.length ? `, here ${listed(narrowOnes.map(object => objectName(scene, object.id).replace(/^object /, '')))}` : ''}: a denser scan tells.`;
}

// "Risk 6.5 ± 1.3 J per walk": the largest.
function largestRiskText(object) {
  const name = causesOf(object)[0];
  if (!name) return '';
  const risk = object.risk_J[name], error = riskError(object, name), {event} = kindOf(name);
  if (risk < 0.001) return `Risk under ${Math.max(0.001, Number((risk + (error || 0)).toPrecision(1)))} J per ${event}`;
  return `Risk ${number(risk)}${within(error)} J per ${event}`;
}

// What else an object may be, and what that would mean: "unsure: one thing with object 5, 41 % likely: then 35 J, low".
function otherwiseTexts(scene, object, share) {
  return (object.alternatives || []).map(other => {
    const what = other.whole >= 0 ? `one thing with ${objectName(scene, other.whole)}` : 'two things';
    const look = other.whole >= 0 ? '' : ` (look whether its parts ${object.weakest_joint.join(' and ')} are one)`;
    const means = other.unsafety_category && other.unsafety_category !== object.unsafety_category ? `: then ${number(other.barrier_J)} J, ${other.unsafety_category}` : '';
    return `unsure: ${what}${look}, ${share(other.probability)} likely${means}`;
  });
}

// What may be otherwise, so that no figure is taken for more than it is.
function howSureText(scene, object) {
  if (object.grounded) return '';
  const share = value => `${Math.max(1, Math.round(100 * value))} %`, parts = [];
  if (object.agreement < 0.995) parts.push(`one whole thing: ${share(object.agreement)} likely`);
  parts.push(...object.piece_of >= 0 ? [pieceText(scene, object)] : [], ...otherwiseTexts(scene, object, share));
  const held = {seen: 'seen', near: 'a gap that the scan left is bridged', leaning: 'it leans on what is beside it', hidden: 'not seen', none: 'not seen'}[object.rests_by];
  if (held && object.seen_enough === false) parts.push('what holds it was not seen');
  else if (held && object.rest_probability < 0.5) parts.push(`what holds it: ${held}, ${share(object.rest_probability)} likely, one of several readings`);
  const ratio = (error, value) => error > 0 && value > 0 ? error / value : 0, mass = ratio(object.mass_error_kg, object.mass_kg);
  if (mass) parts.push(`mass \u00b1 ${share(mass)}`);
  const barrier = ratio(object.barrier_error_J, object.barrier_J);
  if (barrier) parts.push(barrier >= 1 ? 'barrier within its error of nothing' : `barrier \u00b1 ${share(barrier)}`);
  return parts.length > 0 ? `How sure: ${parts.join('; ')}.` : '';
}

// "a piece of object 5 (86 % likely)"; "" where it is likelier a thing of its own.
function pieceText(scene, object) {
  return object.piece_of >= 0 ? `a piece of ${objectName(scene, object.piece_of)} (${twoDigits(100 * object.piece_probability)} % likely)` : '';
}

// Of one whose barrier can't be told from 0: what would upset it.
function doubtText(object) {
  const {push_N: push, push_error_N: error, slide_N: slide} = object.overturning || {}, touch_N = 20, look = 'Hold it, push gently, and look.';
  if (object.mode === 'slide' && slide > touch_N) return `How far it may slide on what carries it is too poorly seen to tell: from ${Math.round(slide)} N on it slides. ${look}`;
  if (object.mode !== 'slide' && push > touch_N) return `Its foot is too poorly seen to tell: between nothing and ${Math.round(push + (error || 0))} N at its top would tip it. ${look}`;
  return 'As scanned a touch would upset it.';
}

// Of one that events which have happened before would have upset by these figures, as host/safety/advise.h has it; '' of others.
function stoodText(object) {
  const often = 0.05, upset = disturbanceKinds.filter(kind => kind.everyday && (object.fall_chance || {})[kind.name] >= often);
  return upset.length ? 'It stood there though so many pass: its foot was probably badly seen. Hold it and push gently first.' : '';
}

// The most that any way out of its place sets free.
function mostReleased(object) {
  return Math.max(releaseOf(object) || 0, ...(object.instability || []).map(step => step.S_J || 0));
}

// What of it is in doubt more than usual.
function isUnsure(object) {
  return !(object.agreement > 0.5) || object.rest_probability < 0.5;
}

// Whether there is more to do than to know about it.
function isAdvised(object) {
  if (isNearly(object)) return true;
  return !!(object.advice && object.advice.sentence) && (object.unsafety_category !== 'none' || isDoubtful(object));
}

// "44.2 kg if solid", "54 kg"
function shortMass(scene, object) {
  const mass = number(object.mass_kg, 'kg');
  return massIsGiven(scene, object) ? mass : mass + ({solid: ' if solid', closed: ' if of boards', hollow: ' as a shell', kind: ' by kind'}[object.mass_model] || '');
}

// A paragraph, where there is a text.
function paragraph(className, text) {
  return text ? [element('p', {className, text})] : [];
}

// What happens, in a sentence: "1 in 40 walks tips it over, which can injure badly." Of a piece of another thing how hard it lands says little.
function happensInShort(object) {
  const able = object.piece_of >= 0 ? '' : severityText(mostReleased(object)), name = causesOf(object)[0];
  if (object.seen_enough === false) return 'Nothing was seen to hold it.';
  if (isDoubtful(object)) return `Unsure what holds it${able && `; its fall ${able}`}.`;
  if (isNearly(object)) return 'Nothing upsets it as measured, but its foot is unsure.';
  const chance = name ? chanceText(name, (object.fall_chance || {})[name]) : '';
  if (!chance || /^no /.test(chance)) return `${name ? 'Hardly anything' : 'Nothing'} here upsets it${able && `; its fall ${able}`}.`;
  const how = {tip: ['tips it over', 'tip it over'], slide: ['pushes it off', 'push it off']}[object.mode] || ['upsets it', 'upset it'];
  const landing = severityText(releaseOf(object));
  return capital(`${chance} ${how[Number(/^\d+ in 10 /.test(chance))]}${able && `, which ${landing}`}.`);
}

// What to do, in a sentence: of the program's the first clause.
function todoInShort(object) {
  if (object.seen_enough === false) return 'Go and look what holds it.';
  if (isDoubtful(object) || stoodText(object)) return 'Hold it and push gently: does it stand firm?';
  if (isNearly(object)) return 'Check that it stands firm.';
  const {action = '', sentence} = object.advice || {};
  if (/ tall and heavy: /.test(action)) return 'Tall and heavy: see that it is fastened.';
  if (object.unsafety_category === 'none') return 'No need to act.';
  return sentence ? `${sentence.split(/, with (?!somebody)|[:;(]|\. |\.$/)[0].trim()}.` : 'Fasten it if it must not fall.';
}

// Who gets hold of it from the floor, and what upsets it then; '' where nobody does who was asked for.
function reachText(object) {
  const all = object.holds || [], unique = values => [...new Set(values)];
  if (!all.length) return '';
  const acts = {pull: 'pulled at', lean: 'leaned on', climb: 'climbed', open: 'opened, if it has drawers', fall: 'fallen against'}, falls = unique(all.filter(hold => hold.fall_chance > 0).map(hold => acts[hold.act]));
  return `Within reach of ${listed(unique(all.map(hold => hold.by)))}${falls.length ? `: it falls when ${falls.join(' or ')}` : ', who do not upset it'}`;
}

// All that there is to know of it in words, for its card and its panel.
function tellings(scene, object) {
  const doubtful = isDoubtful(object), unseen = object.seen_enough === false, known = !unseen && !isNearly(object);
  return [[isAdvised(object) || unseen ? 'advice' : '', unseen ? 'Go and look what holds it.' : object.advice.action], ['', [object.name ? `object ${object.id}` : '', shortMass(scene, object), sizeText(object)].filter(text => text).join(', ')],
    ['', placeText(scene, object)], ['', reachText(object)], ['', known ? largestRiskText(object) : ''], ['', upsetText(scene, object)], ['', known ? yearsText(scene, object) : ''],
    ['', doubtful ? doubtText(object) : ''], ['', unseen ? '' : stoodText(object)], ['', fallKnown(object) ? happensText(scene, object) : ''], ['clear', keepClearText(scene, object)],
    ['', overturningText(object)], ['', howSureText(scene, object)]]
    .flatMap(([className, text]) => paragraph(`why ${className}`, text && text.replace(/([^.?])$/, '$1.')));
}

// on: what its buttons do: choose(id, event), show(id, other) what it may be a piece of, join(id, other) and undo that, joined(id, other): whether that was said.
function riskCard(scene, object, on) {
  const words = element('span', {className: 'words'}, [
    element('span', {className: 'head'}, [element('strong', {text: capital(objectName(scene, object.id))}), categoryBadge(scene, object)]),
    element('span', {text: happensInShort(object)}),
    element('span', {className: isAdvised(object) || object.seen_enough === false ? 'advice' : 'calm', text: todoInShort(object)})]);
  const item = element('button', {type: 'button', className: 'item', onclick: event => on.choose(object.id, event)}, [words]);
  const picture = pictureOf(scene, object.id);
  if (picture) item.prepend(picture);
  item.dataset.object = object.id;
  return element('div', {className: 'card'}, [...pieceButtons(scene, object, on), item,
    element('details', {}, [element('summary', {text: 'details', 'aria-label': `details of ${objectName(scene, object.id)}`}), ...tellings(scene, object)])]);
}

function joinText(joined) {
  return joined ? 'noted, undo' : 'join';
}

// To say that it is one thing with what it may be a piece of, and to see that.
function pieceButtons(scene, object, on) {
  if (!(object.piece_of >= 0)) return [];
  const other = object.piece_of, name = objectName(scene, other);
  const join = element('button', {type: 'button', text: joinText(on.joined(object.id, other)), title: `it is one thing with ${name}`, 'data-join': other, onclick: () => on.join(object.id, other)});
  join.dataset.of = object.id;
  return [element('p', {className: 'row piece'}, [`Part of ${name}?`, join,
    element('button', {type: 'button', className: 'link', text: 'show', 'aria-label': `show ${name}`, 'data-show': other, onclick: () => on.show(object.id, other)})])];
}

// A group of the list, folded or not.
function cardGroup(title, children, open = false) {
  return element('details', {className: 'cards', open}, [element('summary', {}, [element('h3', {text: title})]), ...children]);
}

// What is to be acted on, looked at, and less urgent. The first few cards are seen at once, the others behind a fold: one screen holds what matters.
function fillRisk(panel, scene, on) {
  const act = urgentOnes(scene, true), looks = looksOf(scene), unseen = unseenOnes(scene), calm = calmOnes(scene);
  const boxOf = objects => objects.length ? [element('div', {className: 'items'}, objects.map(object => riskCard(scene, object, on)))] : [];
  const left = (objects, most) => paragraph('hint', objects.length > most ? `And ${objectList(objects.slice(most).map(({id}) => id))}.` : '');
  const folded = (objects, first, ...hints) => [...boxOf(objects.slice(0, first)),
    ...objects.length > first ? [element('details', {}, [element('summary', {text: `${objects.length - first} more`}), ...boxOf(objects.slice(first)), ...hints])] : hints];
  const seenLooks = Math.max(0, unfoldedCards - act.length), openLooks = !act.length || seenLooks > 0 && looks.some(isGrave);
  panel.append(...act.length ? [cardGroup('To act on', folded(act, unfoldedCards), true)] : [],
    ...looks.length + unseen.length ? [cardGroup(looks.length ? 'To look at' : 'Not judged', folded([...looks.slice(0, listedLooks), ...unseen.slice(0, listedUnseen)], openLooks ? seenLooks : Infinity,
      ...left(looks, listedLooks), ...left(unseen, listedUnseen)), openLooks)] : [],
    ...calm.length ? [cardGroup(`Less urgent (${calm.length})`, [...boxOf(calm.slice(0, listedObjects)), ...left(calm, listedObjects)])] : []);
}

// How to read the list.
function fillHow(node, scene) {
  const line = (...parts) => element('p', {}, parts), events = disturbanceKinds.filter(kind => scene.disturbances.includes(kind.name)).map(kind => oneEventText(scene, kind));
  node.append(line('Act from the top: cards go by ', term('category', 'category'), ', high to none, within one those of which it is sure first, and then by ', term('risk', 'risk'),
    '. Unsure: its errors leave a lower one open, or it may be part of another thing. What is \u201cnone\u201d falls too seldom or too softly to matter.', events.length ? ` An event is ${listed(events, 'or')}.` : ''),
  line('\u00b1 is one standard error. \u201cIf solid\u201d: the mass is that of its whole volume, at ' +
    `${number(scene.density_kg_m3, 'kg/m\u00b3')}, about that of wood; what is hollow is lighter. Straps must hold what is said at least: no safety margin is in it. `, term('advice', 'Advice'),
  ' (\u2192) is what brings the risk below the tolerated one; where it is not to move the thing, no safer place was found within 1.5 m on what carries it, or it is not one of the 16 of the largest ' +
    'risk, for which one is looked for.'));
}
