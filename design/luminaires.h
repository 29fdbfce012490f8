#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "design/limits_file.h"
#include "design/places/allowed_places.h"
#include "radiosity/solution/solution.h"
#include "scene/io/lighting_design.h"
#include "viewer/report/requested_grids.h"

namespace lightwell {

/// A lamp, or a surface that emits light. Luminaires that share a name are told apart by a number:
/// "panel 1", "panel 2".
struct Luminaire {
  std::string name{};
  std::string shared_name{};  ///< the name in the scene, without the number
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, the middle
  double watts = 0.0;                                  ///< electric power; 0: unknown
  double lumens = 0.0;                                 ///< flux as solved, at full level
  int channel = -1;                                    ///< of the solution
};

/// Channels for dimming: one for each luminaire, or for each group, and one each for sky and sun.
/// A name in a group stands for all luminaires that share it, for one with its number, or for those
/// that match it as a pattern. Throws InputError if a name stands for no luminaire, if a luminaire
/// would be in two groups, and for more than most_channels channels.
EmitterChannels dimming_channels(const Scene& scene, std::span<const WordedGroup> groups);

/// Throws InputError if the scene has no luminaires, or none of a name in `watts`.
void require_luminaires(const Scene& scene, std::span<const NamedNumber> watts);

/// The lamps that [[move]] tables name, and the places that they may have. Throws InputError for a
/// name that stands for no luminaire, for a surface that emits light and for a lamp that projects a
/// picture, which are not moved, for a lamp of two tables, for a box that does not hold its lamp,
/// and for lamps that are closer to each other than they may be.
AllowedPlaces allowed_places(const Scene& scene, std::span<const WordedMove> moves);

/// The luminaires of a solution with channels, surfaces first; surfaces without patches are left
/// out. Throws InputError for a luminaire without a channel, or with several. Power is that of the
/// design, or that in `watts` for luminaires of a name.
std::vector<Luminaire> luminaires_of(const Scene& scene, const SolvedScene& solved,
                                     const LightingDesign& design,
                                     std::span<const NamedNumber> watts);

}  // namespace lightwell
