// SPDX-License-Identifier: MIT
'use strict';

// What voxels and points share: the place of a record, its group's colour, and the look through walls.
// The palette's alpha says: 1 a movable thing, about 0.5 a grounded one, 0 hidden. In place of its colour a record may
// show its own, that of the scan: then the palette's red says how far it fades, and its green whether it is marked.
const recordShader = `
  attribute vec4 cell;   // x, y, z in steps, group
  attribute vec4 aux;    // normal / 127, flags
  attribute vec4 photo;  // its own colour, and whether it is known
  uniform vec3 origin, stepSize, eye;
  uniform sampler2D palette;
  uniform vec2 paletteSize;
  uniform float through, picking, own;
  varying vec3 shade;

  vec3 place() { return origin + cell.xyz * stepSize; }

  vec4 groupColour() {
    float row = floor((cell.w + 0.5) / paletteSize.x);
    float column = cell.w - row * paletteSize.x;
    vec4 colour = texture2D(palette, (vec2(column, row) + 0.5) / paletteSize);
    if (own > 0.5) {
      vec3 seen = mix(photo.a > 0.5 ? photo.rgb : vec3(0.62), vec3(0.84, 0.835, 0.815), colour.r);
      colour.rgb = mix(seen, vec3(1.0, 0.5, 0.08), colour.g);
    }
    return colour;
  }

  // A wall, floor or ceiling that is seen from behind would hide the room.
  bool isBehind(vec4 colour, vec3 at) {
    return through > 0.5 && colour.a < 0.75 && dot(aux.xyz, eye - at) < 0.0;
  }

  vec3 identity() {
    float group = cell.w + 1.0;
    return vec3(mod(group, 256.0), mod(floor(group / 256.0), 256.0), floor(group / 65536.0)) / 255.0;
  }
`;

const voxelVertexShader = recordShader + `
  uniform vec3 faceNormal, corners[4];
  uniform float cube;
  void main() {
    vec3 centre = place();
    vec4 colour = groupColour();
    if (colour.a < 0.1 || isBehind(colour, centre)) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      return;
    }
    // The mean normal of what was seen there smooths the voxels' steps.
    vec3 seen = length(aux.xyz) > 60.0 ? normalize(aux.xyz) : faceNormal;
    if (dot(seen, faceNormal) < 0.0) seen = -seen;
    float light = 0.77 + 0.25 * dot(normalize(faceNormal + 2.0 * seen), vec3(-0.13, -0.43, 0.89));
    // What was inferred is darker on things; on floors and walls it would only be speckles.
    float inferred = floor(aux.w / 64.0 + 0.001);
    float completed = inferred > 0.5 && colour.a > 0.75 ? 0.93 : 1.0;
    vec3 corner = corners[int(aux.w - 64.0 * inferred + 0.5)];
    shade = picking > 0.5 ? identity() : colour.rgb * light * completed;
    gl_Position = projectionMatrix * viewMatrix * vec4(centre + corner * cube, 1.0);
  }
`;

const surfaceVertexShader = recordShader + `
  varying float before;  // whether the eye is on the side that a room sees it from
  void main() {
    vec3 at = place();
    vec4 colour = groupColour();
    if (colour.a < 0.1) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      return;
    }
    float inferred = floor(aux.w / 64.0 + 0.001), code = floor(aux.w - 64.0 * inferred + 0.5);
    float xy = mod(code, 9.0);
    vec3 facing = vec3(mod(xy, 3.0), floor(xy / 3.0 + 0.01), floor(code / 9.0 + 0.01)) - 1.0;
    before = through > 0.5 && colour.a < 0.75 && dot(facing, facing) > 0.0 ? dot(facing, eye - at) : 1.0;
    float light = 0.77 + 0.25 * dot(normalize(aux.xyz), vec3(-0.13, -0.43, 0.89));
    float completed = inferred > 0.5 && colour.a > 0.75 ? 0.93 : 1.0;
    shade = picking > 0.5 ? identity() : colour.rgb * light * completed;
    gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
  }
`;

const surfaceFragmentShader = `
  varying vec3 shade;
  varying float before;
  void main() {
    if (before < 0.0) discard;
    gl_FragColor = vec4(shade, 1.0);
  }
`;

const pointVertexShader = recordShader + `
  uniform float pointScale, pointSize;
  void main() {
    vec3 at = place();
    vec4 colour = groupColour();
    if (colour.a < 0.1 || isBehind(colour, at)) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      gl_PointSize = 1.0;
      return;
    }
    vec4 seen = viewMatrix * vec4(at, 1.0);
    float facing = length(aux.xyz) > 10.0 ? abs(dot(normalize(aux.xyz), normalize(eye - at))) : 0.8;
    shade = picking > 0.5 ? identity() : colour.rgb * (0.55 + 0.45 * facing);
    gl_Position = projectionMatrix * seen;
    gl_PointSize = clamp(pointSize * pointScale / max(-seen.z, 0.01), 1.5, 40.0);
  }
`;

const recordFragmentShader = `
  varying vec3 shade;
  void main() { gl_FragColor = vec4(shade, 1.0); }
`;

// Low to high, as walks and arrows are coloured.
const rampShader = `
  uniform vec3 ramp[6];
  vec3 rampColour(float share) {
    float at = clamp(share, 0.0, 1.0) * 5.0;
    vec3 colour = ramp[0];
    for (int i = 0; i < 5; ++i) colour = mix(colour, ramp[i + 1], clamp(at - float(i), 0.0, 1.0));
    return colour;
  }
`;

// An arrow along +z of unit length, turned to its direction and scaled.
const arrowVertexShader = rampShader + `
  attribute vec3 offset, direction;
  attribute float strength;
  uniform float longest, thickness, tip;
  varying vec3 shade;
  void main() {
    float speed = length(direction);
    vec3 along = speed > 0.0 ? direction / speed : vec3(0.0, 0.0, 1.0);
    vec3 side = normalize(cross(along, abs(along.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(1.0, 0.0, 0.0)));
    vec3 other = cross(along, side);
    vec3 out_ = position.x * side + position.y * other;
    float size = mix(0.35, 1.0, strength);
    vec3 at = offset + (out_ * thickness + along * (position.z - tip) * longest) * size;
    shade = rampColour(strength) * (0.8 + 0.2 * normalize(out_ + 1e-5).z);
    gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
  }
`;

// One cell of the walkable floor.
const walkVertexShader = rampShader + `
  attribute float share;
  varying vec3 shade;
  void main() {
    shade = rampColour(share);
    gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  }
`;
