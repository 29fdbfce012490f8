#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "viewer/export/appearance.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

/// What a walkthrough page is made from: a description, and arrays of which it gives the place.
/// docs/export.md says what is in them. Lengths are metres with y upwards, counted from the lowest
/// corner of the model, so that a room far from its origin keeps its digits in single precision.
struct PageData {
  nlohmann::ordered_json about{};
  std::string bytes{};
};

PageData page_data(const BakedModel& model, const LuxRange& range);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace lightwell
