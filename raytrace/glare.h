#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mesh/elements/element_caster.h"
#include "radiosity/emitters/direct_light.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"
#include "scene/scene.h"

namespace lightwell {

/// Guth's position index of what is seen `sigma` degrees beside the line of sight, in a direction
/// `tau` degrees from straight up around it. Above the line of sight after Levin 1975, which CIE
/// 117 tabulates:
///
///     ln p = (35.2 - 0.31889 tau - 1.22 exp(-2 tau / 9)) 1e-3 sigma
///            + (21 + 0.26667 tau - 0.002963 tau^2) 1e-5 sigma^2
///
/// below it, where CIE 117 has none, after Iwata & Tokura 1997: p = 1 + 0.8 r for r = tan sigma up
/// to 0.6, beyond 1 + 1.2 r. sigma in [0, 90), tau in [0, 180]; p >= 1.
double position_index(double sigma, double tau);

/// What is seen of a luminaire's opening and of luminous sides so high, those of a box or of a
/// cylinder over an ellipse: m^2, projected along `way`, unit, in the luminaire's own frame.
double luminous_area(const LampOpening& opening, double height, const Eigen::Vector3d& way);

/// Whether what lies so far along the line of sight, beside it and above it counts for glare: the
/// table of CIE 117 ends at 3 times the distance along it to the sides, and at 1.9 times above.
bool counts_for_glare(double ahead, double beside, double above);

/// What an observer sees of one luminaire, or of all of one name.
struct GlareSource {
  std::string name{};
  double solid_angle = 0.0;     ///< sr, of what is seen of it
  double luminance = 0.0;       ///< cd/m^2, mean over that
  double position_index = 0.0;  ///< that with which it would be as bad as it is in one place
  double share = 0.0;           ///< int L^2 / p^2 dw, cd^2 / m^4 sr
};

struct Glare {
  /// The unified glare rating, 8 log10(0.25 / L_b sum L^2 w / p^2) (CIE 117-1995), not below 0;
  /// empty where no luminaire is in sight, or nothing is lit.
  std::optional<double> ugr{};
  double background = 0.0;             ///< L_b = E_i / pi, cd/m^2
  std::vector<GlareSource> sources{};  ///< those in sight, in the order of the scene
  std::vector<std::string>
      left_out{};  ///< lamps without a luminous area, for which there is no UGR
};

/// For an eye at a camera's place that looks along it, of what counts_for_glare(). E_i is the
/// illuminance of the eye by what surfaces reflect. Luminaires are surfaces that emit and lamps
/// with an opening, as bright as they are in the solution; sky and sun are none, and what is seen
/// through glass or in mirrors is left out. `gathering` is for E_i. `luminous_heights`, m, one for
/// each of the scene's lamps or none: of the sides around an opening that shine as well (see
/// luminous_area); they are taken to stand where the opening is.
Glare unified_glare_rating(const Scene& scene, const ElementCaster& caster,
                           const DirectLight& direct_light, const RadiositySolution& solution,
                           const Camera& eye, const GatherOptions& gathering,
                           std::span<const double> luminous_heights = {});

}  // namespace lightwell
