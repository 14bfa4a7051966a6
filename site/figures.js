// The interactive figures of the lessons. Everything shown is computed by the npm package. Points are dragged, or moved by the arrow keys.

import { generateFrames, generateTangents, ready, splitVertices } from './darboux.js';

const SVG = 'http://www.w3.org/2000/svg';

/** An element with attributes and children. */
function element(name, attributes = {}, ...children) {
  const made = ['svg', 'g', 'path', 'circle', 'text', 'line'].includes(name) ? document.createElementNS(SVG, name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

/** A drawing of flat triangles. Points are in units of the surface, with y up. */
class Drawing {
  constructor(label, [width, height], scale, [left, bottom]) {
    this.toPixels = ([x, y]) => [(x - left) * scale, height - (y - bottom) * scale];
    this.toPoint = ([x, y]) => [x / scale + left, (height - y) / scale + bottom];
    this.shapes = element('g');
    this.handles = element('g');
    this.svg = element('svg', { viewBox: `0 0 ${width} ${height}`, role: 'group', 'aria-label': label }, this.shapes, this.handles);
  }

  clear() {
    this.shapes.replaceChildren();
  }

  polygon(points, name) {
    const path = points.map((point) => this.toPixels(point).map((x) => x.toFixed(2)).join(' ')).join('L');
    this.shapes.append(element('path', { d: `M${path}Z`, class: name }));
  }

  /** An arrow from a point along a vector, with a label at its end. */
  arrow(from, [x, y], name, label, width = 3) {
    const [[x0, y0], [x1, y1]] = [this.toPixels(from), this.toPixels([from[0] + x, from[1] + y])];
    const size = Math.hypot(x1 - x0, y1 - y0);
    if (!(size > 1)) return;
    const [dx, dy] = [(x1 - x0) / size, (y1 - y0) / size];
    const head = `M${x1} ${y1}L${x1 - 9 * dx - 5 * dy} ${y1 - 9 * dy + 5 * dx}L${x1 - 9 * dx + 5 * dy} ${y1 - 9 * dy - 5 * dx}Z`;
    this.shapes.append(element('line', { x1: x0, y1: y0, x2: x1 - 6 * dx, y2: y1 - 6 * dy, 'stroke-width': width, class: name }), element('path', { d: head, class: name }));
    if (label) this.text([x1 + 12 * dx - 5, y1 + 12 * dy + 5], label, name);
  }

  text([x, y], words, name = '') {
    this.shapes.append(element('text', { x, y, class: name }, words));
  }

  /** A point that can be moved. `moved` gets its new place. */
  handle(point, label, moved) {
    const circle = element('circle', { r: 9, class: 'handle', tabindex: 0, role: 'button', 'aria-label': `${label}; move it with the arrow keys` });
    const place = () => {
      const [x, y] = this.toPixels(point);
      circle.setAttribute('cx', x);
      circle.setAttribute('cy', y);
    };
    const move = (to) => {
      [point[0], point[1]] = moved(to) ?? to;
      place();
    };
    circle.addEventListener('pointerdown', (event) => circle.setPointerCapture(event.pointerId));
    circle.addEventListener('pointermove', (event) => {
      if (!circle.hasPointerCapture(event.pointerId)) return;
      const inverse = this.svg.getScreenCTM().inverse();
      const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(inverse);
      move(this.toPoint([x, y]));
    });
    const STEPS = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] };
    circle.addEventListener('keydown', (event) => {
      const step = STEPS[event.key];
      if (!step) return;
      event.preventDefault();
      move([point[0] + step[0], point[1] + step[1]]);
    });
    place();
    this.handles.append(circle);
  }
}

/** The arrays of a flat mesh whose normals point to the viewer, or away from it (`facing` is -1). */
function flatMesh(points, uvs, triangles, facing = 1) {
  return [
    Float32Array.from(points.flatMap(([x, y]) => [x, y, 0])),
    Float32Array.from(points.flatMap(() => [0, 0, facing])),
    Float32Array.from(uvs.flat()),
    Uint16Array.from(triangles.flat()),
  ];
}

/** Twice the signed area of a triangle. */
const determinant = ([a, b, c]) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);

/** The place of a label beside a point. */
const beside = ([x, y]) => [x + 11, y - 9];

const number = (x) => x.toFixed(2).replace('-', '−');

/** A triangle whose vertices and UVs are dragged: T and B follow, and w changes its sign when the picture is mirrored. */
function derivatives(place) {
  const points = [[0.3, 0.3], [3.3, 0.6], [0.9, 2.7]];
  const uvs = [[0.1, 0.1], [0.9, 0.1], [0.1, 0.9]];
  const surface = new Drawing('The triangle on the surface', [330, 300], 80, [-0.3, -0.4]);
  const picture = new Drawing('The triangle in the picture', [300, 300], 240, [-0.12, -0.12]);
  const output = element('output');
  const draw = () => {
    // A flipped triangle shows its back.
    const facing = determinant(points) < 0 ? -1 : 1;
    const { tangents, bitangents, magnitudes } = generateFrames(...flatMesh(points, uvs, [[0, 1, 2]], facing));
    const mirrored = determinant(uvs) < 0;
    surface.clear();
    picture.clear();
    picture.polygon([[0, 0], [1, 0], [1, 1], [0, 1]], 'share');
    surface.polygon(points, `triangle${mirrored ? ' mirrored' : ''}`);
    picture.polygon(uvs, `triangle${mirrored ? ' mirrored' : ''}`);
    picture.arrow([0, 0], [0.3, 0], 'tangent', 'u');
    picture.arrow([0, 0], [0, 0.3], 'bitangent', 'v');
    const centre = [0, 1].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / 3);
    surface.arrow(centre, [tangents[0], tangents[1]], 'tangent', 'T');
    surface.arrow(centre, [bitangents[0], bitangents[1]], 'bitangent', 'B');
    points.forEach((point, at) => surface.text(beside(surface.toPixels(point)), `p${at}`));
    uvs.forEach((uv, at) => picture.text(beside(picture.toPixels(uv)), `p${at}`));
    const area = determinant(uvs);
    output.textContent = `det U = ${number(area)}, |P_u| = ${number(magnitudes[0])}, |P_v| = ${number(magnitudes[1])}, w = ${tangents[3] > 0 ? '+1' : '−1'}${mirrored ? ': mirrored' : ''}${facing < 0 ? '; you see its back' : ''}`;
  };
  for (const [at, name] of ['p0', 'p1', 'p2'].entries()) {
    surface.handle(points[at], `${name} on the surface`, (to) => {
      points[at][0] = to[0];
      points[at][1] = to[1];
      draw();
    });
    picture.handle(uvs[at], `uv of ${name} in the picture`, (to) => {
      const kept = to.map((x) => Math.min(1, Math.max(0, x)));
      [uvs[at][0], uvs[at][1]] = kept;
      draw();
      return kept;
    });
  }
  place.append(element('p', {}, 'Drag the corners, in the picture (left) or on the surface (right).'), side(picture.svg, surface.svg), output);
  draw();
}

/** A strip of two squares with a seam: dragging u of the right edge mirrors the right half, and its vertices split. */
function seam(place) {
  const points = [[0, 0], [1.5, 0], [3, 0], [0, 1.5], [1.5, 1.5], [3, 1.5]];
  const triangles = [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
  const u = [[0.9, 0]];
  const surface = new Drawing('The strip on the surface', [330, 230], 80, [-0.4, -0.6]);
  const picture = new Drawing('u of the three columns', [300, 120], 240, [-0.12, -0.2]);
  const output = element('output');
  const draw = () => {
    const columns = [0, 0.45, u[0][0]];
    const uvs = points.map(([, y], at) => [columns[at % 3], y / 1.5]);
    const mesh = flatMesh(points, uvs, triangles);
    const corners = generateTangents(...mesh);
    const split = splitVertices(mesh[3], corners, points.length);
    surface.clear();
    picture.clear();
    for (const triangle of triangles) {
      const mirrored = determinant(triangle.map((vertex) => uvs[vertex])) < 0;
      surface.polygon(triangle.map((vertex) => points[vertex]), `triangle${mirrored ? ' mirrored' : ''}`);
    }
    picture.arrow([0, 0], [1.05, 0], 'tangent', 'u');
    columns.forEach((x, at) => picture.text([picture.toPixels([x, 0])[0] - 12, picture.toPixels([x, 0.12])[1]], ['left', 'seam', 'right'][at]));
    split.sourceOfVertex.forEach((source, vertex) => {
      const [x, y, , w] = split.tangentOfVertex.subarray(4 * vertex, 4 * vertex + 4);
      surface.arrow(points[source], [0.6 * x, 0.6 * y], 'tangent');
      surface.arrow(points[source], [-0.45 * w * y, 0.45 * w * x], 'bitangent');
    });
    const added = split.sourceOfVertex.length - points.length;
    output.textContent = added
      ? `The right half is mirrored: w = −1 there. ${added} vertices at the seam were split, each with a tangent to the left and one to the right.`
      : `Both halves have w = ${corners[3] > 0 ? '+1' : '−1'}. 6 vertices are enough.`;
  };
  picture.handle(u[0], 'u of the right edge', (to) => {
    const kept = [Math.min(1, Math.max(0, to[0])), 0];
    u[0] = kept;
    draw();
    return kept;
  });
  place.append(element('p', {}, 'Drag u of the right edge across the seam at u = 0.45.'), side(picture.svg, surface.svg), output);
  draw();
}

/** A vertex between unlike triangles: the mean under four weightings. */
function weights(place) {
  const METHODS = { 'average': 'none (unit vectors)', 'lengyel': 'length of P_u', 'area': 'area', 'mikktspace': 'angle (MikkTSpace)' };
  const points = [[0, 0], [2.2, -0.2], [1.9, 1.2], [0.25, 2.1], [-1.8, 1.1]];
  const uvs = [[0, 0], [1, -0.1], [0.9, 0.5], [0.06, 1], [-0.25, 0.9]];
  const triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4]];
  const surface = new Drawing('Three triangles around a vertex', [480, 300], 90, [-2.4, -0.6]);
  const output = element('output');
  let method = 'mikktspace';
  const draw = () => {
    surface.clear();
    for (const triangle of triangles) {
      const corners = triangle.map((vertex) => points[vertex]);
      surface.polygon(corners, 'triangle');
      const [x, y] = generateTangents(...flatMesh(corners, triangle.map((vertex) => uvs[vertex]), [[0, 1, 2]]), { method: 'face' });
      const centre = [0, 1].map((axis) => corners.reduce((sum, point) => sum + point[axis], 0) / 3);
      surface.arrow(centre, [0.3 * x, 0.3 * y], 'tangent', '', 1.5);
    }
    const [x, y] = generateTangents(...flatMesh(points, uvs, triangles), { method });
    surface.arrow([0, 0], [0.9 * x, 0.9 * y], 'tangent', 'T', 4);
    output.textContent = `T points ${number((Math.atan2(y, x) * 180) / Math.PI)}° from the right.`;
  };
  const choices = Object.entries(METHODS).map(([name, words]) => {
    const input = element('input', { type: 'radio', name: 'weighting', value: name });
    input.checked = name === method;
    input.addEventListener('change', () => {
      method = name;
      draw();
    });
    return element('label', {}, input, ` ${words}`);
  });
  for (const at of [1, 2, 3, 4]) {
    surface.handle(points[at], `vertex ${at}`, (to) => {
      [points[at][0], points[at][1]] = to;
      draw();
    });
  }
  place.append(element('fieldset', {}, element('legend', {}, 'Weight'), ...choices), surface.svg, output);
  draw();
}

/** Two drawings side by side where there is room. */
function side(...drawings) {
  const row = element('div', { style: 'display:flex;flex-wrap:wrap;gap:1rem' });
  for (const drawing of drawings) row.append(element('div', { style: 'flex:1 1 14rem' }, drawing));
  return row;
}

const FIGURES = { derivatives, seam, weights };

await ready;
for (const place of document.querySelectorAll('.interactive')) FIGURES[place.dataset.figure](place);
