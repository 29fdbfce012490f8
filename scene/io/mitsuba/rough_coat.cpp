#include "scene/io/mitsuba/rough_coat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/microfacet.h"
#include "scene/optics.h"

namespace lightwell {
namespace {

struct RoughSurface {
  double alpha;
  LossyCoat::Facets kind;
};

// Cosine of the normal below which lies the share u of the area of all microfacets, projected along
// the surface's normal.
double facet_cosine(const RoughSurface& facets, double u) {
  const double squared = facets.kind == LossyCoat::Facets::ggx ? u / (1.0 - u) : -std::log1p(-u);
  return 1.0 / std::sqrt(1.0 + facets.alpha * facets.alpha * squared);
}

// Share of the microfacets that is visible from a direction at `cosine`, (0,1], Smith's G1. That of
// Beckmann's microfacets is a rational function of a = 1 / (alpha tan), within 0.35 % (Walter et
// al. 2007).
double visible_share(const RoughSurface& facets, double cosine) {
  if (facets.kind == LossyCoat::Facets::ggx) {
    return 1.0 / (1.0 + ggx_lambda(cosine, facets.alpha));
  }
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double a = sine > 0.0 ? cosine / (facets.alpha * sine) : 2.0;
  if (a >= 1.6) return 1.0;
  return a * (3.535 + 2.181 * a) / (1.0 + a * (2.276 + 2.577 * a));
}

struct Shares {
  double mirrored = 0.0, passed = 0.0;
};

// Shares of light at `cosine` that single microfacets mirror and pass.
Shares shares_at(double cosine, double index, const RoughSurface& facets) {
  constexpr int rings = 48, sectors = 48;
  const Eigen::Vector3d in(-std::sqrt(1.0 - cosine * cosine), 0.0, -cosine);
  Shares sum;
  double visible = 0.0;
  for (int ring = 0; ring < rings; ++ring) {
    // Rings are dense at steep facets, which are rare and to which much light at flat angles comes.
    const double flat = 1.0 - (ring + 0.5) / rings;
    const double z = facet_cosine(facets, 1.0 - flat * flat * flat), r = std::sqrt(1.0 - z * z);
    for (int sector = 0; sector < sectors; ++sector) {
      // Light and facets are alike on both sides of the plane of incidence.
      const double phi = std::numbers::pi * (sector + 0.5) / sectors;
      const Eigen::Vector3d m(r * std::cos(phi), r * std::sin(phi), z);
      const double facing = -in.dot(m);
      if (!(facing > 0.0)) continue;
      const double weight = flat * flat * facing / z,
                   F = fresnel_reflectance(std::min(facing, 1.0), index);
      visible += weight;
      const double up = reflect(in, m).z();
      if (up > 0.0) sum.mirrored += weight * F * visible_share(facets, std::min(up, 1.0));
      const auto refracted = refract(in, m, index);
      if (!refracted || !(refracted->z() < 0.0)) continue;
      sum.passed +=
          weight * (1.0 - F) * visible_share(facets, std::min(-refracted->normalized().z(), 1.0));
    }
  }
  return {.mirrored = sum.mirrored / visible, .passed = sum.passed / visible};
}

// Shares of even light.
Shares mean_shares(double index, const RoughSurface& facets) {
  constexpr int angles = 48;
  Shares sum;
  for (int i = 0; i < angles; ++i) {
    const Shares here = shares_at(std::sqrt((i + 0.5) / angles), index, facets);
    sum.mirrored += here.mirrored / angles;
    sum.passed += here.passed / angles;
  }
  return sum;
}

}  // namespace

LossyCoat::LossyCoat(double index, double alpha, Facets facets, bool saturating)
    : saturating_(saturating) {
  const RoughSurface of{.alpha = alpha, .kind = facets};
  const double entering = mean_shares(index, of).passed;
  twice_passed_ = static_cast<float>(entering * entering / (index * index));
  inside_ = static_cast<float>(mean_shares(1.0 / index, of).mirrored);
}

Spectrum LossyCoat::reflectance(const Spectrum& base) const {
  if (!saturating_) return base * (twice_passed_ / (1.0f - inside_));
  return twice_passed_ * base / (1.0f - base * inside_);
}

}  // namespace lightwell
