#include "scene/io/radiance/patterns/radiance_direction.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "scene/io/radiance/files/radiance_loader.h"
#include "scene/io/radiance/text/radiance_xform.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

// Variables of the formulas: the ray's direction in the pattern's coordinates, the cosine at the
// surface, and the table's value.
const std::vector<std::string> direction_variables = {"Dx", "Dy", "Dz", "Rdot", "table_value"};

// Number of the string argument that names the function file.
std::size_t file_argument(const RadiancePrimitive& pattern) {
  if (pattern.type == "brightfunc") return 1;
  if (pattern.type == "brightdata") return 2;
  if (pattern.type == "colorfunc") return 3;
  pattern.fail("does not depend on direction alone");
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
    : DirectionPattern(pattern, file_argument(pattern), folder) {}

DirectionPattern::DirectionPattern(const RadiancePrimitive& pattern, std::size_t file,
                                   const std::filesystem::path& folder)
    : functions_(pattern, file < pattern.strings.size() ? pattern.strings[file] : ".", folder) {
  const auto& words = pattern.strings;
  if (words.size() <= file) pattern.fail("lacks a function or a file");
  std::size_t transform = file + 1;
  if (pattern.type == "brightdata") {
    const auto path = find_radiance_file(words[1], pattern.location, folder);
    if (!path) {
      pattern.fail(fmt::format("names the table '{}', which is not there", excerpt(words[1])));
    }
    data_ = std::make_shared<const RadianceData>(*path);
    for (; transform <= file + data_->dimensions(); ++transform) {
      if (transform == words.size()) pattern.fail("lacks a coordinate of its table");
      coordinates_.push_back(functions_.formula(words[transform], direction_variables));
    }
    factors_.push_back(functions_.formula(words[0] + "(table_value)", direction_variables));
  } else {
    for (std::size_t i = 0; i < file; ++i) {
      factors_.push_back(functions_.formula(words[i], direction_variables));
    }
  }
  const auto end = words.begin() + static_cast<std::ptrdiff_t>(transform);
  key_ = fmt::format("{} {} {}", fmt::join(words.begin(), end, " "), fmt::join(pattern.reals, " "),
                     functions_.text());
  const Eigen::Matrix3d frame = pattern.frame.linear();
  turn_ = frame / std::cbrt(std::abs(frame.determinant())) *
          turn_of(std::span(words).subspan(transform), pattern.location);
}

Spectrum DirectionPattern::factor(const Eigen::Vector3d& ray, double cosine) const {
  const Eigen::Vector3d local = turn_.transpose() * ray;
  std::vector<double> values = {local.x(), local.y(), local.z(), cosine, 0.0};
  functions_.append_arguments(values);
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
