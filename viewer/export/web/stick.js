// The thumb stick: walks as far forward and aside as the knob is pushed.

const still_share = 0.12;  // of the way to the rim: a thumb at rest

/** Pushes forward and right, each in [-1,1], for a thumb at (x, y) from the middle, y downwards, in radii. */
function push_of(x, y) {
  const length = Math.hypot(x, y);
  if (length < still_share) return {forward: 0, right: 0};
  const push = Math.min(1, (length - still_share) / (1 - still_share));
  return {forward: -y / length * push || 0, right: x / length * push || 0};
}

function set_up_stick(walker) {
  const stick = element('stick'), knob = element('knob');
  let held = null;
  const move = (event) => {
    if (event.pointerId !== held) return;
    const box = stick.getBoundingClientRect(), radius = 0.36 * box.width;
    const x = (event.clientX - box.left - box.width / 2) / radius, y = (event.clientY - box.top - box.height / 2) / radius;
    const beyond = Math.max(1, Math.hypot(x, y));
    knob.style.transform = `translate(${x / beyond * radius}px, ${y / beyond * radius}px)`;
    walker.push(push_of(x, y));
  };
  stick.addEventListener('pointerdown', (event) => {
    held = event.pointerId;
    capture(stick, event);
    move(event);
  });
  stick.addEventListener('pointermove', move);
  const release = (event) => {
    if (event.pointerId !== held) return;
    held = null;
    knob.style.transform = '';
    walker.push({forward: 0, right: 0});
  };
  for (const kind of ['pointerup', 'pointercancel', 'lostpointercapture']) stick.addEventListener(kind, release);
}
