// SPDX-License-Identifier: MIT
'use strict';

// It stands, and yet its barrier can't be told from 0: its risk says more about the scan than about it.
function isDoubtful(object) {
  return !object.grounded && object.barrier_J !== null && object.barrier_J <= object.barrier_error_J;
}

// A barrier that can't be told from 0 is anything up to where its error ends.
function barrierText(object, unit) {
  if (object.grounded || object.barrier_J === null) return number(null);
  if (!isDoubtful(object)) return number(object.barrier_J, unit);
  return '0\u2013' + number(twoDigits(object.barrier_J + object.barrier_error_J), unit);
}

// Object columns: heading, value to sort by, and what stands in the cell.
function objectColumns(scene) {
  const columns = [
    {name: 'Object', value: object => object.id, cell: object => [
      element('button', {type: 'button', className: 'plain', 'aria-label': `choose ${objectName(scene, object.id)}`}, [
        objectSwatch(scene, object.id), object.name ? `${object.name} (${object.id})` : String(object.id)])]},
    {name: 'Mass (kg)', value: object => object.mass_kg},
    {name: 'Barrier (J)', term: 'barrier', value: object => object.grounded ? Infinity : object.barrier_J, cell: object => [barrierText(object)]},
    {name: 'Release (J)', term: 'release', value: object => object.grounded ? -1 : releaseOf(object), number: object => object.grounded ? null : releaseOf(object)},
    {name: 'How', text: true, value: howText, cell: object => [howText(object)]},
  ];
  for (const name of scene.disturbances) {
    columns.push({name: capital(causeOf(name)) + ' (J)', term: 'risk', value: object => object.risk_J[name], cell: object => riskCell(object, name)});
  }
  if (scene.objects.some(object => object.advice && object.advice.kind)) {
    columns.push({name: 'Advice', term: 'advice', text: true, value: adviceText, cell: object => [adviceText(object)]});
  }
  columns.push({name: 'Where (m)', text: true, value: object => { const at = planPlace(scene, object); return at && at.east; }, cell: object => placeCell(scene, object)});
  columns.push({name: 'Unsafety', term: 'unsafety', value: object => object.unsafety, cell: object => [object.unsafety === null ? '\u2013' : object.unsafety.toFixed(1)]});
  // Within one what is certain first, then by unsafety, which is 10 at most.
  columns.push({name: 'Category', term: 'category', text: true, value: object => object.grounded || !object.unsafety_category ? null
    : 20 * urgencyOf(object) + object.unsafety, cell: object => [object.grounded ? '\u2013' : categoryBadge(scene, object)]});
  return columns;
}

function howText(object) {
  return object.grounded ? 'fixed' : {tip: 'tips', slide: 'slides'}[object.mode] || '\u2013';
}

function adviceText(object) {
  return (object.advice || {}).kind || (isNearly(object) ? 'check' : '\u2013');
}

// One standard error of a risk; scenes of earlier versions know that of the sampling alone.
function riskError(object, name) {
  return (object.risk_error_J || object.risk_spread_J || {})[name];
}

// Why it is unsure of its category.
function unsureText(object) {
  if (object.rest_probability < 0.5) return 'how it stands is one of several readings of the scan';
  if ((object.overturning || {}).tilt_deg < 3) return 'it stands, although the slightest lean would upset it by these figures';
  if (stoodText(object)) return 'it stands, although walks like those before would have upset it by these figures';
  return object.unsafety_category === 'none' ? 'it may be a piece of another thing, or the scan hardly shows what holds it' : 'its errors, or what it may be a piece of, leave a lower one open';
}

// The category, and whether the errors leave it open.
function categoryText(object) {
  return object.unsafety_category ? object.unsafety_category + (object.unsafety_certain ? '' : ', unsure') : '\u2013';
}

// Joules per event, their error, and the chance per event that it falls.
function riskCell(object, name) {
  const risk = object.risk_J[name];
  if (object.seen_enough === false) return ['\u2013'];
  if (!(risk > 0)) {
    const open = isNearly(object) && riskError(object, name) > 0;
    return [number(risk), ...open ? [element('small', {text: `if its foot is smaller up to ${number(mostReleased(object), 'J')}`})] : []];
  }
  const error = riskError(object, name), chance = (object.fall_chance || {})[name];
  const cell = [number(risk)];
  if (error !== undefined && error !== null) cell.push(element('span', {className: 'pm', text: ` \u00b1 ${error < risk / 1000 ? '0' : twoDigits(error)}`}));
  if (chance !== undefined && chance !== null) cell.push(element('small', {text: chanceText(name, chance)}));
  return cell;
}

// White or black, whichever stands out more (WCAG's relative luminance): by 4.5 to 1 at least.
function textOn(colour) {
  const [red, green, blue] = colour.map(value => value <= 10 ? value / 3295 : ((value / 255 + 0.055) / 1.055) ** 2.4);
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.179 ? '#000' : '#fff';
}

// Why it has none.
function noCategoryText(object) {
  return object.seen_enough === false ? 'nothing was seen to hold it' : 'no disturbance was asked for';
}

function categoryBadge(scene, object) {
  if (!object.unsafety_category) return element('span', {className: 'category', text: 'not judged', title: noCategoryText(object)});
  const colour = categoryColour(scene, object.unsafety_category);
  return element('span', {
    className: 'category', title: 'category' + (object.unsafety_certain ? '' : `: ${unsureText(object)}`), text: categoryText(object),
    style: {background: css(colour), color: textOn(colour)},
  });
}

class ObjectTable {
  constructor(table, scene, choose) {
    this.scene = scene;
    this.columns = objectColumns(scene);
    this.body = table.tBodies[0];
    this.rows = new Map();
    this.heads = this.columns.map((column, i) => {
      const head = element('th', {className: column.text ? 'text' : '', scope: 'col'},
        [element('button', {type: 'button', text: column.name, title: column.term ? glossary[column.term][1] : '', onclick: () => this.sort(i)})]);
      return head;
    });
    table.tHead.append(element('tr', {}, this.heads));
    for (const object of scene.objects) {
      const cells = this.columns.map(column => element('td', {className: column.text ? 'text' : ''},
        column.cell ? column.cell(object) : [number(column.number ? column.number(object) : column.value(object))]));
      const minor = object.grounded || object.unsafety_category === 'none';
      const row = element('tr', {className: minor ? 'minor' : '', onclick: event => choose(object.id, event)}, cells);
      // Shift-click takes parts, and no text.
      row.addEventListener('mousedown', event => { if (event.shiftKey) event.preventDefault(); });
      this.rows.set(object.id, row);
    }
    this.sort(this.columns.length - 1, -1);
  }

  sort(column, direction) {
    this.direction = direction || (this.column === column ? -this.direction : 1);
    this.column = column;
    const value = this.columns[column].value;
    const missing = v => v === null || v === undefined;
    const objects = this.scene.objects.slice().sort((a, b) => {
      const x = value(a), y = value(b);
      if (missing(x) || missing(y)) return missing(x) - missing(y) || a.id - b.id;
      return (x < y ? -1 : x > y ? 1 : 0) * this.direction || a.id - b.id;
    });
    this.heads.forEach((head, i) => {
      if (i === column) head.setAttribute('aria-sort', this.direction > 0 ? 'ascending' : 'descending');
      else head.removeAttribute('aria-sort');
    });
    this.body.append(...objects.map(object => this.rows.get(object.id)));
  }

  choose(id) {
    for (const [key, row] of this.rows) row.classList.toggle('chosen', key === id);
    const row = this.rows.get(id);
    if (!row) return;
    const box = row.closest('.scroll');
    if (row.offsetTop < box.scrollTop + 30 || row.offsetTop + row.offsetHeight > box.scrollTop + box.clientHeight) {
      box.scrollTop = row.offsetTop - box.clientHeight / 2;
    }
  }
}

// --- the panel of one object --------------------------------------------------------------------------

// Pairs of a name, which may be an element, and a value.
function numberList(pairs) {
  const list = element('dl', {className: 'numbers'});
  for (const [name, value] of pairs) list.append(element('dt', {}, [name]), element('dd', {text: value}));
  return list;
}

// An object's figures, for numberList().
function figuresOf(scene, object) {
  const pairs = [['Mass', massText(scene, object)],
    ['Centre of mass, in the scan\u2019s frame', object.center_of_mass_m.map(v => v === null ? '\u2013' : v.toFixed(2)).join(', ') + ' m' +
      within(Math.hypot(...(object.center_of_mass_error_m || [])))],
    ['Where', placeText(scene, object) || '\u2013']];
  if (object.grounded) return pairs;
  pairs.push([element('span', {}, [term('barrier', 'Barrier'), ': energy that moves it']),
    barrierText(object, 'J') + (isDoubtful(object) ? '' : within(object.barrier_error_J))],
  [element('span', {}, ['It then can ', term('release', 'release')]), number(releaseOf(object), 'J')]);
  if (object.footprint_error_m > 0) pairs.push(['Error of its footprint', number(1000 * object.footprint_error_m, 'mm')]);
  const f = object.fragility || {};
  if (f.pga_g) {
    pairs.push(['Half of all earthquakes upset it from', `${twoDigits(f.pga_g)} g` + (f.pgv_m_s ? `, or ${twoDigits(f.pgv_m_s)} m/s` : '')]);
  }
  if (object.why.azimuth_deg !== null) pairs.push(['Weakest direction', azimuthText(object.why.azimuth_deg)]);
  for (const name of scene.disturbances) {
    pairs.push([element('span', {}, [term('risk', 'Risk'), ` from ${causeOf(name)}`]), riskText(object, name)]);
  }
  if (object.unsafety_category) {
    pairs.push([element('span', {}, [term('category', 'Category'), ', by which to act']),
      categoryText(object) + (object.unsafety_certain ? '' : `: ${unsureText(object)}`)]);
  }
  pairs.push([element('span', {}, [term('unsafety', 'Unsafety'), ', 1 to 10 within this scene']), object.unsafety === null ? '\u2013' : object.unsafety.toFixed(1)]);
  return pairs;
}

function objectLinks(scene, ids, choose) {
  return element('div', {className: 'links'}, ids.map(([id, text]) =>
    element('button', {type: 'button', text: objectName(scene, id) + (text ? ' \u00b7 ' + text : ''), onclick: () => choose(id)})));
}

// Fills the panel, or hides it where nothing is chosen. acts: as riskCard() takes it.
function showObject(panel, scene, id, choose, visit, acts) {
  panel.replaceChildren();
  panel.scrollTop = 0;
  const object = scene.objectById.get(id);
  panel.hidden = !object;
  if (!object) return;
  panel.append(element('div', {className: 'row'}, [
    element('button', {type: 'button', text: '\u2190 all that is at risk', onclick: () => {
      choose(null);
      const item = document.querySelector(`.item[data-object="${id}"]`);
      if (item) item.closest('.cards').open = true;
      (item || document.getElementById('risk')).focus();
    }}),
    element('button', {type: 'button', className: 'near', text: 'show in the view', title: 'The view goes there', onclick: () => visit(id)})]));
  const heading = element('h2', {tabIndex: -1}, [capital(objectName(scene, id)) + (object.name ? ` (object ${id})` : ''),
    ...object.grounded ? [] : [' ', categoryBadge(scene, object)]]);
  panel.append(heading);
  const picture = pictureOf(scene, id);
  if (picture) panel.append(picture);
  panel.append(...object.grounded ? [] : tellings(scene, object), ...pieceButtons(scene, object, acts), ...paragraph('why', object.why.sentence),
    ...paragraph('why advice', object.grounded ? 'If you see furniture in grey, tick its parts below the view and say \u201ca thing by itself\u201d.' : ''),
    ...paragraph('why', fragilityText(scene, object)), ...paragraph('why', scene.verified ? verifiedObjectText(scene.verified, id) : ''));
  const curve = fragilityChart(object);
  panel.append(numberList(figuresOf(scene, object)));

  if (curve) {
    panel.append(element('h3', {}, [term('pga', 'Chance of falling, over an earthquake\u2019s peak')]),
      element('figure', {className: 'fragility'}, [curve]));
  }
  const contacts = contactGraph(scene, id, choose);
  if (contacts) panel.append(contacts);
  panel.append(...drawingsOf(scene, id));
  const on = scene.supports.filter(s => s.supported === id).map(s => [s.supporter, areaText(s.area_m2)]);
  const carries = scene.supports.filter(s => s.supporter === id).map(s => [s.supported, areaText(s.area_m2)]);
  if (on.length) panel.append(element('h3', {text: 'Rests on'}), objectLinks(scene, on, choose));
  if (carries.length) panel.append(element('h3', {text: 'Carries'}), objectLinks(scene, carries, choose));
  panel.append(element('h3', {text: 'Made of'}), primitiveList(scene, object));
}

function riskText(object, name) {
  const risk = object.risk_J[name];
  return number(risk, 'J') + (risk > 0 ? within(riskError(object, name)) : '');
}

function azimuthText(degrees) {
  const initials = compassOf(degrees).split('-').map(word => word[0].toUpperCase());
  return `${Math.round(degrees)}\u00b0 (${initials.join('')})`;
}

function areaText(area) {
  return area === null ? '' : area < 0.1 ? number(area * 1e4, 'cm\u00b2') : number(area, 'm\u00b2');
}

function primitiveList(scene, object) {
  const list = element('dl', {className: 'numbers'});
  const parts = scene.primitives.filter(p => p.object === object.id).sort((a, b) => b.volume_m3 - a.volume_m3);
  for (const part of parts.slice(0, 12)) {
    list.append(element('dt', {}, [colourSwatch(colourOf(scene, part.id)), `part ${part.id}, ${shapeText(part)}`]),
      element('dd', {text: part.volume_m3 === null ? '\u2013' : number(part.volume_m3 * 1000, 'l')}));
  }
  if (parts.length > 12) list.append(element('dt', {text: `and ${parts.length - 12} more`}), element('dd'));
  return list;
}
