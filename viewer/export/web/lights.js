// Light channels: a switch, a slider and a colour for each. Settings mean what those of 'lightwell relight' do.

const most_open_at_first = 8;  // channels; of more, or on a small screen, the panel starts closed

// IEC 61966-2-1.
function srgb_decode(v) { return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; }
function srgb_encode(x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055; }

function linear_of(hex) { return [1, 3, 5].map((i) => srgb_decode(parseInt(hex.slice(i, i + 2), 16) / 255)); }

/** The brightest '#rrggbb' of that hue and saturation. */
function hex_of(rgb) {
  const largest = Math.max(...rgb);
  return '#' + rgb.map((x) => Math.round(255 * srgb_encode(x / largest)).toString(16).padStart(2, '0')).join('');
}

/**
 * The setting of one channel: its basis' weight is factor times tint, or 0 while it is off. The factor is that of the
 * luminous flux, 1 being the light as it was solved; a tint keeps the flux.
 */
class Channel {
  /** `lumens`: flux of red, green and blue; of a channel that takes no colour, one number. */
  constructor(basis, lumens) {
    this.basis = basis;
    this.lumens = lumens;
    this.factor = 1;
    this.tint = [1, 1, 1];
    this.take(basis.weight);
  }

  /** Follows a weight. A channel that is off keeps factor and tint. */
  take(weight) {
    this.basis.weight = weight;
    this.on = weight.some((w) => w > 0);
    if (!this.on) return;
    this.factor = this.flux(weight) / this.flux([1, 1, 1]) || Math.max(...weight);
    this.tint = weight.map((w) => w / this.factor);
  }

  get takes_colour() { return this.lumens.length === 3; }
  flux(weight) { return this.lumens.reduce((sum, lm, k) => sum + lm * weight[k], 0); }

  /** s_k = factor c_k sum Y_j Phi_j / sum Y_j c_j Phi_j. False where the light has nothing of that colour. */
  set_colour(rgb) {
    const before = this.flux([1, 1, 1]), after = this.flux(rgb);
    if (!(after > 1e-6 * before * Math.max(...rgb))) return false;
    this.tint = rgb.map((c) => c * before / after);
    return true;
  }

  apply() { this.basis.weight = this.tint.map((t) => (this.on ? this.factor * t : 0)); }
}

/** The panel. Calls `changed` when a weight has, before that `by_hand` if a control changed it. */
class Lights {
  constructor(model, changed) {
    this.changed = changed;
    this.by_hand = () => {};
    this.panel = element('lights');
    const described = model.about.bases;
    this.channels = model.bases.flatMap((basis, i) =>
      (described[i].weight ? [new Channel(basis, described[i].lumens)] : []));
    if (this.channels.length === 0) return;
    element('open-lights').hidden = false;
    for (const channel of this.channels) this.add_row(channel);
    const is_short = this.channels.length <= most_open_at_first || model.about.cues;
    const opens = is_short && !small_screen.matches;
    if (opens) toggle_panel('lights', true);
  }

  weights() { return this.channels.map((channel) => channel.basis.weight); }

  /** Follows the weights of all channels. */
  take(weights) {
    this.channels.forEach((channel, c) => {
      channel.take(weights[c]);
      channel.show();
      channel.show_colour();
    });
    this.changed();
  }

  toggle() { return this.channels.length > 0 && toggle_panel('lights'); }

  add_row(channel) {
    const input = (type, title) => {
      const made = document.createElement('input');
      made.type = made.className = type;
      Object.assign(made.dataset, {title, of: channel.basis.name});
      return made;
    };
    const name = document.createElement('span'), percent = document.createElement('output');
    name.textContent = name.title = channel.basis.name;
    const power = input('checkbox', 'on_off');
    const slider = Object.assign(input('range', 'brightness'), {className: 'slider',
      min: 0, max: Math.max(200, Math.ceil(100 * channel.factor)), step: 1});
    const colour = channel.takes_colour ? input('color', 'colour') : document.createElement('i');
    if (channel.takes_colour) colour.className = 'colour';
    channel.show = () => {
      power.checked = channel.on;
      slider.max = Math.max(slider.max, Math.ceil(100 * channel.factor));
      slider.value = 100 * channel.factor;
      percent.value = `${number_text(100 * channel.factor, {maximumSignificantDigits: 3})} %`;
      for (const part of [name, slider, percent]) part.classList.toggle('off', !channel.on);
    };
    const change = (values) => {
      this.by_hand();
      Object.assign(channel, values);
      channel.apply();
      channel.show();
      this.changed();
    };
    power.addEventListener('input', () => change({on: power.checked}));
    slider.addEventListener('input', () => change({factor: slider.valueAsNumber / 100, on: true}));
    slider.addEventListener('dblclick', () => change({factor: 1, on: true}));
    channel.show_colour = () => { colour.value = hex_of(channel.tint); };
    colour.addEventListener('input', () => {
      if (channel.set_colour(linear_of(colour.value))) change({on: true});
    });
    colour.addEventListener('change', channel.show_colour);  // not while it is being chosen
    const row = document.createElement('div'), target = document.createElement('label');  // larger than the box, for thumbs
    target.className = 'power';
    target.append(power);
    row.className = 'channel';
    row.append(target, name, slider, percent, colour);
    element('channels').append(row);
    channel.show();
    channel.show_colour();
  }
}
