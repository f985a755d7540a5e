// SPDX-License-Identifier: MIT
'use strict';

// The scene from above, with a compass, metres along both sides, and the numbers of what is at risk where it stands.
class Plan {
  constructor(panel, scene, visit) {
    this.panel = panel;
    this.scene = scene;
    this.visit = visit;
    this.shown = [...numberedOnes(scene), ...unseenOnes(scene).slice(0, 2 * listedUnseen)]
      .filter(object => planPlace(scene, object));
    const {low, high} = scene.planBox;
    this.size = [high[0] - low[0], high[1] - low[1]];
    panel.hidden = !(this.size[0] > 0 && this.size[1] > 0) || !drawnRecords(scene.view).count;
    document.getElementById('plan-note').textContent = 'In metres from the south-west corner; north is the room\u2019s own.' +
      (this.shown.some(object => object.seen_enough === false) ? ' ?: not judged.' : '') + (listedPieces(scene).length ? ' Letters: the building, or a thing.' : '');
  }

  paint() {
    if (this.panel.hidden) return;
    const old = this.panel.querySelector('svg');
    if (old) old.remove();
    this.panel.append(this.drawing());
  }

  drawing() {
    const [across, along] = this.size, {scene} = this, left = 34, right = 30, top = 24, bottom = 34;
    // As large as fits a page and a phone.
    const scale = Math.min((480 - left - right) / across, 440 / along), wide = scale * across, deep = scale * along;
    const svg = svgElement('svg', {viewBox: `0 0 480 ${(top + deep + bottom).toFixed(0)}`, role: 'img', class: 'plan',
      'aria-label': `Plan, ${across.toFixed(1)} by ${along.toFixed(1)} m; ` + (this.shown.length ? `at risk: ${this.shown.map(object =>
        `${objectName(scene, object.id)}, ${placeText(scene, object)}`).join('; ')}` : nothingJudged(scene) ? 'nothing was judged' : 'nothing is at risk')});
    const x = east => left + scale * east, y = north => top + deep - scale * north;
    const picture = this.picture(Math.round(2 * wide), Math.round(2 * deep));
    if (picture) svg.append(svgElement('image', {href: picture, x: left, y: top, width: wide, height: deep, preserveAspectRatio: 'none'}));
    const say = svgTexts(svg);
    const step = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100].find(metre => Math.max(across, along) / metre <= 10) || 200;
    const digits = step < 1 ? 1 : 0;
    for (let east = 0; east <= across + 1e-9; east += step) {
      svg.append(svgElement('path', {class: 'grid', d: `M${x(east)} ${top}V${top + deep}`}));
      say(x(east), top + deep + 14, 'middle', east.toFixed(digits));
    }
    for (let north = 0; north <= along + 1e-9; north += step) {
      svg.append(svgElement('path', {class: 'grid', d: `M${left} ${y(north)}H${left + wide}`}));
      say(left - 5, y(north) + 4, 'end', north.toFixed(digits));
    }
    say(left + wide / 2, top + deep + 29, 'middle', 'm east');
    say(left - 5, top - 9, 'start', 'm north');
    svg.append(svgElement('path', {class: 'needle', d: `M${left + wide + 16} ${top + 4}l6 21h-12z`}));
    say(left + wide + 16, top + 1, 'middle', 'N', 'strong');
    const placed = this.numbers(svg, x, y, say);
    for (const one of listedPieces(scene).filter(piece => piece.letter)) {
      const [east, north] = middleOf(one.box).map((value, k) => value - scene.planBox.low[k]), to = steppedAside(placed, [x(east), y(north)], 18, 18);
      svg.append(svgElement('rect', {class: 'letter', x: to[0] - 8, y: to[1] - 8, width: 16, height: 16}));
      say(to[0], to[1] + 4.5, 'middle', one.letter, 'number');
    }
    return svg;
  }

  // Where they would hide each other they step aside, in the order of the list.
  numbers(svg, x, y, say) {
    const placed = [];
    for (const object of this.shown) {
      const {east, north} = planPlace(this.scene, object), at = [x(east), y(north)];
      const text = (object.name || String(object.id)) + (object.seen_enough === false ? ' ?' : '');
      const wide = 12 + 7.4 * text.length, to = steppedAside(placed, at, wide, 19);
      const colour = categoryColour(this.scene, object.unsafety_category);
      if (to[0] !== at[0]) svg.append(svgElement('path', {class: 'axis', d: `M${at[0]} ${at[1]}L${to[0]} ${to[1]}`}), svgElement('circle', {cx: at[0], cy: at[1], r: 2}));
      const chip = svgElement('rect', {class: 'chip', x: to[0] - wide / 2, y: to[1] - 9, width: wide, height: 18, rx: 9, fill: css(colour)});
      chip.addEventListener('click', () => this.visit(object.id));
      svg.append(chip);
      say(to[0], to[1] + 4.5, 'middle', text, 'number');
      svg.lastChild.style.fill = textOn(colour);
    }
    return placed;
  }

  // As a data URL; null where there are no solids to draw.
  picture(width, height) {
    const {scene} = this, camera = (box, fineWidth, fineHeight) => planCamera(scene.planBox, fineWidth, fineHeight);
    const made = scene.painter.picture(scene.planBox, {width, height, chosen: null, colourOf: byRisk(scene), own: scene.coloured, camera});
    return made && made.canvas.toDataURL('image/png');
  }
}

// Where a label of that width goes that is to stand at a place: beside it, in a spiral, where it would hide one of those placed, to which it is added.
function steppedAside(placed, at, wide, tall) {
  const to = [at[0], at[1]];
  for (let turn = 0; turn < 40 && placed.some(other => Math.abs(other[0] - to[0]) < (other[2] + wide) / 2 && Math.abs(other[1] - to[1]) < tall); ++turn) {
    const angle = 2.4 * turn, reach = 12 + 3 * turn;
    to[0] = at[0] + reach * Math.cos(angle);
    to[1] = at[1] + reach * Math.sin(angle);
  }
  placed.push([...to, wide]);
  return to;
}

// Straight down, and from so far that nothing leans.
function planCamera(box, width, height) {
  const middle = middleOf(box), size = extentOf(box).map(side => Math.max(side, 1e-3));
  const far = 100 * Math.max(...size);
  return {eye: [middle[0], middle[1], middle[2] + far], right: [1, 0, 0], up: [0, 1, 0], ahead: [0, 0, -1],
    focal: far * width / size[0], x0: width / 2, y0: height / 2};
}
