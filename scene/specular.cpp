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

Spectrum ones(const Meeting& meeting) {
  return Spectrum::Ones(meeting.material.specular.size());
}

// One try at a rough surface, in the frame whose columns are `frame`, the last the normal.
std::optional<Onward> rough_way(const Meeting& meeting, const Eigen::Matrix3d& frame,
                                const OnwardLot& lot) {
  const Material& material = meeting.material;
  const double alpha = material.gloss_roughness();
  const Eigen::Vector3d from = -(frame.transpose() * meeting.direction);
  const Eigen::Vector3d m = frame * ggx_visible_normal(from, alpha, lot.u, lot.v);
  const double cos_m = -meeting.direction.dot(m);
  Onward way;
  const auto& glass = material.dielectric;
  way.crosses = glass && !(lot.way < reflected_share(*glass, cos_m, meeting.from_back));
  if (way.crosses) {
    const auto onward = crossing(meeting, m);
    if (!onward) return std::nullopt;
    way.direction = onward->normalized();
    way.share = glass->tint;
  } else {
    way.direction = reflect(meeting.direction, m).normalized();
    way.share = glass ? ones(meeting) : material.specular;
  }
  const double cos_out = way.direction.dot(meeting.normal) * (way.crosses ? -1.0 : 1.0);
  if (!(cos_out > 0.0)) return std::nullopt;
  const double in = ggx_lambda(from.z(), alpha), out = ggx_lambda(cos_out, alpha);
  const bool is_mirrored = !way.crosses || glass->thin;
  const double unmasked = is_mirrored ? (1.0 + in) / (1.0 + in + out) : 1.0 / (1.0 + out);
  constexpr std::uint64_t masking = 0x3a5c;
  if (!(random_uniform(random_key(lot.key, masking)) < unmasked)) return std::nullopt;
  return way;
}

Onward smooth_way(const Meeting& meeting, double which) {
  OnwardWays ways = smooth_ways(meeting);
  if (ways.count == 1) return ways.way[0];
  const bool crosses =
      which >= reflected_share(*meeting.material.dielectric, -meeting.direction.dot(meeting.normal),
                               meeting.from_back);
  Onward way = ways.way[crosses ? 1 : 0];
  way.share = crosses ? meeting.material.dielectric->tint : ones(meeting);
  return way;
}

}  // namespace

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
  Eigen::Matrix3d frame;
  Eigen::Vector3d a, b;
  tangent_frame(meeting.normal, a, b);
  frame << a, b, meeting.normal;
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
