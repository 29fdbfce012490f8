// Mouse and fingers on the picture. Every movement counts from where that finger was before, so that nothing jumps
// when a finger is put down or lifted.

const tap_time = 500, double_tap_time = 350;  // ms

/** A finger moves more than a mouse before that is meant. Pixels. */
function slack(type) { return type === 'touch' ? 8 : 4; }

/** Events of scripts have no pointer to capture. */
function capture(target, event) { if (event.isTrusted) target.setPointerCapture(event.pointerId); }

/** The middle of all fingers, and their mean distance from it. */
function spread(fingers) {
  const all = [...fingers.values()], mean = (values) => values.reduce((sum, x) => sum + x, 0) / all.length;
  const x = mean(all.map((f) => f.x)), y = mean(all.map((f) => f.y));
  return {x, y, radius: mean(all.map((f) => Math.hypot(f.x - x, f.y - y)))};
}

/**
 * `does` has what gestures do; pixels of the canvas:
 * hover({x, y}), null: nowhere; drag(dx, dy); pair(x, y): two fingers are down; pinch({dx, dy, ratio, x, y});
 * tap({x, y, type}), double_tap({x, y, type}); captures(): whether drags go on outside of the canvas.
 */
function watch_gestures(canvas, does) {
  const fingers = new Map();
  let press = null, last_tap = null;
  canvas.addEventListener('pointerdown', (event) => {
    const {clientX: x, clientY: y, pointerId, pointerType: type} = event;
    press = fingers.size === 0 ? {x, y, type, time: event.timeStamp, moved: false} : {...press, moved: true};
    fingers.set(pointerId, {x, y});
    if (type === 'touch') does.hover(null);
    if (fingers.size > 1) does.pair(spread(fingers));
    if (does.captures()) capture(canvas, event);
  });
  canvas.addEventListener('pointermove', (event) => {
    const {clientX: x, clientY: y} = event, finger = fingers.get(event.pointerId);
    if (event.pointerType !== 'touch') does.hover({x, y});
    if (!finger || (x === finger.x && y === finger.y)) return;
    if (!press.moved && Math.hypot(x - press.x, y - press.y) < slack(press.type)) return;
    press.moved = true;
    const before = spread(fingers), dx = x - finger.x, dy = y - finger.y;
    Object.assign(finger, {x, y});
    if (fingers.size === 1) return does.drag(dx, dy);
    const after = spread(fingers), ratio = before.radius > 1 && after.radius > 1 ? after.radius / before.radius : 1;
    does.pinch({dx: after.x - before.x, dy: after.y - before.y, ratio, x: after.x, y: after.y});
  });
  const lift = (event) => {
    if (!fingers.delete(event.pointerId) || fingers.size > 0) return;
    const {x, y, type, time, moved} = press, now = event.timeStamp;
    if (moved || event.type === 'pointercancel' || (type === 'touch' && now - time > tap_time)) return;
    const again = last_tap && now - last_tap.time < double_tap_time &&
      Math.hypot(x - last_tap.x, y - last_tap.y) < 4 * slack(type);
    last_tap = again ? null : {x, y, time: now};
    if (again) does.double_tap({x, y, type});
    else does.tap({x, y, type});
  };
  canvas.addEventListener('pointerup', lift);
  canvas.addEventListener('pointercancel', lift);
  canvas.addEventListener('pointerleave', () => does.hover(null));
  // Safari's own zoom.
  for (const kind of ['gesturestart', 'gesturechange']) {
    document.addEventListener(kind, (event) => event.preventDefault(), {passive: false});
  }
}
