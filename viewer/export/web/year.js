// A year of daylight: the instant that is shown, its sun and sky, and the weights of the light's terms.

const hours_a_day = 24;
/** In BakedYear::pane_of_face: the other side of a pane, which is counted already. */
const other_side_of_pane = 255;
const hours_a_second = 1;  // while a day is played
const metering_pause = 250;  // ms between two looks of the automatic exposure

/**
 * Azimuth of the sun from north by east and altitude, radians, at `days` since noon of 2000-01-01, universal time: Michalsky
 * 1988, as scene/sun_position.cpp.
 */
function sun_position(days, latitude, longitude) {
  const degree = Math.PI / 180, anomaly = (357.528 + 0.9856003 * days) * degree;
  const ecliptic = (280.460 + 0.9856474 * days + 1.915 * Math.sin(anomaly) + 0.020 * Math.sin(2 * anomaly)) * degree;
  const obliquity = (23.439 - 4e-7 * days) * degree;
  const right_ascension = Math.atan2(Math.cos(obliquity) * Math.sin(ecliptic), Math.cos(ecliptic));
  const sin_declination = Math.sin(obliquity) * Math.sin(ecliptic), cos_declination = Math.sqrt(1 - sin_declination ** 2);
  const hour_angle = (280.46061837 + 360.98564737 * days + longitude) * degree - right_ascension;
  const sin_latitude = Math.sin(latitude * degree), cos_latitude = Math.cos(latitude * degree);
  const up = sin_declination * sin_latitude + cos_declination * cos_latitude * Math.cos(hour_angle);
  const north = sin_declination * cos_latitude - cos_declination * sin_latitude * Math.cos(hour_angle);
  const east = -cos_declination * Math.sin(hour_angle);
  return {azimuth: Math.atan2(east, north), altitude: Math.atan2(up, Math.hypot(north, east))};
}

/** The hours of a year with light, and the light of any moment of them. */
class Year {
  constructor(model) {
    const {bytes, about} = model, year = about.year, {count, numbers, skies, weights} = year.hours;
    this.model = model;
    this.about = year;
    this.numbers = new Uint32Array(bytes.buffer, numbers, count);
    this.skies = new Float32Array(bytes.buffer, skies, 7 * count);
    this.weights = model.unpack_halves(weights, count * year.terms, table_of_halves());
    this.first_day = Date.UTC(year.calendar, 0, 1);
    this.days = (Date.UTC(year.calendar + 1, 0, 1) - this.first_day) / 864e5;
    this.index_of_hour = new Int32Array(this.days * hours_a_day).fill(-1);
    this.numbers.forEach((hour, i) => { this.index_of_hour[hour] = i; });
    this.axes = year.axes.map((axis) => new Library.Vector3(...axis));  // north, east, up
  }

  /** Where the sun is `hour` hours after the year began, standard time. */
  sun_at(hour) {
    const {latitude, longitude, hours_east} = this.about;
    const days = (this.first_day - Date.UTC(2000, 0, 1)) / 864e5 - 0.5 + (hour - hours_east) / 24;
    return sun_position(days, latitude, longitude);
  }

  direction_of({azimuth, altitude}) {
    const [north, east, up] = this.axes, level = Math.cos(altitude);
    return new Library.Vector3().addScaledVector(north, level * Math.cos(azimuth))
      .addScaledVector(east, level * Math.sin(azimuth)).addScaledVector(up, Math.sin(altitude));
  }

  /** The moment between two middles of hours at which the sun rises or sets. */
  horizon_between(from, to) {
    const is_up = (hour) => this.sun_at(hour).altitude > 0, at_first = is_up(from);
    if (at_first === is_up(to)) return null;
    for (let i = 0; i < 30; ++i) {
      const middle = (from + to) / 2;
      if (is_up(middle) === at_first) from = middle; else to = middle;
    }
    return from;
  }

  /**
   * Hours have their light in their middle. Between two lit ones it changes evenly; from and to the dark it grows from nothing at
   * sunrise, and falls to nothing at sunset, in half an hour at least: the sun may rise seconds before the middle of an hour. Pairs
   * of an hour's index and its share.
   */
  shares_at(hour) {
    const last = this.index_of_hour.length, before = Math.floor(hour - 0.5), part = hour - 0.5 - before;
    const index = (h) => this.index_of_hour[(h + last) % last];
    const a = index(before), b = index(before + 1);
    if (a >= 0 && b >= 0) return [[a, 1 - part], [b, part]];
    if (a < 0 && b < 0) return [];
    const lit = a >= 0 ? before : before + 1, dark = a >= 0 ? before + 1 : before;
    const horizon = this.horizon_between(before + 0.5, before + 1.5) ?? dark + 0.5;
    const zero = a < 0 ? Math.min(horizon, lit) : Math.max(horizon, lit + 1);
    const share = (hour - zero) / (lit + 0.5 - zero);
    return share > 0 ? [[Math.max(a, b), Math.min(1, share)]] : [];
  }

  /** Sun, sky and weights of an instant. */
  light_at(hour) {
    const {terms} = this.about, shares = this.shares_at(hour), sun = this.sun_at(hour);
    const weights = new Float32Array(terms), sky = new Array(7).fill(0);
    let lit = 0;
    for (const [i, share] of shares) {
      for (let k = 0; k < terms; ++k) weights[k] += share * this.weights[terms * i + k];
      for (let c = 0; c < 7; ++c) sky[c] += share * this.skies[7 * i + c];
      lit += share;
    }
    const gradation = lit > 0 ? sky.slice(2).map((x) => x / lit) : [0, -1, 0, -1, 0];
    const sun_lux = sun.altitude > 0 ? sky[0] : 0;
    return {weights, sun_lux, dome_lux: sky[1], gradation, altitude: sun.altitude, azimuth: sun.azimuth,
      direction: this.direction_of(sun), ground_lux: sky[1] + sun_lux * Math.max(0, Math.sin(sun.altitude))};
  }

  /** Light of the terms at a vertex, lx of red, green and blue. */
  light_of(vertex, {weights}) {
    const {terms, bands} = this.about, {terms_of_light} = this.model, E = [0, 0, 0];
    for (let band = 0; band < bands; ++band) {
      const first = terms * (bands * vertex + band);
      for (let k = 0; k < terms; ++k) E[band] += weights[k] * terms_of_light[first + k];
      E[band] = Math.max(0, E[band]);
    }
    return bands === 1 ? [E[0], E[0], E[0]] : E;
  }
}

/** Paints the dome of an instant: Perez' gradation, scaled so that it lights open ground with its lux. */
function paint_dome(year, light, texels, {columns, rows_above, rows_below}) {
  const [a, b, c, d, e] = light.gradation, sin = Math.sin, cos = Math.cos;
  let sum = 0;
  const luminances = new Float32Array(columns * rows_above);
  for (let row = 0; row < rows_above; ++row) {
    const zenith = row / (rows_above - 1) * Math.PI / 2, cos_zenith = cos(zenith);
    const phi = a === 0 ? 1 : Math.max(0, 1 + a * Math.exp(b / Math.max(cos_zenith, 1e-3)));
    const band = row === 0 || row === rows_above - 1 ? 0.5 : 1;
    for (let column = 0; column < columns; ++column) {
      const azimuth = 2 * Math.PI * column / (columns - 1);
      const cos_chi = cos_zenith * sin(light.altitude) + sin(zenith) * cos(light.altitude) * cos(azimuth - light.azimuth);
      const chi = Math.acos(Math.min(1, Math.max(-1, cos_chi)));
      const L = phi * Math.max(0, 1 + c * (Math.exp(d * chi) - Math.exp(d * Math.PI / 2)) + e * cos_chi * cos_chi);
      luminances[row * columns + column] = L;
      if (column > 0) sum += band * L * cos_zenith * sin(zenith);
    }
  }
  const scale = light.dome_lux / Math.max(1e-9, sum * 2 * Math.PI / (columns - 1) * (Math.PI / 2 / (rows_above - 1)));
  const ground = year.about.ground * light.ground_lux / Math.PI;
  for (let i = 0; i < columns * (rows_above + rows_below); ++i) {
    const L = i < luminances.length ? scale * luminances[i] : ground;
    for (let k = 0; k < 3; ++k) texels[4 * i + k] = L;
  }
}

/** The controls of the year. Calls `changed(light)` with each new instant. */
class YearPanel {
  constructor(year, changed) {
    this.year = year;
    this.changed = changed;
    this.is_automatic = true;
    this.plays = false;
    element('year').hidden = false;
    element('date').max = year.days - 1;
    for (const id of ['date', 'hour']) {
      element(id).addEventListener('input', () => {
        this.play(false);
        this.show();
      });
    }
    element('play').addEventListener('click', () => this.play(!this.plays));
    element('adapt').addEventListener('click', () => this.adapt(!this.is_automatic));
    this.adapt(true);
    // Noon at the equinox of spring, or the lit hour nearest to it in weather of a part of the year.
    const spring = hours_a_day * (year.about.latitude >= 0 ? 79 : 265) + 12;
    const near = (hour) => Math.abs(hour - spring);
    const first = year.numbers.reduce((best, hour) => near(hour) < near(best) ? hour : best);
    this.set(Math.floor(first / hours_a_day), first % hours_a_day + 0.5);
  }

  set(day, hour) {
    element('date').value = day;
    element('hour').value = hour;
    this.show();
  }

  play(on) {
    this.plays = on;
    element('play').setAttribute('aria-pressed', on);
  }

  adapt(on) {
    this.is_automatic = on;
    element('adapt').setAttribute('aria-pressed', on);
  }

  /** Goes on by `seconds`, from dusk to the next dawn at once. */
  advance(seconds) {
    if (!this.plays) return;
    let day = element('date').valueAsNumber, hour = element('hour').valueAsNumber + hours_a_second * seconds;
    const is_dark = (h) => this.year.shares_at(hours_a_day * day + h).length === 0;
    if (hour >= hours_a_day) {
      hour -= hours_a_day;
      day = (day + 1) % this.year.days;
    }
    while (is_dark(hour)) {
      hour += 0.25;
      if (hour < hours_a_day) continue;
      hour = 0;
      day = (day + 1) % this.year.days;
      if (day === element('date').valueAsNumber) return this.play(false);
    }
    this.set(day, hour);
  }

  hour_of_year() { return hours_a_day * element('date').valueAsNumber + element('hour').valueAsNumber; }

  show() {
    this.light = this.year.light_at(this.hour_of_year());
    this.say();
    this.changed(this.light);
  }

  say() {
    const {light, year} = this, minutes = Math.round(60 * element('hour').valueAsNumber);
    const when = new Date(year.first_day + 864e5 * element('date').valueAsNumber + 6e4 * minutes);
    const date = when.toLocaleDateString(language, {day: 'numeric', month: 'long', timeZone: 'UTC'});
    const pad = (x) => String(x).padStart(2, '0');
    element('instant').value = `${date}  ${pad(Math.floor(minutes / 60) % 24)}:${pad(minutes % 60)}`;
    const height = Math.round(light.altitude * 180 / Math.PI);
    element('outside').value = light.ground_lux > 0
      ? `${text('sun')} ${number_text(height, {})}° · ${text('open_ground')} ${digits(light.ground_lux)} lx` : text('dark');
    for (const id of ['date', 'hour']) element(id).setAttribute('aria-valuetext', element('instant').value);
  }
}
