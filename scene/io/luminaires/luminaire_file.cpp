#include "scene/io/luminaires/luminaire_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/degree.h"
#include "scene/errors.h"
#include "scene/io/luminaires/tm33_file.h"
#include "scene/io/text_file.h"

namespace lightwell {

bool is_luminaire_file(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".ies" || extension == ".ldt" ||
         (extension == ".xml" && is_tm33_root(xml_root_name(path)));
}

LuminaireFile read_luminaire(const std::filesystem::path& path, int lamp_set) {
  const std::string extension = lower_extension(path);
  if (extension == ".ies" || extension == ".xml") {
    if (lamp_set != 1) {
      throw InputError(fmt::format(
          "{}: an IES file has one set of lamps, and set {} is asked for; leave that out",
          path.string(), lamp_set));
    }
    return extension == ".ies" ? read_ies(path) : read_tm33(path);
  }
  if (extension == ".ldt") return read_eulumdat(path, lamp_set);
  throw InputError(
      fmt::format("{}: the extension '{}' is of no known photometric format; readable are IES "
                  "LM-63 (.ies), EULUMDAT (.ldt) and IES TM-33 (.xml)",
                  path.string(), extension));
}

std::string fault_of_intensity(double intensity, double factor) {
  if (!(intensity >= 0.0)) {
    return fmt::format("the intensity is {:g}; it must not be below 0", intensity);
  }
  if (intensity * factor <= most_intensity) return {};
  return fmt::format("the intensity is {:g}, by a factor of {:g}; it must not be above {:g}",
                     intensity, factor, most_intensity);
}

void place_luminaire(const LuminaireFile& luminaire, const Bands& bands, const Spectrum& colour,
                     Lamp& lamp) {
  if (!(luminaire.flux() > 0.0)) {
    throw InputError(fmt::format("{}: all of its intensities are 0, so it gives no light",
                                 luminaire.file.string()));
  }
  lamp.shape = luminaire.web;
  lamp.opening = luminaire.opening;
  lamp.body = luminaire.body;
  lamp.intensity = luminaire.is_radiometric
                       ? constant_spectrum(bands, 1.0f)
                       : Spectrum(colour / static_cast<float>(luminous(bands, colour)));
}

std::string sideways_note(double height) {
  return fmt::format(
      "Its light also leaves sideways from a height of {:.3g} m; here all leaves from the opening "
      "across its axis.",
      height);
}

std::vector<std::string> luminaire_notes(const LuminaireFile& luminaire) {
  std::vector<std::string> notes;
  const std::string file = luminaire.file.filename().string();
  if (luminaire.is_radiometric) {
    notes.push_back(fmt::format(
        "{}: Its intensities are radiant, in W/sr, and not candela: figures of light are relative, "
        "1 for 1 W/m2, and none is lux.",
        file));
  }
  for (const std::string& note : luminaire.notes)
    notes.push_back(fmt::format("{}: {}", file, note));
  return notes;
}

const char* symmetry_words(PlaneSymmetry symmetry) {
  constexpr const char* words[] = {
      "none", "the same all around", "two halves alike about the plane C0-C180",
      "two halves alike about the plane C90-C270", "four quarters alike"};
  return words[static_cast<std::size_t>(symmetry)];
}

std::optional<PlaneSymmetry> symmetry_of_planes(const std::vector<double>& angles) {
  if (angles.size() == 1) return PlaneSymmetry::all_around;
  const double first = angles.front(), last = angles.back();
  if (first == 0.0 && last == 90.0) return PlaneSymmetry::quarters;
  if (first == 0.0 && last == 180.0) return PlaneSymmetry::about_c0;
  // The plane C0 of a luminaire alike about C90-C270 is its plane C180.
  const bool has_c180 = std::ranges::find(angles, 180.0) != angles.end();
  if (first == 90.0 && last == 270.0 && has_c180) return PlaneSymmetry::about_c90;
  if (first == 0.0 && last > 180.0 && last <= 360.0) return PlaneSymmetry::none;
  return std::nullopt;
}

std::string no_symmetry_of_planes(const std::vector<double>& angles) {
  return fmt::format(
      "the horizontal angles go from {:g} to {:g}; from 0 they end at 0, 90, 180 or, all around, "
      "up "
      "to 360, and from 90 by way of 180 at 270",
      angles.front(), angles.back());
}

PlaneTable unfolded_planes(PlaneSymmetry symmetry, const std::vector<double>& angles,
                           const Eigen::ArrayXXd& rows) {
  using enum PlaneSymmetry;
  if (symmetry == all_around) return {.planes = {0.0}, .values = rows};
  std::vector<std::pair<double, Eigen::Index>> planes;
  const auto add = [&](auto&& angle) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
      planes.emplace_back(angle(angles[i]), static_cast<Eigen::Index>(i));
    }
  };
  add([](double c) { return c; });
  if (symmetry == about_c0 || symmetry == quarters) add([](double c) { return 360.0 - c; });
  if (symmetry == about_c90 || symmetry == quarters) add([](double c) { return 180.0 - c; });
  if (symmetry == quarters) add([](double c) { return 180.0 + c; });
  return sorted_planes(planes, rows);
}

PlaneTable sorted_planes(const std::vector<std::pair<double, Eigen::Index>>& planes,
                         const Eigen::ArrayXXd& rows) {
  constexpr double turn = 360.0, rounding = 1e-6;
  std::vector<std::pair<double, Eigen::Index>> sorted;
  for (const auto& [angle, row] : planes) {
    double at = std::fmod(std::fmod(angle, turn) + turn, turn);
    if (at > turn - rounding) at = 0.0;
    const auto same = [&, at = at](const auto& other) {
      return std::abs(other.first - at) < rounding;
    };
    if (std::ranges::none_of(sorted, same)) sorted.emplace_back(at, row);
  }
  std::sort(sorted.begin(), sorted.end());
  PlaneTable table{.values =
                       Eigen::ArrayXXd(static_cast<Eigen::Index>(sorted.size()), rows.cols())};
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    table.planes.push_back(sorted[i].first);
    table.values.row(static_cast<Eigen::Index>(i)) = rows.row(sorted[i].second);
  }
  if (!table.planes.empty() && table.planes.front() < rounding) table.planes.front() = 0.0;
  return table;
}

double beam_angle(const PhotometricWeb& web, double plane, double share) {
  constexpr double step = 0.1;
  constexpr int steps = 1800;
  // Half-plane C for i >= 0, half-plane C + 180 for i < 0.
  const auto value = [&](int i) {
    const double gamma = std::abs(i) * step * degree;
    const double turn = (i < 0 ? plane + 180.0 : plane) * degree;
    return web.at(
        {std::sin(gamma) * std::cos(turn), std::sin(gamma) * std::sin(turn), -std::cos(gamma)});
  };
  double most = 0.0;
  for (int i = -steps; i <= steps; ++i) most = std::max(most, value(i));
  if (!(most > 0.0)) return 0.0;
  int first = 0, last = 0;
  bool any = false;
  for (int i = -steps; i <= steps; ++i) {
    if (!(value(i) >= share * most)) continue;
    if (!any) first = i;
    last = i;
    any = true;
  }
  // Between two steps the value is taken as linear.
  const auto beyond = [&](int inner, int outer) {
    if (std::abs(outer) > steps) return 0.0;
    const double above = value(inner) - share * most, below = share * most - value(outer);
    return above + below > 0.0 ? above / (above + below) : 0.0;
  };
  return (last - first + beyond(first, first - 1) + beyond(last, last + 1)) * step;
}

}  // namespace lightwell
