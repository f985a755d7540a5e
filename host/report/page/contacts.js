// SPDX-License-Identifier: MIT
'use strict';

// What the chosen object touches: its own primitives to the left, those of other objects to the
// right, and a line for each contact.

const contactRows = 9;

// The contacts of an object's primitives, those with the largest areas first.
function contactsOf(scene, id) {
  const owner = new Map(scene.primitives.map(primitive => [primitive.id, primitive.object]));
  return scene.contacts.filter(contact => owner.get(contact.a) === id || owner.get(contact.b) === id)
    .map(contact => {
      const swapped = owner.get(contact.a) !== id;
      const inner = swapped ? contact.b : contact.a, outer = swapped ? contact.a : contact.b;
      const object = owner.has(outer) ? owner.get(outer) : -1;
      return {inner, outer, object, own: object === id, relation: contact.relation, probability: contact.probability,
        area: contact.area_m2 || 0};
    }).sort((a, b) => b.area - a.area || a.inner - b.inner || a.outer - b.outer);
}

// As many contacts as there are rows for, and the primitives on either side of them.
function contactRowsOf(contacts) {
  let left = [], right = [];
  const shown = [];
  const joined = (rows, ids) => [...new Set([...rows, ...ids])];
  for (const contact of contacts) {
    const newLeft = joined(left, contact.own ? [contact.inner, contact.outer] : [contact.inner]);
    const newRight = joined(right, contact.own ? [] : [contact.outer]);
    if (newLeft.length > contactRows || newRight.length > contactRows) continue;
    [left, right] = [newLeft, newRight];
    shown.push(contact);
  }
  left.sort((a, b) => a - b);
  // Beside what they touch, so that lines cross little.
  const beside = id => {
    const rows = shown.filter(contact => !contact.own && contact.outer === id).map(contact => left.indexOf(contact.inner));
    return rows.reduce((sum, row) => sum + row, 0) / rows.length;
  };
  right.sort((a, b) => beside(a) - beside(b) || a - b);
  return {left, right, shown};
}

function contactGraph(scene, id, choose) {
  const contacts = contactsOf(scene, id);
  if (!contacts.length) return null;
  const {left, right, shown} = contactRowsOf(contacts);
  const step = 26, top = 26, width = 330, xLeft = 88, xRight = 204;
  const rows = Math.max(left.length, right.length), height = top + step * rows + 4;
  const row = (list, at) => top + step * ((rows - list.length) / 2 + list.indexOf(at) + 0.5);
  const svg = svgElement('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', class: 'contacts',
    'aria-label': `Contacts of ${objectName(scene, id)}`});
  const say = svgTexts(svg);
  say(xLeft, 12, 'end', 'its parts', 'strong');
  if (right.length) say(xRight, 12, 'start', 'what it touches', 'strong');
  const numbers = [], crossing = shown.filter(contact => !contact.own);
  const lines = (side, primitive) => crossing.filter(contact => contact[side] === primitive).length;
  for (const contact of shown) {
    const y0 = row(left, contact.inner), y1 = row(contact.own ? left : right, contact.outer);
    const bow = 18 + 7 * Math.abs(y1 - y0) / step;
    const shape = contact.own ? `M${xLeft} ${y0}C${xLeft + bow} ${y0} ${xLeft + bow} ${y1} ${xLeft} ${y1}` : `M${xLeft} ${y0}L${xRight} ${y1}`;
    svg.append(svgElement('path', {class: 'contact ' + contact.relation, d: shape}));
    const text = contact.probability === null ? '\u2013' : contact.probability.toFixed(2);
    // Near that end of the line where fewer meet.
    const share = lines('inner', contact.inner) < lines('outer', contact.outer) ? 0.3 : 0.75;
    numbers.push(contact.own ? [xLeft + 0.75 * bow + 3, (y0 + y1) / 2 + 4, text, 'start']
      : [xLeft + share * (xRight - xLeft), y0 + share * (y1 - y0) - 3, text, 'middle']);
  }
  if (shown.length <= 14) for (const [x, y, text, anchor] of numbers) say(x, y, anchor, text, 'halo');
  const node = (x, y, object, primitive, own) => {
    const dot = svgElement('circle', {cx: x, cy: y, r: 6, fill: css(own ? colourOf(scene, primitive) : objectColour(scene, object)), class: 'node'});
    svg.append(dot);
    const other = scene.objectById.get(object);
    const text = own ? `part ${primitive}` : object < 0 || !other ? 'no object' : other.grounded ? `building, part ${primitive}` : `${objectName(scene, object)}, part ${primitive}`;
    say(own ? x - 11 : x + 10, y + 4, own ? 'end' : 'start', text, own ? '' : 'reach');
    if (!own && other) {
      dot.addEventListener('click', () => choose(object));
      dot.classList.add('reach');
      svg.lastChild.addEventListener('click', () => choose(object));
    }
  };
  for (const primitive of left) node(xLeft, row(left, primitive), id, primitive, true);
  for (const primitive of right) {
    node(xRight, row(right, primitive), shown.find(contact => contact.outer === primitive && !contact.own).object, primitive, false);
  }
  const figure = element('figure', {}, [element('h3', {text: 'Contacts'})]);
  figure.append(svg);
  const key = [['fixed', 'fixed to each other'], ['support', 'one carries the other'], ['adjacent', 'they only touch']]
    .filter(([relation]) => shown.some(contact => contact.relation === relation))
    .map(([relation, text]) => {
      const sample = svgElement('svg', {viewBox: '0 0 26 8', class: 'sample'});
      sample.append(svgElement('path', {class: 'contact ' + relation, d: 'M1 4H25'}));
      return element('span', {className: 'key'}, [sample, text]);
    });
  key.push(element('span', {text: 'Numbers: the chance that the two are one solid, fixed to each other, 0 to 1.' +
    (shown.length > 14 ? ' (They are in scene.json; here are too many.)' : '') +
    (contacts.length > shown.length ? ` ${contacts.length - shown.length} more contacts, of smaller areas, are not drawn.` : '')}));
  figure.append(element('p', {className: 'hint keys'}, key));
  return figure;
}
