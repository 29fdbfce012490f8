#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lightwell {

/// A lighting class of EN 13201-2:2015 and its limits, 0 where it has none.
///
///     M1 ... M6     carriageways for drivers: luminance
///     C0 ... C5     conflict areas: horizontal illuminance
///     P1 ... P7     footways, cycle paths, slow roads: horizontal illuminance; P7 has no limit
///     SC1 ... SC9   faces: least semi-cylindrical illuminance, 1.5 m above the ground
///     EV1 ... EV6   upright surfaces: least vertical illuminance, 1.5 m above the ground
struct RoadClass {
  std::string key{};
  double luminance = 0.0;                ///< least mean L_m, cd/m^2
  double uniformity = 0.0;               ///< least U_o
  double wet_uniformity = 0.0;           ///< least U_o of the wet road
  double longitudinal_uniformity = 0.0;  ///< least U_l
  double threshold_increment = 0.0;      ///< greatest f_TI, percent
  double edge_ratio = 0.0;               ///< least R_EI
  double mean = 0.0;                     ///< least E_m, lx
  double greatest_mean = 0.0;            ///< greatest E_m, lx
  double least = 0.0;                    ///< least E_min, lx
  double semicylindrical = 0.0;          ///< least E_sc,min, lx
  double vertical = 0.0;                 ///< least E_v,min, lx

  bool is_of_luminance() const { return luminance > 0.0; }
  /// False for P7 alone, whose performance EN 13201-2 leaves undetermined.
  bool has_limits() const {
    return is_of_luminance() || mean > 0.0 || semicylindrical > 0.0 || vertical > 0.0;
  }
};

/// All classes, in the order above.
const std::vector<RoadClass>& road_classes();

/// The class of a key, such as "M3"; empty if there is none.
std::optional<RoadClass> find_road_class(const std::string& key);

}  // namespace lightwell
