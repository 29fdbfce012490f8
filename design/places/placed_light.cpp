#include "design/places/placed_light.h"

#include <cstdint>
#include <numbers>
#include <utility>
#include <variant>

#include "daylight/daylight_model.h"
#include "design/places/kernel_slope.h"
#include "mesh/patches/patch_sampler.h"
#include "radiosity/patch_light.h"
#include "radiosity/solvers/solve_columns.h"
#include "radiosity/visibility/absorbing_bodies.h"
#include "radiosity/visibility/clear_panes.h"
#include "radiosity/visibility/shadow_rays.h"
#include "raytrace/readings/cylinder.h"
#include "raytrace/readings/glare.h"
#include "raytrace/readings/probe_surface.h"
#include "scene/parallel.h"
#include "scene/random_purpose.h"

namespace lightwell {
namespace {

// Columns of a lamp, each of all bands: the irradiance, and its derivatives by x, y and z.
constexpr Eigen::Index value_and_slopes = 4;

// Error of importance, relative to its largest (see solve_columns()): a hundredth of that of 1 %
// that light is solved for.
constexpr double importance_tolerance = 1e-4;

// A plane whose irradiance is a share of a reading: that of a grid's point, or of an eye, which
// gets reflected light alone.
struct ReadingPlane {
  int reading = 0;  // through all grids, then eyes
  float share = 1.0f;
  bool is_of_eye = false;
};

// The planes whose mean is the reading of a grid's point.
std::vector<Probe> planes_of(const LuxGrid& grid, const Probe& point) {
  if (grid.quantity == GridQuantity::planar || grid.quantity == GridQuantity::vertical) {
    return {point};
  }
  std::vector<Probe> planes = cylinder_probes(grid, point.position);
  planes.resize(planes_of_a_cylinder);
  return planes;
}

// Columns of readings from columns of their planes: rows x (planes x bands) to rows x (readings x
// bands).
BandArray readings_of(const BandArray& of_planes, const std::vector<ReadingPlane>& planes,
                      Eigen::Index bands) {
  const Eigen::Index count = planes.empty() ? 0 : planes.back().reading + 1;
  BandArray readings = BandArray::Zero(of_planes.rows(), count * bands);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    readings.middleCols(planes[i].reading * bands, bands) +=
        planes[i].share * of_planes.middleCols(static_cast<Eigen::Index>(i) * bands, bands);
  }
  return readings;
}

}  // namespace

struct PlacedLight::Room {
  Scene scene;  // without light
  PlacedLightOptions options;
  PatchMesh mesh;
  ElementCaster caster;
  ClearPanes panes;
  std::shared_ptr<const AbsorbingBodies> bodies;  // null: no patch lies in one
  SobolPoints of_patch, of_opening;
  std::vector<GatherPoint> points_of_planes{};
  std::vector<ReadingPlane> planes{};
  BandArray importance{};  // patches x (readings x bands)
  Eigen::Index grid_points = 0;
  std::vector<Camera> eyes{};

  Room(const Scene& lit, LightReceivers receivers, const PlacedLightOptions& given);
  void set_planes(const LightReceivers& receivers);
  void find_importance();
  Spectrum passed(const Ray& ray) const;
  void add(const FreeSource& source, const SurfacePoint& at, const Eigen::Array2f& u, double share,
           Eigen::ArrayXXd& sum) const;
  Eigen::ArrayXXd at_patch(const FreeSource& source, int patch) const;
  Eigen::ArrayXXd at_plane(const FreeSource& source, std::size_t plane) const;
  BandArray light_of(const std::vector<FreeSource>& sources) const;
  PlacedValues glare_of(const std::vector<FreeSource>& sources,
                        const std::vector<double>& luminous_heights) const;
};

PlacedLight::Room::Room(const Scene& lit, LightReceivers receivers, const PlacedLightOptions& given)
    : scene(without_light(lit)),
      options(given),
      mesh(build_patches(scene, given.mesh, given.progress)),
      caster(mesh),
      panes(scene),
      bodies(AbsorbingBodies::find(scene, caster)),
      of_patch(given.points_of_patch),
      of_opening(given.points_of_opening) {
  set_planes(receivers);
  eyes = std::move(receivers.eyes);
  find_importance();
}

void PlacedLight::Room::set_planes(const LightReceivers& receivers) {
  std::vector<Probe> probes;
  int reading = 0;
  for (const LuxGrid& grid : receivers.grids) {
    for (const Probe& point : grid.points) {
      const std::vector<Probe> around = planes_of(grid, point);
      probes.insert(probes.end(), around.begin(), around.end());
      planes.insert(planes.end(), around.size(),
                    {.reading = reading++, .share = 1.0f / static_cast<float>(around.size())});
    }
  }
  grid_points = reading;
  points_of_planes = probe_points(caster, probes);
  for (const Camera& eye : receivers.eyes) {
    planes.push_back({.reading = reading++, .is_of_eye = true});
    points_of_planes.push_back({.position = eye.position, .normal = eye.direction});
  }
}

void PlacedLight::Room::find_importance() {
  const DirectLight no_light(scene, mesh);
  const LitScene dark{scene, caster, no_light};
  FormFactorOptions rows = options.form_factors;
  rows.run.progress = options.progress;
  const std::unique_ptr<FormFactors> form_factors = compute_form_factors(dark, rows);
  GatherOptions gather{.rays = options.gather_rays};
  gather.run.progress = options.progress;
  const BandArray received =
      readings_of(gather_patch_shares(dark, points_of_planes, gather), planes, scene.bands.count());
  importance =
      solve_importance(mesh, *form_factors, received, importance_tolerance, options.progress);
}

Spectrum PlacedLight::Room::passed(const Ray& ray) const {
  if (!panes.empty()) return panes.passed(caster, ray);
  std::uint8_t blocked = 0;
  caster.occluded({&ray, 1}, {&blocked, 1});
  return constant_spectrum(scene.bands, blocked ? 0.0f : 1.0f);
}

// Adds `share` of the light of a source's point to `sum`, bands x value_and_slopes.
void PlacedLight::Room::add(const FreeSource& source, const SurfacePoint& at,
                            const Eigen::Array2f& u, double share, Eigen::ArrayXXd& sum) const {
  const ShadowSample sample = shadow_sample(source, at, double{u[0]}, double{u[1]});
  if (!(sample.weight > 0.0)) return;
  Eigen::ArrayXd light = share * (source.light * passed(sample.ray)).cast<double>();
  const Spectrum* absorption = bodies ? bodies->around(caster, at) : nullptr;
  if (absorption) {
    const double way = sample.ray.t_max * sample.ray.direction.norm();
    light *= left_after(*absorption, way).cast<double>();
  }
  if (!(light > 0.0).any()) return;
  const Lamp& lamp = std::get<LampLight>(source.shape).lamp;
  const KernelSlope slope = kernel_slope(lamp, at.position + sample.ray.direction, at);
  sum.col(0) += slope.kernel * light;
  for (Eigen::Index axis = 0; axis < 3; ++axis) sum.col(1 + axis) += slope.gradient[axis] * light;
  if (!absorption) return;
  // d exp(-a r) / dx = -a (v / r) exp(-a r) where v is the way to the lamp.
  const Eigen::Vector3d outwards = sample.ray.direction.normalized();
  const Eigen::ArrayXd dimming = slope.kernel * absorption->cast<double>() * light;
  for (Eigen::Index axis = 0; axis < 3; ++axis) sum.col(1 + axis) -= outwards[axis] * dimming;
}

// Mean over points of a patch, each lit by a point of the opening.
Eigen::ArrayXXd PlacedLight::Room::at_patch(const FreeSource& source, int patch) const {
  const PatchSampler sampler(mesh, patch);
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(scene.bands.count(), value_and_slopes);
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(patch), RandomPurpose::free_source_points);
  for (int i = 0; i < of_patch.count(); ++i) {
    const Eigen::Array4f u = of_patch.point(i, key);
    const PatchPoint point = sampler.point(double{u[2]}, double{u[3]});
    const SurfacePoint at{.position = point.position,
                          .normal = point.normal,
                          .facet = mesh.facet[static_cast<std::size_t>(point.element)]};
    add(source, at, u.head<2>(), 1.0 / of_patch.count(), sum);
  }
  return sum;
}

Eigen::ArrayXXd PlacedLight::Room::at_plane(const FreeSource& source, std::size_t plane) const {
  const GatherPoint& point = points_of_planes[plane];
  const SurfacePoint at{.position = point.position, .normal = point.normal, .facet = point.facet};
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(scene.bands.count(), value_and_slopes);
  if (planes[plane].is_of_eye) return sum;
  // Planes of one point share their numbers.
  const std::uint64_t key =
      random_key(static_cast<std::uint64_t>(planes[plane].reading), RandomPurpose::gather_shadows);
  const int count = has_sharp_shadows(source) ? 1 : of_opening.count();
  for (int i = 0; i < count; ++i) {
    add(source, at, of_opening.point(i, key).head<2>(), 1.0 / count, sum);
  }
  return sum;
}

PlacedLight::PlacedLight(const Scene& scene, std::span<const int> lamps, LightReceivers receivers,
                         std::span<const double> luminous_heights,
                         const PlacedLightOptions& options)
    : room_(std::make_unique<const Room>(scene, std::move(receivers), options)) {
  const std::vector<FreeSource> all = free_sources(scene, BandArray(), {});
  for (const int lamp : lamps) {
    const auto i = static_cast<std::size_t>(lamp);
    sources_.push_back(all[i]);
    luminous_heights_.push_back(i < luminous_heights.size() ? luminous_heights[i] : 0.0);
  }
}

PlacedLight::~PlacedLight() = default;

namespace {

FreeSource placed(FreeSource source, const Eigen::Vector3d& place) {
  std::get<LampLight>(source.shape).lamp.position = place;
  return source;
}

PlacedValues no_values(Eigen::Index receivers, Eigen::Index lamps) {
  PlacedValues values{.value = Eigen::MatrixXd::Zero(receivers, lamps)};
  values.slope.fill(values.value);
  return values;
}

// Light as a luminous quantity in a row: lamps x value_and_slopes x bands to the lamps of `values`.
void set_luminous(const Bands& bands, const Eigen::Ref<const Eigen::ArrayXf>& light,
                  Eigen::Index receiver, double factor, PlacedValues& values) {
  const Eigen::Index n = bands.count();
  for (Eigen::Index i = 0; i < values.value.cols(); ++i) {
    const auto of_column = [&](Eigen::Index c) {
      return factor * luminous(bands, light.segment((i * value_and_slopes + c) * n, n));
    };
    values.value(receiver, i) = of_column(0);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      values.slope[static_cast<std::size_t>(axis)](receiver, i) = of_column(1 + axis);
    }
  }
}

}  // namespace

// Irradiance and derivatives of all readings, readings x (lamps x value_and_slopes x bands).
BandArray PlacedLight::Room::light_of(const std::vector<FreeSource>& sources) const {
  const Eigen::Index bands = scene.bands.count(),
                     columns = static_cast<Eigen::Index>(sources.size()) * value_and_slopes * bands;
  const auto rows_of_light = [&](std::size_t count, auto light) {
    BandArray rows(static_cast<Eigen::Index>(count), columns);
    constexpr int grain = 16;
    parallel_for(static_cast<int>(count), grain, [&](int begin, int end) {
      for (int r = begin; r < end; ++r) {
        Eigen::Index first = 0;
        for (const FreeSource& source : sources) {
          const Eigen::ArrayXXd E = light(source, r);
          rows.row(r).segment(first, E.size()) = E.reshaped().transpose().cast<float>();
          first += E.size();
        }
      }
    });
    return rows;
  };
  const BandArray at_patches =
      rows_of_light(static_cast<std::size_t>(mesh.patch_count()),
                    [&](const FreeSource& source, int p) { return at_patch(source, p); });
  const BandArray at_planes = rows_of_light(planes.size(), [&](const FreeSource& source, int p) {
    return at_plane(source, static_cast<std::size_t>(p));
  });
  BandArray E = reflected_by_importance(importance, at_patches, bands);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    E.row(planes[i].reading) += planes[i].share * at_planes.row(static_cast<Eigen::Index>(i));
  }
  return E;
}

// Shares of glare, and their central differences.
PlacedValues PlacedLight::Room::glare_of(const std::vector<FreeSource>& sources,
                                         const std::vector<double>& luminous_heights) const {
  // Parts of an opening come into sight one after the other: the steps of a difference over as much
  // as a part, an eighth of a panel of 0.6 m, average out.
  constexpr double step = 0.075;  // m
  PlacedValues glare =
      no_values(static_cast<Eigen::Index>(eyes.size()), static_cast<Eigen::Index>(sources.size()));
  for (Eigen::Index i = 0; i < glare.value.cols(); ++i) {
    const FreeSource& source = sources[static_cast<std::size_t>(i)];
    const Eigen::Vector3d place = std::get<LampLight>(source.shape).lamp.position;
    for (Eigen::Index o = 0; o < glare.value.rows(); ++o) {
      const auto share_at = [&](const Eigen::Vector3d& at) {
        return glare_share(scene.bands, caster, placed(source, at),
                           eyes[static_cast<std::size_t>(o)],
                           luminous_heights[static_cast<std::size_t>(i)]);
      };
      glare.value(o, i) = share_at(place);
      for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3d along = step * Eigen::Vector3d::Unit(axis);
        glare.slope[static_cast<std::size_t>(axis)](o, i) =
            (share_at(place + along) - share_at(place - along)) / (2.0 * step);
      }
    }
  }
  return glare;
}

PlacedReadings PlacedLight::at(const Eigen::Matrix3Xd& places) const {
  const Room& room = *room_;
  const auto eyes = static_cast<Eigen::Index>(room.eyes.size());
  std::vector<FreeSource> sources;
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    sources.push_back(placed(sources_[static_cast<std::size_t>(i)], places.col(i)));
  }
  PlacedReadings readings{.lux = no_values(room.grid_points, places.cols()),
                          .glare = room.glare_of(sources, luminous_heights_),
                          .background = no_values(eyes, places.cols())};
  const BandArray E = room.light_of(sources);
  for (Eigen::Index p = 0; p < room.grid_points; ++p) {
    set_luminous(room.scene.bands, E.row(p).transpose(), p, 1.0, readings.lux);
  }
  for (Eigen::Index o = 0; o < eyes; ++o) {
    set_luminous(room.scene.bands, E.row(room.grid_points + o).transpose(), o, std::numbers::inv_pi,
                 readings.background);
  }
  return readings;
}

}  // namespace lightwell
