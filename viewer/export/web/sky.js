// What is seen outside of the scene: sky, ground and sun.

const sky_vertex_program = `
out vec3 way;
void main() {
  // Of this triangle over all of the picture, as far away as there is.
  vec4 beyond = inverse(projectionMatrix) * vec4(position.xy, 1.0, 1.0);
  bool parallel = projectionMatrix[3][3] == 1.0;
  way = transpose(mat3(viewMatrix)) * (parallel ? vec3(0.0, 0.0, -1.0) : beyond.xyz / beyond.w);
  gl_Position = vec4(position.xy, 1.0, 1.0);
}`;

const sky_fragment_program = `
precision highp float;
precision highp sampler2D;
in vec3 way;
out vec4 pixel;
uniform int shows;       // as for the surfaces
uniform vec3 scale;
uniform sampler2D dome;  // a column for each azimuth from north by east, a row for each altitude from the zenith
uniform vec3 rows;       // above the horizon, below it, together
uniform mat3 axes;       // to north, east and up
uniform vec3 dome_weight;
uniform vec4 sun;        // direction, and the cosine to its edge; 2: there is none
uniform vec3 sun_radiance;
${display_functions}
void main() {
  vec3 d = normalize(axes * way);
  float across = float(textureSize(dome, 0).x);
  float azimuth = atan(d.y, d.x) / 6.283185307179586;
  float zenith = acos(clamp(d.z, -1.0, 1.0)) / 1.5707963267948966;  // 0 there, 1 at the horizon, 2 at the nadir
  float row = zenith < 1.0 ? zenith * (rows.x - 1.0) : rows.x + (zenith - 1.0) * (rows.y - 1.0);
  float column = (azimuth < 0.0 ? azimuth + 1.0 : azimuth) * (across - 1.0);
  vec3 L = dome_weight * texture(dome, vec2((column + 0.5) / across, (row + 0.5) / rows.z)).rgb;
  if (dot(normalize(way), sun.xyz) >= sun.w) L += sun_radiance;
  pixel = shows == 1 || shows == 3 ? vec4(0.0, 0.0, 0.0, 1.0)  // no light falls on it
        : vec4(shows == 2 ? L : srgb_encode(shoulder(scale * L)), 1.0);
}`;

/** three.js' numbers for texels. */
const rgba = 1023, half_float = 1016;

/** The half float below a number that is not negative. */
function half_of(x) {
  const bits = new Uint32Array(Float32Array.of(x).buffer)[0], exponent = (bits >>> 23) - 112;
  return exponent <= 0 ? 0 : exponent >= 31 ? 0x7bff : exponent << 10 | bits >>> 13 & 0x3ff;
}

/** The dome of a year, whose texels are painted for each instant. */
function dome_of_year({axes}) {
  return {columns: 73, rows_above: 19, rows_below: 2, axes};
}

/** Goes into the picture's scene, behind all else. */
class SkyPicture {
  constructor(model, shared) {
    this.model = model;
    const {year} = model.about;
    this.about = year ? dome_of_year(year) : model.about.sky;
    const {columns, rows_above, rows_below, axes, sun} = this.about, rows = rows_above + rows_below;
    const texels = this.texels = new Uint16Array(4 * columns * rows);
    if (!year) {
      const halves = new Uint16Array(model.bytes.buffer, this.about.radiance.offset, 3 * columns * rows);
      for (let i = 0; i < columns * rows; ++i) texels.set(halves.subarray(3 * i, 3 * i + 3), 4 * i);
    }
    const dome = this.dome = new Library.DataTexture(texels, columns, rows, rgba, half_float);
    dome.minFilter = dome.magFilter = Library.LinearFilter;
    dome.needsUpdate = true;
    this.uniforms = {
      shows: shared.shows, scale: shared.scale, dome: {value: dome},
      rows: {value: [rows_above, rows_below, rows]},
      axes: {value: [0, 1, 2].flatMap((c) => axes.map((row) => row[c]))},  // by columns
      dome_weight: {value: [0, 0, 0]},
      sun: {value: sun ? [...sun.direction, sun.cosine_of_edge] : [0, 0, 0, 2]},
      sun_radiance: {value: [0, 0, 0]},
    };
    const geometry = new Library.BufferGeometry();
    geometry.setAttribute('position', new Library.BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3));
    this.mesh = new Library.Mesh(geometry, new Library.ShaderMaterial({
      glslVersion: Library.GLSL3, vertexShader: sky_vertex_program, fragmentShader: sky_fragment_program,
      uniforms: this.uniforms, depthWrite: false}));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -1;
    this.light_changed();
  }

  /** Sun and dome of an instant of the year. */
  set_moment(year, light) {
    const {about, texels, uniforms, model: {about: {lumens_per_watt}}} = this, luminances = new Float32Array(texels.length);
    const most = 32768, {white} = year.about;
    paint_dome(year, light, luminances, about);
    const largest = luminances.reduce((a, b) => Math.max(a, b), 1e-9), scale = largest / most;
    luminances.forEach((L, i) => { texels[i] = half_of(L / scale); });
    this.dome.needsUpdate = true;
    uniforms.dome_weight.value = white.map((x) => x * scale / lumens_per_watt);
    const {x, y, z} = light.direction;
    uniforms.sun.value = light.sun_lux > 0 ? [x, y, z, Math.cos(sun_half_angle)] : [0, 0, 0, 2];
    const solid_angle = 2 * Math.PI * (1 - Math.cos(sun_half_angle));
    uniforms.sun_radiance.value = white.map((w) => w * light.sun_lux / solid_angle / lumens_per_watt);
  }

  /** As bright as its channels are now. */
  light_changed() {
    if (this.model.about.year) return;
    const {basis, radiance, sun} = this.about, weight = (b) => (b >= 0 ? this.model.bases[b].weight : [1, 1, 1]);
    this.uniforms.dome_weight.value = weight(basis).map((w) => w * radiance.scale);
    if (sun) this.uniforms.sun_radiance.value = weight(sun.basis).map((w, c) => w * sun.radiance[c]);
  }
}
