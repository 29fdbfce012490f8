#include "radiosity/radiation/shortwave_model.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lightwell {

ShortwaveModel::ShortwaveModel(const FacetViewFactors& found, const ElementCaster& caster,
                               std::span<const SurfacePoint> points, const Eigen::Vector3d& up,
                               const Progress& progress)
    : found_(found),
      caster_(caster),
      points_(points.begin(), points.end()),
      sky_view_(sky_view_factors(found, up, progress)),
      views_(point_views(found, caster, points, up, progress)) {}

void ShortwaveModel::run(std::span<const SunAndSky> instants, const Eigen::ArrayXd& albedo,
                         int rays,
                         const std::function<void(int number, const ShortwaveInstant&)>& each,
                         const Progress& progress) const {
  const auto count = instants.size();
  constexpr std::size_t block = 32;  // instants whose reflections are found at the same time
  std::vector<ShortwaveInstant> lights;
  std::vector<Eigen::ArrayXd> first;
  for (std::size_t h = 0; h < count; ++h) {
    report(progress, "sun", static_cast<double>(h) / double(count));
    const SunAndSky& light = instants[h];
    const Progress here = [&](std::string_view phase, double share) {
      return !progress || progress(phase, (static_cast<double>(h) + share) / double(count));
    };
    ShortwaveInstant made{.direct = Eigen::ArrayXd::Zero(sky_view_.size()),
                          .diffuse = light.diffuse * sky_view_,
                          .point_direct = Eigen::ArrayXd::Zero(views_.sky.size()),
                          .point_diffuse = light.diffuse * views_.sky};
    if (light.direct > 0.0) {
      made.direct = light.direct * sun_factors(found_, caster_, light.sun, rays, here);
      made.point_direct = light.direct * point_sun_factors(caster_, points_, light.sun);
    }
    first.emplace_back(made.direct + made.diffuse);
    lights.push_back(std::move(made));
    if (lights.size() < block && h + 1 < count) continue;

    std::vector<ShortwaveExchange> exchanges = shortwave_exchanges(found_.factors, first, albedo);
    for (std::size_t k = 0; k < lights.size(); ++k) {
      lights[k].exchange = std::move(exchanges[k]);
      lights[k].point_reflected =
          point_reflections(views_, albedo, first[k] + lights[k].exchange.reflected);
      each(static_cast<int>(h + 1 - lights.size() + k), lights[k]);
    }
    lights.clear();
    first.clear();
  }
}

}  // namespace lightwell
