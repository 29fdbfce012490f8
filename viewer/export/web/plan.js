// The plan: an orthographic view from above, cut below the ceiling.

/** A camera of three.js with a parallel projection `span` metres high, or a perspective where `span` is 0. */
function camera_with_span(span) {
  const camera = new Library.PerspectiveCamera(), set_perspective = camera.updateProjectionMatrix;
  camera.span = span;
  camera.updateProjectionMatrix = function () {
    if (this.span === 0) return set_perspective.call(this);
    const half = this.span / 2;
    this.projectionMatrix.makeOrthographic(-half * this.aspect, half * this.aspect, half, -half, this.near, this.far);
    this.projectionMatrixInverse.copy(this.projectionMatrix).invert();
  };
  return camera;
}

class Plan {
  /** `first_hit(origin, direction)`: of the model. */
  constructor(model, first_hit) {
    this.size = model.about.size;
    this.first_hit = first_hit;
    this.camera = camera_with_span(1);
    this.camera.quaternion.setFromEuler(new Library.Euler(-Math.PI / 2, 0, 0));
  }

  /** Shows all of the model below `top` pixels of the canvas, cut a little below the ceiling over the eye. */
  open(eye, {clientWidth: width, clientHeight: height}, top) {
    const [wide, high, deep] = this.size, cut_share = 0.9, margin = 1.12, aspect = width / height;
    const y_of = (way, otherwise) => this.first_hit(eye, new Library.Vector3(0, way, 0))?.point.y ?? otherwise;
    const floor = y_of(-1, 0), ceiling = y_of(1, high);
    this.floor = floor;
    this.camera.aspect = aspect;
    this.camera.span = margin * Math.max(deep * height / Math.max(0.3 * height, height - top), wide / aspect) || 1;
    const lower = top / 2 * this.metres_per_pixel(height);
    this.camera.position.set(wide / 2, floor + cut_share * (ceiling - floor), deep / 2 - lower);
    this.camera.near = 0;
    this.camera.far = this.camera.position.y + 0.01 * (high || 1);
    this.camera.updateProjectionMatrix();
  }

  metres_per_pixel(height) { return this.camera.span / height; }

  /** What was under the pointer stays under it; pixels. */
  shift(dx, dy, height) {
    const step = this.metres_per_pixel(height);
    this.camera.position.x -= dx * step;
    this.camera.position.z -= dy * step;
  }

  /** Larger by `ratio` around a place of the canvas, in pixels. */
  zoom(ratio, x, y, {clientWidth: width, clientHeight: height}) {
    const before = this.metres_per_pixel(height), longest = 4 * Math.hypot(...this.size), camera = this.camera;
    camera.span = Math.min(longest, Math.max(1e-3 * longest, camera.span / ratio));
    const gain = before - this.metres_per_pixel(height);
    camera.position.x += (x - width / 2) * gain;
    camera.position.z += (y - height / 2) * gain;
    camera.updateProjectionMatrix();
  }
}

/** The length of a scale bar of at most `most` pixels, 1, 2 or 5 times a power of ten: metres. */
function bar_length(metres_per_pixel, most) {
  const longest = most * metres_per_pixel, power = 10 ** Math.floor(Math.log10(longest));
  return [5, 2, 1].find((factor) => factor * power <= longest) * power;
}

/** A length with its unit. */
function length_text(metres) {
  const shown = metres < 0.995 ? [100 * metres, 'cm'] : [metres, 'm'];
  return `${number_text(shown[0], {maximumSignificantDigits: metres < 0.995 ? 3 : 4})} ${shown[1]}`;
}

function draw_ruler(plan, height) {
  const step = plan.metres_per_pixel(height), length = bar_length(step, 120);
  element('ruler').style.width = `${length / step}px`;
  element('ruler').textContent = length_text(length);
}
