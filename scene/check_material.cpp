#include "scene/check_material.h"

#include <fmt/format.h>

#include "scene/coat.h"
#include "scene/errors.h"
#include "scene/limits.h"
#include "scene/material_at.h"
#include "scene/specular.h"

namespace lightwell {
namespace {

void check_share(const Scene& scene, const Material& material, const char* what,
                 const Spectrum& values) {
  if (values.size() != scene.bands.count()) {
    refuse_scene(scene, fmt::format("material '{}': {} has {} bands, the scene has {}",
                                    material.name, what, values.size(), scene.bands.count()));
  }
  for (int k = 0; k < values.size(); ++k) {
    if (!(values[k] >= 0.0f && values[k] <= 1.0f)) {
      refuse_scene(scene,
                   fmt::format("material '{}': {} is {} in band {}; it must lie between 0 and 1",
                               material.name, what, values[k], scene.bands.names[k]));
    }
  }
}

void check_roughness(const Scene& scene, const Material& material, float roughness) {
  if (!(roughness >= 0.0f && roughness <= 1.0f)) {
    refuse_scene(scene,
                 fmt::format("material '{}': roughness is {}; it must lie between 0 (smooth) and 1",
                             material.name, roughness));
  }
}

void check_dielectric(const Scene& scene, const Material& m, const Dielectric& glass) {
  check_share(scene, m, "dielectric tint", glass.tint);
  check_roughness(scene, m, glass.roughness);
  const float index = glass.index_of_refraction;
  if (!(index >= lowest_index && index <= highest_index)) {
    refuse_scene(
        scene,
        fmt::format("material '{}': index of refraction {}; it is that behind the surface over "
                    "that before it and must lie between {} and {} (glass: 1.5)",
                    m.name, index, lowest_index, highest_index));
  }
  if (glass.transmissivity.size() > 0) {
    check_share(scene, m, "transmissivity", glass.transmissivity);
    if (!glass.thin) {
      refuse_scene(
          scene, fmt::format("material '{}' has a transmissivity, which only a thin pane has; make "
                             "it thin, or give it an absorption instead",
                             m.name));
    }
  }
  if (glass.absorption.size() == 0) return;
  if (glass.absorption.size() != scene.bands.count()) {
    refuse_scene(scene, fmt::format("material '{}': absorption has {} bands, the scene has {}",
                                    m.name, glass.absorption.size(), scene.bands.count()));
  }
  for (int k = 0; k < glass.absorption.size(); ++k) {
    if (!(glass.absorption[k] >= 0.0f && glass.absorption[k] <= highest_absorption)) {
      refuse_scene(
          scene,
          fmt::format("material '{}': absorption is {} per metre in band {}; it must lie "
                      "between 0 and {:g}",
                      m.name, glass.absorption[k], scene.bands.names[k], highest_absorption));
    }
  }
  if (glass.thin && (glass.absorption > 0.0f).any()) {
    refuse_scene(scene,
                 fmt::format("material '{}' is a thin pane, in which light goes no distance to be "
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
    refuse_scene(scene,
                 fmt::format("material '{}' is a dielectric and has a transmittance; remove one: a "
                             "clear surface passes light by Fresnel's equations",
                             m.name));
  }
  if (m.one_sided) {
    refuse_scene(scene,
                 fmt::format("material '{}' has a transmittance and one side; a sheet that passes "
                             "light needs both sides",
                             m.name));
  }
}

void check_pictures(const Scene& scene, const Material& m) {
  if (m.texture) {
    if (scene.bands.wavelengths_nm.empty() && scene.bands.count() != 3) {
      refuse_scene(scene,
                   fmt::format("material '{}' has a texture, whose colours are r, g and b, but the "
                               "scene has other bands without wavelengths; give it a reflectance "
                               "alone",
                               m.name));
    }
    if (!m.texture->image.picture) {
      refuse_scene(scene, fmt::format("material '{}' has a texture without a picture", m.name));
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
      refuse_scene(scene,
                   fmt::format("material '{}': where its texture is brightest, reflectance {} + "
                               "specular and transmitted {} exceed 1; lower one",
                               m.name, brightest.maxCoeff(), others.maxCoeff()));
    }
    if (m.dielectric) {
      refuse_scene(
          scene, fmt::format("material '{}' is a dielectric and has a texture; remove one: a clear "
                             "surface has no diffuse reflectance",
                             m.name));
    }
  }
  if (m.emission_texture) {
    if (scene.bands.count() != 3 || !scene.bands.wavelengths_nm.empty()) {
      refuse_scene(
          scene, fmt::format("material '{}' has a picture of emission, whose colours are r, g and "
                             "b, but the scene has other bands; give it an emission alone",
                             m.name));
    }
    if (!m.emission_texture->image.picture) {
      refuse_scene(
          scene, fmt::format("material '{}' has a picture of emission without a picture", m.name));
    }
    check_light(scene, fmt::format("material '{}'", m.name), "factor of the picture of emission",
                "W/m^2", m.emission_texture->factor);
    if (m.dielectric || m.mask) {
      refuse_scene(scene,
                   fmt::format("material '{}' has a picture of emission and is a dielectric or has "
                               "holes; remove one",
                               m.name));
    }
  }
  if (m.relief) {
    const double most = m.relief->is_in_metres ? most_relief_depth : most_relief_scale;
    if (!m.relief->slopes.picture) {
      refuse_scene(scene, fmt::format("material '{}' has a relief without a picture", m.name));
    }
    if (!(std::abs(m.relief->scale) <= most) || !(m.relief->steepest > 0.0)) {
      refuse_scene(scene,
                   fmt::format("material '{}' has a relief of the scale {}; it must lie between {} "
                               "and {}",
                               m.name, m.relief->scale, -most, most));
    }
  }
  if (!m.mask) return;
  if (!m.mask->image.picture || !(m.mask->cutoff > 0.0f && m.mask->cutoff <= 1.0f)) {
    refuse_scene(
        scene, fmt::format("material '{}': a mask needs a picture, and a cutoff above 0 and up to "
                           "1",
                           m.name));
  }
  if (m.is_emitter()) {
    refuse_scene(scene,
                 fmt::format("material '{}' emits light and has a mask; remove one: lamps have no "
                             "holes",
                             m.name));
  }
}

void check_pattern(const Scene& scene, const Material& m) {
  if (!m.pattern) return;
  const SurfacePattern& pattern = *m.pattern;
  for (const ShareTexture* share : pictures_of(pattern)) {
    if (!share->image.picture || !(share->factor >= 0.0f && share->factor <= 1.0f)) {
      refuse_scene(scene,
                   fmt::format("material '{}': a picture of a share or roughness needs a picture, "
                               "and a factor between 0 and 1",
                               m.name));
    }
  }
  if (m.dielectric) {
    if (pictures_of(pattern).size() == (pattern.roughness ? 1u : 0u)) return;
    refuse_scene(scene,
                 fmt::format("material '{}' is a dielectric, of which only the roughness may vary "
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
    refuse_scene(scene,
                 fmt::format("material '{}' has a pattern whose shares exceed 1, or whose metal or "
                             "coat is incomplete; make it by set_pattern()",
                             m.name));
  }
}

void check_coat(const Scene& scene, const Material& m) {
  if (!m.coat) return;
  const Spectrum& bare = m.coat->bare;
  if (bare.size() > 0) check_share(scene, m, "bare metal beside a coat", bare);
  if (!(m.coat->cover >= 0.0f && m.coat->cover <= 1.0f)) {
    refuse_scene(scene,
                 fmt::format("material '{}' has a coat that covers {} of its base; it must lie "
                             "between 0 and 1",
                             m.name, m.coat->cover));
  }
  const float index = m.coat->index_of_refraction;
  if (!(index >= lowest_coat_index && index <= highest_index)) {
    refuse_scene(scene,
                 fmt::format("material '{}' has a coat of the index of refraction {}; it must lie "
                             "between {} and {} (lacquer: 1.5)",
                             m.name, index, lowest_coat_index, highest_index));
  }
  if (m.dielectric) {
    refuse_scene(scene,
                 fmt::format("material '{}' is a dielectric and has a coat; remove one: a clear "
                             "surface has no base",
                             m.name));
  }
}

void check_metal(const Scene& scene, const Material& m) {
  if (!m.metal) return;
  for (const Spectrum* part : {&m.metal->eta, &m.metal->k}) {
    if (part->size() != scene.bands.count() ||
        !((*part >= 0.0f) && (*part <= highest_metal_index)).all()) {
      refuse_scene(
          scene, fmt::format("material '{}' is a metal; eta and k must be one number between 0 and "
                             "{} per band",
                             m.name, highest_metal_index));
    }
  }
  // Metals mirror nearly all of grazing light.
  constexpr float rounding = 1e-5f;
  const Spectrum others = mean_sent_on(m) - mean_mirrored(m);
  if (!((others + m.specular) <= 1.0f + rounding).all()) {
    refuse_scene(scene,
                 fmt::format("material '{}' is a metal; its specular factor {:.4g} and what it "
                             "scatters and passes besides, {:.4g}, must add up to at most 1",
                             m.name, m.specular.maxCoeff(), others.maxCoeff()));
  }
  if (m.dielectric || m.coat) {
    refuse_scene(scene, fmt::format("material '{}' is a metal and has {}; remove one", m.name,
                                    m.coat ? "a coat" : "a dielectric"));
  }
}

}  // namespace

void refuse_scene(const Scene& scene, const std::string& what) {
  throw InputError(scene.file.empty() ? what : fmt::format("{}: {}", scene.file.string(), what));
}

void check_light(const Scene& scene, const std::string& of, const char* what, const char* unit,
                 const Spectrum& values) {
  if (values.size() != scene.bands.count() || !(values >= 0.0f).all() || !values.isFinite().all()) {
    refuse_scene(scene, fmt::format("{}: {} must be one finite number >= 0 per band", of, what));
  }
  const float most = values.maxCoeff();
  if (most > most_light || (most > 0.0f && most < least_light)) {
    refuse_scene(scene, fmt::format("{}: {} is {:g} {}; it must lie between {:g} and {:g}, or be 0",
                                    of, what, most, unit, least_light, most_light));
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
      refuse_scene(
          scene,
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
      refuse_scene(
          scene,
          fmt::format("material '{}' is a dielectric and also has a diffuse or mirror reflectance; "
                      "remove one: a clear surface reflects by Fresnel's law alone",
                      m.name));
    }
  }
  check_light(scene, fmt::format("material '{}'", m.name), "emission", "W/m^2", m.emission);
  check_pictures(scene, m);
  check_pattern(scene, m);
}

}  // namespace lightwell
