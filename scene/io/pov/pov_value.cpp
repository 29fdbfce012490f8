#include "scene/io/pov/pov_value.h"

#include <fmt/format.h>

#include <cmath>

namespace lightwell {

void PovNode::fail(std::string_view problem) const {
  place.fail(fmt::format("'{}' {}", keyword, problem));
}

bool PovCursor::take(std::string_view word) {
  if (at_end() || node_.items[at_].word != word) return false;
  ++at_;
  return true;
}

std::optional<PovVector> PovCursor::vector() {
  const PovItem* item = look();
  if (!item || !item->vector()) return std::nullopt;
  ++at_;
  return *item->vector();
}

std::optional<double> PovCursor::number() {
  const auto value = vector();
  if (!value) return std::nullopt;
  return value->c[0];
}

std::optional<std::string> PovCursor::string() {
  const PovItem* item = look();
  const auto* found = item ? std::get_if<std::string>(&item->value) : nullptr;
  if (!found) return std::nullopt;
  ++at_;
  return *found;
}

const PovNode* PovCursor::block() {
  const PovItem* item = look();
  if (!item || !item->node()) return nullptr;
  ++at_;
  return item->node();
}

Eigen::Vector3d PovCursor::need_point(std::string_view what) {
  const auto value = vector();
  if (!value) node_.fail(fmt::format("lacks a vector for its {}", what));
  return pov_point(*value);
}

double PovCursor::need_number(std::string_view what) {
  const auto value = number();
  if (!value) node_.fail(fmt::format("lacks a number for its {}", what));
  return *value;
}

std::size_t PovCursor::need_count(std::string_view what) {
  constexpr double most = 20e6;
  const double value = need_number(what);
  if (!(value >= 0.0 && value <= most)) {
    node_.fail(
        fmt::format("has the {} {:g}; it must be a whole number up to {:g}", what, value, most));
  }
  return static_cast<std::size_t>(std::llround(value));
}

Eigen::Vector3d pov_point(const PovVector& vector) {
  if (vector.count == 1) return Eigen::Vector3d::Constant(vector.c[0]);
  return {vector.c[0], vector.c[1], vector.c[2]};
}

PovVector pov_color(const PovVector& vector) {
  PovVector color = vector;
  if (vector.count == 1) color.c[1] = color.c[2] = vector.c[0];
  color.count = 5;
  return color;
}

}  // namespace lightwell
