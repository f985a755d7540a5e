// SPDX-License-Identifier: MIT
'use strict';

// The first panel: what is at risk, from what, what happens then, and what to do about it.

const listedObjects = 8, listedDoubts = 4, listedUnseen = 4, listedOnPhones = 3;

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

// At risk as scanned, but the scan hardly shows what holds it.
function doubtfulOnes(scene) {
  return byUrgency(scene, isDoubtful);
}

// Which disturbances the run left out, and which of them found nothing to act on.
function missingText(scene) {
  // Whether there is wind in a room its scan doesn't tell: a note says what was taken.
  const lines = [], left = disturbanceKinds.filter(kind => !kind.may_be_left_out && !scene.disturbances.includes(kind.name)).map(kind => kind.name);
  if (scene.objects.length && left.length) {
    lines.push(`This run left out ${listed(left.map(causeOf))}: risks from there are not known. ` +
      `Parse with ${listed(left)} among the disturbances to have them.`);
  }
  if (scene.disturbances.includes('human') && !scene.view.walks.shade.some(shade => shade > 0)) {
    lines.push('No floor was found on which people could walk, so their walks put nothing at risk here.');
  }
  // What the list below stands or falls with.
  lines.push(...scene.notes.filter(note => /^(People walk|Object|A ceiling|The hazard curve|\S+ m\/s\u00b2 is)/.test(note)));
  return lines.join(' ');
}

// Of a scan whose points are so far apart that feet are badly seen: which of the objects listed stand on too little for it; '' of others.
// The program's note has the limit.
function coarseText(scene) {
  const found = scene.notes.map(note => note.match(/^The points are about (\d+) mm apart: .* what stands on less than (\d+) mm /)).find(match => match);
  if (!found) return '';
  const narrow = Number(found[2]) / 1000, centimetres = text => `${Math.round(Number(text) / 10)} cm`;
  const narrowOnes = [...riskiest(scene), ...doubtfulOnes(scene).slice(0, listedDoubts), ...nearlyOnes(scene).slice(0, listedDoubts)]
    .filter(object => object.size_m && object.size_m[2] > 0 && Math.min(object.size_m[0], object.size_m[1]) < narrow).sort((a, b) => a.id - b.id);
  return `Coarse scan (points ${centimetres(found[1])} apart): barriers of all things narrower than ${centimetres(found[2])} are doubtful` +
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

// What else an object may be, and what that would mean: "one thing with object 5, 41 % likely: then 35 J, low".
function otherwiseTexts(scene, object, share) {
  return (object.alternatives || []).map(other => {
    const what = other.whole >= 0 ? `one thing with ${objectName(scene, other.whole)}` : 'two things';
    const look = other.whole >= 0 ? '' : ` (look whether its parts ${object.weakest_joint.join(' and ')} are one)`;
    const means = other.unsafety_category && other.unsafety_category !== object.unsafety_category ? `: then ${number(other.barrier_J)} J, ${other.unsafety_category}` : '';
    return `perhaps ${what}${look}, ${share(other.probability)} likely${means}`;
  });
}

// What may be otherwise, so that no figure is taken for more than it is.
function howSureText(scene, object) {
  if (object.grounded) return '';
  const share = value => `${Math.max(1, Math.round(100 * value))} %`, parts = [];
  if (object.agreement < 0.995) parts.push(`one whole thing: ${share(object.agreement)} likely`);
  parts.push(...otherwiseTexts(scene, object, share));
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
  const {push_N: push, push_error_N: error, slide_N: slide} = object.overturning || {}, touch_N = 20, look = 'Push it by hand, and look.';
  if (object.mode === 'slide' && slide > touch_N) return `How far it may slide on what carries it is too poorly seen to tell: from ${Math.round(slide)} N on it slides. ${look}`;
  if (object.mode !== 'slide' && push > touch_N) return `Its foot is too poorly seen to tell: between nothing and ${Math.round(push + (error || 0))} N at its top would tip it. ${look}`;
  return 'As scanned a touch would upset it.';
}

// Of one that events which have happened before would have upset by these figures, as host/safety/advise.h has it; '' of others.
function stoodText(object) {
  const often = 0.05, upset = disturbanceKinds.filter(kind => kind.everyday && (object.fall_chance || {})[kind.name] >= often);
  return upset.length ? 'It stood there though so many pass: its foot was probably badly seen. Push it by hand first.' : '';
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
  return massIsGiven(scene, object) ? mass : mass + ({solid: ' if solid', closed: ' if of boards', hollow: ' as a shell'}[object.mass_model] || '');
}

// on: what its buttons do: choose(id, event), show(id, other) what it may be a piece of, join(id, other) and undo that, joined(id, other): whether that was said.
function riskCard(scene, object, on) {
  const doubtful = isDoubtful(object), unseen = object.seen_enough === false, plain = !doubtful && !unseen && !isNearly(object);
  const words = element('span', {className: 'words'}, [
    element('span', {className: 'head'}, [objectSwatch(scene, object.id), element('strong', {text: capital(objectName(scene, object.id))}),
      categoryBadge(scene, object)])]);
  const say = (className, text) => { if (text) words.append(element('span', {className, text})); };
  say('mass', [object.name ? `object ${object.id}` : '', shortMass(scene, object), sizeText(object)].filter(text => text).join(', '));
  if (plain || doubtful) say('standing', largestRiskText(object));
  say(isUnsure(object) ? 'doubt' : 'mass', howSureText(scene, object));
  const piece = pieceText(scene, object);
  if (piece) say('doubt', `Look first: it may be ${piece}. If so, say so below this card.`);
  say('mass', placeText(scene, object));
  if (!unseen) say('doubt', stoodText(object));
  if (doubtful) say('from', `${doubtText(object)} ${happensText(scene, object)}`);
  else if (plain) say('from', upsetText(scene, object));
  if (plain || doubtful) say('from', yearsText(scene, object));
  if (plain) for (const text of [happensText(scene, object), keepClearText(scene, object)]) say('then', text);
  say(isAdvised(object) || unseen ? 'advice' : 'calm', unseen ? 'Go and look what holds it.' : object.advice.action);
  if (plain) say('then figures', overturningText(object));
  const item = element('button', {type: 'button', className: 'item', onclick: event => on.choose(object.id, event)}, [words]);
  const picture = pictureOf(scene, object.id);
  if (picture) item.prepend(picture);
  item.dataset.object = object.id;
  return element('div', {className: 'card'}, [item, ...pieceButtons(scene, object, on)]);
}

function joinText(scene, other, joined) {
  return joined ? 'noted, undo' : `one thing with ${objectName(scene, other)}`;
}

// To say that it is one thing with what it may be a piece of, and to see that.
function pieceButtons(scene, object, on) {
  if (!(object.piece_of >= 0)) return [];
  const other = object.piece_of, name = objectName(scene, other);
  const join = element('button', {type: 'button', text: joinText(scene, other, on.joined(object.id, other)), 'data-join': other, onclick: () => on.join(object.id, other)});
  join.dataset.of = object.id;
  return [element('p', {className: 'row piece'}, [join,
    element('button', {type: 'button', className: 'link', text: `show ${name}`, 'data-show': other, onclick: () => on.show(object.id, other)})])];
}

// A paragraph, where there is a text.
function paragraph(className, text) {
  return text ? [element('p', {className, text})] : [];
}

function fillRisk(panel, scene, on) {
  const worst = riskiest(scene), doubtful = doubtfulOnes(scene);
  const movable = scene.objects.filter(object => !object.grounded).length;
  panel.append(element('h2', {text: 'What is at risk, and what to do'}),
    ...scene.notes.filter(text => /left out, as for/.test(text)).flatMap(note => paragraph('hint', note)),
    ...[coarseText(scene), missingText(scene)].flatMap(text => paragraph('warning', text)));
  if (worst.length) fillRiskiest(panel, scene, worst, movable, on);
  else panel.append(...paragraph('hint', nothingJudged(scene) ? 'Nothing was judged: the first line of this page says why.'
    : `None of the disturbances puts ${doubtful.length ? 'any other' : 'an'} object at risk.`));
  fillLooks(panel, scene, doubtful, on);
}

// What is to be looked at: since it would fall at once, since it might with a smaller foot, and since nobody saw what holds it.
function fillLooks(panel, scene, doubtful, on) {
  const nearly = nearlyOnes(scene), unseen = unseenOnes(scene);
  const cards = (objects, most) => panel.append(element('div', {className: 'items'}, objects.slice(0, most).map(object => riskCard(scene, object, on))),
    ...objects.length > most ? [element('p', {className: 'hint', text: `And ${listed(objects.slice(most, most + 12).map(object => objectName(scene, object.id)))}` +
      (objects.length > most + 12 ? `, and ${objects.length - most - 12} more` : '') + '.'})] : []);
  if (doubtful.length || nearly.length) panel.append(element('h3', {text: 'To be looked at'}));
  if (doubtful.length) {
    const [them, stand] = doubtful.length === 1 ? ['it', 'it stands'] : ['them', 'they stand'];
    panel.append(...paragraph('hint', `Of ${plural(doubtful.length, 'more object')} at risk the scan hardly shows what holds ${them}, or ` +
      `${stand} on edge: the least push that upsets ${them} can\u2019t be told from nothing.`));
    cards(doubtful, listedDoubts);
  }
  if (nearly.length) {
    panel.append(...paragraph('hint', `${doubtful.length ? 'And ' : ''}${plural(nearly.length, 'object')} that nothing upsets as measured, but might:`));
    cards(nearly, listedDoubts);
  }
  const tall = tallOnes(scene);
  if (tall.length) {
    panel.append(element('h3', {text: 'Tall and heavy: see that it is fastened'}), element('p', {className: 'hint', text: 'Nothing in this run upsets these.'}),
      objectLinks(scene, tall.map(object => [object.id, sizeText(object)]), on.choose));
  }
  if (!unseen.length) return;
  panel.append(element('h3', {text: 'The scan does not show what holds these: go and look'}),
    element('p', {className: 'hint', text: `${plural(unseen.length, 'object')} without a rank, the largest first; on the plan they have a \u201c?\u201d.`}));
  cards(unseen, listedUnseen);
}

function eventsText(scene) {
  const all = disturbanceKinds.filter(kind => scene.disturbances.includes(kind.name)).map(kind => oneEventText(scene, kind));
  return all.length ? `An event is ${listed(all, 'or')}.` : '';
}

// "The 3 riskiest of the 5 objects that can fall"; fewer words where that is all of them, or one.
function riskiestOf(shown, all, which) {
  if (all === 1) return `The one object ${which}`;
  if (shown >= all) return `The ${all} objects ${which}, the riskiest first`;
  return `The ${shown === 1 ? '' : shown + ' '}riskiest of the ${all} objects ${which}`;
}

// Of which objects the list is, and where the others are.
function rankedText(scene, shown, movable) {
  const doubtful = scene.objects.filter(isDoubtful);
  const unseen = scene.objects.filter(object => !object.grounded && !isDoubtful(object) && object.seen_enough === false).length;
  const nearly = nearlyOnes(scene).length, uncertain = doubtful.length + unseen + nearly;
  const of = riskiestOf(shown, movable - uncertain, uncertain ? 'whose barrier is above its error' : 'that can move');
  const listed = `${of}.` + (unseen ? ` ${unseen} more ${unseen === 1 ? 'has' : 'have'} no rank, since nothing was seen to hold ${unseen === 1 ? 'it' : 'them'}.` : '') +
    (nearly ? ` ${nearly} more nothing upsets as measured, but ${nearly === 1 ? 'its errors leave a category' : 'their errors leave categories'} open.` : '');
  if (!doubtful.length) return listed;
  const atRisk = doubtful.filter(object => largestRisk(object) > 0), urgent = atRisk.filter(object => /medium|high/.test(object.unsafety_category)).length;
  return `${listed} ${doubtful.length} more stand${doubtful.length === 1 ? 's' : ''} on edge, or the scan hardly shows the support: ` +
    (atRisk.length ? `below, under \u201cTo be looked at\u201d${urgent ? `, ${urgent} of them perhaps medium or high` : ''}.` : 'nothing puts them at risk.');
}

function fillRiskiest(panel, scene, worst, movable, on) {
  panel.append(element('p', {className: 'order'}, ['Act from the top: cards go by ', term('category', 'category'),
    ', which says how likely an event makes the thing fall and how hard it then lands, within one those of which it is certain first (? it may be lower), and then by ', term('risk', 'risk'), '.']));
  panel.append(element('p', {className: 'hint', text: rankedText(scene, worst.length, movable)}));
  panel.append(element('details', {}, [element('summary', {text: 'How to read this'}), element('p', {className: 'hint', text: eventsText(scene) +
    ' The badge is the category, high to none; ? where its errors leave a lower one open, or it may be a piece of another thing. What is \u201cnone\u201d falls too seldom or too softly ' +
    'to matter. \u00b1 is one standard error. \u201cIf solid\u201d: the mass is that of its whole volume, at ' +
    `${number(scene.density_kg_m3, 'kg/m\u00b3')}, about that of wood; what is hollow is lighter. Straps must hold what is said at least: no safety margin is in it. `}, [term('advice', 'Advice'), ' (\u2192) is what brings the risk below the tolerated one; where it is not to ' +
    'move the thing, no safer place was found within 1.5 m on what carries it, or it is not one of the 16 of the largest risk, for which one is looked for.'])]));
  const tolerated = worst.every(object => object.unsafety_category === 'none' && !(object.advice && object.advice.kind));
  panel.append(...paragraph('hint', tolerated ? 'All of these risks are tolerated: nothing needs to be done.' : ''),
    element('div', {className: 'items'}, worst.map(object => riskCard(scene, object, on))),
    ...worst.length > listedOnPhones ? [element('button', {type: 'button', className: 'more', text: `show ${worst.length - listedOnPhones} more`,
      onclick: () => panel.classList.add('all')})] : []);
}
