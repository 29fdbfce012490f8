#include "scene/io/radiance/radiance_direction.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "scene/io/radiance/radiance_definitions.h"
#include "scene/io/radiance/radiance_library.h"
#include "scene/io/radiance/radiance_loader.h"
#include "scene/io/radiance/radiance_xform.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// Variables of the formulas: the ray's direction in the pattern's coordinates, the cosine at the
// surface, the table's value, and the arguments A1, A2, ...
constexpr std::size_t first_argument = 5;
constexpr std::size_t least_arguments = 10;  // A1 to A10 are known to every formula

std::string definitions_of(const std::string& file, const RadiancePrimitive& pattern,
                           const std::filesystem::path& folder) {
  if (file == ".") return {};  // none
  if (const auto path = find_radiance_file(file, pattern.location, folder)) {
    return TextFile(*path).text();
  }
  const std::string_view known = radiance_library(file);
  if (known.empty()) {
    pattern.fail(fmt::format("names the file '{}', which is not there", excerpt(file)));
  }
  return std::string(known);
}

Eigen::Matrix3d turn_of(std::span<const std::string> transform, const RadianceLocation& location) {
  if (transform.empty()) return Eigen::Matrix3d::Identity();
  const RadianceXform xform = parse_radiance_xform(transform, location);
  const RadianceXform::Copy& copy = xform.copies.front();
  return copy.to_world.linear() / copy.scale;
}

}  // namespace

DirectionPattern::DirectionPattern(const RadiancePrimitive& pattern,
                                   const std::filesystem::path& folder)
    : pattern_(pattern) {
  const auto& words = pattern.strings;
  const bool is_table = pattern.type == "brightdata";
  const std::size_t file = is_table ? 2 : pattern.type == "colorfunc" ? 3 : 1;
  if (!is_table && pattern.type != "brightfunc" && pattern.type != "colorfunc") {
    pattern.fail("does not depend on direction alone");
  }
  if (words.size() <= file) pattern.fail("lacks a function or a file");
  definitions_of_file_ = definitions_of(words[file], pattern, folder);
  std::size_t transform = file + 1;
  if (is_table) {
    const auto path = find_radiance_file(words[1], pattern.location, folder);
    if (!path) {
      pattern.fail(fmt::format("names the table '{}', which is not there", excerpt(words[1])));
    }
    data_ = std::make_shared<const RadianceData>(*path);
    for (; transform <= file + data_->dimensions(); ++transform) {
      if (transform == words.size()) pattern.fail("lacks a coordinate of its table");
      coordinates_.push_back(formula(words[transform]));
    }
    factors_.push_back(formula(words[0] + "(table_value)"));
  } else {
    for (std::size_t i = 0; i < file; ++i) factors_.push_back(formula(words[i]));
  }
  key_ = fmt::format("{} {} {}",
                     fmt::join(words.begin(), words.begin() + std::ptrdiff_t(transform), " "),
                     fmt::join(pattern.reals, " "), definitions_of_file_);
  turn_ = pattern.turn * turn_of(std::span(words).subspan(transform), pattern.location);
}

RadianceExpression DirectionPattern::formula(const std::string& text) const {
  RadianceDefinitions definitions;
  definitions.add(radiance_library("rayinit.cal"), pattern_.location);
  definitions.add(definitions_of_file_, pattern_.location);
  definitions.add(fmt::format("AC = {}", pattern_.reals.size()), pattern_.location);
  std::vector<std::string> variables = {"Dx", "Dy", "Dz", "Rdot", "table_value"};
  for (std::size_t i = 1; i <= std::max(least_arguments, pattern_.reals.size()); ++i) {
    variables.push_back(fmt::format("A{}", i));
  }
  return {definitions.expanded(text, pattern_.location), text, variables, pattern_.location};
}

Spectrum DirectionPattern::factor(const Eigen::Vector3d& ray, double cosine) const {
  std::vector<double> values(first_argument + std::max(least_arguments, pattern_.reals.size()));
  const Eigen::Vector3d local = turn_.transpose() * ray;
  std::ranges::copy(local, values.begin());
  values[3] = cosine;
  std::ranges::copy(pattern_.reals, values.begin() + first_argument);
  if (data_) {
    std::vector<double> at;
    for (const RadianceExpression& x : coordinates_) at.push_back(x.value_or_nan(values));
    values[4] = data_->at(at);
  }
  Spectrum result(3);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const std::size_t i = factors_.size() == 1 ? 0 : static_cast<std::size_t>(k);
    const auto value = static_cast<float>(factors_[i].value_or_nan(values));
    result[k] = value > 0.0f && std::isfinite(value) ? value : 0.0f;
  }
  return result;
}

}  // namespace lightwell
