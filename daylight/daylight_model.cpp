#include "daylight/daylight_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "daylight/grey_scene.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/patch_light.h"
#include "radiosity/solvers/solve_columns.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Owners of random keys.
constexpr std::uint64_t of_patch = 0, of_sensor = 1;

constexpr int patches_at_once = 4;  // on one thread

// Share of each band in the illuminance of white light.
Eigen::ArrayXf luminous_weights(const Bands& bands) {
  Eigen::ArrayXf weights(bands.count());
  for (int k = 0; k < bands.count(); ++k) {
    Spectrum one = Spectrum::Zero(bands.count());
    one[k] = 1.0f;
    weights[k] = static_cast<float>(luminous(bands, one));
  }
  return weights / weights.sum();
}

SurfacePoint surface_point(const GatherPoint& at) {
  return {.position = at.position, .normal = at.normal, .facet = at.facet};
}

// Calls `body` for each index in parallel, `grain` of them in a row, in pieces between which
// progress is told. A piece has work for many threads.
template <class Body>
void for_each_index(int count, int grain, const char* phase, const Progress& progress, Body body) {
  constexpr int pieces = 64, most_threads = 64;
  const int step = std::max(most_threads * grain, (count + pieces - 1) / pieces);
  for (int first = 0; first < count; first += step) {
    report(progress, phase, static_cast<double>(first) / count);
    const int n = std::min(step, count - first);
    parallel_for(n, grain, [&](int begin, int end) {
      for (int i = first + begin; i < first + end; ++i) body(i);
    });
  }
}

}  // namespace

Scene without_light(Scene scene) {
  scene.lamps.clear();
  scene.sky.reset();
  for (Material& material : scene.materials) {
    material.emission = Spectrum::Zero(scene.bands.count());
    material.emission_texture.reset();
  }
  return scene;
}

DaylightModel::DaylightModel(Scene scene, const Eigen::Vector3d& up, const Eigen::Vector3d& north,
                             const DaylightOptions& options)
    : scene_(with_one_band_if_grey(without_light(std::move(scene)))),
      options_(options),
      sky_(options.sky_subdivision, up, north),
      mesh_(build_patches(scene_, options.mesh, options.progress)) {
  for (const int number : {options.points_of_patch, options.sun_rays, options.sun_rays_of_patch}) {
    if (number < 1 || !std::has_single_bit(static_cast<unsigned>(number))) {
      throw std::invalid_argument(fmt::format(
          "numbers of points and of rays to the sun must be powers of two, not {}", number));
    }
  }
  if (options.points.stride < 1 || options.patches.stride < 1) {
    throw std::invalid_argument("a search of the dome must have a stride of 1 at least");
  }
  caster_.emplace(mesh_);
  direct_light_.emplace(scene_, mesh_);
  panes_.emplace(scene_);
  if (std::ranges::any_of(scene_.materials, &Material::is_specular)) {
    paths_.emplace(scene_, *caster_, options.form_factors.max_specular_depth, PathDetail::points);
  }
  // No fewer cells are searched than Tregenza's rows have, whose cells are as wide as windows.
  options_.patches.stride = std::min(options_.patches.stride, options_.sky_subdivision);
  weights_ = luminous_weights(scene_.bands);
  if (options_.direct_only) return;
  FormFactorOptions rows = options.form_factors;
  rows.run.progress = options.progress;
  form_factors_ = compute_form_factors(lit(), rows);
  view_patches();
}

Surroundings DaylightModel::around() const {
  return {*caster_, *panes_, paths_ ? &*paths_ : nullptr, scene_.bands.count()};
}

std::uint64_t DaylightModel::patch_key(int patch) const {
  return random_key(of_patch, static_cast<std::uint64_t>(patch), options_.replica);
}

std::uint64_t DaylightModel::sensor_key(int sensor) const {
  return random_key(of_sensor, static_cast<std::uint64_t>(sensor), options_.replica);
}

Eigen::ArrayXf DaylightModel::luminous_sum(const Eigen::Ref<const Eigen::ArrayXXf>& bands) const {
  return (bands.matrix() * weights_.matrix()).array();
}

std::vector<SurfacePoint> DaylightModel::points_of_patch(int patch) const {
  const PatchSampler sampler(mesh_, patch);
  const SobolPoints sobol(options_.points_of_patch);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < options_.points_of_patch; ++i) {
    const Eigen::Array4f u = sobol.point(i, patch_key(patch));
    const PatchPoint point = sampler.point(double{u[2]}, double{u[3]});
    points.push_back({.position = point.position,
                      .normal = point.normal,
                      .facet = mesh_.facet[static_cast<std::size_t>(point.element)]});
  }
  return points;
}

void DaylightModel::view_patches() {
  patch_views_.resize(static_cast<std::size_t>(mesh_.patch_count()));
  for_each_index(
      mesh_.patch_count(), patches_at_once, "sky at patches", options_.progress, [&](int p) {
        patch_views_[static_cast<std::size_t>(p)] =
            view_of_dome(around(), sky_, points_of_patch(p), options_.patches, patch_key(p));
      });
}

void DaylightModel::set_sensors(std::span<const GatherPoint> sensors) {
  sensors_.assign(sensors.begin(), sensors.end());
  sensor_views_.resize(sensors_.size());
  for_each_index(sensor_count(), 1, "sky at sensors", options_.progress, [&](int i) {
    const auto sensor = static_cast<std::size_t>(i);
    sensor_views_[sensor] = view_of(sky_, sensors_[sensor], options_.points, i);
  });
  // The sun is up in half of a year's hours and a little more, for its disc and the air's
  // refraction.
  constexpr int hours_of_sun = 4400;
  const bool has_fewer_sources = sensor_count() > sky_.column_count() + hours_of_sun;
  importance_ = options_.direct_only || has_fewer_sources
                    ? BandArray()
                    : importance(sensors_, options_.gather_rays);
}

DomeView DaylightModel::view_of(const SkyPatches& sky, const GatherPoint& point,
                                const DomeEffort& effort, int number) const {
  const SurfacePoint at = surface_point(point);
  return view_of_dome(around(), sky, {&at, 1}, effort, sensor_key(number));
}

LitScene DaylightModel::lit() const {
  return {scene_, *caster_, *direct_light_};
}

GatherOptions DaylightModel::gather_options(int rays) const {
  GatherOptions gather{.rays = rays, .replica = options_.replica};
  gather.run.progress = options_.progress;
  return gather;
}

BandArray DaylightModel::gather(const BandArray& of_patches, const GatherPoints& points,
                                int rays) const {
  return gather_indirect(lit(), to_vertices(mesh_, of_patches), points, gather_options(rays))
      .indirect;
}

BandArray DaylightModel::radiosity(const BandArray& arriving) const {
  return solve_columns(mesh_, *form_factors_, arriving, options_.tolerance, options_.progress);
}

BandArray DaylightModel::shares_in_gather(const GatherPoints& points, int rays) const {
  return gather_patch_shares(lit(), points, gather_options(rays));
}

BandArray DaylightModel::importance(const GatherPoints& points, int rays) const {
  // The ground before a window has a thousandth of the importance of walls behind the window, and
  // a thousand times their light: as exact as light itself is in rooms (see tolerance).
  constexpr double importance_outdoors = 1e-3;
  return solve_importance(mesh_, *form_factors_, shares_in_gather(points, rays),
                          importance_outdoors * options_.tolerance, options_.progress);
}

BandArray reflected_by_importance(const BandArray& importance, const BandArray& arriving,
                                  Eigen::Index bands) {
  const Eigen::Index points = importance.cols() / bands, sources = arriving.cols() / bands;
  BandArray E(points, arriving.cols());
  for (Eigen::Index b = 0; b < bands; ++b) {
    const auto of_band = [&](const BandArray& all, Eigen::Index count) -> BandArray {
      return all(Eigen::all, Eigen::seqN(b, count, bands));
    };
    const BandArray weights = of_band(importance, points), light = of_band(arriving, sources);
    constexpr int width = 64;
    parallel_for(static_cast<int>((sources + width - 1) / width), 1, [&](int begin, int end) {
      const Eigen::Index first = Eigen::Index{begin} * width,
                         n = std::min(Eigen::Index{end} * width, sources) - first;
      const BandArray part = weights.matrix().transpose() * light.middleCols(first, n).matrix();
      E(Eigen::all, Eigen::seqN(first * bands + b, n, bands)) = part;
    });
  }
  return E;
}

// Rays of each of many sensors, which are cast again for each block of sources, and read all of
// their columns.
int DaylightModel::rays_of_many() const {
  return std::max(1, options_.gather_rays / 4);
}

// The light that surfaces reflect to the sensors, sensors x sources, for E0 of patches x columns.
Eigen::ArrayXXf DaylightModel::reflected(const BandArray& arriving) const {
  const Eigen::Index bands = scene_.bands.count(), sources = arriving.cols() / bands;
  Eigen::ArrayXXf lux = Eigen::ArrayXXf::Zero(sensor_count(), sources);
  if (sensors_.empty()) return lux;
  const BandArray E = importance_.size() > 0
                          ? reflected_by_importance(importance_, arriving, bands)
                          : gather(radiosity(arriving), sensors_, rays_of_many());
  for (Eigen::Index s = 0; s < sources; ++s) {
    lux.col(s) = (E.middleCols(s * bands, bands).matrix() * weights_.matrix()).array();
  }
  return lux;
}

SensorLight DaylightModel::sky_coefficients() const {
  const Eigen::Index bands = scene_.bands.count(), columns = sky_.column_count();
  SensorLight light{.direct = Eigen::ArrayXXf(sensor_count(), columns),
                    .reflected = Eigen::ArrayXXf::Zero(sensor_count(), columns)};
  for (int i = 0; i < sensor_count(); ++i) {
    light.direct.row(i) =
        luminous_sum(sensor_views_[static_cast<std::size_t>(i)].coefficient).transpose();
  }
  if (options_.direct_only) return light;
  BandArray arriving(mesh_.patch_count(), columns * bands);
  for (int p = 0; p < mesh_.patch_count(); ++p) {
    const Eigen::ArrayXXf& E0 = patch_views_[static_cast<std::size_t>(p)].coefficient;
    for (Eigen::Index c = 0; c < columns; ++c)
      arriving.row(p).segment(c * bands, bands) = E0.row(c);
  }
  light.reflected = reflected(arriving);
  return light;
}

Eigen::ArrayXXf DaylightModel::direct_sun(std::span<const SunDisc> suns) const {
  Eigen::ArrayXXf direct(sensor_count(), static_cast<Eigen::Index>(suns.size()));
  for_each_index(sensor_count(), 1, "sun at sensors", options_.progress, [&](int i) {
    const SurfacePoint point = surface_point(sensors_[static_cast<std::size_t>(i)]);
    direct.row(i) =
        luminous_sum(sunlight(around(), {&point, 1}, sensor_views_[static_cast<std::size_t>(i)],
                              suns, options_.sun_rays, sensor_key(i)))
            .transpose();
  });
  return direct;
}

// Irradiance of a patch straight from each sun, suns x bands.
Eigen::ArrayXXf DaylightModel::sun_at_patch(int patch, std::span<const SunDisc> suns,
                                            int rays) const {
  return sunlight(around(), points_of_patch(patch), patch_views_[static_cast<std::size_t>(patch)],
                  suns, rays, patch_key(patch));
}

SensorLight DaylightModel::sun_coefficients(std::span<const SunDisc> suns) const {
  const Eigen::Index bands = scene_.bands.count(), count = static_cast<Eigen::Index>(suns.size());
  SensorLight light{.direct = direct_sun(suns),
                    .reflected = Eigen::ArrayXXf::Zero(sensor_count(), count)};
  if (options_.direct_only) return light;
  BandArray arriving(mesh_.patch_count(), count * bands);
  for_each_index(mesh_.patch_count(), patches_at_once, "sun at patches", options_.progress,
                 [&](int p) {
                   const Eigen::ArrayXXf E0 = sun_at_patch(p, suns, options_.sun_rays_of_patch);
                   for (Eigen::Index s = 0; s < count; ++s)
                     arriving.row(p).segment(s * bands, bands) = E0.row(s);
                 });
  light.reflected = reflected(arriving);
  return light;
}

BandArray DaylightModel::hourly_arriving(std::span<const SkyHour> hours, double ground_reflectance,
                                         int sun_rays) const {
  const Eigen::Index bands = scene_.bands.count(), count = static_cast<Eigen::Index>(hours.size());
  const BandArray luminance = hour_luminances(sky_, hours, ground_reflectance);
  std::vector<SunDisc> suns;
  std::vector<Eigen::Index> hour_of_sun;
  for (Eigen::Index h = 0; h < count; ++h) {
    const SkyHour& hour = hours[static_cast<std::size_t>(h)];
    if (!(hour.sun_lux > 0.0)) continue;
    suns.emplace_back(sky_, hour.sun);
    hour_of_sun.push_back(h);
  }
  BandArray arriving(mesh_.patch_count(), count * bands);
  for_each_index(
      mesh_.patch_count(), patches_at_once, "sun at patches", options_.progress, [&](int p) {
        arriving.row(p).setZero();
        const Eigen::ArrayXXf sun = sun_at_patch(p, suns, sun_rays);
        for (Eigen::Index s = 0; s < sun.rows(); ++s) {
          const Eigen::Index h = hour_of_sun[static_cast<std::size_t>(s)];
          const auto lux = static_cast<float>(hours[static_cast<std::size_t>(h)].sun_lux);
          arriving.row(p).segment(h * bands, bands) = lux * sun.row(s);
        }
      });
  add_dome(luminance, arriving);
  return arriving;
}

// Adds the light straight from dome and ground, patches x (hours x bands), whose luminances are
// columns of the sky x hours.
void DaylightModel::add_dome(const BandArray& luminance, BandArray& arriving) const {
  const Eigen::Index bands = scene_.bands.count(), count = luminance.cols();
  // Luminances of so many hours stay in a processor's cache from patch to patch of a block.
  constexpr Eigen::Index width = 128;
  constexpr int block = 32;
  const int patches = mesh_.patch_count();
  const auto add = [&](int p, Eigen::Index first, Eigen::Index n) {
    const Eigen::ArrayXXf& D = patch_views_[static_cast<std::size_t>(p)].coefficient;
    BandArray E0 = BandArray::Zero(bands, n);
    for (Eigen::Index c = 0; c < luminance.rows(); ++c) {
      if (!(D.row(c) > 0.0f).any()) continue;
      for (Eigen::Index b = 0; b < bands; ++b) {
        E0.row(b) += D(c, b) * luminance.row(c).segment(first, n);
      }
    }
    for (Eigen::Index h = 0; h < n; ++h) {
      arriving.row(p).segment((first + h) * bands, bands) += E0.col(h).transpose();
    }
  };
  for_each_index((patches + block - 1) / block, 1, "sky at patches", options_.progress, [&](int i) {
    for (Eigen::Index first = 0; first < count; first += width) {
      for (int p = i * block; p < std::min((i + 1) * block, patches); ++p) {
        add(p, first, std::min(width, count - first));
      }
    }
  });
}

}  // namespace lightwell
