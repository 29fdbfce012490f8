// Walking: the eye of a person who stands on floors, climbs steps and does not pass through walls.

const run_factor = 3;
const turning_speed = 1.2;  // rad/s
const response_time = 0.08;  // s, to full speed and back
const going_time = 0.8;  // s, to where a double click said

/** Which way a key goes: forward, right, up, turn. */
const ways = {
  KeyW: [1, 0, 0, 0], ArrowUp: [1, 0, 0, 0], KeyS: [-1, 0, 0, 0], ArrowDown: [-1, 0, 0, 0],
  KeyD: [0, 1, 0, 0], ArrowRight: [0, 1, 0, 0], KeyA: [0, -1, 0, 0], ArrowLeft: [0, -1, 0, 0],
  Space: [0, 0, 1, 0], KeyC: [0, 0, -1, 0], KeyQ: [0, 0, 0, 1], KeyE: [0, 0, 0, -1],
};

class Walker {
  /** `tree`: of all triangles, for floors and walls. */
  constructor(camera, tree, size) {
    this.camera = camera;
    this.tree = tree;
    const diagonal = Math.hypot(...size), narrow = Math.min(size[0] || diagonal, size[2] || diagonal);
    // A person in a room of 2.5 m and more; in a model of one, somebody as small as it.
    this.normal_eye_height = Math.min(1.6, 0.65 * (size[1] || diagonal));
    this.radius = Math.min(0.25, 0.1 * narrow, 0.3 * this.normal_eye_height);
    this.step_height = 0.25 * this.normal_eye_height;
    this.speed = diagonal <= 7 ? 0.2 * diagonal : 1.4 * Math.sqrt(diagonal / 7);
    this.held = new Set();
    this.pushed = {forward: 0, right: 0};
    this.place();
  }

  /** The camera has been put somewhere: it stays there until it walks. */
  place() {
    this.velocity = new Library.Vector3();
    this.turning = 0;
    this.eye_height = this.normal_eye_height;
    this.stands = false;
    this.goal = null;
  }

  /** Takes a key; says whether it was one of its own. */
  press(code) {
    if (!(code in ways) && !code.startsWith('Shift')) return false;
    this.held.add(code);
    if (code in ways) this.goal = null;
    return true;
  }
  release(code) { this.held.delete(code); }
  release_all() { this.held.clear(); }

  /** Walks on by itself, each way in [-1,1] of its speed. */
  push({forward, right}) {
    this.pushed = {forward, right};
    if (forward || right) this.goal = null;
  }

  /** Walks to the place over or under a point, in about a second, at the height over the floor that the eye has. */
  go_to(point) {
    const eye = this.camera.position, floor = this.first_hit(eye, new Library.Vector3(0, -1, 0), Infinity);
    if (!this.stands && floor && floor.distance < 2 * this.normal_eye_height) this.eye_height = floor.distance;
    const goal = new Library.Vector3(point.x, 0, point.z), way = Math.hypot(point.x - eye.x, point.z - eye.z);
    this.goal = {place: goal, speed: Math.max(this.speed, way / going_time), hindered: 0};
    this.stands = true;
  }

  /** The whole way at once, for people whom motion makes ill. */
  arrive() {
    for (let i = 0; i < 300 && this.goal; ++i) this.advance(1 / 30);
  }

  /** Shifts the eye, as far as walls allow; it stays there until it walks. */
  shift(way) {
    const length = way.length();
    if (length === 0) return;
    const direction = way.clone().divideScalar(length), eye = this.camera.position;
    const wall = this.first_hit(eye, direction, length + this.radius);
    eye.addScaledVector(direction, wall ? Math.min(length, Math.max(0, wall.distance - this.radius)) : length);
    this.place();
  }

  /** Turns the eye, rad. */
  look(yaw, pitch) {
    const euler = new Library.Euler().setFromQuaternion(this.camera.quaternion, 'YXZ');
    euler.y += yaw;
    euler.x = Math.min(1.5, Math.max(-1.5, euler.x + pitch));
    this.camera.quaternion.setFromEuler(euler);
  }

  /** Moves on by `seconds`; says whether anything moved. */
  advance(seconds) {
    const sum = [0, 0, 0, 0];
    for (const code of this.held) ways[code]?.forEach((x, i) => { sum[i] += Math.sign(x); });
    const [, , up, turn] = sum.map((x) => Math.sign(x));
    const runs = this.held.has('ShiftLeft') || this.held.has('ShiftRight');
    const speed = this.speed * (runs ? run_factor : 1);

    const blend = 1 - Math.exp(-seconds / response_time);
    this.turning += (turn * turning_speed - this.turning) * blend;
    if (Math.abs(this.turning) > 1e-3 * turning_speed) this.look(this.turning * seconds, 0);
    else this.turning = 0;

    const wanted = this.goal ? this.velocity_to_goal() : this.pushed_velocity(sum, speed);
    this.velocity.lerp(wanted, blend);
    if (this.velocity.length() < 1e-3 * this.speed) this.velocity.set(0, 0, 0);
    if (wanted.lengthSq() > 0 || up) this.stands = true;

    const before = this.camera.position.clone();
    // No stride is longer than half the body is thick, or it could be beyond a wall before that is noticed.
    const strides = Math.max(1, Math.ceil(Math.max(speed, this.velocity.length()) * seconds / (0.5 * this.radius)));
    for (let i = 0; i < strides; ++i) {
      this.stride(this.velocity.clone().multiplyScalar(seconds / strides));
      this.settle(up * speed, seconds / strides);
    }
    if (this.goal) this.watch_progress(before, seconds);
    return this.turning !== 0 || this.goal !== null || before.distanceToSquared(this.camera.position) > 0;
  }

  /** Where keys and the stick push to, level. */
  pushed_velocity([forward, right], speed) {
    const yaw = new Library.Euler().setFromQuaternion(this.camera.quaternion, 'YXZ').y;
    const keys = new Library.Vector3(Math.sign(right), 0, -Math.sign(forward));
    if (keys.lengthSq() > 0) keys.normalize();
    keys.add(new Library.Vector3(this.pushed.right, 0, -this.pushed.forward));
    return keys.clampLength(0, 1).multiplyScalar(speed).applyEuler(new Library.Euler(0, yaw, 0));
  }

  /** Slower the nearer the goal is, so that the eye stops there. */
  velocity_to_goal() {
    const way = this.goal.place.clone().sub(this.camera.position).setY(0);
    return way.clampLength(0, this.goal.speed * 2 * response_time).divideScalar(2 * response_time);
  }

  /** Forgets the goal once it is reached, or a wall has been in the way for a while. */
  watch_progress(before, seconds) {
    const {goal} = this, left = goal.place.clone().sub(this.camera.position).setY(0).length();
    const moved = this.camera.position.clone().sub(before).setY(0).length();
    goal.hindered = moved < 0.05 * goal.speed * seconds ? goal.hindered + seconds : 0;
    if (left < 0.02 * this.radius || goal.hindered > 0.3) {
      this.goal = null;
      this.velocity.set(0, 0, 0);
    }
  }

  /** One stride, level, as far as walls allow. */
  stride(way) {
    if (way.lengthSq() === 0) return;
    const from = this.camera.position.clone(), to = from.clone().add(way);
    this.push_out(to);
    this.push_out(to);  // out of the second wall of a corner
    const covered = to.clone().sub(from), length = covered.length();
    if (length === 0) return;
    const wall = this.first_hit(from, covered.divideScalar(length), length + 0.5 * this.radius);
    if (!wall) this.camera.position.copy(to);
  }

  /** Moves a place level until no wall is within the body's radius. */
  push_out(eye) {
    const {radius} = this, feet = eye.y - this.eye_height;
    const knee = Math.min(eye.y, feet + this.step_height + radius);
    const body = new Library.Line3(eye.clone(), new Library.Vector3(eye.x, knee, eye.z));
    const box = new Library.Box3().setFromPoints([body.start, body.end]).expandByScalar(radius);
    const on_wall = new Library.Vector3(), on_body = new Library.Vector3();
    this.tree.shapecast({
      intersectsBounds: (bounds) => bounds.intersectsBox(box),
      intersectsTriangle: (triangle) => {
        const distance = triangle.closestPointToSegment(body, on_wall, on_body);
        if (!(distance < radius)) return;
        const away = on_body.sub(on_wall).setY(0);
        if (!(away.length() > 0.1 * distance) || away.lengthSq() === 0) return;  // a floor or a ceiling
        away.setLength(radius - distance);
        body.start.add(away);
        body.end.add(away);
        box.translate(away);
      },
    });
    eye.x = body.start.x;
    eye.z = body.start.z;
  }

  /** Up or down to eye height over the floor, as fast as one climbs or falls; where there is none, as asked. */
  settle(rise, seconds) {
    if (!this.stands) return;
    const eye = this.camera.position, floor = this.first_hit(eye, new Library.Vector3(0, -1, 0), Infinity);
    const least = 0.5 * this.radius;
    if (floor) this.eye_height = Math.max(2 * least, this.eye_height + rise * seconds);
    const wanted = floor ? floor.point.y + this.eye_height : eye.y + rise * seconds;
    // A floor is found to a rounding, after which no eye would ever rest.
    if (Math.abs(wanted - eye.y) < 1e-9 * this.normal_eye_height) return;
    const most = 3 * this.speed * seconds;
    let step = Math.min(most, Math.max(-most, wanted - eye.y));
    const ceiling = step > 0 ? this.first_hit(eye, new Library.Vector3(0, 1, 0), step + least) : null;
    if (ceiling) {
      step = Math.max(0, ceiling.distance - least);
      if (floor) this.eye_height = eye.y + step - floor.point.y;
    }
    eye.y += step;
  }

  first_hit(origin, direction, far) {
    return this.tree.raycastFirst(new Library.Ray(origin.clone(), direction), Library.DoubleSide, 0, far);
  }
}
