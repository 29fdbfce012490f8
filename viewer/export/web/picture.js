// Drawing: the same colours as Lightwell's pictures (docs/tone-mapping.md), a fragment at a time.

/** From radiance to what a screen shows. */
const display_functions = `
vec3 shoulder(vec3 x) {
  return mix(0.5 + 0.5 * (1.0 - exp(-(x - 0.5) / 0.5)), x, lessThanEqual(x, vec3(0.5)));
}
vec3 srgb_encode(vec3 x) {
  x = clamp(x, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}`;

const vertex_program = `
#ifdef OF_YEAR
in vec3 reflectance;
uniform sampler2D terms;   // of the light, four a texel, the texels of a vertex side by side
uniform vec4 weights[OF_YEAR];
uniform float lumens_per_watt;
uniform vec3 luminance_weights;  // Y of red, green and blue
out vec3 rho;
out vec3 outwards;
out vec3 in_page;
centroid out vec3 on_face;  // on the face, where the middle of a pixel at its edge is not
#endif
in vec3 radiance;
in vec3 illuminance;
out vec3 L;
out vec3 E_rgb;
#ifdef WITH_PICTURE
in vec2 place;
in vec3 picture_gain;
out vec2 at;
out vec3 gain;
#endif
void main() {
#ifdef OF_YEAR
  // lx of red, green and blue, or of all alike.
  vec3 lux = vec3(0.0);
  int texel = gl_VertexID * OF_YEAR * BANDS, across = textureSize(terms, 0).x;
  for (int band = 0; band < BANDS; ++band) {
    for (int k = 0; k < OF_YEAR; ++k, ++texel) lux[band] += dot(weights[k], texelFetch(terms, ivec2(texel % across, texel / across), 0));
  }
  lux = max(BANDS == 1 ? lux.rrr : lux, 0.0);
  rho = reflectance;
  outwards = normal;
  in_page = on_face = position;
  L = rho * lux / (3.14159265 * lumens_per_watt);
  E_rgb = lux * luminance_weights;
#else
  L = radiance;
  E_rgb = illuminance;
#endif
#ifdef WITH_PICTURE
  at = place;
  gain = picture_gain;
#endif
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const fragment_program = `
precision highp float;
precision highp sampler2D;
in vec3 L;
in vec3 E_rgb;             // lx of red, green and blue
out vec4 pixel;
uniform int shows;         // 0: light, 1: illuminance and 2: luminance in false colours, 3: illuminance for the light meter
uniform vec3 scale;        // exposure, with the white balance
uniform float opacity;
uniform vec2 range;        // of the false colours
uniform bool logarithmic;
uniform float levels[24];  // of isolux lines, lx
uniform int level_count;
uniform float line_width;  // pixels
uniform float lumens_per_watt;
uniform vec3 luminance_weights;
uniform sampler2D palette;
#ifdef WITH_PICTURE
in vec2 at;
in vec3 gain;
uniform sampler2D picture;
uniform bool is_there;     // it has been decoded
#endif

${display_functions}
#ifdef OF_YEAR
in vec3 rho;
in vec3 outwards;
in vec3 in_page;
centroid in vec3 on_face;
${sunlight_functions}
#endif

// Distance to the nearest isolux line, in pixels. There is none where the illuminance is even, nor where it is so steep
// that lines would run together, as on elements of a few pixels.
float pixels_to_line(float E, float slope) {
  float nearest = 1e9;
  for (int i = 0; i < level_count; ++i) nearest = min(nearest, abs(E - levels[i]));
  return slope > 1e-5 * E && slope < 0.15 * E ? nearest / slope : 1e9;
}

void main() {
  vec3 shown = L, lux = E_rgb;
#ifdef OF_YEAR
  vec3 straight = sunlight(on_face, plane_of(in_page, normalize(outwards)), normalize(outwards));
  shown += rho * straight / (3.14159265 * lumens_per_watt);
  lux += straight * luminance_weights;
#endif
  float E = lux.r + lux.g + lux.b;
  float slope = length(vec2(dFdx(E), dFdy(E)));
#ifdef WITH_PICTURE
  // Texels of holes have no colour; dividing by alpha restores what blending with holes took.
  vec4 texel = texture(picture, at);
  if (is_there && texel.a < 0.5) discard;
  if (is_there) shown *= gain * texel.rgb / texel.a;
#endif
  if (!gl_FrontFacing) {
    pixel = vec4(0.0, 0.0, 0.0, 1.0);
  } else if (shows == 3) {
    pixel = vec4(lux, 1.0);
  } else if (shows != 0) {
    float value = shows == 1 ? E : lumens_per_watt * dot(shown, luminance_weights);
    float place = !logarithmic ? (value - range.x) / (range.y - range.x)
                : value > 0.0 ? log(value / range.x) / log(range.y / range.x) : 0.0;
    // Texel centres are the ends of the scale.
    pixel = vec4(texture(palette, vec2((clamp(place, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb, opacity);
  } else {
    pixel = vec4(srgb_encode(shoulder(scale * shown)), opacity);
  }
  if (level_count > 0 && gl_FrontFacing && shows != 3 && opacity == 1.0) {
    // A bright line on a wider dark one reads on any colour.
    float away = pixels_to_line(E, slope);
    pixel.rgb = mix(vec3(0.05), pixel.rgb, smoothstep(line_width, line_width + 1.0, away));
    pixel.rgb = mix(vec3(1.0), pixel.rgb, smoothstep(0.5 * line_width - 0.5, 0.5 * line_width + 0.5, away));
  }
}`;

const line_vertex_program = `
out float facing;
void main() {
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  facing = -dot(normalMatrix * normal, at.xyz);
  at.xyz *= 0.998;  // before the faces it belongs to
  gl_Position = projectionMatrix * at;
}`;

const line_fragment_program = `
precision highp float;
in float facing;
out vec4 pixel;
void main() {
  if (facing <= 0.0) discard;
  pixel = vec4(0.1, 0.1, 0.1, 1.0);
}`;

const glass_opacity = 0.2;
const metering_width = 160;

/**
 * The mean light of pixels, lx of red, green and blue and a fourth number each: the exposure, which is the multiplier of
 * radiance for which white paper under that light shows white, and the light's colour, of luminance 1. Means are those of
 * the illuminances within a factor 10 of the median. Null without light.
 */
function incident_light(pixels, lumens_per_watt, luminance_weights) {
  const lit = [];
  for (let i = 0; i < pixels.length; i += 4) {
    const E = pixels[i] + pixels[i + 1] + pixels[i + 2];
    if (E > 0 && Number.isFinite(E)) lit.push({E, i});
  }
  if (lit.length === 0) return null;
  lit.sort((a, b) => a.E - b.E);
  const median = lit[Math.floor(lit.length / 2)].E;
  const typical = lit.filter(({E}) => E >= median / 10 && E <= 10 * median), sums = [0, 0, 0];
  for (const {i} of typical) sums.forEach((_, c) => { sums[c] += pixels[i + c]; });
  const sum = sums[0] + sums[1] + sums[2];
  return {exposure: Math.PI * lumens_per_watt * typical.length / sum, colour: sums.map((x, c) => x / (luminance_weights[c] * sum))};
}

function palette_texture(hex) {
  const rgba = new Uint8Array(1024).fill(255);
  for (let i = 0; i < 256; ++i) {
    for (let c = 0; c < 3; ++c) rgba[4 * i + c] = parseInt(hex.substr(6 * i + 2 * c, 2), 16);
  }
  const texture = new Library.DataTexture(rgba, 256, 1);
  texture.minFilter = texture.magFilter = Library.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** three.js' number for faces seen from behind. */
const back_side = 1;

/** WebGL's and three.js' numbers for how a picture goes on and is filtered. */
const wraps = {repeat: 1000, clamp: 1001, mirror: 1002}, nearest = 1003, mipmap = 1008;

class Picture {
  constructor(model, canvas) {
    this.model = model;
    this.renderer = new Library.WebGLRenderer({canvas, antialias: true, alpha: false});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new Library.Scene();
    this.own_camera = this.camera = camera_with_span(0);
    this.cut = 0;  // metres to the plane before which the own camera sees nothing
    this.looks_through = false;
    this.picture_came = () => {};  // for the owner to set: there is something to draw
    this.uniforms = {
      shows: {value: 0},
      scale: {value: [1, 1, 1]},
      range: {value: [0, 1]},
      logarithmic: {value: false},
      levels: {value: new Array(most_levels).fill(0)},
      level_count: {value: 0},
      line_width: {value: 1},
      lumens_per_watt: {value: model.about.lumens_per_watt},
      luminance_weights: {value: model.about.luminance_weights},
      palette: {value: palette_texture(model.about.false_colors.palette)},
    };
    this.geometry = new Library.BufferGeometry();
    this.geometry.setAttribute('position', new Library.BufferAttribute(model.positions, 3));
    this.geometry.setAttribute('radiance', new Library.BufferAttribute(model.radiance, 3));
    this.geometry.setAttribute('illuminance', new Library.BufferAttribute(model.illuminance, 3));
    this.geometry.setIndex(new Library.BufferAttribute(model.triangles, 1));
    if (model.places) {
      this.geometry.setAttribute('place', new Library.BufferAttribute(model.places, 2));
      this.geometry.setAttribute('picture_gain', new Library.BufferAttribute(model.picture_gain, 3));
    }
    if (model.about.year) this.set_up_year();
    model.groups.forEach(({first, count}, g) => this.geometry.addGroup(3 * first, 3 * count, g));
    this.materials = [1, 1, 1, 1, glass_opacity].map((opacity) => this.make_material(opacity));
    const [, backed, dark, dark_backed, glass] = this.materials;  // the groups of Model.split_faces
    this.glass = glass;
    this.with_pictures = (model.about.pictures ?? []).flatMap((picture, i) => this.make_pictured_materials(picture, i));
    this.materials.push(...this.with_pictures);
    // Black backs are drawn by themselves, further away, so that they do not show along the outlines of what they belong to.
    this.backs = [backed, dark_backed, ...this.with_pictures.filter((_, m) => m % 2 === 1)].map((front) => {
      const back = this.make_material(1, {uniforms: front.uniforms, defines: front.defines ?? {}});
      const {first, count} = model.groups[this.materials.indexOf(front)];
      this.geometry.addGroup(3 * first, 3 * count, this.materials.push(back) - 1);
      back.side = back_side;
      return back;
    });
    // Where a lit wall stands on a floor that is black under it, the edge is the wall's: several samples a pixel would
    // else let black through. In pixels of the black face's slope; dots were seen at 1, none from 2 on.
    for (const material of [dark, dark_backed, ...this.backs]) {
      Object.assign(material, {polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 4});
    }
    const mesh = new Library.Mesh(this.geometry, this.materials);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    if (model.lamps) this.scene.add(this.lamps = this.make_lamps());
    this.sunlight?.add_casters(this.geometry.attributes.position, this.geometry.attributes.place,
      (picture) => this.with_pictures[2 * picture].uniforms);
    if (model.about.sky || model.about.year) {
      this.sky = new SkyPicture(model, this.uniforms);
      this.scene.add(this.sky.mesh);
    }
    this.look_through(false);
  }

  /** The terms of the year's light as a texture, and what the sun's rays meet. */
  set_up_year() {
    const {model, geometry} = this, {terms, bands} = model.about.year, across = 4096;
    const rows = Math.ceil(model.about.vertex_count * bands * terms / 4 / across), texels = new Float32Array(4 * across * rows);
    texels.set(model.terms_of_light);
    const texture = new Library.DataTexture(texels, across, rows, rgba, Library.FloatType);
    texture.needsUpdate = true;
    this.sunlight = new Sunlight(model, this.renderer);
    Object.assign(this.uniforms, this.sunlight.uniforms, {terms: {value: texture}, weights: {value: new Array(terms).fill(0)}});
    geometry.setAttribute('reflectance', new Library.BufferAttribute(model.reflectance, 3));
    // Vertices are shared only where surfaces are smooth.
    geometry.computeVertexNormals();
  }

  /** An instant of the year. */
  set_moment(year, light) {
    const {white} = year.about;
    this.uniforms.weights.value = Array.from(light.weights);
    this.sunlight.shine(light.direction, white.map((x) => x * light.sun_lux));
    this.sky.set_moment(year, light);
  }

  /** Luminaires have radiance, but no illuminance. */
  make_lamps() {
    const {positions, radiance, triangles} = this.model.lamps, geometry = new Library.BufferGeometry();
    geometry.setAttribute('position', new Library.BufferAttribute(positions, 3));
    geometry.setAttribute('radiance', new Library.BufferAttribute(radiance, 3));
    geometry.setIndex(new Library.BufferAttribute(triangles, 1));
    const mesh = new Library.Mesh(geometry, this.make_material(1));
    mesh.frustumCulled = false;
    return mesh;
  }

  show_lamps(on) {
    if (this.lamps) this.lamps.visible = on;
  }

  /** Of faces without and with a black other side. Texels come when they are decoded. */
  make_pictured_materials(about, number) {
    const of_picture = {picture: {value: null}, is_there: {value: false}};
    this.model.decode_picture(about).then((decoded) => {
      const {data, width, height} = decoded;
      this.model.keep_picture(number, decoded);
      const texture = new Library.DataTexture(new Uint8Array(data.buffer), width, height);
      [texture.wrapS, texture.wrapT] = about.wrap.map((how) => wraps[how]);
      texture.magFilter = about.is_smooth ? Library.LinearFilter : nearest;
      texture.minFilter = mipmap;
      texture.generateMipmaps = true;
      texture.colorSpace = 'srgb';  // read as linear
      texture.needsUpdate = true;
      of_picture.picture.value = texture;
      of_picture.is_there.value = true;
      this.picture_came();
    });
    return [0, 1].map(() => this.make_material(1, {uniforms: of_picture, defines: {WITH_PICTURE: 1}}));
  }

  make_material(opacity, {uniforms = {}, defines = {}} = {}) {
    const is_glass = opacity < 1, {year} = this.model.about;
    if (year) defines = {...defines, OF_YEAR: year.terms / 4, BANDS: year.bands};
    return new Library.ShaderMaterial({
      glslVersion: Library.GLSL3, vertexShader: vertex_program, fragmentShader: fragment_program,
      uniforms: {...this.uniforms, ...uniforms, opacity: {value: opacity}}, defines,
      transparent: is_glass, depthWrite: !is_glass,
    });
  }

  /** Whether the dark backs of surfaces are left out. */
  look_through(looks_through) {
    this.looks_through = looks_through;
    for (const back of this.backs) back.visible = !looks_through;
  }

  /** Of 'illuminance' or 'luminance' in a range; null: light. */
  set_false_colors(measure, range) {
    this.uniforms.shows.value = measure === null ? 0 : measure === 'illuminance' ? 1 : 2;
    this.show_lamps(measure !== 'illuminance');
    if (measure === null) return;
    this.uniforms.range.value = [range.low, range.high];
    this.uniforms.logarithmic.value = range.logarithmic;
  }

  /** Lines of these illuminances, lx. */
  set_isolux(levels) {
    levels.forEach((level, i) => { this.uniforms.levels.value[i] = level; });
    this.uniforms.level_count.value = levels.length;
  }

  /** `gains`: factors of the white balance. */
  set_scale(scale, gains) { this.uniforms.scale.value = gains.map((gain) => scale * gain); }

  /** Behind a plan there is no sky. */
  show_sky(on) {
    if (this.sky) this.sky.mesh.visible = on;
  }

  /** Tells the graphics card that the model has been mixed anew. */
  light_changed() {
    this.geometry.attributes.radiance.needsUpdate = true;
    this.geometry.attributes.illuminance.needsUpdate = true;
    if (this.lamps) this.lamps.geometry.attributes.radiance.needsUpdate = true;
    this.sky?.light_changed();
  }

  show_outlines(on) {
    if (on && !this.outlines) this.scene.add(this.outlines = this.make_outlines());
    if (this.outlines) this.outlines.visible = on;
  }

  make_outlines() {
    const {model} = this, lines = new Uint32Array(8 * model.about.face_count + model.arcs.length);
    lines.set(model.arcs);
    let count = model.arcs.length;
    for (let f = 0; f < model.about.face_count; ++f) {
      if (model.is_split?.[f]) continue;  // a part of an element
      const corners = model.corner_count(f);
      for (let c = 0; c < corners; ++c) {
        lines[count++] = model.corners[4 * f + c];
        lines[count++] = model.corners[4 * f + (c + 1) % corners];
      }
    }
    const geometry = new Library.BufferGeometry();
    if (!this.geometry.attributes.normal) this.geometry.computeVertexNormals();
    geometry.setAttribute('position', this.geometry.attributes.position);
    geometry.setAttribute('normal', this.geometry.attributes.normal);
    geometry.setIndex(new Library.BufferAttribute(lines.subarray(0, count), 1));
    const outlines = new Library.LineSegments(geometry, new Library.ShaderMaterial({
      glslVersion: Library.GLSL3, vertexShader: line_vertex_program, fragmentShader: line_fragment_program}));
    outlines.frustumCulled = false;
    return outlines;
  }

  resize(width, height) {
    this.renderer.setSize(width, height, false);
    this.uniforms.line_width.value = 1.6 * this.renderer.getPixelRatio();
    this.own_camera.aspect = width / height;
  }

  draw() {
    this.sunlight?.draw();
    if (this.camera === this.own_camera) this.fit_depth();
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.scene, this.camera);
  }

  /** From inside, as near as a depth buffer of 24 bits affords. */
  fit_depth() {
    const {camera} = this, size = new Library.Vector3().fromArray(this.model.about.size), diagonal = size.length();
    const way = size.multiplyScalar(0.5).sub(camera.position);
    const to_center = camera.span === 0 ? way.length() : way.dot(camera.getWorldDirection(new Library.Vector3()));
    camera.near = Math.max(to_center - 0.51 * diagonal, 5e-4 * diagonal, this.cut);
    camera.far = Math.max(to_center + 0.51 * diagonal, 2 * camera.near);
    camera.updateProjectionMatrix();
  }

  /** lx of red, green and blue, and another number, of all pixels of a coarse picture; null if they cannot be read. */
  incident_pixels(width) {
    if (!this.renderer.extensions.has('EXT_color_buffer_float')) return null;
    const height = Math.max(1, Math.round(width / this.camera.aspect));
    const target = new Library.WebGLRenderTarget(width, height, {type: Library.FloatType});
    const pixels = new Float32Array(4 * width * height), shown = this.uniforms.shows.value;
    const outlined = this.outlines?.visible;
    this.sunlight?.draw();
    this.show_lamps(false);
    this.uniforms.shows.value = 3;
    this.glass.visible = false;  // a veil is not to be measured
    this.show_outlines(false);
    if (this.camera === this.own_camera) this.fit_depth();
    this.renderer.setRenderTarget(target);
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
    this.renderer.setRenderTarget(null);
    target.dispose();
    this.uniforms.shows.value = shown;
    this.show_lamps(shown !== 1);
    this.glass.visible = true;
    this.show_outlines(Boolean(outlined));
    return {pixels, width, height};
  }

  /** Exposure and colour of light for what the camera sees now; null if that is dark or cannot be measured. */
  meter() {
    const seen = this.incident_pixels(metering_width);
    return seen && incident_light(seen.pixels, this.model.about.lumens_per_watt, this.model.about.luminance_weights);
  }

  /** Illuminance of a coarse picture, rows from below; null if it cannot be measured. */
  measure_illuminance(width) {
    const seen = this.incident_pixels(width);
    if (!seen) return null;
    const {pixels, height} = seen;
    return {E: Float32Array.from({length: width * height}, (_, i) => pixels[4 * i] + pixels[4 * i + 1] + pixels[4 * i + 2]), width, height};
  }
}
