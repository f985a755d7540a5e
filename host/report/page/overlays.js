// SPDX-License-Identifier: MIT
'use strict';

// What the view draws over the solids: arrows of fields, the floor that people walk on, and what
// happens to the chosen object.

function rampUniform(scene) {
  return {value: scene.ramp.colours.map(colour => new THREE.Vector3(...colour.map(value => value / 255)))};
}

// What colours a field's arrows and makes them long.
function strengthOf(name, arrow) {
  const length = Math.hypot(arrow[3], arrow[4], arrow[5]);
  return {visits: arrow[6], mean: length * arrow[6], speed: length}[kindOf(name).strength];
}

function fieldMesh(scene, name, reach) {
  const field = scene.view.fields[name];
  const offset = new Float32Array(3 * field.count), direction = new Float32Array(3 * field.count);
  const strength = new Float32Array(field.count);
  for (let i = 0; i < field.count; ++i) {
    const arrow = field.arrow.subarray(7 * i, 7 * i + 7);
    offset.set(arrow.subarray(0, 3), 3 * i);
    direction.set(arrow.subarray(3, 6), 3 * i);
    strength[i] = strengthOf(name, arrow);
  }
  const strongest = Float32Array.from(strength).sort()[Math.floor(0.95 * (field.count - 1))] || 1;
  for (let i = 0; i < field.count; ++i) strength[i] = Math.min(strength[i] / strongest, 1);
  const geometry = shapeArrow(new THREE.InstancedBufferGeometry());
  geometry.setAttribute('offset', new THREE.InstancedBufferAttribute(offset, 3));
  geometry.setAttribute('direction', new THREE.InstancedBufferAttribute(direction, 3));
  geometry.setAttribute('strength', new THREE.InstancedBufferAttribute(strength, 1));
  geometry.maxInstancedCount = field.count;
  const longest = Math.min(Math.max(0.035 * reach, 0.05), 0.35);
  const mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
    uniforms: {longest: {value: longest}, thickness: {value: 0.17 * longest}, tip: {value: kindOf(name).at_tip ? 1 : 0}, ramp: rampUniform(scene)},
    vertexShader: arrowVertexShader, fragmentShader: recordFragmentShader, side: THREE.DoubleSide,
    // What is below things they would hide.
    depthTest: !kindOf(name).below_things, transparent: !!kindOf(name).below_things,
  }));
  mesh.frustumCulled = false;
  mesh.userData.strongest = strongest;
  return mesh;
}

// Makes the geometry a shaft and a head with five sides, along z from 0 to 1, one unit thick at the head.
function shapeArrow(geometry) {
  const corners = [], index = [], sides = 5;
  [[0.22, 0], [0.22, 0.55], [0.75, 0.55], [0.01, 1]].forEach(([radius, z], ring) => {
    for (let i = 0; i < sides; ++i) {
      const angle = 2 * Math.PI * i / sides;
      corners.push(radius * Math.cos(angle), radius * Math.sin(angle), z);
      if (ring === 0) continue;
      const a = (ring - 1) * sides + i, b = (ring - 1) * sides + (i + 1) % sides;
      index.push(a, b, b + sides, a, b + sides, a + sides);
    }
  });
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(index);
  return geometry;
}

// Fig. 9: the cells of the floor where people can walk, by how many do, and the ways of some.
function walksGroup(scene, reach) {
  const walks = scene.view.walks, group = new THREE.Group();
  const x = new THREE.Vector3(...walks.along_x_m), y = new THREE.Vector3(...walks.along_y_m);
  const corner = new THREE.Vector3(...walks.corner_m), corners = [], share = [], index = [];
  // Above the voxels of the floor.
  const lift = 0.8 * scene.view.cube_m;
  walks.shade.forEach((shade, at) => {
    if (!shade) return;
    const place = corner.clone().addScaledVector(x, at % walks.nx).addScaledVector(y, Math.floor(at / walks.nx));
    place.z += walks.floor_mm[at] / 1000 + lift;
    const first = corners.length / 3;
    index.push(first, first + 1, first + 2, first, first + 2, first + 3);
    for (const [along, across] of [[0, 0], [1, 0], [1, 1], [0, 1]]) {
      corners.push(...place.clone().addScaledVector(x, along).addScaledVector(y, across).toArray());
      share.push((shade - 1) / 254);
    }
  });
  if (!share.length) return group;
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setAttribute('share', new THREE.Float32BufferAttribute(share, 1));
  geometry.setIndex(index);
  const cells = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
    uniforms: {ramp: rampUniform(scene)}, vertexShader: walkVertexShader, fragmentShader: recordFragmentShader,
    side: THREE.DoubleSide,
  }));
  const ways = new THREE.Mesh(ribbons(walks.paths, 0.0006 * reach, 1.6 * lift),
    new THREE.MeshBasicMaterial({color: 0xffffff, side: THREE.DoubleSide, transparent: true, opacity: 0.75}));
  cells.frustumCulled = ways.frustumCulled = false;
  group.add(cells, ways);
  return group;
}

// Level ribbons along paths, as lines are a pixel wide; `half` their width.
function ribbons(paths, half, lift) {
  const corners = [];
  for (const path of paths) {
    for (let i = 0; i + 5 < path.length; i += 3) {
      const [ax, ay, az, bx, by, bz] = path.slice(i, i + 6), length = Math.hypot(bx - ax, by - ay);
      if (!(length > 0)) continue;
      const sx = -(by - ay) / length * half, sy = (bx - ax) / length * half;
      const a = [[ax + sx, ay + sy, az + lift], [ax - sx, ay - sy, az + lift]];
      const b = [[bx + sx, by + sy, bz + lift], [bx - sx, by - sy, bz + lift]];
      for (const corner of [a[0], a[1], b[1], a[0], b[1], b[0]]) corners.push(...corner);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  return geometry;
}

// Of what the marker is made, in the legend's words.
const markerColours = {middle: '#101418', edge: '#c92c2c', lands: '#d9480f', move: '#0b7a3b'};

// The chosen object's centre of mass, its weakest direction, the edge that it turns over or slides off, where it
// lands and how it should be moved.
class Marker {
  constructor(reach) {
    this.reach = reach;
    this.group = new THREE.Group();
    this.ball = this.add(new THREE.SphereGeometry(1, 16, 12), markerColours.middle);
    this.weakest = this.addArrow(markerColours.middle);
    this.edge = this.add(new THREE.CylinderGeometry(1, 1, 1, 8), markerColours.edge);
    this.lands = this.addArrow(markerColours.lands);
    this.move = this.addArrow(markerColours.move);
    this.group.renderOrder = 10;
  }

  // It shows through what is in front of it.
  add(geometry, color) {
    const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({color, depthTest: false, transparent: true}));
    this.group.add(mesh);
    return mesh;
  }

  addArrow(color) {
    const mesh = this.add(shapeArrow(new THREE.BufferGeometry()), color);
    mesh.material.side = THREE.DoubleSide;
    return mesh;
  }

  setArrow(arrow, from, along) {
    arrow.visible = along.length() > 1e-3;
    if (!arrow.visible) return;
    arrow.position.copy(from);
    arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), along.clone().normalize());
    arrow.scale.set(0.011 * this.reach, 0.011 * this.reach, along.length());
  }

  // What of the marker is drawn, by the legend's names.
  parts() {
    return this.group.visible ? ['middle', ...['edge', 'lands', 'move'].filter(part => this[part].visible)] : [];
  }

  show(object, fromInput) {
    this.group.visible = !!object && object.center_of_mass_m.every(value => value !== null);
    if (!this.group.visible) return;
    const at = fromInput(object.center_of_mass_m), none = new THREE.Vector3();
    this.ball.position.copy(at);
    this.ball.scale.setScalar(0.006 * this.reach);
    const falls = fallKnown(object);
    this.setArrow(this.lands, at, falls ? fromInput(object.fall.lands_m).sub(at) : none);
    const weakest = fromInput(object.direction.map(value => value || 0));
    this.setArrow(this.weakest, at, falls || weakest.length() < 0.5 ? none : weakest.setLength(0.08 * this.reach));
    // Long enough to be seen, however short the way is.
    const move = object.advice && object.advice.kind === 'move' ? fromInput(object.advice.move_m.map(value => value || 0)) : none;
    this.setArrow(this.move, at, move.length() > 0 ? move.clone().setLength(Math.max(move.length(), 0.07 * this.reach)) : none);
    this.edge.visible = object.why.edge_m.length === 2 && object.why.edge_m.flat().every(value => value !== null);
    if (!this.edge.visible) return;
    const [a, b] = object.why.edge_m.map(end => fromInput(end));
    const along = b.clone().sub(a), length = Math.max(along.length(), 0.01 * this.reach);
    this.edge.position.copy(a).add(b).multiplyScalar(0.5);
    this.edge.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.lengthSq() > 0 ? along.normalize() : new THREE.Vector3(1, 0, 0));
    this.edge.scale.set(0.003 * this.reach, length, 0.003 * this.reach);
  }
}

// The numbers of what to act on and to look at, or of the chosen one and of what it may be a piece of, where they stand in the view.
class Labels {
  constructor(container, scene) {
    this.container = container;
    this.scene = scene;
    this.risky = numberedOnes(scene);
    this.nodes = new Map();
    this.seen = null;  // how many places of the view each object covers, once that is known
    this.choose(undefined);
  }

  choose(object) {
    for (const node of this.nodes.values()) node.remove();
    this.nodes.clear();
    this.chosen = object;
    const whole = object && this.scene.objectById.get(object.piece_of);
    for (const shown of object ? [object, ...whole ? [whole] : []] : this.risky) {
      if (shown.center_of_mass_m.some(value => value === null)) continue;
      const node = element('span', {className: 'number', text: shown.name || String(shown.id)});
      this.container.append(node);
      this.nodes.set(shown, node);
    }
  }

  place(camera, fromInput) {
    const placed = [];
    for (const [object, node] of this.nodes) {
      const at = fromInput(object.center_of_mass_m).project(camera);
      // The number of what a wall hides would stand on the wall.
      const hidden = !this.chosen && this.seen && !(this.seen.get(object.id) >= 4);
      node.hidden = hidden || at.z > 1 || Math.abs(at.x) > 1 || Math.abs(at.y) > 1;
      if (node.hidden) continue;
      const [left, top] = steppedAside(placed, [(at.x + 1) / 2 * this.container.clientWidth, (1 - at.y) / 2 * this.container.clientHeight], 14 + 8 * node.textContent.length, 18);
      node.style.left = left + 'px';
      node.style.top = top + 'px';
    }
  }
}
