#include "scene/specular.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/microfacet.h"
#include "scene/optics.h"
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

// Through a microfacet (or the whole surface) of normal m.
std::optional<Eigen::Vector3d> crossing(const Meeting& meeting, const Eigen::Vector3d& m) {
  const Dielectric& glass = *meeting.material.dielectric;
  if (!glass.thin) return refract(meeting.direction, m, relative_index(glass, meeting.from_back));
  return reflect(reflect(meeting.direction, m), meeting.normal);
}

// Share of the light that a microfacet sends onwards which nothing is in the way of; 0 below the
// horizon of the side it belongs to.
double unmasked(const Meeting& meeting, double alpha, const Eigen::Vector3d& onward, bool crosses) {
  const double cos_out = onward.dot(meeting.normal) * (crosses ? -1.0 : 1.0);
  if (!(cos_out > 0.0)) return 0.0;
  const double in = ggx_lambda(-meeting.direction.dot(meeting.normal), alpha);
  const double out = ggx_lambda(cos_out, alpha);
  const bool is_mirrored = !crosses || meeting.material.dielectric->thin;
  return is_mirrored ? (1.0 + in) / (1.0 + in + out) : 1.0 / (1.0 + out);
}

// Share of what meets a microfacet of normal m that it reflects; a mirror's is counted elsewhere.
double microfacet_reflectance(const Meeting& meeting, const Eigen::Vector3d& m) {
  const auto& glass = meeting.material.dielectric;
  return glass ? reflected_share(*glass, -meeting.direction.dot(m), meeting.from_back) : 1.0;
}

// The microfacet's normal is drawn in the frame whose columns are `frame`, the last the surface's.
Eigen::Vector3d draw_microfacet(const Meeting& meeting, const Eigen::Matrix3d& frame, double u,
                                double v) {
  const Eigen::Vector3d from = -(frame.transpose() * meeting.direction);
  return frame * ggx_visible_normal(from, meeting.material.gloss_roughness(), u, v);
}

Eigen::Matrix3d frame_about(const Eigen::Vector3d& normal) {
  Eigen::Vector3d a, b;
  tangent_frame(normal, a, b);
  Eigen::Matrix3d frame;
  frame << a, b, normal;
  return frame;
}

// One try at a rough surface.
std::optional<Onward> rough_way(const Meeting& meeting, const Eigen::Matrix3d& frame,
                                const OnwardLot& lot) {
  const Eigen::Vector3d m = draw_microfacet(meeting, frame, lot.u, lot.v);
  Onward way;
  way.crosses = !(lot.way < microfacet_reflectance(meeting, m));
  const std::optional<Eigen::Vector3d> onward =
      way.crosses ? crossing(meeting, m) : reflect(meeting.direction, m);
  if (!onward) return std::nullopt;
  way.direction = onward->normalized();
  way.share = share_of(meeting, way.crosses);
  constexpr std::uint64_t masking = 0x3a5c;
  const double passes =
      unmasked(meeting, meeting.material.gloss_roughness(), way.direction, way.crosses);
  if (!(random_uniform(random_key(lot.key, masking)) < passes)) return std::nullopt;
  return way;
}

Onward smooth_way(const Meeting& meeting, double which) {
  OnwardWays ways = smooth_ways(meeting);
  if (ways.count == 1) return ways.way[0];
  const bool crosses =
      which >= reflected_share(*meeting.material.dielectric, -meeting.direction.dot(meeting.normal),
                               meeting.from_back);
  Onward way = ways.way[crosses ? 1 : 0];
  way.share = share_of(meeting, crosses);
  return way;
}

}  // namespace

Spectrum share_of(const Meeting& meeting, bool crosses) {
  const auto& glass = meeting.material.dielectric;
  if (!glass) return meeting.material.specular;
  return crosses ? glass->tint : Spectrum(Spectrum::Ones(meeting.material.specular.size()));
}

bool is_clear_pane(const Material& material) {
  const auto& glass = material.dielectric;
  return glass && glass->thin && !(glass->roughness > 0.0f);
}

OnwardWays smooth_ways(const Meeting& meeting) {
  const Material& material = meeting.material;
  const Eigen::Vector3d mirrored = reflect(meeting.direction, meeting.normal);
  OnwardWays ways;
  ways.count = 1;
  ways.way[0] = {.direction = mirrored, .share = material.specular};
  if (!material.dielectric) return ways;
  const double cos_i = -meeting.direction.dot(meeting.normal);
  const auto R =
      static_cast<float>(reflected_share(*material.dielectric, cos_i, meeting.from_back));
  ways.way[0].share = Spectrum::Constant(material.specular.size(), R);
  if (const auto onward = crossing(meeting, meeting.normal)) {
    ways.way[1] = {
        .direction = *onward, .share = (1.0f - R) * material.dielectric->tint, .crosses = true};
    ways.count = 2;
  }
  return ways;
}

Onward draw_way(const Meeting& meeting, const OnwardLot& first) {
  const bool grazes = !(meeting.direction.dot(meeting.normal) < 0.0);
  if (!(meeting.material.gloss_roughness() > 0.0f) || grazes) {
    return smooth_way(meeting, first.way);
  }
  const Eigen::Matrix3d frame = frame_about(meeting.normal);
  // Even at alpha 1 and grazing incidence, a third of all tries go on.
  constexpr int most_tries = 64;
  OnwardLot lot = first;
  for (std::uint64_t i = 1; i <= most_tries; ++i) {
    if (const auto way = rough_way(meeting, frame, lot)) return *way;
    lot.key = random_key(first.key, i);
    lot.way = random_uniform(random_key(lot.key, 1));
    lot.u = random_uniform(random_key(lot.key, 2));
    lot.v = random_uniform(random_key(lot.key, 3));
  }
  return smooth_way(meeting, first.way);
}

int deepest_path(int most, bool met_rough) {
  constexpr int by_chance = 64;
  return met_rough && most > 0 ? std::max(most, by_chance) : most;
}

RoughLobe::RoughLobe(const Material& material, bool from_back) {
  constexpr int count = 256;
  const SobolPoints points(count);
  for (int i = 0; i < steps_; ++i) {
    const double cosine = (i + 0.5) / steps_;
    const Meeting meeting{.material = material,
                          .direction = {std::sqrt(1.0 - cosine * cosine), 0.0, -cosine},
                          .normal = Eigen::Vector3d::UnitZ(),
                          .from_back = from_back};
    double kept = 0.0;
    for (int p = 0; p < count; ++p) {
      const Eigen::Array4d u = points.point(p, static_cast<std::uint64_t>(i)).cast<double>();
      const Eigen::Vector3d m = draw_microfacet(meeting, Eigen::Matrix3d::Identity(), u[0], u[1]);
      const double F = microfacet_reflectance(meeting, m), alpha = material.gloss_roughness();
      kept += F * unmasked(meeting, alpha, reflect(meeting.direction, m), false);
      if (!(F < 1.0)) continue;
      if (const auto onward = crossing(meeting, m)) {
        kept += (1.0 - F) * unmasked(meeting, alpha, *onward, true);
      }
    }
    kept_[static_cast<std::size_t>(i)] = kept / count;
  }
}

double RoughLobe::density(const Meeting& meeting, const Eigen::Vector3d& onward) const {
  const Eigen::Vector3d from = -meeting.direction, &n = meeting.normal;
  const double cos_in = from.dot(n), alpha = meeting.material.gloss_roughness();
  const auto& glass = meeting.material.dielectric;
  const bool crosses = onward.dot(n) < 0.0;
  if (!(cos_in > 0.0) || (crosses && !glass)) return 0.0;
  // The microfacet that sends light there, and its solid angle per solid angle of directions.
  Eigen::Vector3d m;
  double stretch = 0.0;
  if (!crosses || glass->thin) {
    m = from + (crosses ? reflect(onward, n) : onward);
    m.normalize();
    stretch = 0.25 / from.dot(m);
  } else {
    const double index = relative_index(*glass, meeting.from_back);
    m = -(from + index * onward);
    constexpr double unbent = 1e-6;  // of index 1, whose lobe is one direction
    if (!(m.norm() > unbent)) return 0.0;
    m.normalize();
    if (m.dot(n) < 0.0) m = -m;
    const double out_m = onward.dot(m), both = from.dot(m) + index * out_m;
    if (!(out_m < 0.0)) return 0.0;
    stretch = index * index * -out_m / (both * both);
  }
  const double cos_m = m.dot(n), in_m = from.dot(m);
  if (!(cos_m > 0.0 && in_m > 0.0)) return 0.0;
  const double F = microfacet_reflectance(meeting, m);
  const double visible =
      ggx_normals(cos_m, alpha) * in_m / (cos_in * (1.0 + ggx_lambda(cos_in, alpha)));
  const double place = std::clamp(cos_in * steps_ - 0.5, 0.0, steps_ - 1.0);
  const auto low = std::min(static_cast<std::size_t>(place), kept_.size() - 2);
  const double part = place - static_cast<double>(low);
  const double kept = (1.0 - part) * kept_[low] + part * kept_[low + 1];
  return (crosses ? 1.0 - F : F) * visible * stretch * unmasked(meeting, alpha, onward, crosses) /
         kept;
}

void Media::go_on(int material, const Material& what, const Onward& way, bool from_back) {
  if (!way.crosses || !what.dielectric || what.dielectric->thin) return;
  if (from_back) {
    count_ = std::max(0, count_ - 1);
    return;
  }
  if (count_ == deepest) {
    std::move(within_.begin() + 1, within_.end(), within_.begin());
    --count_;
  }
  within_[static_cast<std::size_t>(count_++)] = material;
}

Spectrum Media::passed(const Scene& scene, int material, bool from_back, double distance) const {
  int body = count_ > 0 ? within_[static_cast<std::size_t>(count_ - 1)] : -1;
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
