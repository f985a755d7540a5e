// SPDX-License-Identifier: MIT
'use strict';

// Draws the solids into a 2D canvas, without WebGL: small pictures of objects, and the view where there is no WebGL.
class Painter {
  constructor(scene) {
    this.scene = scene;
    this.draws = scene.view.surface.count + scene.view.voxels.count > 0;  // else there is nothing to make pictures of
  }

  // Made once they are wanted.
  get solids() {
    const {view} = this.scene;
    if (!this.made && this.draws) this.made = view.surface.count ? surfaceSolids(view) : voxelSolids(view);
    return this.made;
  }

  // A picture of a box from above: {width, height} in pixels; `chosen`: the id of an object that is drawn over all others, or null;
  // colourOf(group): [red, green, blue] of what has no colour of its own. `own`: whether the scan's colours are shown. `camera`: as
  // paintersCamera() makes it of the box, the width and height, and `turn`.
  // Nothing (null) where the scene has no solids.
  picture(box, {width, height, chosen, colourOf, own, turn = 0, camera: make = paintersCamera}) {
    if (!this.draws) return null;
    const fine = {width: 2 * width, height: 2 * height};  // four pixels make one
    const camera = make(box, fine.width, fine.height, turn);
    const image = new ImageData(fine.width, fine.height), nearness = new Float32Array(fine.width * fine.height);
    const colours = this.scene.view.groups.map((group, g) => colourOf(g));
    this.project(camera);
    this.fill(image, nearness, camera, colours, own, group => chosen === null || group[1] !== chosen, chosen !== null);
    if (chosen !== null) {
      nearness.fill(0);
      this.fill(image, nearness, camera, colours, own, group => group[1] === chosen, false);
    }
    return {canvas: halved(image, width, height), place: v => {
      const [x, y] = projected(camera, v);
      return [x / 2, y / 2];
    }};
  }

  // Places of all vertices in the picture, and how near they are.
  project(camera) {
    const {cell, count} = this.solids, {origin_m: o, step_m: s} = this.scene.view;
    if (!this.x) [this.x, this.y, this.near] = [0, 1, 2].map(() => new Float32Array(count));
    const {eye, right, up, ahead, focal, x0, y0} = camera;
    for (let v = 0, at = 0; v < count; ++v, at += 4) {
      const x = o[0] + s[0] * cell[at] - eye[0], y = o[1] + s[1] * cell[at + 1] - eye[1], z = o[2] + s[2] * cell[at + 2] - eye[2];
      const depth = x * ahead[0] + y * ahead[1] + z * ahead[2];
      const near = depth > 1e-3 ? 1 / depth : 0;
      this.near[v] = near;
      this.x[v] = x0 + focal * near * (x * right[0] + y * right[1] + z * right[2]);
      this.y[v] = y0 - focal * near * (x * up[0] + y * up[1] + z * up[2]);
    }
  }

  // The triangles of the groups that are `wanted`; the others' step back where they are `pale`.
  fill(image, nearness, camera, colours, own, wanted, pale) {
    const {solids, x, y, near} = this, {index, cell, aux, photo} = solids, {width, height, data} = image;
    const {groups} = this.scene.view, show = groups.map(wanted);
    const background = groups.map(([, id]) => { const object = this.scene.objectById.get(id); return !object || object.grounded; });
    for (let t = 0; t < index.length; t += 3) {
      const a = index[t], b = index[t + 1], c = index[t + 2], g = cell[4 * a + 3];
      if (!show[g] || !(near[a] > 0 && near[b] > 0 && near[c] > 0)) continue;
      const area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]);
      if (area >= 0) continue;  // seen from behind, y being downwards
      const left = Math.max(0, Math.ceil(Math.min(x[a], x[b], x[c]) - 0.5)), east = Math.min(width - 1, Math.floor(Math.max(x[a], x[b], x[c]) - 0.5));
      const top = Math.max(0, Math.ceil(Math.min(y[a], y[b], y[c]) - 0.5)), low = Math.min(height - 1, Math.floor(Math.max(y[a], y[b], y[c]) - 0.5));
      if (left > east || top > low) continue;
      if (background[g] && this.isBehind(camera, a)) continue;
      const n = 4 * a, light = 0.77 + 0.25 * (-0.13 * aux[n] - 0.43 * aux[n + 1] + 0.89 * aux[n + 2]) / (Math.hypot(aux[n], aux[n + 1], aux[n + 2]) || 1);
      const known = own && photo;
      const base = known ? photo[n + 3] ? [photo[n], photo[n + 1], photo[n + 2]] : [158, 158, 158] : colours[g];
      const [red, green, blue] = base.map(value => pale ? 0.4 * value * light + 0.6 * 226 : value * light);
      for (let py = top; py <= low; ++py) {
        for (let px = left; px <= east; ++px) {
          const u = ((x[c] - x[b]) * (py + 0.5 - y[b]) - (px + 0.5 - x[b]) * (y[c] - y[b])) / area;
          const v = ((x[a] - x[c]) * (py + 0.5 - y[c]) - (px + 0.5 - x[c]) * (y[a] - y[c])) / area;
          if (u < 0 || v < 0 || u + v > 1) continue;
          const at = py * width + px, depth = u * near[a] + v * near[b] + (1 - u - v) * near[c];
          if (depth <= nearness[at]) continue;
          nearness[at] = depth;
          data[4 * at] = red;
          data[4 * at + 1] = green;
          data[4 * at + 2] = blue;
          data[4 * at + 3] = 255;
        }
      }
    }
  }

  // Whether a vertex of the background is seen from where no room is.
  isBehind(camera, vertex) {
    const {cell} = this.solids, {origin_m: o, step_m: s} = this.scene.view, [fx, fy, fz] = this.solids.facing(vertex), at = 4 * vertex;
    return fx * (camera.eye[0] - o[0] - s[0] * cell[at]) + fy * (camera.eye[1] - o[1] - s[1] * cell[at + 1]) +
      fz * (camera.eye[2] - o[2] - s[2] * cell[at + 2]) < 0;
  }
}

function surfaceSolids(view) {
  const {surface} = view;
  return {...surface, facing: vertex => {
    const code = surface.aux[4 * vertex + 3] & 63;
    return [code % 3 - 1, Math.floor(code / 3) % 3 - 1, Math.floor(code / 9) - 1];
  }};
}

// The exposed faces of voxels, as triangles; but for those that look down, as pictures are from above.
function voxelSolids(view) {
  const {voxels} = view, shown = [0, 1, 2, 3, 5];
  let faces = 0;
  for (let i = 0; i < voxels.count; ++i) for (const face of shown) faces += voxels.aux[4 * i + 3] >> face & 1;
  const count = 4 * faces, cell = new Uint16Array(4 * count), aux = new Int8Array(4 * count), index = new Uint32Array(6 * faces);
  const photo = voxels.photo ? new Uint8Array(4 * count) : null, half = view.step_m.map(step => view.cube_m / 2 / step);
  let to = 0, next = 0;
  for (let i = 0; i < 4 * voxels.count; i += 4) {
    for (const face of shown) {
      if (!(voxels.aux[i + 3] >> face & 1)) continue;
      for (const corner of [0, 1, 2, 0, 2, 3]) index[next++] = to + corner;
      for (let corner = 0; corner < 4; ++corner, ++to) {
        for (let k = 0; k < 3; ++k) {
          cell[4 * to + k] = Math.min(Math.max(voxels.cell[i + k] + faceCorners[face][corner][k] * half[k], 0), 65535);
          aux[4 * to + k] = voxels.aux[i + k];
        }
        cell[4 * to + 3] = voxels.cell[i + 3];
        if (photo) photo.set(voxels.photo.subarray(i, i + 4), 4 * to);
      }
    }
  }
  return {count, cell, aux, photo, index, facing: vertex => aux.subarray(4 * vertex, 4 * vertex + 3)};
}

// The corners of a cube's faces, anticlockwise seen from outside, as -1 and 1 along each axis; in the order of the records' bits.
const faceCorners = [-1, 1, -1, 1, -1, 1].map((sign, face) => [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => {
  const corner = [], axis = face >> 1;
  corner[axis] = sign;
  corner[(axis + 1) % 3] = sign > 0 ? a : b;
  corner[(axis + 2) % 3] = sign > 0 ? b : a;
  return corner;
}));

// From above, as the view looks at first, turned by `turn` degrees; the box just fits.
function paintersCamera(box, width, height, turn) {
  const angle = Math.atan2(0.75, 0.55) + turn * Math.PI / 180, level = Math.cos(0.588), slope = Math.sin(0.588);
  const ahead = [Math.cos(angle) * level, Math.sin(angle) * level, -slope];
  const right = [Math.sin(angle), -Math.cos(angle), 0], up = [slope * Math.cos(angle), slope * Math.sin(angle), level];
  const middle = middleOf(box), radius = Math.max(Math.hypot(...extentOf(box)) / 2, 0.05);
  const camera = {eye: middle.map((value, k) => value - 3.2 * radius * ahead[k]), right, up, ahead, focal: 1, x0: 0, y0: 0};
  const xs = [], ys = [];
  for (let corner = 0; corner < 8; ++corner) {
    const [x, y] = projected(camera, box.low.map((value, k) => corner >> k & 1 ? box.high[k] : value));
    xs.push(x);
    ys.push(y);
  }
  const [west, east, top, low] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  camera.focal = 0.96 * Math.min(width / Math.max(east - west, 0.02), height / Math.max(low - top, 0.02));
  camera.x0 = width / 2 - camera.focal * (west + east) / 2;
  camera.y0 = height / 2 - camera.focal * (top + low) / 2;
  return camera;
}

function projected({eye, right, up, ahead, focal, x0, y0}, v) {
  const d = v.map((value, k) => value - eye[k]), dot = axis => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
  return [x0 + focal * dot(right) / dot(ahead), y0 - focal * dot(up) / dot(ahead)];
}

function halved(image, width, height) {
  const fine = document.createElement('canvas'), canvas = document.createElement('canvas');
  [fine.width, fine.height, canvas.width, canvas.height] = [image.width, image.height, width, height];
  fine.getContext('2d').putImageData(image, 0, 0);
  canvas.getContext('2d').drawImage(fine, 0, 0, width, height);
  return canvas;
}

// --- pictures of objects ---------------------------------------------------------------------------------

const groundColour = [214, 213, 208];
const pictureSize = {width: 256, height: 192};

// An object's picture, empty until paintPictures() has come to it; null where the scene has no solids of it.
function pictureOf(scene, id) {
  if (!scene.painter.draws || !scene.boxes.has(id)) return null;
  const image = element('img', {className: 'picture', alt: `Picture of ${objectName(scene, id)}`, ...pictureSize});
  image.dataset.object = id;
  if (scene.pictures.has(id)) image.src = scene.pictures.get(id);
  else image.dataset.awaits = id;
  return image;
}

// They are to be made anew, in other colours.
function forgetPictures(scene) {
  scene.pictures.clear();
  for (const image of document.querySelectorAll('img.picture')) image.dataset.awaits = image.dataset.object;
}

// Fills in what pictureOf() left empty, one at a time so that the page goes on answering; at once with `now`.
function paintPictures(scene, now = false) {
  const next = document.querySelector('img[data-awaits]');
  if (!next) return;
  const id = Number(next.dataset.awaits);
  if (!scene.pictures.has(id)) scene.pictures.set(id, objectPicture(scene, id));
  for (const image of document.querySelectorAll(`img[data-awaits="${id}"]`)) {
    image.src = scene.pictures.get(id);
    delete image.dataset.awaits;
  }
  if (now) paintPictures(scene, true);
  else setTimeout(() => paintPictures(scene), 15);
}

// The colours of groups: of what can move and of `also`, else the ground's. of(object): another one than its own.
function byObject(scene, also, of = object => objectColour(scene, object.id)) {
  return g => {
    const object = scene.objectById.get(scene.view.groups[g][1]);
    return !object || object.grounded && object.id !== also ? groundColour : of(object);
  };
}

function byRisk(scene) {
  return byObject(scene, null, object => categoryColour(scene, object.unsafety_category));
}

// As a data URL: the object in its category's colour, where it has one above none, what is around it grey.
function objectPicture(scene, id) {
  const category = scene.objectById.get(id).unsafety_category, colour = !category || category === 'none' ? objectColour(scene, id) : categoryColour(scene, category);
  const {low, high} = scene.boxes.get(id), margin = Math.max(0.25 * Math.hypot(...extentOf({low, high})), 0.02);
  const box = {low: low.map(value => value - margin), high: high.map(value => value + margin)};
  const {canvas} = scene.painter.picture(box, {...pictureSize, chosen: id, colourOf: byObject(scene, id, object => object.id === id ? colour : groundColour), own: scene.coloured});
  const context = canvas.getContext('2d');
  context.globalCompositeOperation = 'destination-over';  // JPEG knows no transparency
  context.fillStyle = '#e9edf1';
  context.fillRect(0, 0, canvas.width, canvas.height);
  return canvas.toDataURL('image/jpeg', 0.85);
}

// The whole scene as a picture, with the numbers of what to act on and to look at, and the letters of what may be furniture; where there is no WebGL, and on paper.
function paintScene(scene, canvas, mode, turn) {
  const {width, height} = canvas;
  const colours = mode === 'risk' ? byRisk(scene) : byObject(scene, null);
  const picture = scene.painter.picture(scene.boxes.get(null), {width, height, chosen: null, colourOf: colours, own: mode === 'photo', turn});
  const context = canvas.getContext('2d');
  context.clearRect(0, 0, width, height);
  context.drawImage(picture.canvas, 0, 0);
  context.font = `600 ${Math.round(13 * width / 960)}px system-ui, sans-serif`;
  context.textAlign = 'center';
  context.lineWidth = 4;
  context.strokeStyle = '#fff';
  const placed = [], say = (text, place) => {
    const [x, y] = steppedAside(placed, picture.place(place), context.measureText(text).width + 6, 16 * width / 960);
    context.strokeText(text, x, y);
    context.fillText(text, x, y);
  };
  for (const object of numberedOnes(scene).filter(one => one.center_of_mass_m.every(value => value !== null))) say(object.name || String(object.id), viewPlace(scene, object.center_of_mass_m));
  for (const one of listedPieces(scene)) if (one.letter) say(one.letter, middleOf(one.box));
}
