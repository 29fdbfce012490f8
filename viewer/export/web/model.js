// The model: what the page's data hold, unpacked.

/** All bytes of base64 text. A piece at a time, so that no string of a hundred megabytes is made twice. */
function decode_base64(text) {
  text = text.trim();
  const padding = text.endsWith('==') ? 2 : text.endsWith('=') ? 1 : 0;
  const bytes = new Uint8Array(text.length / 4 * 3 - padding);
  const piece = 1 << 20;  // of text, a multiple of 4
  for (let at = 0, out = 0; at < text.length; at += piece) {
    const decoded = atob(text.slice(at, at + piece));
    for (let i = 0; i < decoded.length; ++i) bytes[out++] = decoded.charCodeAt(i);
  }
  return bytes;
}

/** The numbers that the 65536 half floats stand for. */
function table_of_halves() {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = bits >> 10 & 31, fraction = bits & 1023;
    const size = exponent === 0 ? fraction * 2 ** -24
      : exponent < 31 ? (1 + fraction / 1024) * 2 ** (exponent - 15)
      : fraction ? NaN : Infinity;
    table[bits] = bits & 0x8000 ? -size : size;
  }
  return table;
}

/**
 * Geometry and light. Positions are metres, y upwards, from the model's lowest corner. Light is a sum of bases, each
 * with radiance (linear RGB, W/(m^2 sr)) and illuminance (lx of red, green and blue, which are added) per vertex, times a
 * weight for red, green and blue.
 * mix() adds them up once weights have changed.
 */
class Model {
  constructor(about, bytes) {
    this.about = about;
    this.bytes = bytes;
    const n = about.vertex_count;
    this.positions = this.unpack_positions();
    this.corners = new Uint32Array(bytes.buffer, about.corners.offset, 4 * about.face_count);
    this.black_behind = new Uint8Array(bytes.buffer, about.black_behind.offset, about.face_count);
    const halves = table_of_halves();
    this.bases = about.bases.map((basis) => ({
      name: basis.name,
      weight: basis.weight ?? [1, 1, 1],
      radiance: this.unpack_halves(basis.radiance, 3 * n, halves),
      illuminance: this.unpack_halves(basis.illuminance, 3 * n, halves),
    }));
    if (about.pictures) {
      this.places = new Float32Array(bytes.buffer, about.places.offset, 2 * n);
      this.picture_gain = this.unpack_halves(about.picture_gain, 3 * n, halves);
    }
    // Bound of the error of illuminance per face, lx, for the light as it was solved.
    this.within = about.lux_within && this.unpack_halves(about.lux_within, about.face_count, halves);
    if (about.year) {
      const {light, reflectance, bands, terms, panes} = about.year;
      this.terms_of_light = this.unpack_halves(light, bands * terms * n, halves);
      this.reflectance = this.unpack_halves(reflectance, 3 * n, halves);
      this.pane = new Uint8Array(bytes.buffer, panes.of_face, about.face_count);
    }
    this.moment = null;  // of the year: {year, light, sun_on}
    about.element_count = about.face_count;
    this.lamps = about.lamps && this.unpack_lamps(about.lamps);
    split_spheres(this);
    this.radiance = new Float32Array(3 * about.vertex_count);
    this.illuminance = new Float32Array(3 * about.vertex_count);
    this.mix();
    this.split_faces();
  }

  /** Whether all bases have the weights of the solution, for which bounds of errors hold. */
  is_as_solved() {
    return this.bases.every((basis, i) => (this.about.bases[i].weight ?? [1, 1, 1]).every((w, k) =>
      Math.abs(w - basis.weight[k]) <= 1e-6 * Math.abs(w)));
  }

  unpack_positions() {
    const {offset, step} = this.about.positions, n = this.about.vertex_count;
    const words = new Uint32Array(this.bytes.buffer, offset, 2 * n), positions = new Float32Array(3 * n);
    for (let v = 0; v < n; ++v) {
      const low = words[2 * v], high = words[2 * v + 1];  // x, y, z: 21 bits each
      positions[3 * v] = step * (low & 0x1fffff);
      positions[3 * v + 1] = step * (low >>> 21 | (high & 0x3ff) << 11);
      positions[3 * v + 2] = step * (high >>> 10 & 0x1fffff);
    }
    return positions;
  }

  /** Triangles of luminaires, with the radiance of their corners in each basis, and the sum of all bases. */
  unpack_lamps(about) {
    const {buffer} = this.bytes, n = 3 * about.corner_count;
    return {
      positions: new Float32Array(buffer, about.positions, n),
      triangles: new Uint32Array(buffer, about.triangles, 3 * about.triangle_count),
      bases: about.radiance.map((offset) => new Float32Array(buffer, offset, n)),
      radiance: new Float32Array(n),
    };
  }

  unpack_halves({offset, scale}, count, halves) {
    const bits = new Uint16Array(this.bytes.buffer, offset, count), values = new Float32Array(count);
    for (let i = 0; i < count; ++i) values[i] = scale * halves[bits[i]];
    return values;
  }

  /** A picture's texels, four bytes each with alpha; rows from the top. */
  async decode_picture({offset, length}) {
    const image = new Image();
    image.src = URL.createObjectURL(new Blob([this.bytes.subarray(offset, offset + length)], {type: 'image/png'}));
    await image.decode();
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [image.width, image.height];
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    URL.revokeObjectURL(image.src);
    return context.getImageData(0, 0, image.width, image.height);
  }

  /** Keeps a decoded picture, linear, for readings: three numbers a texel. */
  keep_picture(number, {data, width, height}) {
    const linear = Float32Array.from({length: 256}, (_, byte) => srgb_decode(byte / 255));
    const about = this.about.pictures[number], wrap = (x, how) => {
      if (how === 'clamp') return Math.min(1, Math.max(0, x));
      const turn = x - Math.floor(x);
      return how === 'mirror' && Math.floor(x) % 2 !== 0 ? 1 - turn : turn;
    };
    (this.kept_pictures ??= [])[number] = (u, v) => {
      const x = Math.min(width - 1, Math.floor(wrap(u, about.wrap[0]) * width));
      const y = Math.min(height - 1, Math.floor(wrap(v, about.wrap[1]) * height));
      return [0, 1, 2].map((c) => linear[data[4 * (y * width + x) + c]]);
    };
  }

  /** Adds the bases up with their weights. */
  mix() {
    const L = this.radiance.fill(0), E = this.illuminance.fill(0), of_lamps = this.lamps?.radiance.fill(0);
    for (const [basis, {weight: [r, g, b], radiance, illuminance}] of this.bases.entries()) {
      if (r === 0 && g === 0 && b === 0) continue;
      const sums = [[L, radiance], [E, illuminance]];
      if (of_lamps) sums.push([of_lamps, this.lamps.bases[basis]]);
      for (const [sum, values] of sums) {
        for (let i = 0; i < sum.length; i += 3) {
          sum[i] += r * values[i];
          sum[i + 1] += g * values[i + 1];
          sum[i + 2] += b * values[i + 2];
        }
      }
    }
  }

  /**
   * Triangles of all faces, quads split from their first corner, in five groups: faces without and with a black other
   * side, both again of faces without light, and glass; then the first two of what shows each picture.
   */
  split_faces() {
    const {parts, materials, face_count, pictures = []} = this.about;
    this.part_of_face = new Uint32Array(face_count);
    const group_of_face = new Uint32Array(face_count), sizes = new Array(5 + 2 * pictures.length).fill(0);
    parts.forEach((part, p) => {
      const is_glass = materials[part.material].kind === 'glass';
      for (let f = part.first_face; f < part.first_face + part.face_count; ++f) {
        this.part_of_face[f] = p;
        const first = !this.is_lit(f) ? 2 : part.picture >= 0 ? 5 + 2 * part.picture : 0;
        group_of_face[f] = is_glass ? 4 : first + this.black_behind[f];
        sizes[group_of_face[f]] += this.corner_count(f) - 2;
      }
    });
    let count = 0;
    const next = sizes.map((size) => (count += size) - size);
    this.groups = next.map((first, g) => ({first, count: sizes[g]}));
    this.triangles = new Uint32Array(3 * count);
    this.face_of_triangle = new Uint32Array(count);
    for (let f = 0; f < face_count; ++f) {
      for (let c = 1; c < this.corner_count(f) - 1; ++c) {
        const t = next[group_of_face[f]]++;
        this.face_of_triangle[t] = f;
        this.triangles.set([this.corners[4 * f], this.corners[4 * f + c], this.corners[4 * f + c + 1]], 3 * t);
      }
    }
  }

  /** Light at a vertex, without that of the sun's own rays: lx of red, green and blue, and radiance as shown. */
  light_of_vertex(v) {
    if (!this.moment) return {E: this.illuminance.subarray(3 * v, 3 * v + 3), L: this.radiance.subarray(3 * v, 3 * v + 3)};
    const {year, light} = this.moment;
    return this.shown_light(year.light_of(v, light), this.reflectance.subarray(3 * v, 3 * v + 3));
  }

  /** White light of `lux` of red, green and blue, and what of it a surface shows. */
  shown_light(lux, reflectance) {
    const {lumens_per_watt, luminance_weights} = this.about;
    return {E: lux.map((x, k) => luminance_weights[k] * x), L: lux.map((x, k) => reflectance[k] * x / (Math.PI * lumens_per_watt))};
  }

  corner_count(face) { return this.corners[4 * face + 3] === 0xffffffff ? 3 : 4; }

  /** Whether any basis has light at any corner. */
  is_lit(face) {
    for (let c = 0; c < this.corner_count(face); ++c) {
      const v = 3 * this.corners[4 * face + c];
      for (const {radiance} of this.bases) {
        if (radiance[v] !== 0 || radiance[v + 1] !== 0 || radiance[v + 2] !== 0) return true;
      }
    }
    return false;
  }

  is_glass(face) { return this.about.materials[this.about.parts[this.part_of_face[face]].material].kind === 'glass'; }

  corner(face, c) {
    const v = this.corners[4 * face + c];
    return new Library.Vector3().fromArray(this.positions, 3 * v);
  }

  /** A place of the page in the scene file's axes and unit. */
  to_scene(p) {
    const {to_scene, origin, metres_per_unit} = this.about, q = [p.x + origin[0], p.y + origin[1], p.z + origin[2]];
    return to_scene.map((row) => (row[0] * q[0] + row[1] * q[1] + row[2] * q[2]) / metres_per_unit);
  }
}
