#include "scene/io/honeybee/honeybee_bsdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

namespace lightwell {
namespace {

// Shares of light from all directions.
struct Scattering {
  double diffuse = 0.0;
  double regular = 0.0;  // light that leaves within the patch of directions that it came in by
};

std::vector<double> numbers_of(std::string_view text) {
  std::vector<double> numbers;
  const char *at = text.data(), *const end = at + text.size();
  while (at != end) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error == std::errc()) numbers.push_back(value);
    at = error == std::errc() ? next : at + 1;
  }
  return numbers;
}

// Projected solid angles of the patches of directions, pi in all.
std::vector<double> projected_angles(const pugi::xml_node& layer) {
  std::vector<double> angles;
  const auto square_of_sine = [](double degrees) {
    const double sine = std::sin(degrees * std::numbers::pi / 180.0);
    return sine * sine;
  };
  for (const pugi::xml_node& block :
       layer.child("DataDefinition").child("AngleBasis").children("AngleBasisBlock")) {
    constexpr int most_around = 10000;  // the finest basis has 24; a damaged file any number
    const int around = block.child("nPhis").text().as_int();
    const pugi::xml_node bounds = block.child("ThetaBounds");
    const double lower = square_of_sine(bounds.child("LowerTheta").text().as_double());
    const double upper = square_of_sine(bounds.child("UpperTheta").text().as_double());
    if (around < 1 || around > most_around) continue;
    angles.insert(angles.end(), static_cast<std::size_t>(around),
                  std::numbers::pi * (upper - lower) / around);
  }
  return angles;
}

// The values of a matrix for each pair of patches, 1/sr.
struct Matrix {
  std::vector<double> values{};
  bool has_columns = true;  ///< true: a column for each patch of incident light; false: a row

  double at(std::size_t incident, std::size_t outgoing, std::size_t n) const {
    return has_columns ? values[outgoing * n + incident] : values[incident * n + outgoing];
  }
};

// Shares by a matrix f: the light of patch i, of the area a_i of the disc of projected directions,
// leaves by patch j in the share f_ij a_j.
std::optional<Scattering> scattering_of(const Matrix& f, const std::vector<double>& area) {
  const std::size_t n = area.size();
  if (n < 2 || f.values.size() != n * n) return std::nullopt;
  Scattering sum;
  for (std::size_t i = 0; i < n; ++i) {
    double others = 0.0, others_area = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      others += f.at(i, j, n) * area[j];
      others_area += area[j];
    }
    // Light that scatters evenly fills the patch of the incident light as it fills the others.
    const double even = std::min(f.at(i, i, n), others / others_area);
    sum.diffuse += (others + even * area[i]) * area[i] / std::numbers::pi;
    sum.regular += (f.at(i, i, n) - even) * area[i] * area[i] / std::numbers::pi;
  }
  return sum;
}

std::optional<Scattering> scattering(const pugi::xml_node& layer, const char* direction,
                                     const std::vector<double>& area) {
  const std::string_view structure =
      layer.child("DataDefinition").child_value("IncidentDataStructure");
  for (const pugi::xml_node& data : layer.children("WavelengthData")) {
    const pugi::xml_node block = data.child("WavelengthDataBlock");
    if (std::string_view(data.child_value("Wavelength")) != "Visible") continue;
    if (std::string_view(block.child_value("WavelengthDataDirection")) != direction) continue;
    return scattering_of({.values = numbers_of(block.child_value("ScatteringData")),
                          .has_columns = structure != "Rows"},
                         area);
  }
  return std::nullopt;
}

// Arguments of a trans without highlight.
std::vector<double> trans(double reflected, double diffuse, double straight) {
  const double passes = diffuse + straight;
  const double all = std::min(reflected + passes, 1.0);
  const double whole = reflected + passes;
  return {all,
          all,
          all,
          0.0,
          0.0,
          whole > 0.0 ? passes / whole : 0.0,
          passes > 0.0 ? straight / passes : 0.0};
}

double mean_or_zero(const JsonObject& modifier, const char* key) {
  if (!modifier.has(key)) return 0.0;
  const std::vector<double> colour = modifier.numbers(key, 3);
  return (colour[0] + colour[1] + colour[2]) / 3.0;
}

std::vector<double> by_matrices(const JsonObject& modifier) {
  const std::string text = modifier.string_or("bsdf_data", "");
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) {
    modifier.fail("'bsdf_data' is no well-formed XML");
  }
  const pugi::xml_node layer = document.child("WindowElement").child("Optical").child("Layer");
  const std::vector<double> area = projected_angles(layer);
  const auto passed = scattering(layer, "Transmission Front", area);
  if (!passed) {
    modifier.fail("'bsdf_data' has no matrix of the visible transmission between its patches");
  }
  double reflected = 0.5 * (mean_or_zero(modifier, "front_diffuse_reflectance") +
                            mean_or_zero(modifier, "back_diffuse_reflectance"));
  for (const char* side : {"Reflection Front", "Reflection Back"}) {
    const Scattering found = scattering(layer, side, area).value_or(Scattering{});
    reflected += 0.5 * (found.diffuse + found.regular);
  }
  return trans(reflected, passed->diffuse + mean_or_zero(modifier, "diffuse_transmittance"),
               passed->regular);
}

}  // namespace

std::vector<double> trans_of_bsdf(const JsonObject& modifier, Remarks& remarks) {
  const std::string name = modifier.string_or("identifier", modifier.place());
  remarks.add("BSDFs became sheets that scatter evenly as much as the BSDF does in all", name);
  constexpr double clear = 0.64;  // of Honeybee's generic window
  std::vector<double> arguments = trans(0.0, 0.0, clear);
  remarks.attempt("BSDFs that cannot be read were taken as clear sheets that pass 0.64", name,
                  [&] { arguments = by_matrices(modifier); });
  return arguments;
}

}  // namespace lightwell
