// The page: what buttons, keys, mouse and fingers do.

function element(id) { return document.getElementById(id); }

/** What false colours can show, and its unit; buttons have these names. */
const measures = {illuminance: 'lx', luminance: 'cd/m²'};
/** Ways to look; buttons have these names. */
const modes = ['walk', 'orbit', 'plan'];
/** A picture taller than this, in degrees, would look warped: on a narrow screen its sides are cut instead. */
const tallest_view = 84;
const wheel_step = 1.0015;  // for each pixel that a wheel scrolls
const rest_time = 160;  // ms without motion, before isolux lines get their labels

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
    this.plan = new Plan(model, (origin, way) => this.walker.first_hit(origin, way, Infinity));
    this.measure = new Measure(model);
    this.white = new WhiteBalance(about.white, () => this.meter_white());
    this.metered = 1;
    this.light_colour = null;
    this.pointer = null;
    this.pinned = null;
    this.outlined = false;
    this.levels = [];
    this.ranges = {};
    for (const measure of Object.keys(measures)) this.reset_range(measure);
    this.lights = new Lights(model, () => { this.light_due = true; });
    if (about.year) this.set_up_year();
    this.cues = new Cues(model, this.lights);
    set_up_panels();
    set_up_stick(this.walker);
    watch_devices();
    this.set_up_choices();
    this.set_up_buttons();
    this.set_up_keys();
    this.set_up_gestures();
    this.set_mode('walk');
    this.resize();
    this.go_to(0);
    this.meter_moment(0);
    this.set_false_colors(null);
    this.say_all();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.time = performance.now();
    this.frame = this.frame.bind(this);
    requestAnimationFrame(this.frame);
  }

  /** All words, in the language of the moment. */
  say_all() {
    const {about} = this.model;
    show_texts();
    element('heading').textContent = document.title;
    element('origin').textContent =
      text('computed', {version: about.version, file: about.scene_file, count: about.element_count}) +
      (about.relative_units ? ` ${text('relative_units')}` : '');
    fill_help(element('finger-help'), finger_help);
    fill_help(element('key-help'), key_help);
    this.measure.show();
    this.year_panel?.say();
    if (about.year) {
      const {place, hours: {count}, terms, error} = about.year;
      element('origin').textContent += ` ${text('light_of_year', {place, hours: count, terms, error: digits(100 * error)})}`;
    }
    this.apply_exposure();
    this.show_range();
  }

  /** A year of daylight, of which the page shows an instant at a time. */
  set_up_year() {
    document.body.classList.add('with-year');
    const year = new Year(this.model);
    this.year_panel = new YearPanel(year, (light) => {
      this.model.moment = {year, light, sun_on: (face, point) => this.picture.sunlight.at(this.tree, face, point)};
      this.picture.set_moment(year, light);
      this.due = this.probe_due = this.meter_due = true;
    });
  }

  /** Exposes for the instant, more slowly while days pass. */
  meter_moment(now) {
    if (!this.year_panel?.is_automatic || now - this.metered_at < metering_pause) return;
    this.meter_due = false;
    this.metered_at = now;
    this.picture.camera.updateMatrixWorld();
    const light = this.picture.meter();
    if (!light) return;
    this.metered *= (light.exposure / this.metered) ** (this.year_panel.plays ? 0.5 : 1);
    this.apply_exposure();
  }

  set_up_choices() {
    element('licenses-text').textContent = element('licenses').textContent;
    this.model.about.cameras.forEach((camera, i) => {
      element('cameras').append(new Option(`${i < 9 ? `${i + 1} ` : ''}${camera.name}`, i));
    });
    for (const [code, {language: name}] of Object.entries(texts)) element('language').append(new Option(name, code));
    element('language').value = language;
    const choose = (id, act) => element(id).addEventListener('change', (event) => act(event.target.value));
    choose('cameras', (value) => {
      this.go_to(Number(value));
      this.canvas.focus();
    });
    choose('language', (value) => {
      language = value;
      this.say_all();
    });
    choose('levels', () => this.set_isolux(true));
    choose('low', () => this.take_range());
    choose('high', () => this.take_range());
    choose('range-scale', () => this.take_range());
  }

  set_up_buttons() {
    const click = (id, act) => element(id).addEventListener('click', (event) => {
      act();
      if (event.detail > 0) this.canvas.focus();  // after a click, not Enter: Space is to raise the eye, not to press again
    });
    for (const mode of modes) click(mode, () => this.set_mode(mode));
    click('auto', () => this.expose());
    for (const measure of Object.keys(measures)) click(measure, () => this.switch_false_colors(measure));
    click('isolux', () => this.set_isolux(this.levels.length === 0));
    click('measure', () => this.set_measuring(!this.measure.is_on));
    click('reset', () => {
      this.reset_range(this.range_shown());
      this.show_range();
    });
    click('outlines', () => this.set_outlines(!this.outlined));
    click('look-through', () => this.look_through(!this.picture.looks_through));
    click('lock', () => this.lock());
    // Keys walk again after the mouse has moved a slider.
    for (const panel of ['lights', 'adjust', 'year']) {
      element(panel).addEventListener('pointerup', ({target}) => {
        if (target.type === 'range' || target.type === 'checkbox') this.canvas.focus();
      });
    }
    element('exposure').addEventListener('input', () => this.apply_exposure());
  }

  set_up_keys() {
    window.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || is_for_control(event)) return;
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
      case 'i': return this.set_isolux(this.levels.length === 0);
      case 'g': return this.set_measuring(!this.measure.is_on);
      case 't': return this.lights.toggle();
      case '.': return this.cues.go();
      case ',': return this.cues.back();
      case ';': return this.cues.play();
      case 'b': return toggle_panel('adjust');
      case 'm': return this.set_outlines(!this.outlined);
      case 'x': return this.look_through(!this.picture.looks_through);
      case 'o': return this.set_mode(this.mode === 'orbit' ? 'walk' : 'orbit');
      case 'p': return this.set_mode(this.mode === 'plan' ? 'walk' : 'plan');
      case 'l': return this.lock();
      case 'r': return this.go_to(0);
      case 'h': case '?': return toggle_panel('help');
      case 'Escape': return this.escape();
    }
    if (code in ways && this.mode !== 'walk') this.set_mode('walk');
    return this.walker.press(code);
  }

  escape() {
    for (const name of ['help', 'adjust']) toggle_panel(name, false);
    this.set_measuring(false);
    return this.pin(null);
  }

  set_up_gestures() {
    const {canvas, camera, walker} = this;
    let depth = 1;  // of what is between two fingers
    const angle = () => camera.fov * Math.PI / 180 / canvas.clientHeight;
    const height_at = (depth) => camera.span || 2 * depth * Math.tan(camera.fov * Math.PI / 360);
    watch_gestures(canvas, {
      captures: () => !this.locked.isLocked,
      hover: (place) => {
        this.pointer = place;
        this.probe_due = true;
      },
      drag: (dx, dy) => {
        if (this.locked.isLocked) return;
        // What was under the pointer stays under it.
        if (this.mode === 'walk') walker.look(dx * angle(), dy * angle());
        if (this.mode === 'plan') this.plan.shift(dx, dy, canvas.clientHeight);
        this.due = true;
      },
      pair: ({x, y}) => { depth = this.depth_at(x, y); },
      pinch: ({dx, dy, ratio, x, y}) => {
        if (this.mode === 'plan') {
          this.plan.shift(dx, dy, canvas.clientHeight);
          this.plan.zoom(ratio, x, y, canvas);
        }
        if (this.mode === 'walk') {
          const step = height_at(depth) / canvas.clientHeight;
          walker.shift(new Library.Vector3(-dx * step, dy * step, -depth * (1 - 1 / ratio)).applyQuaternion(camera.quaternion));
          depth /= ratio;
        }
        this.due = true;
      },
      tap: (place) => this.tap(place),
      double_tap: (place) => this.walk_to(place),
    });
    canvas.addEventListener('wheel', (event) => this.turn_wheel(event), {passive: false});
    this.orbit.addEventListener('change', () => { this.due = true; });
    this.locked.addEventListener('change', () => { this.due = true; });
    for (const [name, on] of [['lock', true], ['unlock', false]]) {
      this.locked.addEventListener(name, () => {
        element('crosshair').hidden = !on;
        this.probe_due = true;
      });
    }
  }

  turn_wheel(event) {
    if (this.mode === 'orbit') return;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : 1), ratio = wheel_step ** -pixels;
    const {clientX: x, clientY: y} = event;
    if (this.mode === 'plan') this.plan.zoom(ratio, x, y, this.canvas);
    else this.walker.shift(this.ray_through(this.place_of({x, y})).direction.multiplyScalar(this.depth_at(x, y) * (1 - 1 / ratio)));
    this.due = true;
  }

  /** A reading, or a place to measure from; on the mark of a reading: lets it go. */
  tap({x, y, type}) {
    const hit = this.hit_at(this.locked.isLocked ? {x: 0, y: 0} : this.place_of({x, y}));
    if (this.measure.is_on) {
      if (hit) this.measure.add(hit.point);
      return this.due = true;
    }
    const at = this.pinned && on_canvas(this.pinned.point, this.picture.camera, this.canvas);
    const on_mark = type === 'touch' && at && Math.hypot(at.x - x, at.y - y) < 22;
    return this.pin(on_mark ? null : hit);
  }

  walk_to(place) {
    if (this.measure.is_on) return this.tap(place);
    const hit = this.hit_at(this.place_of(place));
    if (!hit) return false;
    this.pin(null);
    if (this.mode === 'plan') return this.stand_at(hit.point);
    this.set_mode('walk');
    this.walker.go_to(hit.point);
    if (matchMedia('(prefers-reduced-motion: reduce)').matches) this.walker.arrive();
    return this.due = true;
  }

  /** From the plan: the eye stands on the plan's floor at that point, not on a table, and looks level. */
  stand_at(point) {
    const {camera, walker} = this, yaw = new Library.Euler().setFromQuaternion(camera.quaternion, 'YXZ').y;
    camera.position.set(point.x, this.plan.floor + walker.normal_eye_height, point.z);
    camera.quaternion.setFromEuler(new Library.Euler(0, yaw, 0, 'YXZ'));
    return this.set_mode('walk');
  }

  lock() {
    this.set_mode('walk');
    this.locked.lock();
    return true;
  }

  go_to(number) {
    const bookmark = this.model.about.cameras[number];
    if (!bookmark) return false;
    this.set_mode('walk');
    const back = new Library.Vector3(...bookmark.direction).negate(), up = new Library.Vector3(...bookmark.up);
    const axes = new Library.Matrix4().makeBasis(up.clone().cross(back), up, back);
    this.camera.quaternion.setFromRotationMatrix(axes);
    this.camera.position.set(...bookmark.position);
    this.bookmark = bookmark;
    this.metered = bookmark.exposure;
    this.meter_due = true;
    element('cameras').value = number;
    element('exposure').value = 0;
    this.walker.place();
    this.camera.aspect = bookmark.aspect;  // the white is that of the bookmark's picture
    this.fit_view();
    this.meter_white();
    this.resize();
    return this.apply_exposure();
  }

  /** All of the bookmark's picture is seen, and more at the sides, or above and below. */
  fit_view() {
    const half_width = Math.tan(this.bookmark.fov_degrees * Math.PI / 360);
    const narrower = Math.min(this.camera.aspect, this.bookmark.aspect);
    const own = Math.atan(half_width / this.bookmark.aspect) * 360 / Math.PI;
    this.camera.fov = Math.min(Math.atan(half_width / narrower) * 360 / Math.PI, Math.max(own, tallest_view));
    this.camera.span = (this.bookmark.view_width ?? 0) / narrower;
    this.picture.cut = this.bookmark.near;
    this.camera.updateProjectionMatrix();
    this.due = true;
  }

  resize() {
    const {clientWidth, clientHeight} = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.picture.resize(clientWidth, clientHeight);
    if (this.bookmark) this.fit_view();
    this.plan.camera.aspect = clientWidth / clientHeight;
    this.plan.camera.updateProjectionMatrix();
    this.due = true;
  }

  expose() {
    this.mix_light();
    this.picture.camera.updateMatrixWorld();
    const light = this.picture.meter();
    this.metered = light?.exposure ?? this.metered;
    this.light_colour = light?.colour ?? this.light_colour;
    element('exposure').value = 0;
    return this.apply_exposure();
  }

  change_exposure(stops) {
    element('exposure').valueAsNumber += stops;
    return this.apply_exposure();
  }

  apply_exposure() {
    const stops = element('exposure').valueAsNumber, size = {minimumFractionDigits: 1, maximumFractionDigits: 1};
    element('stops').value = `${stops < 0 ? '−' : '+'}${number_text(Math.abs(stops), size)} ${text('stops')}`;
    this.picture.set_scale(this.metered * 2 ** stops, this.white.gains(this.light_colour));
    return this.due = true;
  }

  /** Automatic white is that of the light on what is seen now. */
  meter_white() {
    this.mix_light();
    this.picture.camera.updateMatrixWorld();
    if (this.white.is_automatic) this.light_colour = this.picture.meter()?.colour ?? this.light_colour;
    return this.apply_exposure();
  }

  switch_false_colors(measure) { return this.set_false_colors(this.false_colors === measure ? null : measure); }

  /** Of a measure; null: light. */
  set_false_colors(measure) {
    this.false_colors = measure;
    for (const name of Object.keys(measures)) element(name).setAttribute('aria-pressed', measure === name);
    element('legend').hidden = measure === null;
    return this.show_range();
  }

  range_shown() { return this.false_colors ?? 'illuminance'; }
  unit_of(measure) { return this.model.about.relative_units ? text('relative') : measures[measure]; }

  reset_range(measure) {
    const {low, high} = this.model.about.false_colors[measure];
    this.ranges[measure] = {low, high, logarithmic: low > 0};
  }

  /** Takes the range that has been typed, if it is one. A logarithmic scale from 0 starts three decades below its end. */
  take_range() {
    const logarithmic = element('range-scale').value === 'logarithmic', high = element('high').valueAsNumber;
    const typed = element('low').valueAsNumber, low = logarithmic && !(typed > 0) ? high / 1000 : typed;
    if (is_sound({low, high, logarithmic})) this.ranges[this.range_shown()] = {low, high, logarithmic};
    this.show_range();
  }

  show_range() {
    const measure = this.range_shown(), range = this.ranges[measure];
    element('low').value = Number(range.low.toPrecision(4));
    element('high').value = Number(range.high.toPrecision(4));
    element('range-scale').value = range.logarithmic ? 'logarithmic' : 'linear';
    element('range-unit').textContent = this.unit_of(measure);
    this.picture.set_false_colors(this.false_colors, range);
    const levels = measure === 'illuminance' ? this.levels : [];
    draw_legend(this.model.about.false_colors.palette, range, this.unit_of(measure), levels);
    return this.due = true;
  }

  set_isolux(on) {
    const {high} = this.model.about.false_colors.illuminance;
    this.levels = on ? isolux_levels(element('levels').value, high) : [];
    this.picture.set_isolux(this.levels);
    element('isolux').setAttribute('aria-pressed', on);
    return this.show_range();
  }

  set_measuring(on) {
    this.measure.switch_on(on);
    this.pin(null);
    element('measure').setAttribute('aria-pressed', on);
    return this.due = true;
  }

  set_outlines(on) {
    this.outlined = on;
    this.picture.show_outlines(on);
    element('outlines').setAttribute('aria-pressed', on);
    return this.due = true;
  }

  look_through(on) {
    this.picture.look_through(on);
    element('look-through').setAttribute('aria-pressed', on);
    return this.due = this.probe_due = true;
  }

  set_mode(mode) {
    for (const name of modes) element(name).setAttribute('aria-pressed', name === mode);
    document.body.dataset.mode = mode;
    element('ruler').hidden = mode !== 'plan';
    if (mode === this.mode) return true;
    if (this.mode === 'orbit') this.orbit.disconnect();
    this.mode = mode;
    this.walker.place();
    this.canvas.style.touchAction = 'none';
    this.picture.camera = mode === 'plan' ? this.plan.camera : this.camera;
    this.picture.show_sky(mode !== 'plan');
    if (mode === 'orbit') {
      // Around what is looked at, if that is near enough to be part of the room.
      const hit = this.hit_at({x: 0, y: 0}), size = new Library.Vector3(...this.model.about.size);
      this.orbit.target.copy(hit ? hit.point : size.multiplyScalar(0.5));
      this.orbit.connect(this.canvas);
      this.orbit.update();
    }
    if (mode === 'plan') this.plan.open(this.camera.position, this.canvas, element('bar').getBoundingClientRect().bottom);
    return this.look_through(mode !== 'walk');
  }

  /** A place of the canvas in [-1,1], y upwards. */
  place_of({x, y}) {
    const {clientWidth, clientHeight} = this.canvas;
    return {x: 2 * x / clientWidth - 1, y: 1 - 2 * y / clientHeight};
  }

  /** Where the reading is taken: the pointer, or the middle while it is locked. */
  pointer_place() {
    if (this.locked.isLocked) return {x: 0, y: 0};
    return this.pointer && this.place_of(this.pointer);
  }

  ray_through(place) {
    const {camera} = this.picture;
    camera.updateMatrixWorld();
    const beyond = new Library.Vector3(place.x, place.y, 0.5).unproject(camera);
    const from = camera.span > 0 ? new Library.Vector3(place.x, place.y, -1).unproject(camera) : camera.position.clone();
    return new Library.Ray(from, beyond.sub(from).normalize());
  }

  hit_at(place) {
    return place && pick(this.model, this.tree, this.ray_through(place), this.picture.looks_through);
  }

  /** How far what is seen there is, metres. */
  depth_at(x, y) {
    const hit = this.hit_at(this.place_of({x, y}));
    return hit ? hit.point.distanceTo(this.picture.camera.position) : 0.5 * Math.hypot(...this.model.about.size);
  }

  /** Keeps a reading on show; null lets it go. */
  pin(hit) {
    this.pinned = hit;
    return this.due = this.probe_due = true;
  }

  draw_marks() {
    const {canvas, picture: {camera}} = this;
    camera.updateMatrixWorld();
    const at = this.pinned && on_canvas(this.pinned.point, camera, canvas);
    element('pin').hidden = !at;
    if (at) Object.assign(element('pin').style, {left: `${at.x}px`, top: `${at.y}px`});
    element('marks').replaceChildren();
    this.measure.draw(camera, canvas);
    if (this.mode !== 'plan') return;
    draw_eye(this.camera, camera, canvas);
    draw_ruler(this.plan, canvas.clientHeight);
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
    const passed = Math.max(0, (now - this.time) / 1000), seconds = Math.min(0.1, passed);
    this.time = now;
    this.cues.advance(passed);
    this.year_panel?.advance(seconds);
    if (this.meter_due) this.meter_moment(now);
    if (this.mode === 'walk' && this.walker.advance(seconds)) this.due = true;
    this.mix_light();
    if (this.due || this.probe_due) {
      const hit = this.measure.is_on ? null : this.pinned ?? this.hit_at(this.pointer_place());
      show_reading(this.model, hit, element('probe'));
      this.probe_due = false;
    }
    if (this.due) this.draw(now);
    else if (this.labels_due && now - this.drawn > rest_time) this.label();
    requestAnimationFrame(this.frame);
  }

  draw(now) {
    this.due = false;
    this.drawn = now;
    this.labels_due = true;
    element('labels').replaceChildren();
    this.picture.draw();
    this.draw_marks();
  }

  label() {
    this.labels_due = false;
    label_isolux(this.picture, this.levels, this.canvas);
  }
}

function begin() {
  const message = element('message');
  const say = (words) => {
    message.textContent = words;
    message.hidden = false;
  };
  show_texts();
  if (!document.createElement('canvas').getContext('webgl2')) return say(text('no_webgl'));
  say(text('unpacking'));
  window.addEventListener('error', (event) => say(text('failed', {what: event.message})));
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
