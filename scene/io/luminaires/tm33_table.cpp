// Intensities of IES TM-33: one element for each direction, with attributes h (C) and v (gamma).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "scene/errors.h"
#include "scene/io/luminaires/tm33_file.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr std::size_t most_tm33_angles = 4000;
constexpr std::size_t most_tm33_sums = 1000000;  // planes of half a degree take 260 000

struct IntensityAt {
  double plane, gamma, value;
  pugi::xml_node element;
};

double angle_of(const XmlFile& file, const pugi::xml_node& data, const char* name, double most) {
  const pugi::xml_attribute attribute = data.attribute(name);
  if (!attribute) {
    file.fail(data, fmt::format("an intensity has no angle '{}'; it needs 'h' and 'v', in degrees",
                                name));
  }
  const double angle = file.number(data, fmt::format("angle {}", name), attribute.value());
  if (!(angle >= 0.0 && angle <= most)) {
    file.fail(data, fmt::format("the angle {} is {:g}; it must lie within 0 and {:g}", name, angle,
                                most));
  }
  return angle;
}

std::vector<IntensityAt> read_intensities(const XmlFile& file, const pugi::xml_node& intensity,
                                          double factor) {
  std::vector<IntensityAt> all;
  for (const pugi::xml_node data : intensity.children("IntData")) {
    const double value = file.number(data, "intensity", data.child_value());
    if (const std::string fault = fault_of_intensity(value, factor); !fault.empty()) {
      file.fail(data, fault);
    }
    all.push_back({.plane = angle_of(file, data, "h", 360.0),
                   .gamma = angle_of(file, data, "v", 180.0),
                   .value = value * factor,
                   .element = data});
  }
  if (all.empty()) {
    file.fail(intensity, "there is no <IntData>; give an intensity for each pair of angles");
  }
  return all;
}

std::vector<double> distinct(std::vector<double> angles) {
  std::ranges::sort(angles);
  const auto rest = std::ranges::unique(angles);
  angles.erase(rest.begin(), rest.end());
  return angles;
}

std::vector<double> angles_of(const std::vector<IntensityAt>& all, double IntensityAt::*angle) {
  std::vector<double> angles;
  angles.reserve(all.size());
  for (const IntensityAt& one : all) angles.push_back(one.*angle);
  return distinct(std::move(angles));
}

// Holds the number of angles to the one that the file states.
void check_count(const XmlFile& file, const pugi::xml_node& intensity, const char* stated,
                 const char* which, std::size_t count) {
  if (count > most_tm33_angles) {
    file.fail(intensity, fmt::format("there are {} {} angles; at most {} are read", count, which,
                                     most_tm33_angles));
  }
  const auto number = tm33_number(file, intensity, stated);
  if (number && *number != static_cast<double>(count)) {
    file.fail(intensity, fmt::format("{} is {:g}, and the intensities are at {} {} angles", stated,
                                     *number, count, which));
  }
}

PlaneSymmetry stated_symmetry(const XmlFile& file, const pugi::xml_node& element,
                              PlaneSymmetry of_angles) {
  using enum PlaneSymmetry;
  constexpr std::pair<const char*, PlaneSymmetry> known[] = {
      {"symm_none", none},     {"symm_bi_0", about_c0},   {"symm_bi_90", about_c90},
      {"symm_quad", quarters}, {"symm_full", all_around}, {"symm_arbitrary", none}};
  const std::string word = tm33_word(element.child_value());
  for (const auto& [name, symmetry] : known) {
    if (word != name) continue;
    // Planes of the whole circle hold whatever their symmetry.
    if (symmetry == of_angles || of_angles == none) return symmetry;
    file.fail(element, fmt::format("the symmetry is {}, and the horizontal angles are those of: {}",
                                   word, symmetry_words(of_angles)));
  }
  file.fail(element, fmt::format("the symmetry '{}' is unknown; it must be Symm_None, Symm_Bi_0, "
                                 "Symm_Bi_90, Symm_Quad, Symm_Full or Symm_Arbitrary",
                                 as_utf8(excerpt(element.child_value()))));
}

Eigen::ArrayXXd rows_of(const XmlFile& file, const std::vector<IntensityAt>& all,
                        const std::vector<double>& planes, const std::vector<double>& gammas) {
  const auto index = [](const std::vector<double>& angles, double angle) {
    return std::ranges::lower_bound(angles, angle) - angles.begin();
  };
  Eigen::ArrayXXd rows = Eigen::ArrayXXd::Constant(static_cast<Eigen::Index>(planes.size()),
                                                   static_cast<Eigen::Index>(gammas.size()), -1.0);
  for (const IntensityAt& one : all) {
    double& value = rows(index(planes, one.plane), index(gammas, one.gamma));
    if (value >= 0.0) {
      file.fail(one.element,
                fmt::format("the intensity at h {:g}, v {:g} is given twice; give it once",
                            one.plane, one.gamma));
    }
    value = one.value;
  }
  return rows;
}

// Intensity of a row at an angle gamma.
double along_gamma(const Tm33Table& table, Eigen::Index row, double gamma) {
  const std::vector<double>& at = table.gammas;
  if (gamma < at.front() || gamma > at.back()) return 0.0;
  const auto above = std::ranges::lower_bound(at, gamma) - at.begin();
  if (at[static_cast<std::size_t>(above)] == gamma) return table.values(row, above);
  const double low = at[static_cast<std::size_t>(above) - 1];
  const double high = at[static_cast<std::size_t>(above)];
  return std::lerp(table.values(row, above - 1), table.values(row, above),
                   (gamma - low) / (high - low));
}

double intensity_at(const Tm33Table& table, double plane, double gamma) {
  const std::vector<double>& at = table.planes;
  const auto above = std::ranges::upper_bound(at, plane) - at.begin();
  const bool is_last = above == std::ssize(at);
  const double low = at[static_cast<std::size_t>(above) - 1];
  const double high = is_last ? at.front() + 360.0 : at[static_cast<std::size_t>(above)];
  return std::lerp(along_gamma(table, above - 1, gamma),
                   along_gamma(table, is_last ? 0 : above, gamma), (plane - low) / (high - low));
}

}  // namespace

Tm33Table read_tm33_table(const XmlFile& file, const pugi::xml_node& intensity, double factor) {
  factor *= tm33_number(file, intensity, "Multiplier").value_or(1.0);
  if (!(factor > 0.0 && std::isfinite(factor))) {
    file.fail(intensity,
              fmt::format("multiplier and ballast factor make {:g}; they must be above 0", factor));
  }
  const std::vector<IntensityAt> all = read_intensities(file, intensity, factor);
  const std::vector<double> planes = angles_of(all, &IntensityAt::plane);
  Tm33Table table{.gammas = angles_of(all, &IntensityAt::gamma)};
  check_count(file, intensity, "NumberHorz", "horizontal", planes.size());
  check_count(file, intensity, "NumberVert", "vertical", table.gammas.size());
  if (table.gammas.size() < 2) {
    file.fail(intensity, "all intensities are at one vertical angle; give at least two angles");
  }
  if (all.size() != planes.size() * table.gammas.size()) {
    file.fail(intensity,
              fmt::format("there are {} intensities at {} horizontal and {} vertical angles; each "
                          "pair of angles needs one",
                          all.size(), planes.size(), table.gammas.size()));
  }
  const auto of_angles = symmetry_of_planes(planes);
  if (!of_angles) file.fail(intensity, no_symmetry_of_planes(planes));
  const pugi::xml_node stated = intensity.child("Symm");
  table.symmetry = stated ? stated_symmetry(file, stated, *of_angles) : *of_angles;
  PlaneTable unfolded =
      unfolded_planes(*of_angles, planes, rows_of(file, all, planes, table.gammas));
  table.planes = std::move(unfolded.planes);
  table.values = std::move(unfolded.values);
  return table;
}

Tm33Table sum_of_tm33_tables(const std::filesystem::path& path,
                             const std::vector<Tm33Table>& tables) {
  if (tables.size() == 1) return tables.front();
  constexpr double end = 1e-6;  // degrees; files state angles to hundredths
  Tm33Table sum;
  double first = 180.0, last = 0.0;
  for (const Tm33Table& table : tables) {
    first = std::min(first, table.gammas.front());
    last = std::max(last, table.gammas.back());
  }
  for (const Tm33Table& table : tables) {
    std::ranges::copy(table.planes, std::back_inserter(sum.planes));
    std::ranges::copy(table.gammas, std::back_inserter(sum.gammas));
    sum.gammas.push_back(std::max(table.gammas.front() - end, first));
    sum.gammas.push_back(std::min(table.gammas.back() + end, last));
  }
  sum.planes = distinct(std::move(sum.planes));
  sum.gammas = distinct(std::move(sum.gammas));
  if (sum.planes.size() * sum.gammas.size() > most_tm33_sums) {
    throw LimitError(fmt::format(
        "{}: its emitters have {} horizontal and {} vertical angles in all, which is more than {} "
        "intensities; give them at the same angles",
        path.string(), sum.planes.size(), sum.gammas.size(), most_tm33_sums));
  }
  sum.values.setZero(static_cast<Eigen::Index>(sum.planes.size()),
                     static_cast<Eigen::Index>(sum.gammas.size()));
  for (const Tm33Table& table : tables) {
    for (Eigen::Index p = 0; p < sum.values.rows(); ++p) {
      for (Eigen::Index g = 0; g < sum.values.cols(); ++g) {
        sum.values(p, g) += intensity_at(table, sum.planes[static_cast<std::size_t>(p)],
                                         sum.gammas[static_cast<std::size_t>(g)]);
      }
    }
  }
  const auto differs = [&](const Tm33Table& table) {
    return table.symmetry != tables.front().symmetry;
  };
  sum.symmetry =
      std::ranges::any_of(tables, differs) ? PlaneSymmetry::none : tables.front().symmetry;
  return sum;
}

}  // namespace lightwell
