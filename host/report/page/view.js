// SPDX-License-Identifier: MIT
'use strict';

const fieldColours = {human: [0.10, 0.45, 0.20], wind: [0.05, 0.42, 0.70], earthquake: [0.62, 0.25, 0.05]};
const faceNormals = [[-1, 0, 0], [1, 0, 0], [0, -1, 0], [0, 1, 0], [0, 0, -1], [0, 0, 1]];

// The 3D view. Throws where there is no WebGL. Draws only when something changed.
class View {
  constructor(container, scene) {
    this.container = container;
    this.scene = scene;
    this.renderer = new THREE.WebGLRenderer({antialias: true, alpha: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.02, 500);
    this.camera.up.set(0, 0, 1);
    container.prepend(this.renderer.domElement);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener('change', () => this.redraw());
    this.makePalette();
    this.measure();
    this.makeVoxels();
    this.makePoints();
    this.makeFields();
    this.makeMarker();
    this.ids = new THREE.WebGLRenderTarget(1, 1, {magFilter: THREE.NearestFilter, minFilter: THREE.NearestFilter});
    this.idsStale = true;
    this.show = 'solids';
    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
    this.reset();
  }

  // --- data ---------------------------------------------------------------------------------------

  makePalette() {
    const groups = this.scene.view.groups.length;
    this.paletteWidth = Math.min(1024, Math.pow(2, Math.ceil(Math.log2(groups))));
    const rows = Math.pow(2, Math.ceil(Math.log2(Math.ceil(groups / this.paletteWidth))));
    this.paletteBytes = new Uint8Array(this.paletteWidth * rows * 4);
    this.palette = new THREE.DataTexture(this.paletteBytes, this.paletteWidth, rows, THREE.RGBAFormat);
    this.palette.magFilter = this.palette.minFilter = THREE.NearestFilter;
    this.palette.generateMipmaps = false;
    const view = this.scene.view;
    this.uniforms = {
      origin: {value: new THREE.Vector3(...view.origin_m)},
      stepSize: {value: new THREE.Vector3(...view.step_m)},
      eye: {value: new THREE.Vector3()},
      palette: {value: this.palette},
      paletteSize: {value: new THREE.Vector2(this.paletteWidth, rows)},
      through: {value: 1},
      picking: {value: 0},
      // A little over its edge, so that rounding opens no cracks between neighbours.
      cube: {value: 1.005 * view.cube_m + 2 * Math.max(...view.step_m)},
      pointSize: {value: 1},
      pointScale: {value: 1},
    };
  }

  // Colours every group by `mode`; with `chosen`, all but that object's fade.
  paint(mode, chosen) {
    this.scene.view.groups.forEach(([primitive, id], i) => {
      const object = this.scene.objectById.get(id);
      const grounded = !object || object.grounded;
      let colour = mode === 'primitive' ? colourOf(this.scene, primitive) : colourOf(this.scene, id);
      if (mode === 'risk') colour = !object || grounded ? noColour : riskColour(object.unsafety);
      // What can't fall steps back: paler and greyer.
      let fade = grounded ? (mode === 'primitive' ? 0.45 : 0.8) : 0;
      if (chosen !== null) fade = id === chosen ? 0 : Math.max(fade, 0.72);
      const pale = [214, 213, 208];
      for (let c = 0; c < 3; ++c) this.paletteBytes[4 * i + c] = colour[c] + (pale[c] - colour[c]) * fade;
      this.paletteBytes[4 * i + 3] = grounded ? 128 : 255;
    });
    this.palette.needsUpdate = true;
    this.redraw();
  }

  // The middle and the reach of what is drawn, from the records' 2nd and 98th hundredths.
  measure() {
    const view = this.scene.view;
    const records = view.voxels.count ? view.voxels : view.points;
    this.centre = new THREE.Vector3();
    this.reach = 1;
    this.height = 0;
    if (!records.count) return;
    let sum = 0;
    const stride = Math.max(1, Math.floor(records.count / 20000));
    ['x', 'y', 'z'].forEach((axis, k) => {
      const values = [];
      for (let i = 0; i < records.count; i += stride) values.push(records.cell[4 * i + k]);
      values.sort((a, b) => a - b);
      const at = share => view.origin_m[k] + view.step_m[k] * values[Math.floor(share * (values.length - 1))];
      this.height = at(0.98) - at(0.02);  // of the last axis in the end
      this.centre[axis] = (at(0.02) + at(0.98)) / 2;
      sum += Math.pow(at(0.98) - at(0.02), 2);
    });
    this.reach = Math.max(Math.sqrt(sum), 4 * view.cube_m, 0.05);
  }

  // --- what is drawn --------------------------------------------------------------------------------

  // One mesh for each direction of face: the exposed faces only.
  makeVoxels() {
    const {voxels} = this.scene.view;
    this.solids = new THREE.Group();
    this.faces = 0;
    faceNormals.forEach((normal, face) => {
      let count = 0;
      for (let i = 0; i < voxels.count; ++i) count += voxels.aux[4 * i + 3] >> face & 1;
      if (!count) return;
      const cell = new Uint16Array(4 * count), aux = new Int8Array(4 * count);
      let at = 0;
      for (let i = 0; i < voxels.count; ++i) {
        if (!(voxels.aux[4 * i + 3] >> face & 1)) continue;
        for (let k = 0; k < 4; ++k) {
          cell[at + k] = voxels.cell[4 * i + k];
          aux[at + k] = voxels.aux[4 * i + k];
        }
        at += 4;
      }
      const geometry = new THREE.InstancedBufferGeometry();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(faceCorners(normal), 3));
      geometry.setIndex([0, 1, 2, 0, 2, 3]);
      geometry.setAttribute('cell', new THREE.InstancedBufferAttribute(cell, 4));
      geometry.setAttribute('aux', new THREE.InstancedBufferAttribute(aux, 4));
      geometry.maxInstancedCount = count;
      const material = new THREE.ShaderMaterial({
        uniforms: Object.assign({faceNormal: {value: new THREE.Vector3(...normal)}}, this.uniforms),
        vertexShader: voxelVertexShader, fragmentShader: recordFragmentShader,
      });
      const mesh = new THREE.Mesh(geometry, material);
      mesh.frustumCulled = false;
      this.solids.add(mesh);
      this.faces += count;
    });
    this.world.add(this.solids);
  }

  makePoints() {
    const {points} = this.scene.view;
    const geometry = new THREE.BufferGeometry();
    // three.js counts the vertices by `position`, which the shader does not read.
    geometry.setAttribute('position', new THREE.BufferAttribute(points.cell, 4));
    geometry.setAttribute('cell', new THREE.BufferAttribute(points.cell, 4));
    geometry.setAttribute('aux', new THREE.BufferAttribute(points.aux, 4));
    const material = new THREE.ShaderMaterial({
      uniforms: this.uniforms, vertexShader: pointVertexShader, fragmentShader: recordFragmentShader,
    });
    this.points = new THREE.Points(geometry, material);
    this.points.frustumCulled = false;
    this.points.visible = false;
    this.world.add(this.points);
    // Points cover their share of the surface: about as large as they lie apart.
    const area = this.reach * this.reach * 2;
    this.uniforms.pointSize.value = Math.max(Math.sqrt(area / Math.max(points.count, 1)) * 1.1, 0.3 * this.scene.voxel_size_m);
  }

  makeFields() {
    this.fields = {};
    for (const name of Object.keys(this.scene.view.fields)) {
      const field = this.scene.view.fields[name];
      if (!field.count) continue;
      const offset = new Float32Array(3 * field.count), direction = new Float32Array(3 * field.count);
      const speed = new Float32Array(field.count);
      for (let i = 0; i < field.count; ++i) {
        for (let k = 0; k < 3; ++k) {
          offset[3 * i + k] = field.arrow[7 * i + k];
          direction[3 * i + k] = field.arrow[7 * i + 3 + k];
        }
        speed[i] = Math.hypot(...field.arrow.subarray(7 * i + 3, 7 * i + 6));
      }
      const strongest = Float32Array.from(speed).sort()[Math.floor(0.95 * (field.count - 1))] || 1;
      for (let i = 0; i < field.count; ++i) speed[i] = Math.min(speed[i] / strongest, 1);
      const geometry = new THREE.InstancedBufferGeometry();
      const {corners, index} = arrowShape();
      geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
      geometry.setIndex(index);
      geometry.setAttribute('offset', new THREE.InstancedBufferAttribute(offset, 3));
      geometry.setAttribute('direction', new THREE.InstancedBufferAttribute(direction, 3));
      geometry.setAttribute('strength', new THREE.InstancedBufferAttribute(speed, 1));
      geometry.maxInstancedCount = field.count;
      const longest = Math.min(Math.max(0.035 * this.reach, 0.05), 0.35);
      const mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
        uniforms: {
          longest: {value: longest}, thickness: {value: 0.14 * longest},
          colour: {value: new THREE.Vector3(...(fieldColours[name] || [0.35, 0.2, 0.5]))},
        },
        vertexShader: arrowVertexShader, fragmentShader: recordFragmentShader, side: THREE.DoubleSide,
      }));
      mesh.frustumCulled = false;
      mesh.visible = false;
      mesh.userData.strongest = strongest;
      this.fields[name] = mesh;
      this.world.add(mesh);
    }
  }

  // The chosen object's centre of mass, weakest direction, and the edge that it turns over or slides off.
  makeMarker() {
    this.marker = new THREE.Group();
    const ink = new THREE.MeshBasicMaterial({color: 0x101418, depthTest: false, transparent: true});
    this.ball = new THREE.Mesh(new THREE.SphereGeometry(1, 16, 12), ink);
    this.arrow = new THREE.ArrowHelper(new THREE.Vector3(1, 0, 0), new THREE.Vector3(), 1, 0x101418);
    this.arrow.line.material.depthTest = this.arrow.cone.material.depthTest = false;
    this.arrow.line.material.transparent = this.arrow.cone.material.transparent = true;
    // As thick as it is needed: lines are a pixel wide.
    this.edge = new THREE.Mesh(new THREE.CylinderGeometry(1, 1, 1, 8),
      new THREE.MeshBasicMaterial({color: 0xc92c2c, depthTest: false, transparent: true}));
    this.marker.add(this.ball, this.arrow, this.edge);
    this.marker.visible = false;
    this.marker.renderOrder = 10;
    this.world.add(this.marker);
  }

  mark(object) {
    this.marker.visible = !!object && object.center_of_mass_m.every(value => value !== null);
    if (this.marker.visible) {
      const at = this.fromInput(object.center_of_mass_m);
      this.ball.position.copy(at);
      this.ball.scale.setScalar(0.006 * this.reach);
      const direction = this.fromInput(object.direction.map(value => value || 0));
      this.arrow.visible = direction.length() > 0.5;
      if (this.arrow.visible) {
        this.arrow.position.copy(at);
        this.arrow.setDirection(direction.normalize());
        this.arrow.setLength(0.08 * this.reach, 0.02 * this.reach, 0.012 * this.reach);
      }
      this.edge.visible = object.why.edge_m.length === 2 && object.why.edge_m.flat().every(value => value !== null);
      if (this.edge.visible) {
        const [a, b] = object.why.edge_m.map(end => this.fromInput(end));
        const along = b.clone().sub(a), length = Math.max(along.length(), 0.01 * this.reach);
        this.edge.position.copy(a).add(b).multiplyScalar(0.5);
        this.edge.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.lengthSq() > 0 ? along.normalize() : new THREE.Vector3(1, 0, 0));
        this.edge.scale.set(0.003 * this.reach, length, 0.003 * this.reach);
      }
    }
    this.redraw();
  }

  fromInput(v) {
    const rows = this.scene.view.view_from_input;
    return new THREE.Vector3(...rows.map(row => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]));
  }

  // --- the camera ---------------------------------------------------------------------------------

  reset() {
    const direction = new THREE.Vector3(-0.55, -0.75, 0.62).normalize();
    this.camera.near = 0.004 * this.reach;
    this.camera.far = 20 * this.reach;
    // The sphere around the scene fits the narrower side of the window.
    const half = Math.atan(Math.tan(this.camera.fov * Math.PI / 360) * Math.min(1, this.camera.aspect));
    const distance = 0.53 * this.reach / Math.sin(half);
    // The near walls and the ceiling are left out, so what shows lies below the middle.
    const target = this.centre.clone();
    target.z -= 0.14 * this.height;
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.maxDistance = 10 * this.reach;
    this.controls.update();
    this.redraw();
  }

  resize() {
    const width = this.container.clientWidth || 1, height = this.container.clientHeight || 1;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.render();
  }

  setShow(what) {
    this.solids.visible = what === 'solids';
    this.points.visible = what === 'points';
    this.redraw();
  }

  setField(name, visible) {
    if (this.fields[name]) this.fields[name].visible = visible;
    this.redraw();
  }

  setThrough(on) {
    this.uniforms.through.value = on ? 1 : 0;
    this.redraw();
  }

  // --- drawing ------------------------------------------------------------------------------------

  redraw() {
    this.idsStale = true;
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.render();
    });
  }

  render() {
    const height = this.renderer.domElement.height;
    this.uniforms.eye.value.copy(this.camera.position);
    this.uniforms.pointScale.value = height / (2 * Math.tan(this.camera.fov * Math.PI / 360));
    this.renderer.render(this.world, this.camera);
    this.idsStale = true;
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    const needle = document.getElementById('needle');
    needle.setAttribute('transform', `rotate(${Math.atan2(-ahead.x, ahead.y) * 180 / Math.PI})`);
  }

  // Draws each place's group number instead of its colour, once per view, at half the resolution.
  drawGroups() {
    const {width, height} = this.renderer.domElement;
    this.ids.setSize(Math.max(width >> 1, 1), Math.max(height >> 1, 1));
    const shown = [this.marker, ...Object.values(this.fields)].filter(thing => thing.visible);
    for (const thing of shown) thing.visible = false;
    this.uniforms.picking.value = 1;
    this.renderer.setRenderTarget(this.ids);
    this.renderer.clear();
    this.renderer.render(this.world, this.camera);
    this.renderer.setRenderTarget(null);
    this.uniforms.picking.value = 0;
    for (const thing of shown) thing.visible = true;
    this.idsStale = false;
  }

  // The object under a place of the container (CSS pixels): its id, -1 for unassigned, null for none.
  pick(x, y) {
    if (this.idsStale) this.drawGroups();
    const column = Math.floor(x / this.container.clientWidth * this.ids.width);
    const row = Math.floor((1 - y / this.container.clientHeight) * this.ids.height);
    const bytes = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.ids, column, row, 1, 1, bytes);
    return this.objectOf(bytes, 0);
  }

  objectOf(bytes, at) {
    const group = bytes[at] + 256 * bytes[at + 1] + 65536 * bytes[at + 2] - 1;
    return group >= 0 && group < this.scene.view.groups.length ? this.scene.view.groups[group][1] : null;
  }

  // How many places of the view each object covers.
  seen() {
    if (this.idsStale) this.drawGroups();
    const {width, height} = this.ids, bytes = new Uint8Array(4 * width * height), count = new Map();
    this.renderer.readRenderTargetPixels(this.ids, 0, 0, width, height, bytes);
    for (let at = 0; at < bytes.length; at += 4) {
      const id = this.objectOf(bytes, at);
      if (id !== null) count.set(id, (count.get(id) || 0) + 1);
    }
    return count;
  }
}

// The corners of a unit cube's face, anticlockwise seen from outside.
function faceCorners(normal) {
  const n = new THREE.Vector3(...normal);
  const side = new THREE.Vector3(Math.abs(n.z), Math.abs(n.x), Math.abs(n.y));
  const up = new THREE.Vector3().crossVectors(n, side);
  const corners = [];
  for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) {
    corners.push(...n.clone().addScaledVector(side, a).addScaledVector(up, b).multiplyScalar(0.5).toArray());
  }
  return corners;
}

// A shaft and a head with five sides, along z from 0 to 1, one unit thick at the head.
function arrowShape() {
  const corners = [], index = [], sides = 5;
  const ring = (radius, z) => {
    for (let i = 0; i < sides; ++i) {
      const angle = 2 * Math.PI * i / sides;
      corners.push(radius * Math.cos(angle), radius * Math.sin(angle), z);
    }
  };
  const join = (a, b) => {
    for (let i = 0; i < sides; ++i) {
      const next = (i + 1) % sides;
      index.push(a + i, a + next, b + next, a + i, b + next, b + i);
    }
  };
  ring(0.22, 0);
  ring(0.22, 0.6);
  ring(0.6, 0.6);
  ring(0.01, 1);
  join(0, sides);
  join(sides, 2 * sides);
  join(2 * sides, 3 * sides);
  return {corners, index};
}
