#include <bit>

#include "scene/projected_picture.h"
#include "scene/scene.h"

namespace lightwell {
namespace {

// FNV-1a hash of everything added, byte by byte.
class Hash {
 public:
  void add(std::uint64_t x) {
    for (int byte = 0; byte < 8; ++byte) {
      state_ = (state_ ^ ((x >> (8 * byte)) & 0xffu)) * 0x100000001b3ull;
    }
  }
  void add(double x) {
    add(std::bit_cast<std::uint64_t>(x + 0.0));
  }  // + 0.0: -0 and 0 are one value
  void add(const Eigen::Vector3d& v) {
    for (int c = 0; c < 3; ++c) add(v[c]);
  }
  void add(const Spectrum& s) {
    add(static_cast<std::uint64_t>(s.size()));
    for (float x : s) add(static_cast<double>(x));
  }
  void add(const std::vector<int>& loop) {
    add(static_cast<std::uint64_t>(loop.size()));
    for (int i : loop) add(static_cast<std::uint64_t>(i));
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

// Adds gloss only where there is any, so that solutions of scenes without gloss keep their hash.
// Each kind begins with a word of its own, which no reflectance has.
void add_gloss(const Material& m, Hash& hash) {
  constexpr std::uint64_t rough_mirror = 0x6d17707e, glass_body = 0x61a55b0d,
                          body_of_pane = 0x9a4eb0d1, coat = 0xc0a7ba5e, translucent = 0x7a0d1ff5,
                          straight = 0x57a1647, metal = 0x3e7a1;
  if (m.specular_roughness > 0.0f && m.mirrors()) {
    hash.add(rough_mirror);
    hash.add(static_cast<double>(m.specular_roughness));
  }
  if (m.coat) {
    hash.add(coat);
    hash.add(static_cast<double>(m.coat->index_of_refraction));
    if (m.coat->cover < 1.0f) hash.add(static_cast<double>(m.coat->cover));
    if (m.coat->bare.size() > 0) hash.add(m.coat->bare);
  }
  if (m.metal) {
    hash.add(metal);
    hash.add(m.metal->eta);
    hash.add(m.metal->k);
  }
  if (m.is_translucent()) {
    hash.add(translucent);
    hash.add(m.transmittance);
  }
  if (m.passes_straight()) {
    hash.add(straight);
    hash.add(m.regular_transmittance);
  }
  if (!m.dielectric) return;
  const Dielectric& glass = *m.dielectric;
  if (glass.roughness > 0.0f || glass.thin || (glass.absorption > 0.0f).any()) {
    hash.add(glass_body);
    hash.add(static_cast<double>(glass.roughness));
    hash.add(static_cast<std::uint64_t>(glass.thin));
    hash.add(glass.absorption);
  }
  if (glass.transmissivity.size() > 0) {
    hash.add(body_of_pane);
    hash.add(glass.transmissivity);
  }
}

void add_image(const SurfaceTexture& image, Hash& hash) {
  hash.add(image.picture->hash());
  for (const TextureWrap wrap : image.wrap) hash.add(static_cast<std::uint64_t>(wrap));
  hash.add(static_cast<std::uint64_t>(image.is_smooth));
  for (const double x : image.placement.reshaped()) hash.add(x);
}

void add_pattern(const SurfacePattern& pattern, Hash& hash) {
  constexpr std::uint64_t word = 0x9a77e26u;
  hash.add(word);
  for (const auto* share : {&pattern.roughness, &pattern.metal, &pattern.coat, &pattern.opacity,
                            &pattern.translucency}) {
    hash.add(static_cast<std::uint64_t>(share->has_value()));
    if (!share->has_value()) continue;
    add_image((*share)->image, hash);
    hash.add(static_cast<double>((*share)->factor));
  }
  for (const Spectrum* of : {&pattern.base, &pattern.behind_base, &pattern.passed,
                             &pattern.mirrored, &pattern.metal_color, &pattern.straight}) {
    hash.add(*of);
  }
  hash.add(static_cast<std::uint64_t>(pattern.metal_shows_texture));
}

void add_pictures(const Material& m, Hash& hash) {
  constexpr std::uint64_t texture = 0x7e87u, emission = 0xe3155u, mask = 0x3a5cu;
  if (m.texture) {
    hash.add(texture);
    add_image(m.texture->image, hash);
    hash.add(m.texture->factor);
  }
  if (m.emission_texture) {
    hash.add(emission);
    add_image(m.emission_texture->image, hash);
    hash.add(m.emission_texture->factor);
  }
  if (m.mask) {
    hash.add(mask);
    add_image(m.mask->image, hash);
    hash.add(static_cast<double>(m.mask->cutoff));
  }
  if (m.pattern) add_pattern(*m.pattern, hash);
}

void add_material(const Material& m, Hash& hash) {
  hash.add(m.reflectance);
  hash.add(m.specular);
  hash.add(m.emission);
  hash.add(static_cast<std::uint64_t>(m.one_sided) +
           2 * static_cast<std::uint64_t>(m.emits_both_sides));
  if (m.dielectric) {
    hash.add(static_cast<double>(m.dielectric->index_of_refraction));
    hash.add(m.dielectric->tint);
  }
  add_gloss(m, hash);
  add_pictures(m, hash);
}

// Texture coordinates matter only where the material shows a picture.
void add_uv(const PolygonMesh& mesh, const Material& material, Hash& hash) {
  if (!material.texture && !material.emission_texture && !material.mask && !material.pattern) {
    return;
  }
  for (const UvMap& uv : mesh.uv_maps) {
    for (const double x : uv.gradient.reshaped()) hash.add(x);
    for (const double x : uv.offset) hash.add(x);
  }
  for (const Facet& facet : mesh.facets) hash.add(static_cast<std::uint64_t>(facet.uv_map + 1));
}

// Adds lamps only where there are any, like add_gloss.
void add_lamps(const Scene& scene, Hash& hash) {
  constexpr std::uint64_t lamp_word = 0x1a3b5u;
  for (const Lamp& lamp : scene.lamps) {
    hash.add(lamp_word);
    hash.add(lamp.position);
    for (const double x : lamp.axes.reshaped()) hash.add(x);
    hash.add(lamp.intensity);
    hash.add(static_cast<std::uint64_t>(lamp.shape.index()));
    if (const auto* cone = std::get_if<SpotCone>(&lamp.shape)) {
      hash.add(cone->inner);
      hash.add(cone->outer);
      hash.add(static_cast<std::uint64_t>(cone->edge));
    } else if (const auto* web = std::get_if<SharedWeb>(&lamp.shape)) {
      hash.add(static_cast<std::uint64_t>((*web)->planes().size()));
      for (const double x : (*web)->planes()) hash.add(x);
      for (const double x : (*web)->gammas()) hash.add(x);
      for (const double x : (*web)->values().reshaped()) hash.add(x);
    } else if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
      const auto& [beam, focus, lens, shutters] = (*picture)->optics();
      const auto& [left, right, top, bottom] = shutters;
      hash.add((*picture)->slide().picture().hash());
      for (const double x : {beam, focus, lens, left, right, top, bottom}) hash.add(x);
    }
    hash.add(lamp.opening.along_c0);
    hash.add(lamp.opening.along_c90);
    hash.add(static_cast<std::uint64_t>(lamp.opening.is_round));
  }
}

// Normals decide across which edges light is smooth. Added only where there are any, like gloss.
void add_normals(const PolygonMesh& mesh, Hash& hash) {
  if (mesh.normal_maps.empty()) return;
  constexpr std::uint64_t normals = 0x5a007bu;
  hash.add(normals);
  for (const NormalMap& map : mesh.normal_maps) {
    for (const double x : map.gradient.reshaped()) hash.add(x);
    hash.add(map.offset);
  }
  for (const Facet& facet : mesh.facets) {
    hash.add(static_cast<std::uint64_t>(facet.normal_map + 1));
  }
}

}  // namespace

std::uint64_t material_hash(const Material& material) {
  Hash hash;
  add_material(material, hash);
  return hash.value();
}

static void add_frustum(const Frustum& frustum, Hash& hash) {
  hash.add(frustum.base);
  hash.add(frustum.axis);
  for (const double size : {frustum.height, frustum.base_radius, frustum.top_radius}) {
    hash.add(size);
  }
  hash.add(std::uint64_t{frustum.inward});
}

std::uint64_t scene_hash(const Scene& scene) {
  Hash hash;
  hash.add(scene.bands.lumens_per_watt);
  for (double nm : scene.bands.wavelengths_nm) hash.add(nm);
  for (const Material& m : scene.materials) add_material(m, hash);
  for (const Surface& surface : scene.surfaces) {
    hash.add(static_cast<std::uint64_t>(surface.material));
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      for (const auto& v : mesh->vertices) hash.add(v);
      for (const Facet& facet : mesh->facets) {
        hash.add(facet.boundary);
        for (const auto& hole : facet.holes) hash.add(hole);
      }
      add_uv(*mesh, scene.materials[static_cast<std::size_t>(surface.material)], hash);
      add_normals(*mesh, hash);
    } else if (const auto* sphere = std::get_if<Sphere>(&surface.shape)) {
      hash.add(sphere->center);
      hash.add(sphere->radius);
    } else {
      add_frustum(std::get<Frustum>(surface.shape), hash);
    }
  }
  add_lamps(scene, hash);
  if (scene.sky) hash.add(sky_hash(*scene.sky));
  return hash.value();
}

}  // namespace lightwell
