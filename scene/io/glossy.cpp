#include "scene/io/glossy.h"

#include <algorithm>
#include <cmath>

#include "scene/optics.h"

namespace lightwell {

double diffuse_fresnel(double index) {
  // Midpoint rule in cos^2: 2 cos dcos = d(cos^2), so the weights are equal.
  constexpr int steps = 1000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    sum += fresnel_reflectance(std::sqrt((i + 0.5) / steps), index);
  }
  return sum / steps;
}

Coat::Coat(double index, bool saturating, const Spectrum& specular)
    : outside_(static_cast<float>(diffuse_fresnel(index))),
      inside_(static_cast<float>(diffuse_fresnel(1.0 / index))),
      saturating_(saturating),
      specular_(specular) {}

Spectrum Coat::operator()(const Spectrum& rho) const {
  const Spectrum returned = saturating_ ? rho : Spectrum(Spectrum::Ones(rho.size()));
  return (specular_ * outside_ +
          (1.0f - outside_) * (1.0f - inside_) * rho / (1.0f - inside_ * returned))
      .min(1.0f);
}

Spectrum coated_reflectance(const Spectrum& rho, double index, bool saturating,
                            const Spectrum& specular) {
  return Coat(index, saturating, specular)(rho);
}

Spectrum metal_reflectance(const Spectrum& eta, const Spectrum& k) {
  const Spectrum absorbed = k.square();
  return ((eta - 1.0f).square() + absorbed) / ((eta + 1.0f).square() + absorbed);
}

double pane_transmittance(double index) {
  const double F = fresnel_reflectance(1.0, index);
  return (1.0 - F) / (1.0 + F);
}

Dielectric thin_pane(double index, const Spectrum& tint, double alpha) {
  return {.index_of_refraction = static_cast<float>(index),
          .tint = tint,
          .roughness = roughness_of(alpha),
          .thin = true};
}

float roughness_of(double alpha) {
  return alpha > smooth_alpha ? static_cast<float>(std::min(alpha, 1.0)) : 0.0f;
}

void add_highlight(Material& material, const Spectrum& share, double alpha) {
  if (!(share > 0.0f).any()) return;
  if (alpha > glossy_alpha) {
    material.reflectance += share;
    return;
  }
  material.specular += share;
  material.specular_roughness = roughness_of(alpha);
}

void set_metallic(Material& material, const Spectrum& color, double metallic, double alpha) {
  const Spectrum metal = static_cast<float>(metallic) * color;
  material.reflectance = color - metal;
  material.specular = Spectrum::Zero(color.size());
  add_highlight(material, metal, alpha);
}

}  // namespace lightwell
