// White balance: which light shows as grey. The rule of raytrace/display/light_meter.cpp.

const largest_gain = 64;

/** Factors of linear RGB for light of a colour of luminance 1. */
function white_balance(colour) { return colour.map((c) => 1 / Math.max(c, 1 / largest_gain)); }

/** The selector. Calls `changed` after a choice. */
class WhiteBalance {
  constructor({first, black_bodies}, changed) {
    this.black_bodies = black_bodies;
    this.selector = element('white');
    const add = (value, key, label = '') => {
      const option = new Option(label, value);
      if (key) option.dataset.text = key;
      this.selector.append(option);
    };
    add('as-lit', 'as_lit');
    add('auto', 'automatic');
    for (const {kelvin} of black_bodies) add(kelvin, null, `${kelvin} K`);
    this.selector.value = first;
    this.selector.addEventListener('change', changed);
  }

  get is_automatic() { return this.selector.value === 'auto'; }

  /** Factors for the choice. `metered`: colour of the light on what is seen; null: unknown. */
  gains(metered) {
    const body = this.black_bodies.find(({kelvin}) => String(kelvin) === this.selector.value);
    const colour = body ? body.colour : this.is_automatic ? metered : null;
    return colour ? white_balance(colour) : [1, 1, 1];
  }
}
