#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "scene/coat.h"
#include "scene/errors.h"
#include "scene/limits.h"
#include "scene/material_at.h"
#include "scene/projected_picture.h"
#include "scene/round_shape.h"
#include "scene/scene.h"
#include "scene/specular.h"

namespace lightwell {
namespace {

// Least diagonal of a scene, m. Areas of its facets have to be normal floats.
constexpr double smallest_scene = 1e-9;

[[noreturn]] void fail(const Scene& scene, const std::string& what) {
  throw InputError(scene.file.empty() ? what : fmt::format("{}: {}", scene.file.string(), what));
}

void check_share(const Scene& scene, const Material& material, const char* what,
                 const Spectrum& values) {
  if (values.size() != scene.bands.count()) {
    fail(scene, fmt::format("material '{}': {} has {} bands, the scene has {}", material.name, what,
                            values.size(), scene.bands.count()));
  }
  for (int k = 0; k < values.size(); ++k) {
    if (!(values[k] >= 0.0f && values[k] <= 1.0f)) {
      fail(scene, fmt::format("material '{}': {} is {} in band {}; it must lie between 0 and 1",
                              material.name, what, values[k], scene.bands.names[k]));
    }
  }
}

void check_roughness(const Scene& scene, const Material& material, float roughness) {
  if (!(roughness >= 0.0f && roughness <= 1.0f)) {
    fail(scene, fmt::format("material '{}': roughness is {}; it must lie between 0 (smooth) and 1",
                            material.name, roughness));
  }
}

// Refuses light that is no number, below 0, or beyond what floats can add up.
void check_light(const Scene& scene, const std::string& of, const char* what, const char* unit,
                 const Spectrum& values) {
  if (values.size() != scene.bands.count() || !(values >= 0.0f).all() || !values.isFinite().all()) {
    fail(scene, fmt::format("{}: {} must be one finite number >= 0 per band", of, what));
  }
  const float most = values.maxCoeff();
  if (most > most_light || (most > 0.0f && most < least_light)) {
    fail(scene, fmt::format("{}: {} is {:g} {}; it must lie between {:g} and {:g}, or be 0", of,
                            what, most, unit, least_light, most_light));
  }
}

void check_dielectric(const Scene& scene, const Material& m, const Dielectric& glass) {
  check_share(scene, m, "dielectric tint", glass.tint);
  check_roughness(scene, m, glass.roughness);
  const float index = glass.index_of_refraction;
  if (!(index >= lowest_index && index <= highest_index)) {
    fail(scene,
         fmt::format("material '{}': index of refraction {}; it is that behind the surface over "
                     "that before it and must lie between {} and {} (glass: 1.5)",
                     m.name, index, lowest_index, highest_index));
  }
  if (glass.transmissivity.size() > 0) {
    check_share(scene, m, "transmissivity", glass.transmissivity);
    if (!glass.thin) {
      fail(scene,
           fmt::format("material '{}' has a transmissivity, which only a thin pane has; make "
                       "it thin, or give it an absorption instead",
                       m.name));
    }
  }
  if (glass.absorption.size() == 0) return;
  if (glass.absorption.size() != scene.bands.count()) {
    fail(scene, fmt::format("material '{}': absorption has {} bands, the scene has {}", m.name,
                            glass.absorption.size(), scene.bands.count()));
  }
  for (int k = 0; k < glass.absorption.size(); ++k) {
    if (!(glass.absorption[k] >= 0.0f && glass.absorption[k] <= highest_absorption)) {
      fail(scene,
           fmt::format("material '{}': absorption is {} per metre in band {}; it must lie "
                       "between 0 and {:g}",
                       m.name, glass.absorption[k], scene.bands.names[k], highest_absorption));
    }
  }
  if (glass.thin && (glass.absorption > 0.0f).any()) {
    fail(scene, fmt::format("material '{}' is a thin pane, in which light goes no distance to be "
                            "absorbed along; give it a transmissivity or a tint instead of an "
                            "absorption",
                            m.name));
  }
}

bool is_sheet(const Material& m) {
  return m.is_translucent() || m.passes_straight();
}

// Checks the light that passes a thin sheet.
void check_sheet(const Scene& scene, const Material& m) {
  for (const Spectrum* share : {&m.transmittance, &m.regular_transmittance}) {
    if (share->size() > 0) check_share(scene, m, "transmittance", *share);
  }
  if (!is_sheet(m)) return;
  if (m.dielectric) {
    fail(scene, fmt::format("material '{}' is a dielectric and has a transmittance; remove one: a "
                            "clear surface passes light by Fresnel's equations",
                            m.name));
  }
  if (m.one_sided) {
    fail(scene, fmt::format("material '{}' has a transmittance and one side; a sheet that passes "
                            "light needs both sides",
                            m.name));
  }
}

void check_pictures(const Scene& scene, const Material& m) {
  if (m.texture) {
    if (scene.bands.wavelengths_nm.empty() && scene.bands.count() != 3) {
      fail(scene, fmt::format("material '{}' has a texture, whose colours are r, g and b, but the "
                              "scene has other bands without wavelengths; give it a reflectance "
                              "alone",
                              m.name));
    }
    if (!m.texture->image.picture) {
      fail(scene, fmt::format("material '{}' has a texture without a picture", m.name));
    }
    check_share(scene, m, "texture factor", m.texture->factor);
    constexpr float rounding = 1e-5f;
    // In bands of wavelengths no colour reflects more than its largest share.
    const Eigen::Array3f largest = m.texture->image.picture->largest();
    const Spectrum brightest =
        m.texture->factor * (scene.bands.wavelengths_nm.empty()
                                 ? Spectrum(largest)
                                 : constant_spectrum(scene.bands, largest.maxCoeff()));
    const Spectrum others = mean_sent_on(m) - m.reflectance;
    // The shares of a pattern are bounded each, since the brightest paint may lie where there is no
    // metal.
    if (!m.pattern && !((brightest + others) <= 1.0f + rounding).all()) {
      fail(scene, fmt::format("material '{}': where its texture is brightest, reflectance {} + "
                              "specular and transmitted {} exceed 1; lower one",
                              m.name, brightest.maxCoeff(), others.maxCoeff()));
    }
    if (m.dielectric) {
      fail(scene,
           fmt::format("material '{}' is a dielectric and has a texture; remove one: a clear "
                       "surface has no diffuse reflectance",
                       m.name));
    }
  }
  if (m.emission_texture) {
    if (scene.bands.count() != 3 || !scene.bands.wavelengths_nm.empty()) {
      fail(scene, fmt::format("material '{}' has a picture of emission, whose colours are r, g and "
                              "b, but the scene has other bands; give it an emission alone",
                              m.name));
    }
    if (!m.emission_texture->image.picture) {
      fail(scene, fmt::format("material '{}' has a picture of emission without a picture", m.name));
    }
    check_light(scene, fmt::format("material '{}'", m.name), "factor of the picture of emission",
                "W/m^2", m.emission_texture->factor);
    if (m.dielectric || m.mask) {
      fail(scene, fmt::format("material '{}' has a picture of emission and is a dielectric or has "
                              "holes; remove one",
                              m.name));
    }
  }
  if (m.relief) {
    const double most = m.relief->is_in_metres ? most_relief_depth : most_relief_scale;
    if (!m.relief->slopes.picture) {
      fail(scene, fmt::format("material '{}' has a relief without a picture", m.name));
    }
    if (!(std::abs(m.relief->scale) <= most) || !(m.relief->steepest > 0.0)) {
      fail(scene, fmt::format("material '{}' has a relief of the scale {}; it must lie between {} "
                              "and {}",
                              m.name, m.relief->scale, -most, most));
    }
  }
  if (!m.mask) return;
  if (!m.mask->image.picture || !(m.mask->cutoff > 0.0f && m.mask->cutoff <= 1.0f)) {
    fail(scene, fmt::format("material '{}': a mask needs a picture, and a cutoff above 0 and up to "
                            "1",
                            m.name));
  }
  if (m.is_emitter()) {
    fail(scene, fmt::format("material '{}' emits light and has a mask; remove one: lamps have no "
                            "holes",
                            m.name));
  }
}

void check_pattern(const Scene& scene, const Material& m) {
  if (!m.pattern) return;
  const SurfacePattern& pattern = *m.pattern;
  for (const ShareTexture* share : pictures_of(pattern)) {
    if (!share->image.picture || !(share->factor >= 0.0f && share->factor <= 1.0f)) {
      fail(scene, fmt::format("material '{}': a picture of a share or roughness needs a picture, "
                              "and a factor between 0 and 1",
                              m.name));
    }
  }
  if (m.dielectric) {
    if (pictures_of(pattern).size() == (pattern.roughness ? 1u : 0u)) return;
    fail(scene, fmt::format("material '{}' is a dielectric, of which only the roughness may vary "
                            "by a picture; remove the other pictures",
                            m.name));
  }
  check_share(scene, m, "base of the pattern", pattern.base);
  check_share(scene, m, "base of the pattern", pattern.behind_base);
  check_share(scene, m, "mirror of the pattern", pattern.mirrored);
  for (const Spectrum* share : {&pattern.passed, &pattern.metal_color, &pattern.straight}) {
    if (share->size() > 0) check_share(scene, m, "share of the pattern", *share);
  }
  constexpr float rounding = 1e-5f;
  Spectrum front = pattern.base, behind = pattern.behind_base;
  if (pattern.straight.size() > 0) front += pattern.straight;
  if (pattern.straight.size() > 0) behind += pattern.straight;
  if (pattern.passed.size() > 0) behind += pattern.passed;
  const bool adds_up = (front.max(behind) <= 1.0f + rounding).all();
  if (!adds_up || pattern.metal.has_value() != (pattern.metal_color.size() > 0) ||
      m.coat.has_value() != (pattern.coat_levels != nullptr)) {
    fail(scene, fmt::format("material '{}' has a pattern whose shares exceed 1, or whose metal or "
                            "coat is incomplete; make it by set_pattern()",
                            m.name));
  }
}

void check_coat(const Scene& scene, const Material& m) {
  if (!m.coat) return;
  const Spectrum& bare = m.coat->bare;
  if (bare.size() > 0) check_share(scene, m, "bare metal beside a coat", bare);
  if (!(m.coat->cover >= 0.0f && m.coat->cover <= 1.0f)) {
    fail(scene, fmt::format("material '{}' has a coat that covers {} of its base; it must lie "
                            "between 0 and 1",
                            m.name, m.coat->cover));
  }
  const float index = m.coat->index_of_refraction;
  if (!(index >= lowest_coat_index && index <= highest_index)) {
    fail(scene, fmt::format("material '{}' has a coat of the index of refraction {}; it must lie "
                            "between {} and {} (lacquer: 1.5)",
                            m.name, index, lowest_coat_index, highest_index));
  }
  if (m.dielectric) {
    fail(scene, fmt::format("material '{}' is a dielectric and has a coat; remove one: a clear "
                            "surface has no base",
                            m.name));
  }
}

void check_metal(const Scene& scene, const Material& m) {
  if (!m.metal) return;
  for (const Spectrum* part : {&m.metal->eta, &m.metal->k}) {
    if (part->size() != scene.bands.count() ||
        !((*part >= 0.0f) && (*part <= highest_metal_index)).all()) {
      fail(scene,
           fmt::format("material '{}' is a metal; eta and k must be one number between 0 and "
                       "{} per band",
                       m.name, highest_metal_index));
    }
  }
  // Metals mirror nearly all of grazing light.
  constexpr float rounding = 1e-5f;
  const Spectrum others = mean_sent_on(m) - mean_mirrored(m);
  if (!((others + m.specular) <= 1.0f + rounding).all()) {
    fail(scene, fmt::format("material '{}' is a metal; its specular factor {:.4g} and what it "
                            "scatters and passes besides, {:.4g}, must add up to at most 1",
                            m.name, m.specular.maxCoeff(), others.maxCoeff()));
  }
  if (m.dielectric || m.coat) {
    fail(scene, fmt::format("material '{}' is a metal and has {}; remove one", m.name,
                            m.coat ? "a coat" : "a dielectric"));
  }
}

void check_material(const Scene& scene, const Material& m) {
  check_share(scene, m, "reflectance", m.reflectance);
  check_share(scene, m, "specular reflectance", m.specular);
  check_roughness(scene, m, m.specular_roughness);
  check_coat(scene, m);
  check_metal(scene, m);
  constexpr float rounding = 1e-5f;  // decimals of a file that should add up to 1
  check_sheet(scene, m);
  const Spectrum mirrored = mean_mirrored(m), sum = mean_sent_on(m);
  for (int k = 0; k < scene.bands.count(); ++k) {
    if (!(sum[k] <= 1.0f + rounding)) {
      fail(scene,
           fmt::format(
               "material '{}': reflectance {} + specular {}{} = {} in band {}; more light would "
               "leave than arrives, lower one so that they add up to at most 1",
               m.name, m.reflectance[k], mirrored[k],
               is_sheet(m)
                   ? fmt::format(" + transmittance {:.4g}", sum[k] - m.reflectance[k] - mirrored[k])
                   : "",
               sum[k], scene.bands.names[k]));
    }
  }
  if (m.dielectric) {
    check_dielectric(scene, m, *m.dielectric);
    if ((m.reflectance > 0.0f).any() || (m.specular > 0.0f).any()) {
      fail(scene, fmt::format(
                      "material '{}' is a dielectric and also has a diffuse or mirror reflectance; "
                      "remove one: a clear surface reflects by Fresnel's law alone",
                      m.name));
    }
  }
  check_light(scene, fmt::format("material '{}'", m.name), "emission", "W/m^2", m.emission);
  check_pictures(scene, m);
  check_pattern(scene, m);
}

void check_loop(const Scene& scene, const Surface& surface, const PolygonMesh& mesh, int facet,
                const std::vector<int>& loop) {
  if (loop.size() < 3) {
    fail(scene, fmt::format("surface '{}', polygon {}: {} vertices; a polygon needs at least 3",
                            surface.name, facet, loop.size()));
  }
  for (int v : loop) {
    if (v < 0 || v >= static_cast<int>(mesh.vertices.size())) {
      fail(scene, fmt::format("surface '{}', polygon {}: vertex index {} is out of range 0..{}",
                              surface.name, facet, v, mesh.vertices.size() - 1));
    }
  }
}

// Fault of a position, or of a radius as a vector; empty if there is none.
std::string place_fault(const Eigen::Vector3d& p) {
  if (!p.allFinite()) return "a coordinate is not a finite number";
  const double reach = p.cwiseAbs().maxCoeff();
  if (reach <= farthest_coordinate) return {};
  return fmt::format("a coordinate is {:g} m; nothing may lie beyond {:g} m, check the unit", reach,
                     farthest_coordinate);
}

void check_mesh(const Scene& scene, const Surface& surface, const PolygonMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (const std::string what = place_fault(mesh.vertices[v]); !what.empty()) {
      fail(scene, fmt::format("surface '{}', vertex {}: {}", surface.name, v, what));
    }
  }
  for (std::size_t f = 0; f < mesh.facets.size(); ++f) {
    const Facet& facet = mesh.facets[f];
    check_loop(scene, surface, mesh, static_cast<int>(f), facet.boundary);
    for (const auto& hole : facet.holes)
      check_loop(scene, surface, mesh, static_cast<int>(f), hole);
    if (!(facet_area(mesh, facet) > 0.0)) {
      fail(scene,
           fmt::format(
               "surface '{}', polygon {}: its area is zero; remove it or correct its vertices",
               surface.name, f));
    }
    if (facet.uv_map < -1 || facet.uv_map >= static_cast<int>(mesh.uv_maps.size())) {
      fail(scene, fmt::format("surface '{}', polygon {}: its texture coordinates do not exist",
                              surface.name, f));
    }
    if (facet.normal_map < -1 || facet.normal_map >= static_cast<int>(mesh.normal_maps.size())) {
      fail(scene,
           fmt::format("surface '{}', polygon {}: its normals do not exist", surface.name, f));
    }
  }
  for (const NormalMap& map : mesh.normal_maps) {
    if (map.gradient.allFinite() && map.offset.allFinite()) continue;
    fail(scene, fmt::format("surface '{}': its normals are not finite", surface.name));
  }
  for (const UvMap& uv : mesh.uv_maps) {
    if (uv.gradient.allFinite() && uv.offset.allFinite()) continue;
    fail(scene, fmt::format("surface '{}': its texture coordinates are not finite", surface.name));
  }
}

void check_lamp(const Scene& scene, const Lamp& lamp) {
  const auto refuse = [&](const std::string& what) {
    fail(scene, fmt::format("lamp '{}': {}", lamp.name, what));
  };
  if (const std::string what = place_fault(lamp.position); !what.empty()) refuse(what);
  constexpr double rounding = 1e-6;
  const Eigen::Matrix3d& axes = lamp.axes;
  if (!((axes.transpose() * axes - Eigen::Matrix3d::Identity()).norm() < rounding) ||
      !(axes.determinant() > 0.0)) {
    refuse("its axes are no rotation; give three unit vectors at right angles, right-handed");
  }
  check_light(scene, fmt::format("lamp '{}'", lamp.name), "its intensity", "W/sr", lamp.intensity);
  const LampOpening& opening = lamp.opening;
  for (const double size : {opening.along_c0, opening.along_c90}) {
    if (!(size >= 0.0 && std::isfinite(size))) {
      refuse(fmt::format("its opening is {:g} m by {:g} m; neither may be below 0",
                         opening.along_c0, opening.along_c90));
    }
  }
  if (const auto* cone = std::get_if<SpotCone>(&lamp.shape)) {
    if (!(cone->inner >= 0.0 && cone->inner <= cone->outer && cone->outer > 0.0 &&
          cone->outer <= std::numbers::pi)) {
      refuse(
          fmt::format("its cone is {:g} inside and {:g} outside; 0 <= inside <= outside <= pi, "
                      "with outside above 0",
                      cone->inner, cone->outer));
    }
  }
  if (const auto* picture = std::get_if<SharedPicture>(&lamp.shape)) {
    if (!*picture) refuse("its picture is empty");
    if (!opening.is_point()) {
      refuse("it projects a picture and has an opening; such a lamp is a point, so remove one");
    }
    if ((*picture)->in_bands(Eigen::Array3d::Ones()).size() != scene.bands.count()) {
      refuse("its picture is in other bands than the scene");
    }
  }
  const auto* web = std::get_if<SharedWeb>(&lamp.shape);
  if (web && (!*web || (*web)->values().size() == 0)) refuse("its distribution is empty");
}

void check_motion(const Scene& scene, const std::string& what, int motion) {
  if (motion >= -1 && motion < static_cast<int>(scene.motions.size())) return;
  fail(scene, fmt::format("{}: its motion does not exist", what));
}

void check_motions(const Scene& scene) {
  for (const RigidMotion& motion : scene.motions) {
    if (const std::string what = fault(motion); !what.empty()) {
      fail(scene, fmt::format("motion '{}' {}", motion.name, what));
    }
    if (motion.rest_time != scene.motions.front().rest_time) {
      fail(scene,
           fmt::format("motion '{}' rests at another time than '{}'; light is solved for one "
                       "instant",
                       motion.name, scene.motions.front().name));
    }
  }
  for (const Surface& surface : scene.surfaces) {
    check_motion(scene, fmt::format("surface '{}'", surface.name), surface.motion);
    if (surface.motion < 0) continue;
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    if (material.is_emitter()) {
      fail(scene,
           fmt::format("surface '{}' moves and its material '{}' emits light; light of lamps "
                       "that move is not modelled: let the lamp stand still",
                       surface.name, material.name));
    }
  }
  for (const Camera& camera : scene.cameras) {
    check_motion(scene, fmt::format("camera '{}'", camera.name), camera.motion);
  }
}

void check_round(const Scene& scene, const Surface& surface, const RoundShape& shape) {
  const auto* frustum = std::get_if<Frustum>(&shape);
  const auto fault = [&](const std::string& what) {
    fail(scene, fmt::format("{} '{}': {}", frustum ? "frustum" : "sphere", surface.name, what));
  };
  const Sphere ball = ball_around(shape);
  for (const Eigen::Vector3d& p : {ball.center, Eigen::Vector3d::Constant(ball.radius).eval()}) {
    if (const std::string what = place_fault(p); !what.empty()) fault(what);
  }
  if (!frustum) {
    if (ball.radius > 0.0) return;
    fault(fmt::format("its radius is {}; it must be positive", ball.radius));
  }
  for (const double size : {frustum->height, frustum->base_radius, frustum->top_radius}) {
    if (!(size >= 0.0))
      fault(fmt::format("a size is {}; height and radii must be at least 0", size));
  }
  constexpr double rounding = 1e-9;
  if (!(std::abs(frustum->axis.norm() - 1.0) <= rounding)) fault("its axis must have length 1");
  if (!(area(shape) > 0.0)) fault("it has no area; give it a height, or two different radii");
}

}  // namespace

void validate(const Camera& camera) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("camera '{}': {}", camera.name, what));
  };
  if (const std::string what = place_fault(camera.position); !what.empty()) refuse(what);
  constexpr double rounding = 1e-6;
  if (!(std::abs(camera.direction.norm() - 1.0) < rounding) ||
      !(std::abs(camera.up.norm() - 1.0) < rounding) ||
      !(std::abs(camera.direction.dot(camera.up)) < rounding)) {
    refuse("direction and up must be unit vectors at right angles to each other");
  }
  if (const std::string what = projection_fault(camera); !what.empty()) refuse(what);
  if (!(camera.lens_radius >= 0.0 && camera.lens_radius <= farthest_coordinate)) {
    refuse(fmt::format("a lens of radius {} m; it must lie between 0, for a pinhole, and {:g} m",
                       camera.lens_radius, farthest_coordinate));
  }
  if (!(camera.focus_distance >= smallest_scene && camera.focus_distance <= farthest_coordinate)) {
    refuse(fmt::format("it is focused at {} m; the distance must lie between {:g} and {:g} m",
                       camera.focus_distance, smallest_scene, farthest_coordinate));
  }
  if (camera.blades != 0 && (camera.blades < 3 || camera.blades > max_blades)) {
    refuse(fmt::format("an aperture of {} blades; give 3 to {}, or 0 for a round one",
                       camera.blades, max_blades));
  }
  if (!std::isfinite(camera.shutter_open) || !std::isfinite(camera.shutter_close) ||
      !(camera.shutter_open <= camera.shutter_close)) {
    refuse(
        fmt::format("its shutter opens at {:g} s and closes at {:g} s; both must be finite, and it "
                    "must not close before it opens",
                    camera.shutter_open, camera.shutter_close));
  }
}

void validate(const Scene& scene) {
  const int bands = scene.bands.count();
  if (bands < 1 || bands > max_bands) {
    fail(scene, fmt::format("the scene has {} bands; give between 1 and {}", bands, max_bands));
  }
  for (const Material& material : scene.materials) check_material(scene, material);
  for (const Lamp& lamp : scene.lamps) check_lamp(scene, lamp);
  for (const Camera& camera : scene.cameras) {
    try {
      validate(camera);
    } catch (const InputError& error) {
      fail(scene, error.what());
    }
  }
  if (scene.sky) {
    try {
      validate(*scene.sky, scene.bands);
    } catch (const std::invalid_argument& error) {
      fail(scene, error.what());
    }
  }
  for (const Surface& surface : scene.surfaces) {
    if (surface.material < 0 || surface.material >= static_cast<int>(scene.materials.size())) {
      fail(scene, fmt::format("surface '{}' names a material that does not exist", surface.name));
    }
    if (const auto* mesh = std::get_if<PolygonMesh>(&surface.shape)) {
      check_mesh(scene, surface, *mesh);
    } else {
      check_round(scene, surface, *round_shape(surface));
    }
  }
  if (!scene.surfaces.empty()) {
    const double diagonal = scene_bounds(scene).diagonal();
    if (diagonal < smallest_scene) {
      fail(scene,
           fmt::format("all of the scene lies within {:g} m; check the unit: a scene must be "
                       "larger than {:g} m",
                       diagonal, smallest_scene));
    }
  }
  check_motions(scene);
}

}  // namespace lightwell
