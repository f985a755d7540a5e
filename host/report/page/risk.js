// SPDX-License-Identifier: MIT
'use strict';

// The first panel: what is at risk, from what, what happens then, and what to do about it.

const listedObjects = 8, listedDoubts = 4, listedOnPhones = 3;

function byRisk(scene, wanted) {
  return scene.objects.filter(object => !object.grounded && largestRisk(object) > 0 && wanted(object))
    .sort((a, b) => largestRisk(b) - largestRisk(a) || a.id - b.id);
}

// What can fall, the largest risk first.
function riskiest(scene) {
  return byRisk(scene, object => !isDoubtful(object)).slice(0, listedObjects);
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

// What its rank, its category and its advice are of, so that they don't seem to contradict each other. rank: 0 for none.
function standingText(object, rank) {
  const words = [];
  if (rank) words.push(`${rank === 1 ? 'Largest' : `${rank}${['nd', 'rd'][rank - 2] || 'th'} largest`} risk here`);
  if (object.unsafety_category) words.push(`by itself: ${categoryText(object)}`);
  if (!(object.advice && object.advice.sentence)) words.push('tolerated, no advice');
  return capital(words.join(' \u00b7 '));
}

function riskItem(scene, object, choose, rank = 0) {
  const line = (className, text) => element('span', {className, text});
  const advice = object.advice && object.advice.sentence, mass = number(object.mass_kg, 'kg');
  const words = element('span', {className: 'words'}, [
    element('span', {className: 'head'}, [
      element('span', {className: 'swatch', style: {background: css(colourOf(scene, object.id))}}),
      element('strong', {text: capital(objectName(scene, object.id))}),
      unsafetyBadge(scene, object)]),
    line('mass', [object.name ? `object ${object.id}` : '', massIsGiven(scene, object) ? mass : mass + ({solid: ' if solid', closed: ' if of boards', hollow: ' as a shell'}[object.mass_model] || ''), sizeText(object)].filter(text => text).join(', ')),
    line('standing', standingText(object, rank)),
    line('from', isDoubtful(object) ? `As scanned a touch would upset it. ${happensText(scene, object)}` : upsetText(object)),
  ]);
  if (!isDoubtful(object)) {
    words.append(line('then', happensText(scene, object)));
    for (const text of [overturningText(object), fragilityText(object), keepClearText(scene, object)]) if (text) words.append(line('then', text));
  }
  if (object.agreement < 0.5) {
    words.append(line('then', `Only ${Math.round(100 * object.agreement)} % of the searches found it so: its parts may belong together otherwise.`));
  }
  if (advice) words.append(line('advice', advice));
  const item = element('button', {type: 'button', className: 'item', onclick: () => choose(object.id)}, [words]);
  const picture = pictureOf(scene, object.id);
  if (picture) item.prepend(picture);
  item.dataset.object = object.id;
  return item;
}

function fillRisk(panel, scene, choose) {
  const worst = riskiest(scene), doubtful = byRisk(scene, isDoubtful);
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
    `shows what holds them, or they stand on edge.${doubtful.length > listedDoubts ? ` The ${listedDoubts} of the largest risk:` : ''}`}));
  panel.append(element('div', {className: 'items'},
    doubtful.slice(0, listedDoubts).map(object => riskItem(scene, object, choose))));
}

function eventsText(scene) {
  const events = scene.events || {};
  const all = disturbanceKinds.map(kind => {
    const {key, follows, unit} = kind.figure, value = events[key];
    return kind.one_event + (follows && value !== undefined ? follows + number(value, unit) : '');
  });
  return `An event is ${listed(all, 'or')}.` +
    (events.tolerable_J === undefined ? '' : ` What has no advice is below ${number(events.tolerable_J, 'J')} per event, which is tolerated.`);
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
  const one = shown === 1;
  const listed = `${of}: by the chance that one event upsets ${one ? 'it' : 'them'}, times the energy that ${one ? 'it then sets' : 'they then set'} free.` +
    (unseen ? ` ${unseen} more ${unseen === 1 ? 'has' : 'have'} no rank, since nothing was seen to hold ${unseen === 1 ? 'it' : 'them'}.` : '');
  if (!doubtful.length) return listed;
  const risky = doubtful.some(object => largestRisk(object) > 0);
  return `${listed} ${doubtful.length} more stand${doubtful.length === 1 ? 's' : ''} on edge, or the scan hardly shows the support: ` +
    (risky ? 'below, under \u201cTo be looked at\u201d.' : 'nothing puts them at risk.');
}

function fillRiskiest(panel, scene, worst, movable, choose) {
  panel.append(element('p', {className: 'hint', text: rankedText(scene, worst.length, movable)}));
  panel.append(element('details', {}, [element('summary', {text: 'How to read this'}), element('p', {className: 'hint', text: eventsText(scene) + ' The badge is '}, [
    term('unsafety', 'unsafety'), ': it ranks, and 10 is the worst of this scene, however harmless. \u201cBy itself\u201d is the ', term('category', 'category'),
    ', none to high, whatever else is here; ? where its error leaves a lower one open. ', term('advice', 'Advice'), ' (\u2192) is for what is above the tolerated risk.'])]));
  if (worst.every(object => !(object.advice && object.advice.kind))) {
    panel.append(element('p', {className: 'hint', text: 'All of these risks are tolerated: nothing needs to be done.'}));
  }
  const list = element('div', {className: 'items'}, worst.map((object, n) => riskItem(scene, object, choose, n + 1)));
  panel.append(list);
  if (worst.length > listedOnPhones) {
    panel.append(element('button', {type: 'button', className: 'more', text: `show ${worst.length - listedOnPhones} more`,
      onclick: () => panel.classList.add('all')}));
  }
}
