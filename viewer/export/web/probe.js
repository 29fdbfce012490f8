// Reading numbers off a surface.

/**
 * Weights of a face's corners at a point in it: barycentric in triangles, bilinear in quads, as 'lightwell probe
 * --interpolate' has them.
 */
function weights_at(model, face, point) {
  const p0 = model.corner(face, 0), p1 = model.corner(face, 1), p2 = model.corner(face, 2);
  const e = p1.clone().sub(p0), q = point.clone().sub(p0);
  if (model.corner_count(face) === 3) {
    const f = p2.clone().sub(p0), normal = e.clone().cross(f), area = normal.lengthSq();
    const b = q.clone().cross(f).dot(normal) / area, c = e.clone().cross(q).dot(normal) / area;
    return [1 - b - c, b, c];
  }
  // p = p0 + s e + t f + s t g; without s, a quadratic for t (in the plane, x being the cross product).
  const p3 = model.corner(face, 3), f = p3.clone().sub(p0), g = p2.clone().sub(p1).sub(f);
  const normal = p2.clone().sub(p0).cross(p3.clone().sub(p1)).normalize();
  const x = (a, b) => a.clone().cross(b).dot(normal);
  const k2 = x(f, g), k1 = x(f, e) - x(q, g), k0 = -x(q, e);
  // The root with |t| small; written so that a parallelogram (k2 = 0) divides by no difference.
  const root = Math.sqrt(Math.max(0, k1 * k1 - 4 * k2 * k0));
  const half = -0.5 * (k1 + (k1 < 0 ? -root : root));
  const roots = [k0 / half, half / k2].filter(Number.isFinite);
  const outside = (t) => Math.max(0, -t, t - 1);
  const t = Math.min(1, Math.max(0, roots.sort((a, b) => outside(a) - outside(b))[0] ?? 0));
  const along = e.clone().addScaledVector(g, t);
  const s = Math.min(1, Math.max(0, q.clone().addScaledVector(f, -t).dot(along) / along.lengthSq()));
  return [(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t];
}

/**
 * Light on a face at a point: illuminance (lx) and the bound of its error (null: not known), luminance (cd/m^2), radiosity (linear
 * RGB; W/m^2 of RGB bands).
 */
function light_at(model, face, point) {
  const weights = weights_at(model, face, point), radiance = [0, 0, 0], place = [0, 0], gain = [0, 0, 0];
  const reflectance = [0, 0, 0];
  let illuminance = 0;
  const texel_at = model.kept_pictures?.[model.about.parts[model.part_of_face[face]].picture];
  weights.forEach((w, c) => {
    const v = model.corners[4 * face + c];
    const {E, L} = model.light_of_vertex(v);
    for (let k = 0; k < 3; ++k) {
      illuminance += w * E[k];
      radiance[k] += w * L[k];
      if (model.moment) reflectance[k] += w * model.reflectance[3 * v + k];
    }
    if (!texel_at) return;
    for (let k = 0; k < 2; ++k) place[k] += w * model.places[2 * v + k];
    for (let k = 0; k < 3; ++k) gain[k] += w * model.picture_gain[3 * v + k];
  });
  let sunlight = 0;
  if (model.moment) {
    const {E, L} = model.shown_light(model.moment.sun_on(face, point), reflectance);
    sunlight = E[0] + E[1] + E[2];
    illuminance += sunlight;
    L.forEach((x, k) => { radiance[k] += x; });
  }
  // A patch has the mean of its picture; here it is what is seen.
  if (texel_at) texel_at(...place).forEach((rho, k) => { radiance[k] *= gain[k] * rho; });
  const Y = model.about.luminance_weights.reduce((sum, weight, k) => sum + weight * radiance[k], 0);
  const within = model.within && model.is_as_solved() ? model.within[face] : null;
  return {illuminance, sunlight, within, luminance: model.about.lumens_per_watt * Y, radiosity: radiance.map((L) => Math.PI * L)};
}

/** What a ray meets first of what is drawn; glass is looked through. Null: nothing. */
function pick(model, tree, ray, looks_through) {
  const hits = tree.raycast(ray, Library.DoubleSide).sort((a, b) => a.distance - b.distance);
  for (const hit of hits) {
    const face = model.face_of_triangle[hit.faceIndex];
    if (model.is_glass(face)) continue;
    if (hit.face.normal.dot(ray.direction) < 0) return {face, point: hit.point, is_black: false};
    if (model.black_behind[face] && !looks_through) return {face, point: hit.point, is_black: true};
  }
  return null;
}

/** Four digits at most, and no more than people read. */
function digits(x) {
  return number_text(x, Math.abs(x) >= 9999.5 ? {maximumFractionDigits: 0} : {maximumSignificantDigits: 4});
}

/** A coordinate to a ten-thousandth of the model's size. */
function coordinate(x, about) {
  const size = Math.hypot(...about.size) / about.metres_per_unit;
  const decimals = Math.min(20, Math.max(0, 4 - Math.floor(Math.log10(size))));
  return Number(x.toFixed(decimals)) || 0;  // no -0
}

/** The reading as an element's content; numbers also as data-... attributes, for scripts. */
function show_reading(model, hit, element) {
  element.replaceChildren();
  for (const key of Object.keys(element.dataset)) delete element.dataset[key];
  if (!hit) return;
  const {about} = model, part = about.parts[model.part_of_face[hit.face]], at = model.to_scene(hit.point);
  const name = document.createElement('span'), bracketed = (key) => ` (${text(key)})`;
  name.textContent = part.name + (part.is_back !== hit.is_black ? bracketed('back') : '');
  const coordinates = at.map((x) => number_text(coordinate(x, about), {maximumFractionDigits: 20}));
  const place = `${text('at')} ${coordinates.join(' / ')} ${about.unit_name}`;
  Object.assign(element.dataset, {surface: part.name, x: at[0], y: at[1], z: at[2]});
  if (hit.is_black) {
    element.append(name, `\n${text('no_light')}\n${place}`);
    return;
  }
  const light = light_at(model, hit.face, hit.point), relative = about.relative_units;
  Object.assign(element.dataset, {illuminance: light.illuminance, luminance: light.luminance,
    radiosity: light.radiosity.join(' ')});
  if (model.moment) element.dataset.sunlight = light.sunlight;
  const lux = document.createElement('b');
  const within = light.within === null ? '' : ` ± ${number_text(light.within, {maximumSignificantDigits: 2})}`;
  if (light.within !== null) element.dataset.within = light.within;
  lux.textContent = `${digits(light.illuminance)}${within} ${relative ? bracketed('relative') : 'lx'}`;
  const kind = about.materials[part.material].kind;
  // Of many bands the page has only their colour, which is no power.
  const radiosity = about.is_spectral ? ''
    : `, ${text('radiosity_is')} ${light.radiosity.map(digits).join(' ')}${relative ? '' : ' W/m²'} (r g b)`;
  element.append(lux, '  ', name, kind === 'mirror' ? bracketed('mirror') : '',
    `\n${text('luminance_is')} ${digits(light.luminance)}${relative ? '' : ' cd/m²'}${radiosity}\n${place}`);
}
