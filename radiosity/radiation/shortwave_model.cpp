#include "radiosity/radiation/shortwave_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scene/degree.h"
#include "scene/perez_sky.h"

namespace lightwell {

SunAndSky under_perez_sky(SunAndSky light, const Eigen::Vector3d& up, int day_of_year) {
  const double altitude = std::asin(std::clamp(light.sun.dot(up), -1.0, 1.0)) / degree;
  if (!(altitude > 0.0) || !(light.diffuse > 0.0)) return light;
  const SkyState state = within_data(sky_state(light.direct, light.diffuse, altitude, day_of_year));
  light.gradation = perez_sky(state, altitude);
  return light;
}

ShortwaveModel::ShortwaveModel(const FacetViewFactors& found, const ElementCaster& caster,
                               std::span<const SurfacePoint> points, const Eigen::Vector3d& up,
                               const Progress& progress)
    : found_(found),
      caster_(caster),
      points_(points.begin(), points.end()),
      up_(up),
      sky_view_(sky_view_factors(found, up, progress)),
      views_(point_views(found, caster, points, up, progress)) {}

// Patches about 6 degrees wide (Reinhart's 577), narrower than the glow about the sun, whose width
// is some 20 degrees.
ShortwaveModel::Dome::Dome(const Eigen::Vector3d& up)
    : patches(2, up, up.unitOrthogonal()), means(patches) {}

Eigen::VectorXf ShortwaveModel::Dome::exitances(const SunAndSky& light) const {
  const Sky sky{.up = patches.up(),
                .north = patches.north(),
                .gradation = *light.gradation,
                .bright = light.sun,
                .scale = Spectrum::Ones(1)};
  const Eigen::ArrayXd radiance = means.of(sky);
  const double on_ground = (radiance * means.on_ground()).sum();
  return (radiance * (std::numbers::pi / on_ground)).matrix().cast<float>();
}

void ShortwaveModel::see_dome(const Progress& progress) {
  Dome dome(up_);
  dome.of_rows = dome_views(found_, caster_, dome.patches, sky_view_, progress);
  dome.of_points = point_dome_views(caster_, points_, dome.patches, views_.sky, progress);
  dome_ = std::move(dome);
}

ShortwaveInstant ShortwaveModel::first_light(const SunAndSky& light, int rays,
                                             const Progress& progress) const {
  ShortwaveInstant made{.direct = Eigen::ArrayXd::Zero(sky_view_.size()),
                        .diffuse = light.diffuse * sky_view_,
                        .point_direct = Eigen::ArrayXd::Zero(views_.sky.size()),
                        .point_diffuse = light.diffuse * views_.sky};
  if (light.gradation) {
    if (!dome_) throw std::logic_error("see_dome() comes before skies that are not even");
    const Eigen::VectorXf exitances = dome_->exitances(light);
    const auto irradiance = [&](const DomeViews& views) {
      return (light.diffuse * (views * exitances).cast<double>().array()).eval();
    };
    made.diffuse = irradiance(dome_->of_rows);
    made.point_diffuse = irradiance(dome_->of_points);
  }
  if (light.direct > 0.0) {
    made.direct = light.direct * sun_factors(found_, caster_, light.sun, rays, progress);
    made.point_direct = light.direct * point_sun_factors(caster_, points_, light.sun);
  }
  return made;
}

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
    ShortwaveInstant made = first_light(light, rays, here);
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
