#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "daylight/dome_view.h"
#include "daylight/sky_year.h"
#include "mesh/build_patches.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/form_factors/form_factors.h"
#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// The scene without light of its own, for daylight is that of sun and sky alone: lamps, emission
/// and sky are left out.
Scene without_light(Scene scene);

/// Effort of a DaylightModel.
struct DaylightOptions {
  int sky_subdivision = 4;  ///< of SkyPatches: 2305 patches
  MeshOptions mesh{.auto_patch_count = 3200};
  FormFactorOptions form_factors{};
  /// Error of the equations, relative to the brightest patch. That patch lies outdoors, and a room
  /// behind a window may have a thousandth of its light.
  double tolerance = 1e-6;
  DomeEffort points{.search = 4, .rays = 4096};
  DomeEffort patches{.search = 1, .rays = 1024, .stride = 4};
  int points_of_patch = 16;   ///< points of a patch whose view is averaged; a power of two
  int sun_rays = 16;          ///< of a sensor to the sun's disc; a power of two
  int sun_rays_of_patch = 4;  ///< of a patch to the sun's disc; a power of two
  /// Rays of a sensor for light that surfaces reflect; a quarter of these where the sensors are
  /// more than the sources of a year.
  int gather_rays = 4096;
  std::uint64_t replica = 0;  ///< another number gives independent rays
  /// True for what sensors see of sun, sky and ground alone: surfaces reflect nothing, and no form
  /// factors are computed.
  bool direct_only = false;
  Progress progress{};
};

/// Reflected and direct light of sensors, each for a source of its own: sensors x sources.
struct SensorLight {
  Eigen::ArrayXXf direct{}, reflected{};

  Eigen::ArrayXXf sum() const { return direct + reflected; }
};

/// A room for daylight: its exchange of light between patches, computed once, and what each patch
/// and each sensor sees of the dome.
///
/// Light is linear, so that the light of a source is a column of
///
///     B = rho (E0 + F B)      E0: irradiance of patches straight from the source
///
/// with the same form factors for every sky patch and every sun of the year (daylight coefficients:
/// Tregenza & Waters 1983). Light at a sensor is the source's own, seen through windows, and that
/// of all surfaces by a final gather.
///
/// A room has thousands of sources and mostly fewer sensors. Reflected light is then found from the
/// other side: the importance of all patches for each sensor is a column, and the light of every
/// source a sum over patches.
///
/// Illuminance is per unit: of a sky patch lx over cd/m^2, of the sun lx over the lx across its
/// rays. Daylight is white, with the same power in each band; materials tint the light.
class DaylightModel {
 public:
  /// Lamps, emission and sky of the scene are left out. `up` and `north` are unit and
  /// perpendicular. Throws InputError for a scene without surfaces, std::invalid_argument for
  /// options out of range, Interrupted when progress says stop.
  DaylightModel(Scene scene, const Eigen::Vector3d& up, const Eigen::Vector3d& north,
                const DaylightOptions& options = {});
  DaylightModel(const DaylightModel&) = delete;
  DaylightModel& operator=(const DaylightModel&) = delete;

  const Scene& scene() const { return scene_; }
  const PatchMesh& mesh() const { return mesh_; }
  const ElementCaster& caster() const { return *caster_; }
  const SkyPatches& sky() const { return sky_; }
  const DaylightOptions& options() const { return options_; }
  /// Share of each band in the illuminance of white light; their sum is 1.
  const Eigen::ArrayXf& band_weights() const { return weights_; }

  /// Sets the sensors; keeps a copy.
  void set_sensors(std::span<const GatherPoint> sensors);
  const std::vector<GatherPoint>& sensors() const { return sensors_; }
  int sensor_count() const { return static_cast<int>(sensors_.size()); }

  /// Coefficients of the columns of sky() at the sensors.
  SensorLight sky_coefficients() const;
  /// Illuminance of the sensors straight from each sun, sensors x suns.
  Eigen::ArrayXXf direct_sun(std::span<const SunDisc> suns) const;
  /// Illuminance of the sensors by each sun.
  SensorLight sun_coefficients(std::span<const SunDisc> suns) const;

  /// Irradiance E0 of the patches straight from the whole sky of each hour, dome, ground and sun,
  /// lx: patches x (hours x bands), the bands of an hour side by side, each as bright as all light.
  /// `sun_rays` as DaylightOptions::sun_rays_of_patch.
  BandArray hourly_arriving(std::span<const SkyHour> hours, double ground_reflectance,
                            int sun_rays) const;
  /// B = rho (E0 + F B) for E0 of patches x (sources x bands), in the same columns.
  BandArray radiosity(const BandArray& arriving) const;
  /// Importance of the patches for the light that surfaces reflect to points, which gather by
  /// `rays` each: patches x (points x bands).
  BandArray importance(const GatherPoints& points, int rays) const;
  /// Irradiance of points by such radiosities of patches, by `rays` each: points x columns of
  /// `of_patches`.
  BandArray gather(const BandArray& of_patches, const GatherPoints& points, int rays) const;
  /// View of `sky` from a point, which has the random numbers of the sensor `number`.
  DomeView view_of(const SkyPatches& sky, const GatherPoint& point, const DomeEffort& effort,
                   int number) const;

 private:
  LitScene lit() const;
  GatherOptions gather_options(int rays) const;
  Surroundings around() const;
  std::uint64_t patch_key(int patch) const;
  std::uint64_t sensor_key(int sensor) const;
  Eigen::ArrayXf luminous_sum(const Eigen::Ref<const Eigen::ArrayXXf>& bands) const;
  std::vector<SurfacePoint> points_of_patch(int patch) const;
  void view_patches();
  void add_dome(const BandArray& luminance, BandArray& arriving) const;
  Eigen::ArrayXXf sun_at_patch(int patch, std::span<const SunDisc> suns, int rays) const;
  int rays_of_many() const;
  BandArray shares_in_gather(const GatherPoints& points, int rays) const;
  Eigen::ArrayXXf reflected(const BandArray& arriving) const;

  Scene scene_;
  DaylightOptions options_;
  SkyPatches sky_;
  PatchMesh mesh_;
  std::optional<ElementCaster> caster_{};
  std::optional<DirectLight> direct_light_{};
  std::optional<ClearPanes> panes_{};
  std::optional<LightPaths> paths_{};  // empty where nothing mirrors or refracts
  Eigen::ArrayXf weights_{};           // of bands in illuminance, of sum 1
  std::unique_ptr<FormFactors> form_factors_{};
  std::vector<DomeView> patch_views_{};
  std::vector<GatherPoint> sensors_{};
  std::vector<DomeView> sensor_views_{};
  BandArray importance_{};  // of the patches for the sensors; empty where sources are fewer
};

/// Light that surfaces reflect to points by DaylightModel::importance(), for E0 of patches x
/// (sources x bands): points x (sources x bands).
BandArray reflected_by_importance(const BandArray& importance, const BandArray& arriving,
                                  Eigen::Index bands);

}  // namespace lightwell
