#include "scene/specular.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/coat.h"
#include "scene/microfacet.h"
#include "scene/optics.h"
#include "scene/random_purpose.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

double relative_index(const Dielectric& glass, bool from_back) {
  const double index = glass.index_of_refraction;
  return from_back && !glass.thin ? 1.0 / index : index;
}

double reflected_share(const Dielectric& glass, double cos_incident, bool from_back) {
  const double cosine = std::min(1.0, cos_incident);
  const double index = relative_index(glass, from_back);
  return glass.thin ? pane_reflectance(cosine, index) : fresnel_reflectance(cosine, index);
}

// Light of each band relative to that of a clear pane of the same index: what a thin pane sends
// back and what it lets pass, without its tint.
struct BodyShares {
  Spectrum reflected, passed;
};

// The shares at a pane whose body absorbs.
BodyShares body_shares(const Dielectric& pane, double cos_incident) {
  const double cosine = std::min(1.0, cos_incident);
  const double index = double{pane.index_of_refraction};
  const double R = pane_reflectance(cosine, index);
  const Spectrum& t = pane.transmissivity;
  BodyShares shares{Spectrum::Ones(t.size()), Spectrum::Ones(t.size())};
  for (Eigen::Index k = 0; k < t.size(); ++k) {
    if (k > 0 && t[k] == t[k - 1]) {
      shares.reflected[k] = shares.reflected[k - 1];
      shares.passed[k] = shares.passed[k - 1];
      continue;
    }
    const PaneShares band = pane_shares(cosine, index, double{t[k]});
    if (R > 0.0) shares.reflected[k] = static_cast<float>(std::min(1.0, band.reflected / R));
    if (R < 1.0) shares.passed[k] = static_cast<float>(std::min(1.0, band.passed / (1.0 - R)));
  }
  return shares;
}

bool has_absorbing_body(const Dielectric& glass) {
  return glass.thin && glass.transmissivity.size() > 0;
}

// Cosine between the incident light and the normal of the microfacet of a thin pane, a mirror or a
// coat, or of the whole surface, that sends the light along `sample`.
double cosine_at_facet(const SurfaceInteraction& interaction, const ScatteringSample& sample) {
  const Eigen::Vector3d reflected =
      sample.crosses ? reflect(sample.direction, interaction.normal) : sample.direction;
  return std::sqrt(std::max(0.0, 0.5 - 0.5 * interaction.direction.dot(reflected)));
}

// Direction of the light transmitted through a microfacet, or the whole surface, of normal m. Empty
// under total internal reflection.
std::optional<Eigen::Vector3d> transmitted_direction(const SurfaceInteraction& interaction,
                                                     const Eigen::Vector3d& m) {
  const Dielectric& glass = *interaction.material.dielectric;
  if (!glass.thin)
    return refract(interaction.direction, m, relative_index(glass, interaction.from_back));
  return reflect(reflect(interaction.direction, m), interaction.normal);
}

// Share of the light scattered by a microfacet that no other microfacet masks; 0 below the horizon
// of the side on which the light leaves.
double unmasked(const SurfaceInteraction& interaction, double alpha,
                const Eigen::Vector3d& outgoing, bool crosses) {
  const double cos_out = outgoing.dot(interaction.normal) * (crosses ? -1.0 : 1.0);
  if (!(cos_out > 0.0)) return 0.0;
  const double in = ggx_lambda(-interaction.direction.dot(interaction.normal), alpha);
  const double out = ggx_lambda(cos_out, alpha);
  const bool is_reflected = !crosses || interaction.material.dielectric->thin;
  return is_reflected ? (1.0 + in) / (1.0 + in + out) : 1.0 / (1.0 + out);
}

// Fresnel reflectance of a microfacet of normal m. 1 for a mirror, whose reflectance
// scattering_weight() has.
double microfacet_reflectance(const SurfaceInteraction& interaction, const Eigen::Vector3d& m) {
  const auto& glass = interaction.material.dielectric;
  return glass ? reflected_share(*glass, -interaction.direction.dot(m), interaction.from_back)
               : 1.0;
}

// Draws the normal of a microfacet. The columns of `frame` are axes about the surface's normal, the
// last column.
Eigen::Vector3d sample_microfacet_normal(const SurfaceInteraction& interaction,
                                         const Eigen::Matrix3d& frame, double u, double v) {
  const Eigen::Vector3d from = -(frame.transpose() * interaction.direction);
  return frame * ggx_visible_normal(from, interaction.material.gloss_roughness(), u, v);
}

Eigen::Matrix3d frame_about(const Eigen::Vector3d& normal) {
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  Eigen::Matrix3d frame;
  frame << a, b, normal;
  return frame;
}

// One attempt at a sample of a rough surface; empty if the sample is masked.
std::optional<ScatteringSample> sample_microfacet(const SurfaceInteraction& interaction,
                                                  const Eigen::Matrix3d& frame,
                                                  const ScatteringRandom& random) {
  const Eigen::Vector3d m = sample_microfacet_normal(interaction, frame, random.u, random.v);
  ScatteringSample sample;
  sample.crosses = !(random.component < microfacet_reflectance(interaction, m));
  const std::optional<Eigen::Vector3d> outgoing =
      sample.crosses ? transmitted_direction(interaction, m) : reflect(interaction.direction, m);
  if (!outgoing) return std::nullopt;
  sample.direction = outgoing->normalized();
  sample.weight = scattering_weight(interaction, sample);
  const double passes = unmasked(interaction, interaction.material.gloss_roughness(),
                                 sample.direction, sample.crosses);
  if (!(random_uniform(random_key(random.key, RandomPurpose::microfacet_masking)) < passes))
    return std::nullopt;
  return sample;
}

// Light at a smooth dielectric before its tint, per band, and its polarisation afterwards.
struct DielectricLight {
  Spectrum reflected, passed;
  Polarisation after_reflection{}, after_crossing{};
  float reflected_if_clear = 0.0f;  // `reflected` if the body absorbed nothing
};

DielectricLight dielectric_light(const SurfaceInteraction& interaction) {
  const Dielectric& glass = *interaction.material.dielectric;
  const double cosine = std::clamp(-interaction.direction.dot(interaction.normal), 0.0, 1.0);
  const double index = relative_index(glass, interaction.from_back);
  const Polarisation before =
      about_plane_of_incidence(interaction.polarisation, interaction.direction, interaction.normal);
  const Eigen::Index bands = interaction.material.specular.size();
  if (!has_absorbing_body(glass)) {
    const InterfaceShares shares =
        glass.thin ? pane_interface(cosine, index, 1.0) : face_shares(cosine, index);
    const PolarisedLight back = after_interface(before, shares.reflected);
    const auto R = static_cast<float>(back.share);
    return {.reflected = Spectrum::Constant(bands, R),
            .passed = Spectrum::Constant(bands, 1.0f - R),
            .after_reflection = back.polarisation,
            .after_crossing = after_interface(before, shares.passed).polarisation,
            .reflected_if_clear = R};
  }
  DielectricLight light{.reflected = Spectrum(bands), .passed = Spectrum(bands)};
  InterfaceShares mean;
  const auto add = [bands](const PolarisedShares& of, PolarisedShares& sum) {
    const auto count = static_cast<double>(bands);
    sum = {sum.s + of.s / count, sum.p + of.p / count, sum.u + of.u / count};
  };
  InterfaceShares shares;
  for (Eigen::Index k = 0; k < bands; ++k) {
    const float t = glass.transmissivity[k];
    if (k == 0 || t != glass.transmissivity[k - 1]) {
      shares = pane_interface(cosine, index, double{t});
    }
    light.reflected[k] = static_cast<float>(after_interface(before, shares.reflected).share);
    light.passed[k] = static_cast<float>(after_interface(before, shares.passed).share);
    add(shares.reflected, mean.reflected);
    add(shares.passed, mean.passed);
  }
  light.after_reflection = after_interface(before, mean.reflected).polarisation;
  light.after_crossing = after_interface(before, mean.passed).polarisation;
  light.reflected_if_clear = static_cast<float>(
      after_interface(before, pane_interface(cosine, index, 1.0).reflected).share);
  return light;
}

// Polarisation after an ideal mirror, which turns the phase of s against p by half a wave.
Polarisation mirrored_polarisation(const SurfaceInteraction& interaction) {
  const Polarisation& light = interaction.polarisation;
  if (light.q == 0.0 && light.u == 0.0) return {};
  return after_interface(about_plane_of_incidence(light, interaction.direction, interaction.normal),
                         {.s = 1.0, .p = 1.0, .u = -1.0})
      .polarisation;
}

SmoothScattering lobes_of(const SurfaceInteraction& interaction, const DielectricLight& light) {
  SmoothScattering lobes;
  lobes.count = 1;
  lobes.sample[0] = {.direction = reflect(interaction.direction, interaction.normal),
                     .weight = light.reflected,
                     .polarisation = light.after_reflection};
  if (const auto outgoing = transmitted_direction(interaction, interaction.normal)) {
    lobes.sample[1] = {.direction = *outgoing,
                       .weight = light.passed * interaction.material.dielectric->tint,
                       .crosses = true,
                       .polarisation = light.after_crossing};
    lobes.count = 2;
  }
  return lobes;
}

ScatteringSample mirror_sample(const SurfaceInteraction& interaction) {
  ScatteringSample sample{.direction = reflect(interaction.direction, interaction.normal)};
  sample.weight = scattering_weight(interaction, sample);
  // A coat is taken to leave light unpolarised, as the base below it does.
  if (!interaction.material.coat) sample.polarisation = mirrored_polarisation(interaction);
  return sample;
}

ScatteringSample sample_smooth(const SurfaceInteraction& interaction, double which) {
  if (!interaction.material.dielectric) return mirror_sample(interaction);
  const DielectricLight light = dielectric_light(interaction);
  const SmoothScattering lobes = lobes_of(interaction, light);
  if (lobes.count == 1) return lobes.sample[0];
  // No weight is above 1, as it would be with the shares of a band that absorbs less than others.
  const float back = light.reflected_if_clear;
  const bool crosses = which >= static_cast<double>(back);
  ScatteringSample sample = lobes.sample[crosses ? 1 : 0];
  const float chance = crosses ? 1.0f - back : back;
  if (chance > 0.0f) sample.weight /= chance;
  return sample;
}

}  // namespace

Spectrum mean_sent_on(const Material& material) {
  Spectrum share = material.reflectance + mean_specular(material);
  if (material.is_translucent()) share += material.transmittance;
  return share;
}

namespace {

// Share of light, per band, that passes a sheet straight on. No light passes other surfaces, behind
// which a lamp may lie.
// - Light under a coat passes by the factor of the coated base: coat, base and passing light
//   together never exceed the light that arrives.
// - Holes, which are what the coat does not cover, pass all light.
Spectrum straight_share(const SurfaceInteraction& interaction) {
  const Material& material = interaction.material;
  const Spectrum& all = material.regular_transmittance;
  if (all.size() == 0) return Spectrum::Zero(material.specular.size());
  if (!material.coat) return all;
  const auto holes_beside = [&]() -> Spectrum {
    const Coat& coat = *material.coat;
    const Spectrum covered = coat.cover > 0.0f ? Spectrum(material.specular / coat.cover)
                                               : Spectrum(Spectrum::Zero(all.size()));
    const Spectrum taken = coat.bare.size() > 0 ? Spectrum(covered + coat.bare) : covered;
    return all.min((1.0f - taken).max(0.0f));
  };
  const Spectrum holes = holes_beside();
  if (!(all > holes).any()) return all;
  const double cosine = -interaction.direction.dot(interaction.normal);
  return holes + static_cast<float>(CoatedBase(material).factor(cosine)) * (all - holes);
}

}  // namespace

Spectrum scattering_weight(const SurfaceInteraction& interaction, const ScatteringSample& sample) {
  const auto& glass = interaction.material.dielectric;
  if (!glass && sample.crosses) return straight_share(interaction);
  if (const auto& coat = interaction.material.coat) {
    const double cosine = std::min(1.0, cosine_at_facet(interaction, sample));
    const double F = fresnel_reflectance(cosine, double{coat->index_of_refraction});
    Spectrum share = static_cast<float>(F) * interaction.material.specular;
    if (coat->bare.size() > 0) share += coat->bare;
    return share;
  }
  if (const auto& metal = interaction.material.metal) {
    const double cosine = std::min(1.0, cosine_at_facet(interaction, sample));
    return reflectance_at(*metal, cosine) * interaction.material.specular;
  }
  if (!glass) return interaction.material.specular;
  if (has_absorbing_body(*glass)) {
    const BodyShares shares = body_shares(*glass, cosine_at_facet(interaction, sample));
    return sample.crosses ? Spectrum(glass->tint * shares.passed) : shares.reflected;
  }
  return sample.crosses ? glass->tint
                        : Spectrum(Spectrum::Ones(interaction.material.specular.size()));
}

Spectrum crossing_share(const Dielectric& glass) {
  return has_absorbing_body(glass) ? Spectrum(glass.tint * body_shares(glass, 1.0).passed)
                                   : glass.tint;
}

double radiance_scale(const Material& material, bool crosses, bool from_back) {
  if (!crosses || !material.dielectric || material.dielectric->thin) return 1.0;
  const double n = relative_index(*material.dielectric, from_back);
  return 1.0 / (n * n);
}

bool is_clear_pane(const Material& material) {
  const auto& glass = material.dielectric;
  return glass ? glass->thin && !(glass->roughness > 0.0f) : material.passes_straight();
}

Spectrum mean_specular(const Material& material) {
  Spectrum share = mean_mirrored(material);
  if (material.passes_straight()) share += material.regular_transmittance;
  return share;
}

ScatteringSample straight_sample(const SurfaceInteraction& interaction) {
  return {.direction = interaction.direction,
          .weight = straight_share(interaction),
          .crosses = true,
          .polarisation = interaction.polarisation};
}

SmoothScattering smooth_scattering(const SurfaceInteraction& interaction) {
  if (interaction.material.dielectric) return lobes_of(interaction, dielectric_light(interaction));
  SmoothScattering lobes;
  lobes.count = 1;
  lobes.sample[0] = mirror_sample(interaction);
  if (interaction.material.passes_straight()) {
    lobes.sample[1] = straight_sample(interaction);
    lobes.count = 2;
  }
  return lobes;
}

ScatteringSample sample_scattering(const SurfaceInteraction& interaction,
                                   const ScatteringRandom& first) {
  const Material& material = interaction.material;
  if (!material.passes_straight()) return sample_lobe(interaction, first);
  // Chances in proportion to the greatest share of either kind: no weight exceeds their sum, at
  // most 2.
  const double straight = static_cast<double>(material.regular_transmittance.maxCoeff());
  const double bare = material.coat && material.coat->bare.size() > 0
                          ? static_cast<double>(material.coat->bare.maxCoeff())
                          : 0.0;
  const double mirrored = static_cast<double>(material.specular.maxCoeff()) + bare;
  const double chance = straight / (straight + mirrored);
  if (first.component < chance) {
    ScatteringSample sample = straight_sample(interaction);
    sample.weight /= static_cast<float>(chance);
    return sample;
  }
  ScatteringRandom rest = first;
  rest.component = (first.component - chance) / (1.0 - chance);
  ScatteringSample sample = sample_lobe(interaction, rest);
  sample.weight /= static_cast<float>(1.0 - chance);
  return sample;
}

ScatteringSample sample_lobe(const SurfaceInteraction& interaction, const ScatteringRandom& first) {
  const bool grazes = !(interaction.direction.dot(interaction.normal) < 0.0);
  if (!(interaction.material.gloss_roughness() > 0.0f) || grazes) {
    return sample_smooth(interaction, first.component);
  }
  const Eigen::Matrix3d frame = frame_about(interaction.normal);
  // Even at alpha 1 and grazing incidence a third of all attempts succeed.
  constexpr int most_tries = 64;
  ScatteringRandom random = first;
  for (std::uint64_t i = 1; i <= most_tries; ++i) {
    if (const auto sample = sample_microfacet(interaction, frame, random)) return *sample;
    random.key = random_key(first.key, i);
    random.component = random_uniform(random_key(random.key, 1));
    random.u = random_uniform(random_key(random.key, 2));
    random.v = random_uniform(random_key(random.key, 3));
  }
  return sample_smooth(interaction, first.component);
}

int deepest_path(int most) {
  constexpr int least = 128;
  return most > 0 ? std::max(most, least) : 0;
}

RoughLobe::RoughLobe(const Material& material, bool from_back) {
  if (!material.pattern || !material.pattern->roughness) {
    kept_.push_back(kept_shares(material, from_back));
    return;
  }
  Material at_level = material;
  for (int i = 0; i <= level_steps_; ++i) {
    const float alpha = static_cast<float>(i * i) / static_cast<float>(level_steps_ * level_steps_);
    at_level.specular_roughness = alpha;
    if (at_level.dielectric) at_level.dielectric->roughness = alpha;
    Shares all{};
    all.fill(1.0);  // nothing masks the facets of a smooth surface
    kept_.push_back(i > 0 ? kept_shares(at_level, from_back) : all);
  }
}

RoughLobe::Shares RoughLobe::kept_shares(const Material& material, bool from_back) {
  constexpr int count = 256;
  const SobolPoints points(count);
  Shares shares{};
  for (int i = 0; i < steps_; ++i) {
    const double cosine = (i + 0.5) / steps_;
    const SurfaceInteraction interaction{
        .material = material,
        .direction = {std::sqrt(1.0 - cosine * cosine), 0.0, -cosine},
        .normal = Eigen::Vector3d::UnitZ(),
        .from_back = from_back};
    double kept = 0.0;
    for (int p = 0; p < count; ++p) {
      const Eigen::Array4d u = points.point(p, static_cast<std::uint64_t>(i)).cast<double>();
      const Eigen::Vector3d m =
          sample_microfacet_normal(interaction, Eigen::Matrix3d::Identity(), u[0], u[1]);
      const double F = microfacet_reflectance(interaction, m), alpha = material.gloss_roughness();
      kept += F * unmasked(interaction, alpha, reflect(interaction.direction, m), false);
      if (!(F < 1.0)) continue;
      if (const auto outgoing = transmitted_direction(interaction, m)) {
        kept += (1.0 - F) * unmasked(interaction, alpha, *outgoing, true);
      }
    }
    shares[static_cast<std::size_t>(i)] = kept / count;
  }
  return shares;
}

double RoughLobe::kept(double cosine, double alpha) const {
  const double place = std::clamp(cosine * steps_ - 0.5, 0.0, steps_ - 1.0);
  const auto low = std::min(static_cast<std::size_t>(place), std::size_t{steps_} - 2);
  const double part = place - static_cast<double>(low);
  const auto of = [&](const Shares& level) {
    return (1.0 - part) * level[low] + part * level[low + 1];
  };
  if (kept_.size() == 1) return of(kept_[0]);
  const double step = level_steps_ * std::sqrt(std::clamp(alpha, 0.0, 1.0));
  const auto level = std::min(static_cast<std::size_t>(step), kept_.size() - 2);
  const double rest = step - static_cast<double>(level);
  return (1.0 - rest) * of(kept_[level]) + rest * of(kept_[level + 1]);
}

double RoughLobe::density(const SurfaceInteraction& interaction,
                          const Eigen::Vector3d& outgoing) const {
  const Eigen::Vector3d from = -interaction.direction, &n = interaction.normal;
  const double cos_in = from.dot(n), alpha = interaction.material.gloss_roughness();
  const auto& glass = interaction.material.dielectric;
  const bool crosses = outgoing.dot(n) < 0.0;
  if (!(cos_in > 0.0) || (crosses && !glass)) return 0.0;
  // Normal of the microfacet that scatters into `outgoing`, and d omega_m / d omega_outgoing.
  Eigen::Vector3d m;
  double stretch = 0.0;
  if (!crosses || glass->thin) {
    m = from + (crosses ? reflect(outgoing, n) : outgoing);
    m.normalize();
    stretch = 0.25 / from.dot(m);
  } else {
    const double index = relative_index(*glass, interaction.from_back);
    m = -(from + index * outgoing);
    constexpr double unbent = 1e-6;  // at index 1 the lobe is a single direction
    if (!(m.norm() > unbent)) return 0.0;
    m.normalize();
    if (m.dot(n) < 0.0) m = -m;
    const double out_m = outgoing.dot(m), both = from.dot(m) + index * out_m;
    if (!(out_m < 0.0)) return 0.0;
    stretch = index * index * -out_m / (both * both);
  }
  const double cos_m = m.dot(n), in_m = from.dot(m);
  if (!(cos_m > 0.0 && in_m > 0.0)) return 0.0;
  const double F = microfacet_reflectance(interaction, m);
  const double visible =
      ggx_normals(cos_m, alpha) * in_m / (cos_in * (1.0 + ggx_lambda(cos_in, alpha)));
  return (crosses ? 1.0 - F : F) * visible * stretch *
         unmasked(interaction, alpha, outgoing, crosses) / kept(cos_in, alpha);
}

void Media::cross(int material, const Material& what, const ScatteringSample& sample,
                  bool from_back) {
  if (!sample.crosses || !what.dielectric || what.dielectric->thin) return;
  if (from_back) {
    count_ = std::max(0, count_ - 1);
    return;
  }
  if (count_ == deepest) {
    std::move(bodies_.begin() + 1, bodies_.end(), bodies_.begin());
    --count_;
  }
  bodies_[static_cast<std::size_t>(count_++)] = material;
}

Spectrum Media::passed(const Scene& scene, int material, bool from_back, double distance) const {
  int body = count_ > 0 ? bodies_[static_cast<std::size_t>(count_ - 1)] : -1;
  const auto clear = [&](int i) -> const Dielectric* {
    const auto& glass = scene.materials[static_cast<std::size_t>(i)].dielectric;
    return glass && !glass->thin ? &*glass : nullptr;
  };
  if (from_back && clear(material)) body = material;
  const Dielectric* glass = body >= 0 ? clear(body) : nullptr;
  if (!glass || !(glass->absorption > 0.0f).any()) return Spectrum::Ones(scene.bands.count());
  return (-static_cast<float>(distance) * glass->absorption).exp();
}

}  // namespace lightwell
