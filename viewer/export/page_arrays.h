#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "viewer/export/write_whole.h"

namespace lightwell {

/// Appends values as half floats, divided by a scale that maps the largest to 32768. Values down to
/// 2e-9 of the largest keep 11 bits. Returns offset and scale.
template <class Values>
nlohmann::ordered_json append_halves(const Values& values, std::string& bytes) {
  float largest = 0.0f;
  for (const float value : values) largest = std::max(largest, std::abs(value));
  const float scale = largest > 0.0f ? largest / 32768.0f : 1.0f;
  const nlohmann::ordered_json place = {{"offset", bytes.size()}, {"scale", scale}};
  for (const float value : values) append_bytes(bytes, Eigen::half(value / scale).x);
  bytes.resize((bytes.size() + 3) / 4 * 4);
  return place;
}

/// The numbers of an array, in the order of memory.
template <class Array>
std::span<const float> numbers(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// A vector as JSON.
inline nlohmann::ordered_json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace lightwell
