// Spheres: their faces split finer, on the sphere itself, so that they look round.

/** A chord of 1/128 of the circle is off it by 3e-4 of the radius: a tenth of a pixel where the sphere is 600 wide. */
const pieces_around = 128;
/** Of all spheres together; very many are left coarser. */
const most_fine_faces = 1e5;

/**
 * A face of three or four corners in pieces, n along an edge: `weights` of the corners at each point, `faces` of points in
 * the same sense of rotation, and `arcs`, pairs of points along the face's own edges.
 */
function split_face(corners, n) {
  const weights = [], faces = [], arcs = [], number = new Map();
  const is_quad = corners === 4, last = (j) => (is_quad ? n : n - j);
  for (let j = 0; j <= n; ++j) {
    for (let i = 0; i <= last(j); ++i) {
      const s = i / n, t = j / n;
      number.set(`${i},${j}`, weights.length);
      weights.push(is_quad ? [(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t] : [1 - s - t, s, t]);
    }
  }
  const at = (i, j) => number.get(`${i},${j}`);
  for (let j = 0; j < n; ++j) {
    for (let i = 0; i < last(j); ++i) {
      if (is_quad) {
        faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        continue;
      }
      faces.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
      if (i + j + 1 < n) faces.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
  }
  for (let k = 0; k < n; ++k) {
    arcs.push([at(k, 0), at(k + 1, 0)], [at(0, k), at(0, k + 1)]);
    if (is_quad) arcs.push([at(n, k), at(n, k + 1)], [at(k, n), at(k + 1, n)]);
    else arcs.push([at(n - k, k), at(n - k - 1, k + 1)]);
  }
  return {weights, faces, arcs};
}

/** How many pieces each edge of each sphere's faces gets, by part; 1: it is left as it is. */
function sphere_pieces(model) {
  const {parts} = model.about, wanted = new Map();
  let faces = 0;
  for (const part of parts.filter(({sphere}) => sphere)) {
    let longest = 0;
    for (let f = part.first_face; f < part.first_face + part.face_count; ++f) {
      for (let c = 0; c < model.corner_count(f); ++c) {
        const next = model.corner(f, (c + 1) % model.corner_count(f));
        longest = Math.max(longest, model.corner(f, c).distanceTo(next));
      }
    }
    wanted.set(part, Math.ceil(longest / part.sphere.radius * pieces_around / (2 * Math.PI)));
    faces += part.face_count;
  }
  const afforded = Math.max(1, Math.floor(Math.sqrt(most_fine_faces / Math.max(1, faces))));
  return new Map([...wanted].map(([part, n]) => [part, Math.min(n, afforded)]));
}

/**
 * Puts finer faces in place of the spheres', with vertices of their own after the model's: their light is that of the face's
 * corners, as it is seen at the same place of the face. Numbers the parts' faces anew. `model.arcs` keeps the
 * outlines of the faces that were split, `model.is_split` tells which faces are pieces.
 */
function split_spheres(model) {
  const {about} = model, pieces = sphere_pieces(model);
  model.arcs = [];
  model.is_split = null;
  if (pieces.size === 0) return;
  const positions = [], sources = [], corners = [], black_behind = [], is_split = [], within = [], pane = [];
  const none = 0xffffffff, first_new = about.vertex_count;
  for (const part of about.parts) {
    const {first_face, face_count} = part, n = pieces.get(part) ?? 1;
    part.first_face = black_behind.length;
    for (let f = first_face; f < first_face + face_count; ++f) {
      const own = [...model.corners.subarray(4 * f, 4 * f + 4)], count = model.corner_count(f);
      if (n === 1) {
        corners.push(...own);
        black_behind.push(model.black_behind[f]);
        within.push(model.within?.[f]);
        pane.push(model.pane?.[f]);
        is_split.push(0);
        continue;
      }
      const center = new Library.Vector3(...part.sphere.center), {weights, faces, arcs} = split_face(count, n);
      const first = first_new + sources.length;
      for (const w of weights) {
        const at = new Library.Vector3();
        w.forEach((share, c) => at.addScaledVector(model.corner(f, c), share));
        at.sub(center).setLength(part.sphere.radius).add(center);
        positions.push(at.x, at.y, at.z);
        sources.push({own, w});
      }
      for (const face of faces) {
        corners.push(...face.map((p) => first + p), ...(face.length === 3 ? [none] : []));
        black_behind.push(model.black_behind[f]);
        within.push(model.within?.[f]);
        pane.push(model.pane?.[f]);
        is_split.push(1);
      }
      for (const [from, to] of arcs) model.arcs.push(first + from, first + to);
    }
    part.face_count = black_behind.length - part.first_face;
  }
  about.vertex_count += sources.length;
  about.face_count = black_behind.length;
  model.corners = Uint32Array.from(corners);
  model.black_behind = Uint8Array.from(black_behind);
  model.is_split = Uint8Array.from(is_split);
  if (model.pane) model.pane = Uint8Array.from(pane);
  if (model.within) model.within = Float32Array.from(within);
  const longer = (values, more) => {
    const all = new Float32Array(values.length + more.length);
    all.set(values);
    all.set(more, values.length);
    return all;
  };
  // What vertices have, so many numbers each, at the new ones.
  const blend = (values, size) => longer(values, sources.flatMap(({own, w}) => Array.from({length: size}, (_, k) =>
    w.reduce((sum, share, c) => sum + share * values[size * own[c] + k], 0))));
  model.positions = longer(model.positions, positions);
  for (const basis of model.bases) {
    basis.radiance = blend(basis.radiance, 3);
    basis.illuminance = blend(basis.illuminance, 3);
  }
  if (about.year) {
    model.terms_of_light = blend(model.terms_of_light, about.year.bands * about.year.terms);
    model.reflectance = blend(model.reflectance, 3);
  }
  if (model.places) {
    model.places = blend(model.places, 2);
    model.picture_gain = blend(model.picture_gain, 3);
  }
}
