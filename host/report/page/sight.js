// SPDX-License-Identifier: MIT
'use strict';

// What clicks choose: what is seen there; and what lies behind it, one after the other, where a place is clicked again.
class SightLine {
  constructor(view) {
    this.view = view;
    this.passed = [];  // what was chosen there, in turn
  }

  // The object to choose at a place of the view (CSS pixels), or null: there is none, or the last was reached. chosen: what is, or null.
  next(x, y, chosen) {
    const camera = this.view.camera.matrixWorld.elements.join();
    const again = this.passed.length > 0 && chosen === this.passed[this.passed.length - 1] && camera === this.camera && Math.hypot(x - this.x, y - this.y) <= 5;
    if (!again) [this.x, this.y, this.camera, this.passed] = [x, y, camera, []];
    const known = this.view.scene.objectById, through = new Set(this.passed);
    let group = this.view.pickBehind(this.x, this.y, through);
    // What is no part of an object is looked through.
    for (; group && !known.has(group[1]); group = this.view.pickBehind(this.x, this.y, through)) through.add(group[1]);
    this.passed = group ? [...this.passed, group[1]] : [];
    return group ? group[1] : null;
  }
}
