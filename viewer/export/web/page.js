// The page: what buttons, keys and the mouse do.

const element = (id) => document.getElementById(id);

/** What false colours can show, and its unit; buttons have these names. */
const measures = {illuminance: 'lx', luminance: 'cd/m²'};

class Page {
  constructor(model) {
    const {about} = model;
    this.model = model;
    this.canvas = element('view');
    this.picture = new Picture(model, this.canvas);
    this.picture.picture_came = () => { this.due = true; };
    this.camera = this.picture.camera;
    const geometry = new Library.BufferGeometry();
    geometry.setAttribute('position', this.picture.geometry.attributes.position);
    geometry.setIndex(this.picture.geometry.index);
    // Indirect: the triangles that are drawn stay in their order.
    this.tree = new Library.MeshBVH(geometry, {indirect: true});
    this.walker = new Walker(this.camera, this.tree, about.size);
    this.locked = new Library.PointerLockControls(this.camera, this.canvas);
    this.orbit = new Library.OrbitControls(this.camera, null);
    this.metered = 1;
    this.pointer = null;
    this.pinned = null;
    this.outlined = false;
    this.lights = new Lights(model, () => { this.light_due = true; });
    this.set_up_text();
    this.set_up_buttons();
    this.set_up_keys();
    this.set_up_mouse();
    this.resize();
    this.go_to(0);
    this.set_false_colors(null);
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.time = performance.now();
    this.frame = this.frame.bind(this);
    requestAnimationFrame(this.frame);
  }

  set_up_text() {
    const {about} = this.model;
    element('heading').textContent = document.title;
    element('origin').textContent =
      `Computed with Lightwell ${about.version} from ${about.scene_file}: ${about.element_count} elements.` +
      (about.relative_units ? ' Its light is in no known unit; figures are relative.' : '');
    element('licenses-text').textContent = element('licenses').textContent;
    about.cameras.forEach((camera, i) => {
      element('cameras').append(new Option(`${i < 9 ? `${i + 1} ` : ''}${camera.name}`, i));
    });
  }

  set_up_buttons() {
    const click = (id, act) => element(id).addEventListener('click', () => {
      act();
      this.canvas.focus();  // so that Space does not press the button again
    });
    click('mode', () => this.set_orbit(!this.orbit.enabled_here));
    click('auto', () => this.expose());
    for (const measure of Object.keys(measures)) click(measure, () => this.switch_false_colors(measure));
    click('lock', () => this.lock());
    click('ask', () => this.toggle_help());
    // Keys walk again after the mouse has moved a slider.
    element('lights').addEventListener('pointerup', (event) => {
      if (event.target.type !== 'color') this.canvas.focus();
    });
    element('exposure').addEventListener('input', () => this.apply_exposure());
    element('cameras').addEventListener('change', (event) => {
      this.go_to(Number(event.target.value));
      this.canvas.focus();
    });
  }

  set_up_keys() {
    window.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLSelectElement) return;
      if (event.target instanceof HTMLInputElement && event.code.startsWith('Arrow')) return;
      if (this.lights.takes(event)) return;
      if (this.press(event)) event.preventDefault();
    });
    window.addEventListener('keyup', (event) => this.walker.release(event.code));
    window.addEventListener('blur', () => this.walker.release_all());
  }

  press(event) {
    const {key, code} = event;
    if (key >= '1' && key <= '9') return this.go_to(Number(key) - 1);
    switch (key.length === 1 ? key.toLowerCase() : key) {
      case '0': return this.expose();
      case '+': case '=': return this.change_exposure(1 / 3);
      case '-': return this.change_exposure(-1 / 3);
      case 'v': return this.switch_false_colors('illuminance');
      case 'u': return this.switch_false_colors('luminance');
      case 't': return this.lights.toggle();
      case 'm': return this.set_outlines(!this.outlined);
      case 'x': return this.look_through(!this.picture.looks_through);
      case 'o': return this.set_orbit(!this.orbit.enabled_here);
      case 'l': return this.lock();
      case 'r': return this.go_to(0);
      case 'h': case '?': return this.toggle_help();
      case 'Escape': return this.pin(null) && this.toggle_help(false);
    }
    if (code in ways && this.orbit.enabled_here) this.set_orbit(false);
    return this.walker.press(code);
  }

  set_up_mouse() {
    const canvas = this.canvas;
    let down = null;
    canvas.addEventListener('pointerdown', (event) => {
      down = {x: event.clientX, y: event.clientY, moved: false};
      if (!this.locked.isLocked) canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', (event) => {
      this.pointer = {x: event.clientX, y: event.clientY};
      this.probe_due = true;
      if (!down) return;
      const dx = event.clientX - down.x, dy = event.clientY - down.y;
      if (!down.moved && Math.hypot(dx, dy) < 4) return;
      Object.assign(down, {x: event.clientX, y: event.clientY, moved: true});
      if (this.orbit.enabled_here || this.locked.isLocked) return;
      // What was under the pointer stays under it.
      const angle = this.camera.fov * Math.PI / 180 / canvas.clientHeight;
      this.walker.look(dx * angle, dy * angle);
      this.due = true;
    });
    canvas.addEventListener('pointerup', () => {
      if (down && !down.moved) this.pin(this.hit_at(this.pointer_place()));
      down = null;
    });
    canvas.addEventListener('pointerleave', () => {
      this.pointer = null;
      this.probe_due = true;
    });
    this.orbit.enabled_here = false;
    this.orbit.addEventListener('change', () => { this.due = true; });
    this.locked.addEventListener('change', () => { this.due = true; });
    for (const [name, on] of [['lock', true], ['unlock', false]]) {
      this.locked.addEventListener(name, () => {
        element('crosshair').hidden = !on;
        this.probe_due = true;
      });
    }
  }

  lock() {
    this.set_orbit(false);
    this.locked.lock();
    return true;
  }

  toggle_help(on = element('help').hidden) {
    element('help').hidden = !on;
    return true;
  }

  go_to(number) {
    const bookmark = this.model.about.cameras[number];
    if (!bookmark) return false;
    this.set_orbit(false);
    const back = new Library.Vector3(...bookmark.direction).negate(), up = new Library.Vector3(...bookmark.up);
    const axes = new Library.Matrix4().makeBasis(up.clone().cross(back), up, back);
    this.camera.quaternion.setFromRotationMatrix(axes);
    this.camera.position.set(...bookmark.position);
    this.bookmark = bookmark;
    this.metered = bookmark.exposure;
    element('cameras').value = number;
    element('exposure').value = 0;
    this.walker.place();
    this.fit_view();
    return this.apply_exposure();
  }

  /** All of the bookmark's picture is seen, and more at the sides, or above and below. */
  fit_view() {
    const half_width = Math.tan(this.bookmark.fov_degrees * Math.PI / 360);
    const narrower = Math.min(this.camera.aspect, this.bookmark.aspect);
    this.camera.fov = Math.atan(half_width / narrower) * 360 / Math.PI;
    this.camera.updateProjectionMatrix();
    this.due = true;
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.picture.resize(clientWidth, clientHeight);
    if (this.bookmark) this.fit_view();
    this.due = true;
  }

  expose() {
    this.mix_light();
    this.camera.updateMatrixWorld();
    this.metered = this.picture.meter() ?? this.metered;
    element('exposure').value = 0;
    return this.apply_exposure();
  }

  change_exposure(stops) {
    element('exposure').valueAsNumber += stops;
    return this.apply_exposure();
  }

  apply_exposure() {
    const stops = element('exposure').valueAsNumber;
    element('stops').value = `${stops < 0 ? '−' : '+'}${Math.abs(stops).toFixed(1)}`;
    this.picture.set_scale(this.metered * 2 ** stops);
    return this.due = true;
  }

  switch_false_colors(measure) { return this.set_false_colors(this.false_colors === measure ? null : measure); }

  /** Of 'illuminance' or 'luminance'; null: light. */
  set_false_colors(measure) {
    this.false_colors = measure;
    this.picture.set_false_colors(measure);
    for (const each of Object.keys(measures)) element(each).setAttribute('aria-pressed', each === measure);
    element('legend').hidden = measure === null;
    if (measure !== null) draw_legend(this.model.about, measure);
    return this.due = true;
  }

  set_outlines(on) {
    this.outlined = on;
    this.picture.show_outlines(on);
    return this.due = true;
  }

  look_through(on) {
    this.picture.look_through(on);
    return this.due = this.probe_due = true;
  }

  set_orbit(on) {
    if (on === this.orbit.enabled_here) return true;
    this.orbit.enabled_here = on;
    element('mode').textContent = on ? 'Walk' : 'Orbit';
    if (on) {
      // Around what is looked at, if that is near enough to be part of the room.
      const hit = this.hit_at({x: 0, y: 0}), size = new Library.Vector3(...this.model.about.size);
      this.orbit.target.copy(hit ? hit.point : size.multiplyScalar(0.5));
      this.orbit.connect(this.canvas);
      this.orbit.update();
    } else {
      this.orbit.disconnect();
      this.canvas.style.touchAction = 'none';
      this.walker.place();
    }
    return this.look_through(on);
  }

  /** Where the reading is taken: the pointer, or the middle while it is locked; in [-1,1], y upwards. */
  pointer_place() {
    if (this.locked.isLocked) return {x: 0, y: 0};
    if (!this.pointer) return null;
    const {clientWidth, clientHeight} = this.canvas;
    return {x: 2 * this.pointer.x / clientWidth - 1, y: 1 - 2 * this.pointer.y / clientHeight};
  }

  hit_at(place) {
    if (!place) return null;
    this.camera.updateMatrixWorld();
    const beyond = new Library.Vector3(place.x, place.y, 0.5).unproject(this.camera);
    const ray = new Library.Ray(this.camera.position.clone(), beyond.sub(this.camera.position).normalize());
    return pick(this.model, this.tree, ray, this.picture.looks_through);
  }

  /** Keeps a reading on show; null lets it go. */
  pin(hit) {
    this.pinned = hit;
    element('pin').hidden = !hit;
    return this.due = this.probe_due = true;
  }

  place_pin() {
    if (!this.pinned) return;
    const at = this.pinned.point.clone().project(this.camera);
    element('pin').hidden = at.z > 1;
    element('pin').style.left = `${(at.x + 1) / 2 * this.canvas.clientWidth}px`;
    element('pin').style.top = `${(1 - at.y) / 2 * this.canvas.clientHeight}px`;
  }

  /** Brings picture and readings up to date with the lights. */
  mix_light() {
    if (!this.light_due) return;
    this.light_due = false;
    this.model.mix();
    this.picture.light_changed();
    this.due = true;
  }

  frame(now) {
    // A page that was hidden does not leap when it is back.
    const seconds = Math.min(0.1, Math.max(0, (now - this.time) / 1000));
    this.time = now;
    if (!this.orbit.enabled_here && this.walker.advance(seconds)) this.due = true;
    this.mix_light();
    if (this.due || this.probe_due) {
      show_reading(this.model, this.pinned ?? this.hit_at(this.pointer_place()), element('probe'));
      this.place_pin();
      this.probe_due = false;
    }
    if (this.due) {
      this.due = false;
      this.picture.draw();
    }
    requestAnimationFrame(this.frame);
  }
}

function draw_legend(about, measure) {
  const {palette} = about.false_colors, {low, high, steps} = about.false_colors[measure];
  const context = element('scale').getContext('2d');
  for (let i = 0; i < 256; ++i) {
    context.fillStyle = `#${palette.substr(6 * i, 6)}`;
    context.fillRect(0, 255 - i, 1, 1);
  }
  element('unit').textContent = about.relative_units ? 'relative' : measures[measure];
  for (const label of document.querySelectorAll('.step')) label.remove();
  for (const value of steps) {
    const place = low === 0 ? value / high : Math.log(value / low) / Math.log(high / low);
    const label = document.createElement('span');
    label.className = 'step';
    label.textContent = Number(value.toPrecision(4));
    label.style.top = `calc(30px + ${1 - place} * (100% - 44px))`;
    element('legend').append(label);
  }
}

function begin() {
  const message = element('message');
  const fail = (text) => {
    message.textContent = text;
    message.hidden = false;
  };
  if (!document.createElement('canvas').getContext('webgl2')) {
    fail('This browser shows no WebGL 2, which this page draws with. Switch hardware acceleration on, or open the ' +
         'page in a current Firefox, Chromium or Safari.');
    return;
  }
  window.addEventListener('error', (event) => fail(`The page failed: ${event.message}`));
  // After the message is on the screen.
  setTimeout(() => {
    const model = new Model(JSON.parse(element('about').textContent), decode_base64(element('data').textContent));
    element('data').remove();
    window.lightwell = new Page(model);
    message.hidden = true;
    element('view').focus();
  }, 30);
}

begin();
