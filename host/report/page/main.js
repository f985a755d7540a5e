// SPDX-License-Identifier: MIT
'use strict';

window.addEventListener('error', event => { document.body.dataset.error = event.message || 'error'; });

function fillHeader(scene) {
  document.getElementById('title').textContent = scene.source || 'scene';
  const loose = scene.objects.filter(object => !object.grounded).length;
  document.getElementById('summary').textContent =
    `${plural(scene.objects.length, 'object')} of ${plural(scene.primitives.length, 'primitive')}; ` +
    `${loose} of them can move, the others are the ground or fixed to it.`;
  const up = {
    given: 'given by the user', manhattan: 'from the room\u2019s three main directions',
    'dominant-plane': 'from the largest plane', 'upright-surfaces': 'along the walls', assumed: 'assumed',
  };
  const facts = [
    ['topple', scene.topple_version],
    ['backend', scene.backend + (scene.device ? ' (' + scene.device + ')' : '')],
    ['voxel', number(scene.voxel_size_m * 100, 'cm')],
    ['up', (up[scene.up_method] || scene.up_method) + ' (' + scene.up.map(v => v === null ? '\u2013' : v.toFixed(2)).join(', ') + ')'],
    ['density', number(scene.density_kg_m3, 'kg/m\u00b3')],
    ['friction', number(scene.friction)],
    ['seed', String(scene.seed)],
  ];
  const list = document.getElementById('facts');
  for (const [name, value] of facts) {
    list.append(element('div', {}, [element('dt', {text: name}), element('dd', {text: value})]));
  }
}

function fillBottom(scene) {
  const put = (id, panel, node) => {
    if (node) document.getElementById(id).append(node);
    else document.getElementById(panel).hidden = true;
  };
  put('timings', 'timings-panel', Object.keys(scene.timings_s).length ? timingBars(scene.timings_s) : null);
  put('energy', 'energy-panel', energyChart(scene.swc_energy));
  const notes = document.getElementById('notes');
  for (const note of scene.notes) notes.append(element('li', {text: note}));
  if (!scene.notes.length) document.getElementById('notes-panel').hidden = true;
  document.getElementById('table-note').textContent =
    'Click a heading to sort. Barrier: the least energy that moves an object; release: what it then can set free. ' +
    'Risks are joules per event.';
}

// One button of a group is pressed at a time.
function radioGroup(id, value, change) {
  const buttons = [...document.querySelectorAll('#' + id + ' button')];
  const press = chosen => buttons.forEach(b => b.setAttribute('aria-pressed', String(b.dataset.value === chosen)));
  for (const button of buttons) {
    button.addEventListener('click', () => {
      press(button.dataset.value);
      change(button.dataset.value);
    });
  }
  press(value);
}

function legend(scene, mode, fieldsOn, view) {
  const box = document.getElementById('legend');
  box.replaceChildren();
  if (mode === 'risk') {
    box.append(element('div', {text: 'Unsafety'}),
      element('div', {className: 'bar', style: {background: `linear-gradient(90deg, ${riskStops.map(css).join(',')})`}}),
      element('div', {className: 'ends'}, [element('span', {text: '1 safest'}), element('span', {text: '10'})]));
  }
  for (const name of fieldsOn) {
    const unit = name === 'earthquake' ? 'm/s\u00b2' : 'm/s';
    box.append(element('div', {text: `${capital(name)}: longest arrow ${number(view.fields[name].userData.strongest, unit)}`}));
  }
  box.hidden = !box.childNodes.length;
}

function sayThinned(scene) {
  const view = scene.view, parts = [];
  if (view.cube_m > 1.01 * scene.voxel_size_m) {
    parts.push(`Voxels are drawn merged to cubes of ${number(view.cube_m * 100, 'cm')}.`);
  }
  if (view.points.count < view.points.total) {
    parts.push(`${view.points.count.toLocaleString('en')} of ${plural(view.points.total, 'scan point')} are drawn.`);
  }
  const line = document.getElementById('thinned');
  line.textContent = parts.join(' ');
  line.hidden = !parts.length;
}

function openView(scene) {
  const canvas = document.getElementById('canvas');
  try {
    return new View(canvas, scene);
  } catch (error) {
    const message = document.getElementById('no-view');
    message.textContent = 'The 3D view needs WebGL, which this browser doesn\u2019t offer here. The table and the curves below work without it.';
    message.hidden = false;
    document.body.dataset.view = 'none';
    return null;
  }
}

function connectPointer(scene, view, choose) {
  const canvas = view.renderer.domElement, tip = document.getElementById('tip');
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
    const id = view.pick(x, y);
    choose(id !== null && id >= 0 ? id : null);
  });
  let asked = 0;
  canvas.addEventListener('pointermove', event => {
    if (down || event.pointerType === 'touch') return;
    const [x, y] = place(event);
    // Where the pointer rests: finding what lies there takes a pass over the scene.
    clearTimeout(asked);
    asked = setTimeout(() => {
      const id = view.pick(x, y), object = scene.objectById.get(id);
      tip.hidden = id === null;
      if (id === null) return;
      tip.textContent = !object ? 'not part of an object'
        : `object ${id}` + (object.grounded ? ', grounded' : `, unsafety ${object.unsafety === null ? '\u2013' : object.unsafety.toFixed(1)}`);
      tip.style.left = x + 'px';
      tip.style.top = y + 'px';
    }, 60);
  });
  canvas.addEventListener('pointerleave', () => { clearTimeout(asked); tip.hidden = true; });
}

function start() {
  const scene = loadScene();
  fillHeader(scene);
  fillBottom(scene);
  sayThinned(scene);
  const view = openView(scene);
  const panel = document.getElementById('detail');
  const state = {mode: 'object', chosen: null, fieldsOn: []};
  const repaint = () => {
    if (!view) return;
    view.paint(state.mode, state.chosen);
    legend(scene, state.mode, state.fieldsOn, view);
  };
  const choose = id => {
    state.chosen = id === state.chosen ? null : id;
    showObject(panel, scene, state.chosen, choose);
    table.choose(state.chosen);
    if (view) view.mark(scene.objectById.get(state.chosen));
    repaint();
  };
  const table = new ObjectTable(document.getElementById('objects'), scene, choose);
  showObject(panel, scene, null, choose);

  if (view) {
    radioGroup('colour-by', state.mode, mode => { state.mode = mode; repaint(); });
    const hasSolids = scene.view.voxels.count > 0;
    radioGroup('show', hasSolids ? 'solids' : 'points', what => view.setShow(what));
    view.setShow(hasSolids ? 'solids' : 'points');
    const fields = document.getElementById('fields');
    for (const name of Object.keys(view.fields)) {
      const box = element('input', {type: 'checkbox', onchange: () => {
        view.setField(name, box.checked);
        state.fieldsOn = box.checked ? [...state.fieldsOn, name] : state.fieldsOn.filter(other => other !== name);
        legend(scene, state.mode, state.fieldsOn, view);
      }});
      box.dataset.field = name;
      fields.append(element('label', {className: 'check'}, [box, name + ' field']));
    }
    document.getElementById('through').addEventListener('change', event => view.setThrough(event.target.checked));
    document.getElementById('reset').addEventListener('click', () => view.reset());
    connectPointer(scene, view, choose);
    repaint();
    view.render();
    window.toppleView = view;
    document.body.dataset.faces = view.faces;
    document.body.dataset.points = scene.view.points.count;
    document.body.dataset.triangles = view.renderer.info.render.triangles;
  } else {
    for (const bar of document.querySelectorAll('.toolbar')) bar.hidden = true;
  }
  window.toppleChoose = choose;
  document.body.dataset.rows = document.querySelectorAll('#objects tbody tr').length;
  document.body.dataset.ready = '1';
}

start();
