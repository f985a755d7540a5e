// SPDX-License-Identifier: MIT
'use strict';

window.addEventListener('unhandledrejection', event => { document.body.dataset.error = String(event.reason && event.reason.message || event.reason); });
window.addEventListener('error', event => { document.body.dataset.error = event.message || 'error'; });

function fillHeader(scene) {
  document.getElementById('title').textContent = scene.title || 'scene';
  document.getElementById('headline').textContent = headlineOf(scene);
  document.getElementById('believe').append(...believeTexts(scene).flatMap(text => paragraph('warning', text)));
  sayIn('verification', scene.verified ? verifiedText(scene.verified) : '');
  const up = {
    given: 'given by the user', manhattan: 'from the room\u2019s three main directions',
    'dominant-plane': 'from the largest plane', 'upright-surfaces': 'along the walls', assumed: 'assumed', map: 'the map\'s z', format: 'by the file\'s format',
  };
  const facts = [
    ['scan', scene.source],
    ...scene.made ? [['made', scene.made]] : [],
    ['things that can move', String(scene.objects.filter(object => !object.grounded).length)],
    ['parts', scene.primitives.length.toLocaleString('en')],
    ['topple', scene.topple_version],
    ['backend', scene.backend + (scene.device ? ' (' + scene.device + ')' : '')],
    ['voxel', number(scene.voxel_size_m * 100, 'cm')],
    ['up', (up[scene.up_method] || scene.up_method) + ' (' + scene.up.map(v => v === null ? '\u2013' : v.toFixed(2)).join(', ') + ')'],
    ['density', number(scene.density_kg_m3, 'kg/m\u00b3')],
    ['friction', number(scene.friction)],
    ['seed', String(scene.seed)],
    ...eventFacts(scene),
  ];
  document.getElementById('facts').append(...facts.map(([name, value]) => element('div', {}, [element('dt', {text: name}), element('dd', {text: value})])));
}

// What was reckoned with, as far as this run asked for it.
function eventFacts(scene) {
  const known = [...disturbanceKinds.map(({figure}) => [figure.key, figure.name, figure.unit]),
    ['hazard_from_g', 'hazard of the place: a curve that begins at', 'g'],
    ['floor_amplification', 'floors and shelves shake', 'times as strongly as the ground'], ['tolerable_J', 'tolerated risk', 'J per event']];
  const events = scene.events || {};
  return known.filter(([key]) => events[key] !== undefined).map(([key, name, unit]) => [name, number(events[key], unit) + shakingText(key, events[key])]);
}

function fillBottom(scene) {
  const put = (id, panel, node) => {
    if (node) document.getElementById(id).append(node);
    else document.getElementById(panel).hidden = true;
  };
  put('timings', 'timings-panel', Object.keys(scene.timings_s).length ? timingBars(scene.timings_s) : null);
  put('energy', 'energy-panel', energyChart(scene.swc_energy));
  const notes = [...missingTexts(scene), ...scene.notes], count = notes.length ? plural(notes.length, 'note') : '';
  document.getElementById('notes').append(...notes.map(text => element('li', {text})));
  document.getElementById('to-about').textContent = count || 'about';
  document.getElementById('about-heading').textContent = `About this scan${count && ` (${count})`}`;
  document.getElementById('to-about').addEventListener('click', () => { document.getElementById('about').open = true; });
  document.getElementById('objects-heading').textContent = `All ${plural(scene.objects.length, 'object')}, in a table`;
  fillHow(document.getElementById('how'), scene);
  document.getElementById('table-note').textContent =
    'Click a heading to sort. Where: as on the plan, and how high above ' + (scene.floor.known ? 'the floor' : 'the lowest that was scanned') + '. Barrier: the least energy that moves an object; release: what it sets free when its largest risk comes true. ' +
    'For each disturbance: joules expected per event, \u00b1 one standard error, of the sampling of events and of what is not known of barrier and mass (not of what the grouping may have got wrong), and how often an event upsets the object.';
}

// What was said by hand, if anything was.
function fillTold(scene, parts) {
  const lines = correctionLines(scene, parts);
  document.getElementById('told-list').replaceChildren(...lines.map(text => element('li', {text})));
  document.getElementById('told').hidden = !lines.length;
}

// One button of a group is pressed at a time. Returns what presses another one.
function radioGroup(id, value, change) {
  const buttons = [...document.querySelectorAll('#' + id + ' button')];
  const press = chosen => buttons.forEach(b => b.setAttribute('aria-pressed', String(b.dataset.value === chosen)));
  const take = chosen => { press(chosen); change(chosen); };
  for (const button of buttons) button.addEventListener('click', () => take(button.dataset.value));
  press(value);
  return take;
}

const markerTexts = {middle: 'centre of mass', edge: 'edge it turns over or leaves', lands: 'where it lands', move: 'where to move it'};

function legend(scene, state, view) {
  const box = document.getElementById('legend');
  box.replaceChildren();
  const bar = colours => element('div', {className: 'bar', style: {background: `linear-gradient(90deg, ${colours.map(css).join(',')})`}});
  const ends = (low, high) => element('div', {className: 'ends'}, [element('span', {text: low}), element('span', {text: high})]);
  if (state.mode === 'risk') {
    const line = (category, text) => element('div', {}, [colourSwatch(categoryColour(scene, category)), text]);
    box.append(element('div', {className: 'keys'}, [...[...categories].reverse().map(category => line(category, `${category}${category === 'high' ? ' risk' : ''}`)),
      ...scene.objects.some(object => !object.grounded && !object.unsafety_category) ? [line('', 'not judged')] : []]));
  }
  if (state.mode === 'reach') {
    const texts = {none: 'nobody\u2019s hands upset it', low: severityText(0), medium: severityText(slight_J), high: severityText(serious_J)};
    box.append(element('div', {text: `Upset by who reaches for it (${listed(scene.people || ['people'])}):`}),
      element('div', {className: 'keys'}, [...categories].reverse().map(category => element('div', {}, [colourSwatch(categoryColour(scene, category)), texts[category]]))));
  }
  if (state.fieldsOn.includes('walks')) {
    box.append(element('div', {text: 'Floor: how many of 100 walks pass there'}), bar(scene.ramp.colours), ends('0', number(100 * scene.view.walks.most)));
  }
  for (const name of state.fieldsOn.filter(field => field !== 'walks')) {
    const {strongest} = view.fields[name].userData, {legend: text, scale, unit} = kindOf(name);
    box.append(element('div', {text: `Arrows: ${text}`}), bar(scene.ramp.colours), ends('0', number(scale * strongest, unit)));
  }
  for (const part of view.marker.parts()) {
    box.append(element('div', {className: 'part'}, [
      element('span', {className: 'dot', style: {background: markerColours[part]}}), markerTexts[part]]));
  }
  box.hidden = !box.childNodes.length;
}

// A box for each disturbance's arrows and for the floor that people walk on; one that has nothing to show says why.
function fieldBoxes(scene, view, state) {
  const fields = document.getElementById('fields');
  const entries = disturbanceNames().map(name => [name, capital(causeOf(name)), !!view.fields[name],
    scene.disturbances.includes(name) ? 'it reaches nothing here' : 'this run left it out']);
  entries.push(['walks', 'Walked floor', !!view.fields.walks,
    scene.disturbances.includes('human') ? 'no floor was found that people could walk on' : 'this run left people out']);
  const missing = [];
  for (const [name, label, there, why] of entries) {
    const box = element('input', {type: 'checkbox', disabled: !there, onchange: () => {
      view.setField(name, box.checked);
      state.fieldsOn = box.checked ? [...state.fieldsOn, name] : state.fieldsOn.filter(other => other !== name);
      legend(scene, state, view);
    }});
    box.dataset.field = name;
    fields.append(element('label', {className: there ? 'check' : 'check off', title: there ? '' : why}, [box, label.toLowerCase()]));
    if (!there) missing.push(`${label}: ${why}.`);
  }
  sayIn('missing', missing.length ? 'Not shown: ' + missing.join(' ') : '');
}

function sayThinned(scene) {
  const view = scene.view, parts = [];
  if (!view.surface.count && view.cube_m > 1.01 * scene.voxel_size_m) {
    parts.push(`Voxels are drawn merged to cubes of ${number(view.cube_m * 100, 'cm')}.`);
  }
  if (view.points.count < view.points.total) {
    // Clouds that are parsed in blocks are known by a sample; their parts count all points.
    const sampled = scene.primitives.reduce((sum, part) => sum + part.points, 0) > view.points.total;
    parts.push(`${view.points.count.toLocaleString('en')} of ${plural(view.points.total, sampled ? 'sample' : 'scan point')} are drawn` +
      (sampled ? ', each of which stands for the scan\u2019s points around it.' : '.'));
  }
  sayIn('thinned', parts.join(' '));
}

function openView(scene) {
  try {
    return new View(document.getElementById('canvas'), scene);
  } catch (error) {
    document.body.dataset.view = 'none';
    return null;
  }
}

// A still picture in the view's place, from each of four sides.
function showStill(scene) {
  const drawn = scene.painter.draws;
  sayIn('no-view', 'The 3D view needs WebGL, which this browser doesn\u2019t offer here. ' +
    (drawn ? 'Here is a picture instead; numbers are those of the riskiest objects.' : 'The table and the curves below work without it.'));
  // What is about the view, which isn't there.
  for (const part of document.querySelectorAll('.toolbar, .stage .hint')) part.hidden = true;
  document.querySelector('.compass').style.display = 'none';
  if (!drawn) return;
  const still = element('canvas', {width: 960, height: 600, role: 'img', className: 'still'});
  const sides = [['from the south-west', 0], ['from the south-east', 90], ['from the north-east', 180], ['from the north-west', -90]];
  const show = side => {
    paintScene(scene, still, 'risk', sides[side][1]);
    still.setAttribute('aria-label', `The scene ${sides[side][0]}`);
  };
  const box = element('div', {className: 'group', id: 'sides', role: 'group', 'aria-label': 'Seen from'},
    sides.map(([text], n) => element('button', {type: 'button', text, 'data-value': String(n)})));
  document.getElementById('canvas').append(box, still);
  radioGroup('sides', '0', value => show(Number(value)));
  show(0);
}

// choose(id); chosen(): the object that is, or null.
function connectPointer(scene, view, parts, choose, chosen) {
  const canvas = view.renderer.domElement, tip = document.getElementById('tip'), line = new SightLine(view);
  let down = null;
  const place = event => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  canvas.addEventListener('pointerdown', event => { down = place(event); tip.hidden = true; });
  canvas.addEventListener('pointerup', event => {
    const [x, y] = place(event);
    const moved = down ? Math.hypot(x - down[0], y - down[1]) : 99;
    down = null;
    if (moved > 5 || event.button !== 0) return;
    const [part, id] = view.pickGroup(x, y) || [-1, -1];
    if (event.shiftKey && id >= 0) parts.toggleObject(id);
    else if (event.ctrlKey || event.metaKey || document.getElementById('mend-tap').checked) parts.togglePart(part);
    else if (!event.shiftKey) choose(line.next(x, y, chosen()));
  });
  // By keys: in the middle of the view.
  canvas.addEventListener('keydown', event => {
    if (event.key !== 'Enter') return;
    event.preventDefault();
    choose(line.next(canvas.clientWidth / 2, canvas.clientHeight / 2, chosen()));
  });
  let asked = 0;
  canvas.addEventListener('pointermove', event => {
    if (down || event.pointerType === 'touch') return;
    const [x, y] = place(event);
    // Where the pointer rests: finding what lies there takes a pass over the scene.
    clearTimeout(asked);
    asked = setTimeout(() => {
      const group = view.pickGroup(x, y);
      tip.hidden = !group;
      if (!group) return;
      const [part, id] = group, object = scene.objectById.get(id);
      tip.textContent = !object ? 'not part of an object'
        : objectName(scene, id) + (part >= 0 ? `, part ${part}` : '') + (object.grounded ? ', fixed' : `, category ${categoryText(object)}`);
      tip.style.left = x + 'px';
      tip.style.top = y + 'px';
    }, 60);
  });
  canvas.addEventListener('pointerleave', () => { clearTimeout(asked); tip.hidden = true; });
}

// "#object=12"
function linkedObject(scene) {
  const found = location.hash.match(/^#object=(\d+)$/);
  return found && scene.objectById.has(Number(found[1])) ? Number(found[1]) : null;
}

// The address says what is chosen, without a step in the history for each.
function setLink(id) {
  if (id === null && !location.hash.startsWith('#object=')) return;
  try {
    history.replaceState(null, '', id === null ? '#' : `#object=${id}`);
  } catch (error) {
    // A page within another has no address.
  }
}

// On paper the view is a picture, and all pictures are there.
function preparePrint(scene, state, plan, parts) {
  document.getElementById('print').addEventListener('click', () => print());
  addEventListener('beforeprint', () => {
    // Paper can't unfold.
    const folded = [...document.querySelectorAll('main details:not([open], #mend)')];
    for (const details of folded) details.open = true;
    addEventListener('afterprint', () => folded.forEach(details => { details.open = false; }), {once: true});
    fillSheet(scene);
    fillTold(scene, parts);
    paintPictures(scene, true);
    plan.paint();
    const stage = document.getElementById('canvas');
    for (const old of stage.querySelectorAll('.on-paper')) old.remove();
    if (!scene.painter.draws || stage.querySelector('.still')) return;
    const canvas = element('canvas', {width: 1200, height: 750, className: 'on-paper'});
    paintScene(scene, canvas, state.mode === 'primitive' ? 'object' : state.mode, 0);
    stage.append(canvas);
  });
}

async function start() {
  const scene = await loadScene();
  // Of each object, of all of them (key null), and of each part.
  scene.boxes = boxesBy(scene.view, 1).set(null, wholeBox(scene.view));
  scene.partBoxes = boxesBy(scene.view, 0);
  scene.planBox = planBoxOf(scene);
  scene.floor = floorOf(scene, scene.boxes);
  scene.painter = new Painter(scene);
  scene.pictures = new Map();
  fillHeader(scene);
  fillBottom(scene);
  fillGlossary();
  sayThinned(scene);
  const view = openView(scene);
  const panel = document.getElementById('detail');
  const state = {mode: 'risk', chosen: null, fieldsOn: []};
  const mend = document.getElementById('mend');
  const say = text => { document.getElementById('say').textContent = text; };
  const repaint = () => {
    if (!view) return;
    view.paint(state.mode, state.chosen, parts.marked);
    legend(scene, state, view);
  };
  const parts = new PartsPanel(scene, () => { mend.open = mend.open || parts.marked.size > 0; repaint(); }, say);
  const on = {
    // Another one while this one stays chosen: the view labels both.
    show: (id, other) => {
      if (state.chosen !== id) choose(id);
      if (!view || !scene.boxes.has(other)) return;
      view.fly(scene.boxes.get(other));
      document.querySelector('.stage').scrollIntoView({block: 'nearest'});
    },
    join: (id, other) => {
      parts.join(id, other);
      mend.open = true;
      document.getElementById('mend-result').scrollIntoView({block: 'nearest'});
    },
    joined: (id, other) => !!parts.joinOf(id, other),
  };
  const choose = id => {
    state.chosen = id === state.chosen || !scene.objectById.has(id) ? null : id;
    showObject(panel, scene, state.chosen, choose, visit, on);
    table.choose(state.chosen);
    parts.choose(state.chosen);
    if (state.chosen === null) delete document.body.dataset.chosen;
    else document.body.dataset.chosen = state.chosen;
    setLink(state.chosen);
    say(state.chosen === null ? 'Nothing is chosen.' : chosenText(scene, scene.objectById.get(state.chosen)));
    if (view) view.mark(scene.objectById.get(state.chosen));
    repaint();
    paintPictures(scene);
  };
  // From a list or a link: the view goes there.
  const visit = id => {
    if (id !== state.chosen) choose(id);
    if (view && scene.boxes.has(id)) view.fly(scene.boxes.get(id));
  };
  // Shift takes all parts of it, as in the view.
  const pick = (id, event, then) => event && event.shiftKey ? parts.toggleObject(id) : then(id);
  const table = new ObjectTable(document.getElementById('objects'), scene, (id, event) => pick(id, event, choose));
  on.choose = (id, event) => pick(id, event, chosen => {
    choose(chosen);
    document.querySelector('.stage').scrollIntoView({block: 'nearest'});
    if (!panel.hidden) panel.querySelector('h2').focus({preventScroll: true});
  });
  fillRisk(document.getElementById('risk'), scene, on);
  fillFurniture(document.getElementById('risk'), scene, (ids, box) => {
    parts.take(ids);
    if (view) view.fly(box);
    mend.scrollIntoView({block: 'nearest'});
  });
  const plan = new Plan(document.getElementById('plan'), scene, visit);
  const recolour = () => {
    for (const swatch of document.querySelectorAll('.swatch[data-object]')) swatch.style.background = css(objectColour(scene, Number(swatch.dataset.object)));
    forgetPictures(scene);
    plan.paint();
    repaint();
    paintPictures(scene);
  };
  const compare = new ComparePanel(scene, visit, say, recolour);

  document.getElementById('wrong').addEventListener('click', () => {
    mend.open = !mend.open;
    if (mend.open) mend.scrollIntoView({block: 'nearest'});
  });
  if (view) {
    if (!scene.coloured) document.querySelector('#colour-by [data-value=photo]').remove();
    if (!scene.disturbances.includes('reach')) document.querySelector('#colour-by [data-value=reach]').remove();
    const colourBy = radioGroup('colour-by', state.mode, mode => { state.mode = mode; repaint(); });
    // Whoever puts something right must see what is one object.
    mend.addEventListener('toggle', () => { if (state.mode === (mend.open ? 'risk' : 'object')) colourBy(mend.open ? 'object' : 'risk'); });
    const hasSolids = scene.view.surface.count + scene.view.voxels.count > 0;
    radioGroup('show', hasSolids ? 'solids' : 'points', what => view.setShow(what));
    view.setShow(hasSolids ? 'solids' : 'points');
    fieldBoxes(scene, view, state);
    document.getElementById('through').addEventListener('change', event => view.setThrough(event.target.checked));
    document.getElementById('reset').addEventListener('click', () => view.reset());
    connectPointer(scene, view, parts, choose, () => state.chosen);
    repaint();
    view.render();
    window.toppleView = view;
    document.body.dataset.faces = view.faces;
    document.body.dataset.points = scene.view.points.count;
    document.body.dataset.triangles = view.renderer.info.render.triangles;
    // Milliseconds from the page's start until the first picture stood, which reading it back waits for.
    view.renderer.getContext().readPixels(0, 0, 1, 1, WebGLRenderingContext.RGBA, WebGLRenderingContext.UNSIGNED_BYTE, new Uint8Array(4));
    document.body.dataset.firstPictureMs = Math.round(performance.now());
    view.hideUnseenLabels();
  } else {
    showStill(scene);
  }
  fillTold(scene, parts);
  preparePrint(scene, state, plan, parts);
  addEventListener('keydown', event => {
    if (event.key === 'Escape' && state.chosen !== null) choose(null);
  });
  const follow = () => {
    if (linkedObject(scene) !== null) visit(linkedObject(scene));
    else if (location.hash.startsWith('#object=')) {
      const wanted = location.hash.slice(1).replace('=', ' ');
      choose(null);
      say(`There is no ${wanted} here.`);
    }
  };
  addEventListener('hashchange', follow);
  follow();
  followOutputs(view, () => parts.marked.size > 0 || !parts.corrections.saved);
  paintPictures(scene);
  setTimeout(() => plan.paint(), 30);  // the page answers before
  window.toppleChoose = choose;
  window.toppleParts = parts;
  window.toppleCompare = compare;
  window.toppleScene = scene;
  window.topplePlan = plan;
  document.body.dataset.rows = document.querySelectorAll('#objects tbody tr').length;
  document.body.dataset.ready = '1';
}

// For screen readers, when one is chosen.
function chosenText(scene, object) {
  return `${capital(objectName(scene, object.id))} chosen: ${number(object.mass_kg, 'kg')}` +
    (object.grounded ? ', fixed.' : `, category ${object.unsafety_category ? categoryText(object) : 'not known'}. ${upsetText(scene, object)}`);
}

window.toppleReady = start();
window.toppleReady.catch(error => {
  document.body.dataset.error = error.message;
  sayIn('no-view', error.message);
});
