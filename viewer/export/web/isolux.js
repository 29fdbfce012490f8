// Isolux lines: the fragments of picture.js draw them; here are their levels, and the labels beside them.

/** What the shader has room for. */
const most_levels = 24;

/** lx. 1-2-5 levels go down six decades from `high`, which is near the brightest. */
function isolux_levels(kind, high) {
  if (kind === 'work') return [100, 200, 300, 500, 750];
  const top = Math.floor(Math.log10(high)) + 1, levels = [];
  for (let power = top - 6; power <= top; ++power) levels.push(...[1, 2, 5].map((factor) => factor * 10 ** power));
  return levels;
}

/**
 * Places at which the illuminance crosses a level between neighbours of a coarse picture: {x, y, level}, x and y in
 * [0,1] from the lower left. Neighbours of different surfaces, whose illuminance jumps, have none.
 */
function crossings({E, width, height}, levels) {
  const found = [], largest_step = 1.6;
  const look = (x, y, dx, dy) => {
    const a = E[y * width + x], b = E[(y + dy) * width + x + dx];
    if (!(a > 0 && b > 0) || Math.max(a / b, b / a) > largest_step) return;
    const level = levels.find((l) => (a < l) !== (b < l));
    if (level === undefined) return;
    const t = (level - a) / (b - a);
    found.push({x: (x + 0.5 + t * dx) / width, y: (y + 0.5 + t * dy) / height, level});
  };
  for (let y = 0; y < height - 1; ++y) {
    for (let x = 0; x < width - 1; ++x) {
      look(x, y, 1, 0);
      look(x, y, 0, 1);
    }
  }
  return found;
}

/** A few of the crossings of each level, `apart` pixels or more from each other and the edges. */
function chosen_labels(found, {width, height, apart}) {
  const chosen = [], of_level = new Map(), most_of_level = 3;
  const middle = ({x, y}) => Math.hypot((x - 0.5) * width, (y - 0.5) * height);
  for (const place of [...found].sort((a, b) => middle(a) - middle(b))) {
    const x = place.x * width, y = (1 - place.y) * height, count = of_level.get(place.level) ?? 0;
    if (count === most_of_level || Math.min(x, y, width - x, height - y) < 0.5 * apart) continue;
    if (chosen.some((other) => Math.hypot(other.x - x, other.y - y) < apart)) continue;
    of_level.set(place.level, count + 1);
    chosen.push({x, y, level: place.level});
  }
  return chosen;
}

/** Labels of what is seen now; without levels none. */
function label_isolux(picture, levels, {clientWidth: width, clientHeight: height}) {
  const labels = element('labels');
  labels.replaceChildren();
  const seen = levels.length > 0 && picture.measure_illuminance(160);
  if (!seen) return;
  const covered = [...document.querySelectorAll('.panel:not([hidden])')].map((panel) => panel.getBoundingClientRect());
  const is_free = ({x, y}) => covered.every((box) => x < box.left - 24 || x > box.right + 24 || y < box.top - 12 || y > box.bottom + 12);
  const found = crossings(seen, levels).filter((at) => is_free({x: at.x * width, y: (1 - at.y) * height}));
  for (const {x, y, level} of chosen_labels(found, {width, height, apart: 84})) {
    const label = document.createElement('span');
    label.textContent = number_text(level, {maximumSignificantDigits: 3});
    label.style.left = `${x}px`;
    label.style.top = `${y}px`;
    labels.append(label);
  }
}
