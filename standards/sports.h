#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/lighting_design.h"
#include "standards/requirement.h"

namespace lightwell {

/// Limits of EN 12193:2018 for a class of a sport; a limit of 0 is none.
struct SportLimits {
  double mean = 0.0;              ///< least E_m of the principal area, lx
  double uniformity = 0.0;        ///< least U_0
  double glare_rating = 0.0;      ///< greatest R_G
  double colour_rendering = 0.0;  ///< least R_a
};

/// A sport and its classes I, II and III.
struct Sport {
  std::string key{}, title{};
  std::array<SportLimits, 3> classes{};
};

/// The sports that the program knows by itself: the contents of standards/sports.toml.
std::vector<Sport> usual_sports();

/// Reads a table of sports (TOML; its keys are in docs/standards.md). Throws InputError naming
/// file, line and remedy.
std::vector<Sport> read_sports(const std::filesystem::path& file);

/// The limits of an area's sport and class (1 to 3). Throws InputError that begins with `asked_by`,
/// such as "area 'pitch'", and names the nearest key.
const SportLimits& sport_limits(const std::vector<Sport>& sports, const std::string& key,
                                int sport_class, const std::string& asked_by);

/// The grid of EN 12193 over the rectangle of another grid, where that has points: the odd number
/// of points nearest to d / p along the longer side d for p = 0.2 * 5^log10(d), at most 10 m, and
/// the odd number that gives about the same spacing across.
LuxGrid sport_grid(const LuxGrid& area);

/// A field towards a camera.
struct CameraField {
  GridField field{};
  const LuxGrid* grid = nullptr;
};

/// Measurements of a sports area, of maintained electric light.
struct SportPlace {
  std::string name{};
  GridField pitch{};
  std::vector<CameraField> cameras{};
  std::vector<NamedRating> observers{};   ///< R_G
  std::vector<NamedRating> luminaires{};  ///< R_a
};

/// The limits of EN 12193 that were measured.
std::vector<Requirement> sport_requirements(const SportPlace& place, const SportLimits& limits,
                                            const TelevisionLimits& cameras);

/// Greatest change between points that are neighbours along or across a grid, percent of the
/// brighter of both for one step of the grid (CIE 169:2005). Diagonal neighbours are left out. 0
/// for a single point.
struct Gradient {
  double percent = 0.0;
  /// Bound of the error: no change of any two neighbours lies above `percent + within` by their
  /// bounds. NaN if the bound of a point with a lit neighbour is not known.
  double within = 0.0;
};
Gradient greatest_gradient(const LuxGrid& grid, const LuxField& field);

namespace standards_data {
extern const std::string_view sports;  ///< the bytes of sports.toml
}  // namespace standards_data

}  // namespace lightwell
