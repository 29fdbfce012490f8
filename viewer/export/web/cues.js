// Lighting cues: stepped through, and played with their fades.

class Cues {
  constructor(model, lights) {
    this.cues = model.about.cues ?? [];
    this.lights = lights;
    this.number = -1;  // before the first
    this.fade = null;  // until the end of fade and hold
    this.is_playing = false;
    if (this.cues.length === 0) return;
    lights.by_hand = () => this.stop();
    element('cue-row').hidden = false;
    const list = element('cues');
    list.append(Object.assign(new Option('–', -1), {hidden: true}));
    this.cues.forEach(({name}, i) => list.append(new Option(name, i)));
    list.addEventListener('change', () => this.begin(Number(list.value)));
    for (const [id, act] of [['cue-back', 'back'], ['cue-go', 'go'], ['cue-play', 'play']]) {
      element(id).addEventListener('click', () => this[act]());
    }
    this.show();
  }

  get is_last() { return this.number + 1 >= this.cues.length; }

  /** Begins the fade to a cue, from the light of the moment. */
  begin(number, from = this.lights.weights()) {
    const {weights: to, wait, fade_up, fade_down} = this.cues[number];
    const duration = to.map((weight, c) => {
      const before = this.lights.channels[c].flux(from[c]), after = this.lights.channels[c].flux(weight);
      return after < (1 - 1e-6) * before ? fade_down : fade_up;  // a colour keeps the flux but for rounding
    });
    const changes = to.map((weight, c) => weight.some((w, k) => w !== from[c][k]));
    const end = Math.max(wait, ...duration.map((d, c) => (changes[c] ? wait + d : 0)));
    this.number = number;
    this.fade = {from, to, wait, duration, end, seconds: 0, has_arrived: false};
    this.show();
    return true;
  }

  go() { return this.cues.length > 0 && (this.is_last || this.begin(this.number + 1)); }

  /** The previous cue, at once. */
  back() {
    if (this.number < 1) return this.cues.length > 0;
    this.is_playing = false;
    this.begin(this.number - 1, this.cues[this.number - 1].weights);
    this.fade.seconds = this.fade.end;  // without its wait
    return true;
  }

  /** Plays from the next cue on, after the last from the first; or stops, which lets a fade end. */
  play() {
    if (this.cues.length === 0) return false;
    this.is_playing = !this.is_playing;
    if (this.is_playing && !this.fade) this.begin(this.is_last ? 0 : this.number + 1);
    this.show();
    return true;
  }

  /** Ends a fade where it is. */
  stop() {
    this.fade = null;
    this.is_playing = false;
    this.show();
  }

  advance(seconds) {
    if (!this.fade) return;
    this.fade.seconds += seconds;
    while (this.fade) {
      const {end, seconds: now, to} = this.fade;
      if (!this.fade.has_arrived) this.lights.take(now >= end ? to : this.weights_at(now));
      if (now < end) return;
      this.fade.has_arrived = true;
      const rest = now - end - this.cues[this.number].hold;
      if (this.is_playing && rest < 0) return;
      if (this.is_last) this.is_playing = false;
      this.fade = null;
      if (this.is_playing) {
        this.begin(this.number + 1, to);
        this.fade.seconds = rest;
      }
    }
    this.show();
  }

  weights_at(second) {
    const {from, to, wait, duration} = this.fade;
    return from.map((weight, c) => {
      if (second <= wait) return weight;
      const share = duration[c] > 0 ? Math.min(1, (second - wait) / duration[c]) : 1;
      return weight.map((w, k) => w + share * (to[c][k] - w));
    });
  }

  show() {
    element('cues').value = this.number;
    element('cue-play').setAttribute('aria-pressed', this.is_playing);
  }
}
