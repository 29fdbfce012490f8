#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mesh/build_patches.h"
#include "radiosity/emitters/free_source.h"
#include "radiosity/form_factors/form_factors.h"
#include "raytrace/readings/lux_grid.h"
#include "scene/progress.h"

namespace lightwell {

/// Effort of a PlacedLight.
struct PlacedLightOptions {
  MeshOptions mesh{};
  FormFactorOptions form_factors{};
  int gather_rays = 1024;      ///< of a point, for its importance; a power of two
  int points_of_patch = 16;    ///< that get direct light of a lamp; a power of two
  int points_of_opening = 64;  ///< of a lamp, that light a grid's point; a power of two
  Progress progress{};
};

/// Receivers of light: points of grids, and eyes.
struct LightReceivers {
  std::vector<LuxGrid> grids{};
  std::vector<Camera> eyes{};
};

/// Values for each lamp at full level, and their derivatives by its place, 1/m: receivers x lamps.
struct PlacedValues {
  Eigen::MatrixXd value{};
  std::array<Eigen::MatrixXd, 3> slope{};  ///< by x, y and z
};

/// Light of lamps in some places.
struct PlacedReadings {
  PlacedValues lux{};         ///< at the points of all grids, one grid behind the other, lx
  PlacedValues glare{};       ///< at the eyes, glare_share(), cd^2/m^4 sr
  PlacedValues background{};  ///< at the eyes, part of L_b by reflected light, cd/m^2
};

/// Light of lamps at any places, in a room whose exchange of light is computed once:
///
///     E(p; x) = E_direct(p; x) + sum_j w_j(p) E_j(x)       x: place of the lamp
///     dE/dx = dE_direct/dx + sum_j w_j(p) dE_j/dx
///
/// E_j is the direct irradiance of patch j, and w_j(p) the importance of the patch (see
/// solve_importance()): what one unit of E_j gives the point by all reflections. Importance does
/// not depend on lamps, so one solve for each point serves all places.
///
/// Direct light and its derivative are sums over the same pairs of points, of a lamp's opening and
/// of a receiver, each times what passes between the two. The derivative takes visibility as fixed:
/// a shadow's edge that wanders over a patch or a point is not part of it. Light by way of mirrors,
/// gloss and clear bodies is part of E only after a diffuse reflection. Grids of cylinders are
/// means of planes (see cylinder_probes()). The derivative of glare_share() is a central
/// difference.
class PlacedLight {
 public:
  /// `lamps`: indices into Scene::lamps, of lamps that project no picture. `luminous_heights`: see
  /// unified_glare_rating(). Keeps a copy of the scene without its light. Throws InputError for a
  /// scene without surfaces, Interrupted when progress says stop.
  PlacedLight(const Scene& scene, std::span<const int> lamps, LightReceivers receivers,
              std::span<const double> luminous_heights = {},
              const PlacedLightOptions& options = {});
  ~PlacedLight();
  PlacedLight(const PlacedLight&) = delete;
  PlacedLight& operator=(const PlacedLight&) = delete;

  /// The light with each lamp at its place, m: 3 x lamps. The same places give the same bits.
  PlacedReadings at(const Eigen::Matrix3Xd& places) const;

 private:
  struct Room;
  std::unique_ptr<const Room> room_;
  std::vector<FreeSource> sources_{};
  std::vector<double> luminous_heights_{};  // of each source
};

}  // namespace lightwell
