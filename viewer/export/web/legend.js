// Scales of false colours, and their legend.

/** A range {low, high, logarithmic} is sound if it rises; a logarithmic one starts above 0. */
function is_sound({low, high, logarithmic}) {
  return Number.isFinite(low) && Number.isFinite(high) && low < high && (logarithmic ? low > 0 : low >= 0);
}

/** Where a value stands on the scale: 0 at its low end, 1 at its high end. */
function place_on_scale(value, {low, high, logarithmic}) {
  return logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
}

/** About five even values, each step 1, 2 or 5 times a power of ten. */
function even_steps(low, high) {
  const power = 10 ** Math.floor(Math.log10((high - low) / 5));
  const step = [1, 2, 5, 10].find((factor) => factor * power * 4 >= 0.999 * (high - low)) * power;
  const steps = [];
  for (let i = Math.ceil(0.999 * low / step); i * step <= high + 1e-3 * step; ++i) steps.push(i * step);
  return steps;
}

/** 1, 2 and 5 times the powers of ten in a range; over more than two decades the powers, and its ends. */
function decade_steps(low, high) {
  const steps = [], is_long = high > 100 * low;
  for (let power = 10 ** Math.floor(Math.log10(low)); power <= high; power *= 10) {
    for (const factor of [1, 2, 5]) {
      const value = factor * power, is_end = value <= 1.001 * low || value >= 0.999 * high;
      if (value < 0.999 * low || value > 1.001 * high) continue;
      if (factor === 1 || is_end || !is_long) steps.push(value);
    }
  }
  return steps;
}

/** Draws the scale with labelled values, and lines at `levels`. */
function draw_legend(palette, range, unit, levels) {
  const context = element('scale').getContext('2d');
  for (let i = 0; i < 256; ++i) {
    context.fillStyle = `#${palette.substr(6 * i, 6)}`;
    context.fillRect(0, 255 - i, 1, 1);
  }
  element('unit').textContent = unit;
  for (const label of document.querySelectorAll('.step, .level')) label.remove();
  const add = (kind, value, words) => {
    const label = document.createElement('span');
    label.className = kind;
    label.textContent = words;
    label.style.top = `${100 * (1 - place_on_scale(value, range))}%`;
    element('ramp').append(label);
  };
  const steps = range.logarithmic ? decade_steps(range.low, range.high) : even_steps(range.low, range.high);
  for (const value of steps) add('step', value, number_text(value, {maximumSignificantDigits: 4}));
  for (const value of levels) if (value > range.low && value < range.high) add('level', value, '');
}
