#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "daylight/year_basis.h"
#include "scene/io/weather/weather_file.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

/// A year of daylight of a BakedModel: the light of each vertex as a sum of terms with a weight for
/// each hour (see YearBasis), and all that a page needs to add the light straight from the sun.
///
/// Light is lx of red, green and blue. Their sum, weighted by the luminance of the primaries of
/// Rec. 709, is the illuminance.
struct BakedYear {
  int bands = 3;             ///< 1: the light of every term is grey
  BandArray light{};         ///< vertices x (bands x terms), the terms of a band side by side
  RgbArray reflectance{};    ///< as shown, of each vertex (see shown_reflectance)
  Eigen::ArrayXXf weight{};  ///< hours x terms
  double error = 0.0;        ///< of YearBasis
  std::vector<SkyHour> hours{};
  Eigen::Array3f white{};  ///< light of a sun of 1 lx
  double ground_reflectance = 0.2;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), north = Eigen::Vector3d::UnitY();
  // Place and calendar of the weather.
  std::string place{};
  double latitude = 0.0, longitude = 0.0, hours_east = 0.0;
  bool is_leap_year = false;

  /// Transmittance of the materials of clear panes at cosines 0, 1/n, ... 1 of the angle of
  /// incidence, of unpolarised light: n + 1 rows each.
  std::vector<RgbArray> panes{};
  /// Per face of the model: 1 + the index of its pane; 0: sunlight does not pass; `other_side`: the
  /// other side of a pane, which is counted already.
  std::vector<std::uint8_t> pane_of_face{};
  static constexpr std::uint8_t other_side = 255;
};

/// Number of steps of BakedYear::panes.
inline constexpr int pane_steps = 64;

/// A computed year, for bake_year().
struct YearOfLight {
  const DaylightModel& model;
  const YearBasis& basis;
  std::span<const SkyHour> hours{};
  const Weather& weather;
  double ground_reflectance = 0.2;
};

/// The model of a page with a year. `scene` is that of the daylight model as it was read; `names`
/// are as for bake_model(). The scene's lamps, emission and sky are left out. Throws what
/// bake_model() throws, and InputError for more than 254 materials of panes.
BakedModel bake_year(const YearOfLight& year, const Scene& scene, const Provenance& provenance,
                     const JoinedSurfaces* names = nullptr);

}  // namespace lightwell
