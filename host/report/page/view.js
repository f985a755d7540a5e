// SPDX-License-Identifier: MIT
'use strict';

// Of parts that were chosen to be put right.
const markColour = [255, 128, 20];

// Of vertices {cell, aux, photo}, with the corners of triangles where there are any.
function recordGeometry({cell, aux, photo}, index) {
  const geometry = new THREE.BufferGeometry();
  // three.js knows geometry, and counts its vertices, by `position`, which the shader does not read.
  geometry.setAttribute('position', new THREE.BufferAttribute(cell, 4));
  geometry.setAttribute('cell', new THREE.BufferAttribute(cell, 4));
  geometry.setAttribute('aux', new THREE.BufferAttribute(aux, 4));
  if (photo) geometry.setAttribute('photo', new THREE.BufferAttribute(photo, 4, true));
  if (index) geometry.setIndex(new THREE.BufferAttribute(index, 1));
  return geometry;
}

// The 3D view. Throws where there is no WebGL. Draws only when something changed.
class View {
  constructor(container, scene) {
    this.container = container;
    this.scene = scene;
    this.software = drawsInSoftware();
    // Smooth edges take long in software, and where a pixel is half a CSS pixel they are smooth enough.
    this.renderer = new THREE.WebGLRenderer({antialias: (window.devicePixelRatio || 1) < 2 && !this.software, alpha: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.world = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(45, 1, 0.02, 500);
    this.camera.up.set(0, 0, 1);
    container.prepend(this.renderer.domElement);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableKeys = false;  // they would move what keys turn here
    this.controls.addEventListener('change', () => this.redraw());
    this.renderer.domElement.tabIndex = 0;
    this.renderer.domElement.addEventListener('keydown', event => this.turnByKey(event));
    this.makePalette();
    this.measure();
    this.makeSolids();
    this.makePoints();
    this.makeOverlays();
    this.ids = new THREE.WebGLRenderTarget(1, 1, {magFilter: THREE.NearestFilter, minFilter: THREE.NearestFilter});
    this.idsStale = true;
    this.show = 'solids';
    this.fit();
    this.reset();
    new ResizeObserver(() => { if (this.fit()) this.render(); }).observe(container);
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
      own: {value: 0},
      // A little over its edge, so that rounding opens no cracks between neighbours.
      cube: {value: 1.005 * view.cube_m + 2 * Math.max(...view.step_m)},
      pointSize: {value: 1},
      pointScale: {value: 1},
    };
  }

  // Colours every group by `mode`, or all by the scan's colours; with `chosen`, all but that object's fade. The parts of
  // the set `marked` are coloured as chosen ones.
  paint(mode, chosen, marked) {
    const pale = [214, 213, 208];
    this.scene.view.groups.forEach(([primitive, id], i) => {
      const object = this.scene.objectById.get(id);
      const grounded = !object || object.grounded;
      let colour = mode === 'primitive' ? colourOf(this.scene, primitive) : objectColour(this.scene, id);
      if (mode === 'risk') colour = !object || grounded ? noColour : categoryColour(this.scene, object.unsafety_category);
      if (mode === 'reach') colour = !object || grounded ? noColour : categoryColour(this.scene, reachCategory(object));
      // What can't fall steps back: paler and greyer.
      let fade = grounded ? (mode === 'primitive' ? 0.45 : 0.8) : 0;
      // Of a photo the ground is what people recognise their room by.
      if (mode === 'photo') fade = 0;
      if (chosen !== null) fade = id === chosen ? 0 : Math.max(fade, 0.72);
      const mark = marked.has(primitive);
      for (let c = 0; c < 3; ++c) {
        this.paletteBytes[4 * i + c] = mode === 'photo' ? [255 * fade, mark ? 255 : 0, 0][c]
          : mark ? markColour[c] : colour[c] + (pale[c] - colour[c]) * fade;
      }
      this.paletteBytes[4 * i + 3] = grounded && !mark ? 128 : 255;
    });
    this.uniforms.own.value = mode === 'photo' ? 1 : 0;
    this.palette.needsUpdate = true;
    this.redraw();
  }

  // The box and the reach of what is drawn.
  measure() {
    const {low, high} = this.scene.boxes.get(null);
    this.box = new THREE.Box3(new THREE.Vector3(...low), new THREE.Vector3(...high));
    this.reach = Math.max(this.box.min.distanceTo(this.box.max), 4 * this.scene.view.cube_m, 0.05);
    if (!drawnRecords(this.scene.view).count) this.reach = 1;
  }

  // --- what is drawn --------------------------------------------------------------------------------

  makeSolids() {
    this.solids = new THREE.Group();
    this.faces = 0;
    if (this.scene.view.surface.count) this.makeSurface();
    else this.makeVoxels();
    this.world.add(this.solids);
  }

  makeSurface() {
    const {surface} = this.scene.view;
    const mesh = new THREE.Mesh(recordGeometry(surface, surface.index), new THREE.ShaderMaterial({
      uniforms: this.uniforms, vertexShader: surfaceVertexShader, fragmentShader: surfaceFragmentShader,
    }));
    mesh.frustumCulled = false;
    this.solids.add(mesh);
    this.faces = surface.triangles;
  }

  // One mesh for each direction of face, of the exposed faces only. Four vertices a face rather than an instance:
  // drawing in software takes long over instances.
  makeVoxels() {
    const {voxels} = this.scene.view;
    const fromCell = new Uint32Array(voxels.cell.buffer), fromAux = new Uint32Array(voxels.aux.buffer);
    const fromPhoto = voxels.photo && new Uint32Array(voxels.photo.buffer);
    faceCorners.forEach((corners, face) => {
      let count = 0;
      for (let i = 0; i < voxels.count; ++i) count += voxels.aux[4 * i + 3] >> face & 1;
      if (!count) return;
      const cell = new Uint16Array(16 * count), aux = new Int8Array(16 * count), index = new Uint32Array(6 * count);
      const toPhoto = new Uint32Array(fromPhoto ? 4 * count : 0);
      // By words of 32 bits: two hold a cell, one its normal and flags.
      const toCell = new Uint32Array(cell.buffer), toAux = new Uint32Array(aux.buffer);
      let to = 0, next = 0;
      for (let i = 0; i < voxels.count; ++i) {
        const flags = voxels.aux[4 * i + 3];
        if (!(flags >> face & 1)) continue;
        for (const corner of [0, 1, 2, 0, 2, 3]) index[next++] = to + corner;
        for (let corner = 0; corner < 4; ++corner, ++to) {
          toCell[2 * to] = fromCell[2 * i];
          toCell[2 * to + 1] = fromCell[2 * i + 1];
          toAux[to] = fromAux[i] & 0xffffff | (corner + (flags & 64)) << 24;
          if (fromPhoto) toPhoto[to] = fromPhoto[i];
        }
      }
      const photo = fromPhoto && new Uint8Array(toPhoto.buffer), places = corners.map(corner => new THREE.Vector3(...corner).multiplyScalar(0.5));
      const uniforms = {faceNormal: {value: places[0].clone().add(places[2])}, corners: {value: places}};
      const mesh = new THREE.Mesh(recordGeometry({cell, aux, photo}, index), new THREE.ShaderMaterial({
        uniforms: Object.assign(uniforms, this.uniforms),
        vertexShader: voxelVertexShader, fragmentShader: recordFragmentShader,
      }));
      mesh.frustumCulled = false;
      this.solids.add(mesh);
      this.faces += count;
    });
  }

  // Leaves out the directions of faces that the camera, being past all of them, sees from behind only.
  hideBacks() {
    const view = this.scene.view, eye = this.camera.position.toArray();
    if (view.surface.count) return;
    for (const mesh of this.solids.children) {
      const normal = mesh.material.uniforms.faceNormal.value.toArray(), axis = normal.findIndex(value => value !== 0);
      const low = view.origin_m[axis] - view.cube_m, high = view.origin_m[axis] + 65535 * view.step_m[axis] + view.cube_m;
      mesh.visible = normal[axis] > 0 ? eye[axis] > low : eye[axis] < high;
    }
  }

  makePoints() {
    const {points} = this.scene.view;
    this.points = new THREE.Points(recordGeometry(points), new THREE.ShaderMaterial({
      uniforms: this.uniforms, vertexShader: pointVertexShader, fragmentShader: recordFragmentShader,
    }));
    this.points.frustumCulled = false;
    this.points.visible = false;
    this.world.add(this.points);
    // Points cover their share of the surface: about as large as they lie apart.
    const area = this.reach * this.reach * 2;
    this.uniforms.pointSize.value = Math.max(Math.sqrt(area / Math.max(points.count, 1)) * 1.1, 0.3 * this.scene.voxel_size_m);
  }

  // What lies over the solids; each of it is hidden at first.
  makeOverlays() {
    this.fields = {};
    for (const name of Object.keys(this.scene.view.fields)) {
      if (this.scene.view.fields[name].count) this.fields[name] = fieldMesh(this.scene, name, this.reach);
    }
    const walks = walksGroup(this.scene, this.reach);
    if (walks.children.length) this.fields.walks = walks;
    this.marker = new Marker(this.reach);
    this.labels = new Labels(this.container, this.scene);
    for (const overlay of [...Object.values(this.fields), this.marker.group]) {
      overlay.visible = false;
      this.world.add(overlay);
    }
  }

  mark(object) {
    this.marker.show(object, v => this.fromInput(v));
    this.labels.choose(object);
    this.redraw();
  }

  fromInput(v) {
    return new THREE.Vector3(...viewPlace(this.scene, v));
  }

  // --- the camera ---------------------------------------------------------------------------------

  // From above, as near as the box fits.
  reset() {
    const direction = new THREE.Vector3(-0.55, -0.75, 0.62).normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(direction).normalize(), up = new THREE.Vector3().crossVectors(direction, right);
    // The nearest upper corner belongs to walls and a ceiling that are looked through.
    const {min, max} = this.box, all = [min.x, max.x].flatMap(x => [min.y, max.y].flatMap(y => [min.z, max.z].map(z => new THREE.Vector3(x, y, z))));
    const corners = all.filter(({x, y, z}) => x !== min.x || y !== min.y || z !== max.z);
    const tall = 0.94 * Math.tan(this.camera.fov * Math.PI / 360), wide = tall * this.camera.aspect;
    const target = this.box.getCenter(new THREE.Vector3());
    let distance = this.reach;
    for (let round = 0; round < 20; ++round) {
      // How far the corners reach to each side of the middle, as shares of what the window shows.
      const reach = (axis, half) => {
        const shares = corners.map(corner => corner.clone().sub(target)).map(p => p.dot(axis) / (distance - p.dot(direction)) / half);
        return [Math.min(...shares), Math.max(...shares)];
      };
      const [left, east] = reach(right, wide), [low, high] = reach(up, tall);
      target.addScaledVector(right, (left + east) / 2 * wide * distance).addScaledVector(up, (low + high) / 2 * tall * distance);
      distance = Math.max(distance * Math.max((east - left) / 2, (high - low) / 2), 0.3 * this.reach);
    }
    this.camera.near = 0.004 * this.reach;
    this.camera.far = 20 * this.reach;
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.maxDistance = 10 * this.reach;
    this.controls.update();
    this.redraw();
  }

  // To where an object is seen from near by, from the side that the camera is on; at once where movement is not wanted or slow.
  fly(box) {
    const low = new THREE.Vector3(...box.low), high = new THREE.Vector3(...box.high);
    const target = low.clone().add(high).multiplyScalar(0.5), radius = Math.max(low.distanceTo(high) / 2, 0.03 * this.reach);
    const direction = this.camera.position.clone().sub(this.controls.target).normalize();
    if (direction.z < 0.35) direction.setZ(0.35).normalize();
    const half = Math.atan(Math.tan(this.camera.fov * Math.PI / 360) * Math.min(1, this.camera.aspect));
    const position = target.clone().addScaledVector(direction, 2.2 * radius / Math.sin(half));
    const from = {position: this.camera.position.clone(), target: this.controls.target.clone()};
    const still = this.software || matchMedia('(prefers-reduced-motion: reduce)').matches, begun = performance.now();
    const step = () => {
      const share = still ? 1 : Math.min((performance.now() - begun) / 450, 1), eased = share * share * (3 - 2 * share);
      this.camera.position.lerpVectors(from.position, position, eased);
      this.controls.target.lerpVectors(from.target, target, eased);
      this.controls.update();
      this.redraw();
      if (share < 1) requestAnimationFrame(step);
    };
    step();
  }

  // Arrows turn the view about its middle, plus and minus come nearer and go back, 0 shows all.
  turnByKey(event) {
    const offset = this.camera.position.clone().sub(this.controls.target), ball = new THREE.Spherical().setFromVector3(
      new THREE.Vector3(offset.x, offset.z, -offset.y));
    const keys = {
      ArrowLeft: () => { ball.theta -= 0.15; }, ArrowRight: () => { ball.theta += 0.15; },
      ArrowUp: () => { ball.phi -= 0.12; }, ArrowDown: () => { ball.phi += 0.12; },
      '+': () => { ball.radius *= 0.85; }, '=': () => { ball.radius *= 0.85; }, '-': () => { ball.radius /= 0.85; },
    };
    if (event.key === '0') this.reset();
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
    const turned = new THREE.Vector3().setFromSpherical(ball.makeSafe());
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3(turned.x, -turned.z, turned.y));
    this.controls.update();
    this.redraw();
  }

  // Takes on the container's size; whether that changed.
  fit() {
    const width = this.container.clientWidth || 1, height = this.container.clientHeight || 1;
    if (this.size && this.size[0] === width && this.size[1] === height) return false;
    this.size = [width, height];
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    return true;
  }

  setShow(what) {
    this.solids.visible = what === 'solids';
    this.points.visible = what === 'points';
    this.redraw();
  }

  setField(name, visible) {
    this.fields[name].visible = visible;
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
    this.hideBacks();
    this.uniforms.pointScale.value = height / (2 * Math.tan(this.camera.fov * Math.PI / 360));
    this.renderer.render(this.world, this.camera);
    this.idsStale = true;
    const ahead = this.camera.getWorldDirection(new THREE.Vector3());
    const needle = document.getElementById('needle');
    this.labels.place(this.camera, v => this.fromInput(v));
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.hideUnseenLabels(), 150);
    needle.setAttribute('transform', `rotate(${Math.atan2(-ahead.x, ahead.y) * 180 / Math.PI})`);
  }

  // Draws each place's group number instead of its colour, once per view, at half the resolution.
  drawGroups() {
    const {width, height} = this.renderer.domElement;
    this.ids.setSize(Math.max(width >> 1, 1), Math.max(height >> 1, 1));
    const shown = [this.marker.group, ...Object.values(this.fields)].filter(thing => thing.visible);
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
    const group = this.pickGroup(x, y);
    return group ? group[1] : null;
  }

  // The primitive and the object there, or null.
  pickGroup(x, y) {
    if (this.idsStale) this.drawGroups();
    const column = Math.floor(x / this.container.clientWidth * this.ids.width);
    const row = Math.floor((1 - y / this.container.clientHeight) * this.ids.height);
    const bytes = new Uint8Array(4);
    this.renderer.readRenderTargetPixels(this.ids, column, row, 1, 1, bytes);
    return this.groupOf(bytes, 0);
  }

  // The same where the objects of the set `passed` are looked through.
  pickBehind(x, y, passed) {
    if (!passed.size) return this.pickGroup(x, y);
    const shown = this.paletteBytes.slice();
    this.scene.view.groups.forEach(([, id], i) => { if (passed.has(id)) this.paletteBytes[4 * i + 3] = 0; });
    this.palette.needsUpdate = true;
    this.drawGroups();
    const group = this.pickGroup(x, y);
    this.paletteBytes.set(shown);
    this.palette.needsUpdate = true;
    this.idsStale = true;
    return group;
  }

  groupOf(bytes, at) {
    const group = bytes[at] + 256 * bytes[at + 1] + 65536 * bytes[at + 2] - 1;
    return this.scene.view.groups[group] || null;
  }

  // Once the camera rests: finding what is seen takes a pass over the scene.
  hideUnseenLabels() {
    clearTimeout(this.resting);
    this.labels.seen = this.seen();
    this.labels.place(this.camera, v => this.fromInput(v));
  }

  // How many places of the view each object covers.
  seen() {
    if (this.idsStale) this.drawGroups();
    const {width, height} = this.ids, bytes = new Uint8Array(4 * width * height), count = new Map();
    this.renderer.readRenderTargetPixels(this.ids, 0, 0, width, height, bytes);
    for (let at = 0; at < bytes.length; at += 4) {
      const group = this.groupOf(bytes, at);
      if (group) count.set(group[1], (count.get(group[1]) || 0) + 1);
    }
    return count;
  }
}

// Whether this browser draws without a GPU.
function drawsInSoftware() {
  const gl = document.createElement('canvas').getContext('webgl');
  const info = gl && gl.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  const lose = gl && gl.getExtension('WEBGL_lose_context');
  if (lose) lose.loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}
