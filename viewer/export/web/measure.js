// Measuring distances, and marks over the picture.

/** Where a place is on the canvas, in pixels; null behind the camera. */
function on_canvas(point, camera, {clientWidth, clientHeight}) {
  const at = point.clone().project(camera);
  return Math.abs(at.z) > 1 ? null : {x: (at.x + 1) / 2 * clientWidth, y: (1 - at.y) / 2 * clientHeight};
}

/** The part of a segment that lies before the camera, on the canvas; null if none does. */
function segment_on_canvas(from, to, camera, canvas) {
  const [a, b] = [from, to].map((p) => p.clone().applyMatrix4(camera.matrixWorldInverse)), nearest = -1.001 * camera.near;
  if (a.z > nearest && b.z > nearest) return null;
  const ends = [[a, b], [b, a]].map(([p, q]) =>
    (p.z <= nearest ? p : p.clone().lerp(q, (p.z - nearest) / (p.z - q.z))).applyMatrix4(camera.projectionMatrix));
  return ends.map(({x, y}) => ({x: (x + 1) / 2 * canvas.clientWidth, y: (1 - y) / 2 * canvas.clientHeight}));
}

function mark(kind, attributes) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', kind);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  element('marks').append(made);
  return made;
}

/** Distance of two places of the page and its parts along the scene's axes, metres. */
function distance_of(model, from, to) {
  const [a, b] = [from, to].map((p) => model.to_scene(p)), {metres_per_unit} = model.about;
  return {distance: from.distanceTo(to), parts: a.map((x, i) => (b[i] - x) * metres_per_unit)};
}

class Measure {
  constructor(model) {
    this.model = model;
    this.is_on = false;
    this.points = [];
  }

  switch_on(on) {
    this.is_on = on;
    this.points = [];
    this.show();
  }

  /** The first place, the second, and then the first of the next distance. */
  add(point) {
    this.points = this.points.length === 1 ? [this.points[0], point.clone()] : [point.clone()];
    this.show();
  }

  show() {
    const panel = element('distance');
    panel.hidden = !this.is_on;
    panel.replaceChildren();
    for (const key of Object.keys(panel.dataset)) delete panel.dataset[key];
    if (this.points.length < 2) {
      panel.textContent = text(this.points.length === 0 ? 'from_here' : 'to_there');
      return;
    }
    const {distance, parts} = distance_of(this.model, ...this.points), whole = document.createElement('b');
    whole.textContent = length_text(distance);
    panel.append(whole, ...['x', 'y', 'z'].map((axis, i) =>
      `\u2003Δ${axis} ${number_text(parts[i], {maximumFractionDigits: 3, minimumFractionDigits: 3})}`), ' m');
    Object.assign(panel.dataset, {distance, dx: parts[0], dy: parts[1], dz: parts[2]});
  }

  draw(camera, canvas) {
    const [from, to] = this.points;
    const ends = to && segment_on_canvas(from, to, camera, canvas);
    if (ends) {
      const [a, b] = ends;
      for (const kind of ['shade', 'line']) mark('line', {class: kind, x1: a.x, y1: a.y, x2: b.x, y2: b.y});
      mark('text', {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 - 8}).textContent = length_text(from.distanceTo(to));
    }
    for (const point of this.points) {
      const at = on_canvas(point, camera, canvas);
      if (at) mark('circle', {cx: at.x, cy: at.y, r: 5});
    }
  }
}

/** Where the eye stands in the plan, and which way it looks. */
function draw_eye(eye, camera, canvas) {
  const at = on_canvas(eye.position.clone().setY(0), camera, canvas);
  const yaw = new Library.Euler().setFromQuaternion(eye.quaternion, 'YXZ').y;
  if (at) mark('path', {class: 'eye', d: 'M0 -13 L9 10 L0 5 L-9 10 Z', transform: `translate(${at.x} ${at.y}) rotate(${-yaw * 180 / Math.PI})`});
}
