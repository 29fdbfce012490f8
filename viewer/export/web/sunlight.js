// Light straight from the sun: a map of what its rays meet first, and of what panes let pass, drawn from the sun.

/** Texels along the map's sides: 1 to 1.5 cm each in a room of 20 m. Larger models get more. */
const usual_map_size = 2048, large_map_size = 4096, large_model = 25;  // m
const sun_half_angle = 0.2665 * Math.PI / 180;  // as scene/sky.h

/** Sunlight of a fragment, lx of red, green and blue. */
const sunlight_functions = `
uniform vec4 sun;            // towards it; w: 1 while it shines
uniform vec3 sun_lux;        // across its rays
uniform mat4 to_sun;         // from the page to the map, [0,1] each way
uniform mat3 from_sun;       // back, of directions
uniform sampler2D sun_near;  // how near the sun is what its rays meet first: 1 - depth, in 24 bits
uniform sampler2D sun_passed;
uniform float sun_slack;     // of the depth

float first_met(ivec2 at, ivec2 last) {
  vec3 bytes = texelFetch(sun_near, clamp(at, ivec2(0), last), 0).rgb;
  return 1.0 - dot(bytes, vec3(1.0, 1.0 / 255.0, 1.0 / 65025.0));
}

// The share of four by four texels about a point of a plane that the sun reaches, weighted by their distance.
float reached(vec3 p, vec2 slope) {
  ivec2 size = textureSize(sun_near, 0);
  vec2 texel = p.xy * vec2(size) - 0.5, low = floor(texel), part = texel - low;
  // Corners of triangles are drawn to a sixteenth of a texel or better.
  float sum = 0.0, slack = sun_slack + dot(abs(slope), 0.1 / vec2(size));
  for (int j = -1; j <= 2; ++j) {
    for (int i = -1; i <= 2; ++i) {
      vec2 away = vec2(i, j) - part;
      // The plane's own depth at the texel, so that it does not shade itself.
      float depth = p.z + dot(slope, away / vec2(size));
      vec2 weight = 1.0 - clamp(abs(away) - 1.0, 0.0, 1.0);
      if (depth <= first_met(ivec2(low) + ivec2(i, j), size - 1) + slack) sum += weight.x * weight.y;
    }
  }
  // Half of the edge is left out, so that no light leaks where a wall stands on the floor. Sunlit places end some 0.7 texel early.
  return max(0.0, 2.0 * sum / 9.0 - 1.0);
}

// Normal of the plane of a face, which is a piece of something round where its normals differ.
vec3 plane_of(vec3 at, vec3 outwards) {
  vec3 plane = normalize(cross(dFdx(at), dFdy(at)));
  return dot(plane, outwards) > 0.9999 ? outwards : plane;
}

vec3 sunlight(vec3 at, vec3 plane, vec3 outwards) {
  float cosine = dot(outwards, sun.xyz);
  if (sun.w == 0.0 || cosine <= 0.0) return vec3(0.0);
  // A plane that the sun grazes rises so fast from texel to texel that the plane would pass through the surface that shades it.
  // Below 14 degrees its slope is limited, and the map is asked before the plane instead, by what four by four texels reach: 2.8.
  const float steepest = 4.0, reach = 3.0;  // texels
  float along = abs(dot(plane, sun.xyz)), steep = sqrt(1.0 - min(along * along, 1.0)) / max(along, 1e-3);
  float limit = min(1.0, steepest / max(steep, 1e-3));
  vec2 scale = vec2(length(vec3(to_sun[0].x, to_sun[1].x, to_sun[2].x)), length(vec3(to_sun[0].y, to_sun[1].y, to_sun[2].y)));
  vec2 texel = 1.0 / (vec2(textureSize(sun_near, 0)) * scale);
  vec3 p = (to_sun * vec4(at + reach * (1.0 - limit) * max(texel.x, texel.y) * outwards, 1.0)).xyz;
  vec3 n = normalize(plane * from_sun);
  vec2 slope = -limit * n.xy / (n.z < 0.0 ? min(n.z, -1e-3) : max(n.z, 1e-3));
  return sun_lux * cosine * reached(p, slope) * texture(sun_passed, p.xy).rgb;
}`;

const sun_near_program = `
precision highp float;
precision highp sampler2D;
out vec4 pixel;
#ifdef WITH_PICTURE
in vec2 at;
uniform sampler2D picture;
uniform bool is_there;
#endif
void main() {
#ifdef WITH_PICTURE
  if (is_there && texture(picture, at).a < 0.5) discard;
#endif
  float near = 1.0 - gl_FragCoord.z;
  vec3 bytes = fract(near * vec3(1.0, 255.0, 65025.0));
  pixel = vec4(bytes - bytes.yzz * vec3(1.0 / 255.0, 1.0 / 255.0, 0.0), 1.0);
}`;

const sun_near_vertex_program = `
#ifdef WITH_PICTURE
in vec2 place;
out vec2 at;
#endif
void main() {
#ifdef WITH_PICTURE
  at = place;
#endif
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const sun_pane_vertex_program = `
in vec3 passed;
out vec3 share;
void main() {
  share = passed;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

const sun_pane_program = `
precision highp float;
in vec3 share;
out vec4 pixel;
void main() { pixel = vec4(share, 1.0); }`;

/** three.js' numbers: blending by factors of its own, 0 and the source's colour as factors. */
const own_blending = 5, factor_zero = 200, factor_source = 202;

/** Transmittance of a pane, as rows of red, green and blue at even cosines. */
function pane_passes({steps, transmittance}, pane, cosine) {
  const table = transmittance[pane], place = Math.min(1, Math.abs(cosine)) * steps, low = Math.min(steps - 1, Math.floor(place));
  return [0, 1, 2].map((c) => {
    const a = table[3 * low + c], b = table[3 * low + 3 + c];
    return a + (place - low) * (b - a);
  });
}

/** What the sun's rays meet, and readings of the sun. Directions are the page's. */
class Sunlight {
  constructor(model, renderer) {
    this.model = model;
    this.renderer = renderer;
    this.about = model.about.year.panes;
    this.camera = camera_with_span(1);
    this.map_size = Math.hypot(...model.about.size) > large_model ? large_map_size : usual_map_size;
    const target = () => new Library.WebGLRenderTarget(this.map_size, this.map_size);
    this.near = target();
    this.passed = target();
    this.near.texture.minFilter = this.near.texture.magFilter = nearest;
    this.uniforms = {
      sun: {value: [0, 1, 0, 0]}, sun_lux: {value: [0, 0, 0]}, to_sun: {value: new Library.Matrix4()},
      from_sun: {value: new Array(9).fill(0)}, sun_slack: {value: 0},
      sun_near: {value: this.near.texture}, sun_passed: {value: this.passed.texture},
    };
    this.scene = new Library.Scene();
    this.panes = this.make_panes();
  }

  /** Triangles of what stops the sun's rays: `pictured(p)` makes the uniforms of a picture with holes. */
  add_casters(position, place, pictured) {
    const {model} = this, groups = new Map();
    for (let t = 0; t < model.face_of_triangle.length; ++t) {
      const face = model.face_of_triangle[t];
      if (model.pane[face] !== 0) continue;
      const {picture} = model.about.parts[model.part_of_face[face]];
      const key = picture >= 0 && model.about.pictures[picture].has_holes ? picture : -1;
      if (!groups.has(key)) groups.set(key, []);
      groups.get(key).push(...model.triangles.subarray(3 * t, 3 * t + 3));
    }
    for (const [picture, triangles] of groups) {
      const geometry = new Library.BufferGeometry();
      geometry.setAttribute('position', position);
      if (picture >= 0) geometry.setAttribute('place', place);
      geometry.setIndex(new Library.BufferAttribute(Uint32Array.from(triangles), 1));
      this.add(geometry, new Library.ShaderMaterial({
        glslVersion: Library.GLSL3, vertexShader: sun_near_vertex_program, fragmentShader: sun_near_program,
        uniforms: picture >= 0 ? pictured(picture) : {}, defines: picture >= 0 ? {WITH_PICTURE: 1} : {}, side: Library.DoubleSide}));
    }
  }

  add(geometry, material) {
    const mesh = new Library.Mesh(geometry, material);
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    return mesh;
  }

  /** Each place of a pane once, with what it passes of the sun's light. */
  make_panes() {
    const {model} = this, corners = [], numbers = [];
    for (let t = 0; t < model.face_of_triangle.length; ++t) {
      const pane = model.pane[model.face_of_triangle[t]];
      if (pane === 0 || pane === other_side_of_pane) continue;
      for (let c = 0; c < 3; ++c) {
        const v = 3 * model.triangles[3 * t + c];
        corners.push(model.positions[v], model.positions[v + 1], model.positions[v + 2]);
      }
      numbers.push(pane - 1);
    }
    if (numbers.length === 0) return null;
    const geometry = new Library.BufferGeometry(), positions = Float32Array.from(corners);
    geometry.setAttribute('position', new Library.BufferAttribute(positions, 3));
    geometry.setAttribute('passed', new Library.BufferAttribute(new Float32Array(positions.length), 3));
    const mesh = this.add(geometry, new Library.ShaderMaterial({
      glslVersion: Library.GLSL3, vertexShader: sun_pane_vertex_program, fragmentShader: sun_pane_program, side: Library.DoubleSide,
      transparent: true, depthWrite: false, blending: own_blending, blendSrc: factor_zero, blendDst: factor_source}));
    mesh.visible = false;
    const at = (i) => new Library.Vector3().fromArray(positions, 3 * i);
    const normals = numbers.map((_, t) => {
      const p = at(3 * t);
      return at(3 * t + 1).sub(p).cross(at(3 * t + 2).sub(p)).normalize();
    });
    return {mesh, numbers, normals};
  }

  /** The sun has moved to `direction`, or its light, lx across the rays, has changed. */
  shine(direction, lux) {
    const {sun, sun_lux} = this.uniforms, is_up = lux.some((x) => x > 0);
    const [x, y, z] = sun.value, moved = x !== direction.x || y !== direction.y || z !== direction.z;
    sun.value = [direction.x, direction.y, direction.z, is_up ? 1 : 0];
    sun_lux.value = lux;
    if (is_up && (moved || !this.is_drawn)) this.due = true;
  }

  /** The map covers all of the model as closely as the sun's direction allows. */
  aim() {
    const {camera, model: {about: {size}}, uniforms} = this, direction = new Library.Vector3(...uniforms.sun.value.slice(0, 3));
    const middle = new Library.Vector3(...size).multiplyScalar(0.5);
    camera.up.set(0, Math.abs(direction.y) > 0.99 ? 0 : 1, Math.abs(direction.y) > 0.99 ? 1 : 0);
    camera.position.copy(middle).add(direction);
    camera.lookAt(middle);
    camera.updateMatrixWorld();
    const box = new Library.Box3(), to_camera = camera.matrixWorld.clone().invert();
    for (let i = 0; i < 8; ++i) {
      box.expandByPoint(new Library.Vector3(...size.map((x, c) => (i >> c & 1) * x)).applyMatrix4(to_camera));
    }
    const margin = 1e-3 * Math.hypot(...size), {min, max} = box;
    camera.span = max.y - min.y + 2 * margin;
    camera.aspect = (max.x - min.x + 2 * margin) / camera.span;
    const shift = new Library.Vector3((min.x + max.x) / 2, (min.y + max.y) / 2, max.z + margin).applyQuaternion(camera.quaternion);
    camera.position.add(shift);
    camera.near = 0;
    camera.far = max.z - min.z + 2 * margin;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    const texel = Math.max(camera.span, camera.span * camera.aspect) / this.map_size;
    uniforms.sun_slack.value = (0.02 * texel + 2e-6 * camera.far) / camera.far;
    const half = new Library.Matrix4().set(0.5, 0, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 1);
    uniforms.to_sun.value.copy(half).multiply(camera.projectionMatrix).multiply(camera.matrixWorld.clone().invert());
    const {elements} = uniforms.to_sun.value.clone().invert();
    uniforms.from_sun.value = [0, 1, 2, 4, 5, 6, 8, 9, 10].map((i) => elements[i]);  // by columns
  }

  /** Draws the maps anew where the sun has moved. */
  draw() {
    if (!this.due) return;
    this.due = false;
    this.is_drawn = true;
    this.aim();
    const {renderer, scene, camera, panes} = this, casters = scene.children.filter((mesh) => mesh !== panes?.mesh);
    const render = (target, colour) => {
      renderer.setClearColor(colour, 1);
      renderer.setRenderTarget(target);
      renderer.clear();
      renderer.render(scene, camera);
    };
    render(this.near, 0x000000);
    // Surfaces between panes and the sun hide the panes from the map, too: rays of the sun end there.
    if (panes) {
      this.weigh_panes();
      panes.mesh.visible = true;
      for (const {material} of casters) material.colorWrite = false;
      render(this.passed, 0xffffff);
      for (const {material} of casters) material.colorWrite = true;
      panes.mesh.visible = false;
    } else if (!this.is_clear) {
      for (const mesh of casters) mesh.visible = false;
      render(this.passed, 0xffffff);
      for (const mesh of casters) mesh.visible = true;
      this.is_clear = true;
    }
    renderer.setClearColor(0x000000, 1);
    renderer.setRenderTarget(null);
  }

  weigh_panes() {
    const {panes: {mesh, numbers, normals}, uniforms} = this, {passed} = mesh.geometry.attributes;
    const direction = new Library.Vector3(...uniforms.sun.value.slice(0, 3));
    numbers.forEach((pane, t) => {
      const share = pane_passes(this.about, pane, normals[t].dot(direction));
      for (let c = 0; c < 3; ++c) passed.array.set(share, 9 * t + 3 * c);
    });
    passed.needsUpdate = true;
  }

  /** Sunlight on a face at a point, lx of red, green and blue, by a ray to the middle of the sun. */
  at(tree, face, point) {
    const {model, uniforms} = this, [x, y, z, shines] = uniforms.sun.value, direction = new Library.Vector3(x, y, z);
    const corner = (c) => model.corner(face, c);
    const normal = corner(1).sub(corner(0)).cross(corner(2).sub(corner(0))).normalize(), cosine = normal.dot(direction);
    if (!shines || !(cosine > 0)) return [0, 0, 0];
    const least = 1e-4 * Math.hypot(...model.about.size);
    const ray = new Library.Ray(point.clone().addScaledVector(normal, least), direction);
    let share = uniforms.sun_lux.value.map((lux) => lux * cosine);
    for (const hit of tree.raycast(ray, Library.DoubleSide)) {
      const pane = model.pane[model.face_of_triangle[hit.faceIndex]];
      if (pane === 0) return [0, 0, 0];
      if (pane === other_side_of_pane) continue;
      const passed = pane_passes(this.about, pane - 1, hit.face.normal.dot(direction));
      share = share.map((lux, c) => lux * passed[c]);
    }
    return share;
  }
}
