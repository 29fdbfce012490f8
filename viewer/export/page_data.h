#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "raytrace/display/light_meter.h"
#include "viewer/export/appearance.h"
#include "viewer/export/baked_model.h"

namespace lightwell {

/// Data of a walkthrough page, as docs/export.md describes. Lengths are metres, y upwards, from the
/// lowest corner of the model: a room far from its origin keeps its digits in single precision.
struct PageData {
  nlohmann::ordered_json about{};  ///< description, with offsets of arrays in `bytes`
  std::string bytes{};             ///< arrays, little-endian
};

/// Data of a model's page. `range`: scale of the false colours of illuminance, lx; `white`: light
/// that shows as grey at first.
PageData page_data(const BakedModel& model, const LuxRange& range, const WhitePoint& white = {});

/// Text as the content of an HTML element or of an attribute in double quotes.
std::string html_text(std::string_view text);

/// Base64 of RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace lightwell
