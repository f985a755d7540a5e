// SPDX-License-Identifier: MIT
'use strict';

// The first panel: what is at risk, from what, what happens then, and what to do about it.

const listedObjects = 8, listedDoubts = 4, listedOnPhones = 3;

// In the order in which one acts: by category, and within one by risk.
function byUrgency(scene, wanted) {
  const level = object => categories.indexOf(object.unsafety_category);
  return scene.objects.filter(object => !object.grounded && largestRisk(object) > 0 && wanted(object))
    .sort((a, b) => level(b) - level(a) || largestRisk(b) - largestRisk(a) || a.id - b.id);
}

// What can fall and is to be acted on first.
function riskiest(scene) {
  return byUrgency(scene, object => !isDoubtful(object)).slice(0, listedObjects);
}

// At risk as scanned, but the scan hardly shows what holds it.
function doubtfulOnes(scene) {
  return byUrgency(scene, isDoubtful);
}

// Which disturbances the run left out, and which of them found nothing to act on.
function missingText(scene) {
  const lines = [], left = disturbanceNames().filter(name => !scene.disturbances.includes(name));
  if (scene.objects.length && left.length) {
    lines.push(`This run left out ${listed(left.map(causeOf))}: risks from there are not known. ` +
      `Parse with the disturbances ${listed(disturbanceNames())} to have them.`);
  }
  if (scene.disturbances.includes('human') && !scene.view.walks.shade.some(shade => shade > 0)) {
    lines.push('No floor was found on which people could walk, so their walks put nothing at risk here.');
  }
  // What the list below stands or falls with.
  lines.push(...scene.notes.filter(note => /^(People walk|Object|A ceiling)/.test(note)));
  return lines.join(' ');
}

// "Risk 6.5 ± 1.3 J per walk": the largest.
function largestRiskText(object) {
  const name = causesOf(object)[0];
  if (!name) return '';
  const risk = object.risk_J[name], error = riskError(object, name), {event} = kindOf(name);
  if (risk < 0.001) return `Risk under ${Math.max(0.001, Number((risk + (error || 0)).toPrecision(1)))} J per ${event}`;
  return `Risk ${number(risk)}${within(error)} J per ${event}`;
}

// How far the searches agree that its parts are one thing; '' where they do.
function agreementText(object) {
  if (object.grounded || !(object.agreement < 0.995)) return '';
  const share = Math.round(100 * object.agreement);
  return object.agreement > 0.5 ? `${share} % of the searches found it so.`
    : `Uncertain: only ${share} % of the searches found it so. Its parts may belong together otherwise, and all figures are of this reading of the scan.`;
}

// What to do, so that it does not seem to contradict the category.
function actionText(scene, object) {
  const advice = object.advice && object.advice.sentence, tolerable = (scene.events || {}).tolerable_J;
  const limit = tolerable === undefined ? 'what is tolerated' : `the ${number(tolerable, 'J')} per event that this run tolerates`;
  if (object.unsafety_category !== 'none' || isDoubtful(object)) {
    return advice || (object.unsafety_category ? `Its risk is below ${limit}: if it must not fall all the same, fasten it.` : '');
  }
  if (!advice) return 'No need to act.';
  return `No need to act. To bring its risk below ${limit} all the same: ${advice.charAt(0).toLowerCase()}${advice.slice(1)}`;
}

// Whether there is more to do than to know about it.
function isAdvised(object) {
  return !!(object.advice && object.advice.sentence) && (object.unsafety_category !== 'none' || isDoubtful(object));
}

function riskItem(scene, object, choose) {
  const mass = number(object.mass_kg, 'kg'), doubtful = isDoubtful(object);
  const words = element('span', {className: 'words'}, [
    element('span', {className: 'head'}, [objectSwatch(scene, object.id), element('strong', {text: capital(objectName(scene, object.id))}),
      categoryBadge(scene, object)])]);
  const say = (className, text) => { if (text) words.append(element('span', {className, text})); };
  say('mass', [object.name ? `object ${object.id}` : '', massIsGiven(scene, object) ? mass : mass + ({solid: ' if solid', closed: ' if of boards', hollow: ' as a shell'}[object.mass_model] || ''), sizeText(object)].filter(text => text).join(', '));
  say('standing', largestRiskText(object));
  say(object.agreement <= 0.5 ? 'doubt' : 'mass', agreementText(object));
  say('mass', placeText(scene, object));
  say('from', doubtful ? `As scanned a touch would upset it. ${happensText(scene, object)}` : upsetText(object));
  if (!doubtful) for (const text of [happensText(scene, object), keepClearText(scene, object)]) say('then', text);
  say(isAdvised(object) ? 'advice' : 'calm', actionText(scene, object));
  if (!doubtful) for (const text of [overturningText(object), fragilityText(object)]) say('then figures', text);
  const item = element('button', {type: 'button', className: 'item', onclick: () => choose(object.id)}, [words]);
  const picture = pictureOf(scene, object.id);
  if (picture) item.prepend(picture);
  item.dataset.object = object.id;
  return item;
}

function fillRisk(panel, scene, choose) {
  const worst = riskiest(scene), doubtful = doubtfulOnes(scene);
  const movable = scene.objects.filter(object => !object.grounded).length;
  panel.append(element('h2', {text: 'What is at risk, and what to do'}));
  const missing = missingText(scene);
  if (missing) panel.append(element('p', {className: 'warning', text: missing}));
  if (!worst.length) {
    panel.append(element('p', {className: 'hint', text: !movable ? 'No object was found that could fall.'
      : `None of the disturbances puts ${doubtful.length ? 'any other' : 'an'} object at risk.`}));
  } else {
    fillRiskiest(panel, scene, worst, movable, choose);
  }
  if (!doubtful.length) return;
  panel.append(element('h3', {text: 'To be looked at'}));
  panel.append(element('p', {className: 'hint', text:
    `As scanned, ${plural(doubtful.length, 'more object')} at risk would fall at the slightest push, and yet stood there: the scan hardly ` +
    `shows what holds them, or they stand on edge.${doubtful.length > listedDoubts ? ` The first ${listedDoubts}, in the same order:` : ''}`}));
  panel.append(element('div', {className: 'items'},
    doubtful.slice(0, listedDoubts).map(object => riskItem(scene, object, choose))));
}

function eventsText(scene) {
  const events = scene.events || {};
  const all = disturbanceKinds.map(kind => {
    const {key, follows, unit} = kind.figure, value = events[key];
    return kind.one_event + (follows && value !== undefined ? follows + number(value, unit) + shakingText(key, value) : '');
  });
  return `An event is ${listed(all, 'or')}.`;
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
  const uncertain = doubtful.length + unseen;
  const of = riskiestOf(shown, movable - uncertain, uncertain ? 'whose barrier is above its error' : 'that can move');
  const listed = `${of}.` + (unseen ? ` ${unseen} more ${unseen === 1 ? 'has' : 'have'} no rank, since nothing was seen to hold ${unseen === 1 ? 'it' : 'them'}.` : '');
  if (!doubtful.length) return listed;
  const atRisk = doubtful.filter(object => largestRisk(object) > 0), urgent = atRisk.filter(object => /medium|high/.test(object.unsafety_category)).length;
  return `${listed} ${doubtful.length} more stand${doubtful.length === 1 ? 's' : ''} on edge, or the scan hardly shows the support: ` +
    (atRisk.length ? `below, under \u201cTo be looked at\u201d${urgent ? `, ${urgent} of them perhaps medium or high` : ''}.` : 'nothing puts them at risk.');
}

function fillRiskiest(panel, scene, worst, movable, choose) {
  panel.append(element('p', {className: 'order'}, ['Act from the top: cards go by ', term('category', 'category'),
    ', which says how likely an event makes the thing fall and how hard it then lands (? it may be lower), and within one by ', term('risk', 'risk'), '.']));
  panel.append(element('p', {className: 'hint', text: rankedText(scene, worst.length, movable)}));
  panel.append(element('details', {}, [element('summary', {text: 'How to read this'}), element('p', {className: 'hint', text: eventsText(scene) +
    ' The badge is the category, high to none; ? where its errors leave a lower one open. What is \u201cnone\u201d falls too seldom or too softly ' +
    'to matter. \u00b1 is one standard error. '}, [term('advice', 'Advice'), ' (\u2192) is what brings the risk below the tolerated one; where it is not to ' +
    'move the thing, no safer place was found within 1.5 m on what carries it, or it is not one of the 16 of the largest risk, for which one is looked for.'])]));
  if (worst.every(object => object.unsafety_category === 'none' && !(object.advice && object.advice.kind))) {
    panel.append(element('p', {className: 'hint', text: 'All of these risks are tolerated: nothing needs to be done.'}));
  }
  const list = element('div', {className: 'items'}, worst.map(object => riskItem(scene, object, choose)));
  panel.append(list);
  if (worst.length > listedOnPhones) {
    panel.append(element('button', {type: 'button', className: 'more', text: `show ${worst.length - listedOnPhones} more`,
      onclick: () => panel.classList.add('all')}));
  }
}
