// SPDX-License-Identifier: MIT
'use strict';

// What explains a drawing, by the first word of its title.
const drawnTerms = {Instability: 'instability', Poses: 'pose', Disconnectivity: 'basin'};

// The drawings of an object's energy landscapes, as the program laid them out.
function drawingsOf(scene, id) {
  return (scene.drawings[id] || []).map(drawing => {
    const key = drawnTerms[drawing.title.split(/[ :]/)[0]];
    const figure = element('figure', {}, [element('h3', {}, [key ? term(key, drawing.title) : drawing.title])]);
    figure.append(paintDrawing(scene, drawing));
    return figure;
  });
}

function paintDrawing(scene, drawing) {
  const svg = svgElement('svg', {viewBox: `0 0 ${drawing.width} ${drawing.height}`, role: 'img', 'aria-label': drawing.title});
  if (drawing.sphere) svg.append(sphereImage(scene, drawing.sphere));
  if (drawing.raster) svg.append(rasterImage(drawing.raster));
  for (const [colour, [x, y], width, height] of drawing.swatches) {
    svg.append(svgElement('rect', {x, y, width, height, fill: css(colour)}));
  }
  for (const [style, points] of drawing.strokes) {
    svg.append(svgElement('polyline', {class: style, points: points.join(' ')}));
  }
  for (const [style, [cx, cy], r] of drawing.dots) svg.append(svgElement('circle', {class: style, cx, cy, r}));
  for (const [anchor, [x, y], strong, text] of drawing.labels) {
    svg.append(svgElement('text', {x, y, 'text-anchor': anchor, class: strong ? 'strong' : ''}, text));
  }
  return svg;
}

// Pixels as an image of an SVG; `colourAt` gives [red, green, blue], or null for none.
function pixelImage(side, box, colourAt) {
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = side;
  const context = canvas.getContext('2d'), pixels = context.createImageData(side, side);
  for (let y = 0, at = 0; y < side; ++y) {
    for (let x = 0; x < side; ++x, at += 4) {
      const colour = colourAt(x, y);
      if (!colour) continue;
      for (let c = 0; c < 3; ++c) pixels.data[at + c] = colour[c];
      pixels.data[at + 3] = 255;
    }
  }
  context.putImageData(pixels, 0, 0);
  return svgElement('image', Object.assign({href: canvas.toDataURL(), preserveAspectRatio: 'none'}, box));
}

// The height of the centre of mass over all up directions, an equal-area map: Lambert's azimuthal
// projection around the pose as it is. Bands of equal height make the contours.
function sphereImage(scene, sphere) {
  const corners = new Int16Array(bytesOf(sphere.corners).buffer), side = Math.round(3 * sphere.radius);
  const colours = [];
  for (let band = 0; band < scene.ramp.bands; ++band) colours.push(colourAlong(scene.ramp.colours, (band + 0.5) / scene.ramp.bands));
  const scale = scene.ramp.bands / Math.max(sphere.high - sphere.low, 1e-9);
  const box = {x: sphere.middle[0] - sphere.radius, y: sphere.middle[1] - sphere.radius,
    width: 2 * sphere.radius, height: 2 * sphere.radius};
  return pixelImage(side, box, (px, py) => {
    const u = (px + 0.5) / side * 2 - 1, v = (py + 0.5) / side * 2 - 1, square = u * u + v * v;
    if (square > 1) return null;
    const level = 2 * Math.sqrt(1 - square), x = -level * u, y = level * v, z = 1 - 2 * square;
    let lowest = Infinity;
    for (let i = 0; i < corners.length; i += 3) {
      const height = corners[i] * x + corners[i + 1] * y + corners[i + 2] * z;
      if (height < lowest) lowest = height;
    }
    return colours[Math.min(Math.max(Math.floor((-lowest - sphere.low) * scale), 0), colours.length - 1)];
  });
}

function rasterImage(raster) {
  const code = bytesOf(raster.code), scale = Math.max(1, Math.floor(400 / raster.side));
  const box = {x: raster.corner[0], y: raster.corner[1], width: raster.size, height: raster.size};
  return pixelImage(raster.side * scale, box,
    (x, y) => raster.palette[code[Math.floor(y / scale) * raster.side + Math.floor(x / scale)]]);
}
