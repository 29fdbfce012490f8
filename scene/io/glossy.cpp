#include "scene/io/glossy.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "scene/optics.h"

namespace lightwell {
namespace {

// Cosine-weighted mean over the hemisphere of a function of the cosine.
template <class F>
double diffuse_mean(F&& of_cosine) {
  // Midpoint rule in cos^2: 2 cos dcos = d(cos^2), so the weights are equal.
  constexpr int steps = 1000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += of_cosine(std::sqrt((i + 0.5) / steps));
  return sum / steps;
}

// Fresnel reflectance of a metal for unpolarised light; `index` = eta + i k.
double metal_reflectance(double cosine, std::complex<double> index) {
  if (!(std::abs(index) > 0.0)) return 1.0;
  const std::complex<double> inside = std::sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
  const auto across = (cosine - index * inside) / (cosine + index * inside);
  const auto along = (index * cosine - inside) / (index * cosine + inside);
  return 0.5 * (std::norm(across) + std::norm(along));
}

}  // namespace

double diffuse_fresnel(double index) {
  return diffuse_mean([index](double cosine) { return fresnel_reflectance(cosine, index); });
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

Spectrum diffuse_metal_reflectance(const Spectrum& eta, const Spectrum& k) {
  Spectrum mean(eta.size());
  for (Eigen::Index i = 0; i < mean.size(); ++i) {
    const std::complex<double> index(static_cast<double>(eta[i]), static_cast<double>(k[i]));
    mean[i] = static_cast<float>(
        diffuse_mean([&](double cosine) { return metal_reflectance(cosine, index); }));
  }
  return mean;
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
