#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "viewer/export/baked_model.h"

namespace lightwell {

/// Description of a model's year, whose arrays are appended to `bytes`, as docs/export.md
/// describes. The model has a year.
nlohmann::ordered_json page_year(const BakedModel& model, std::string& bytes);

}  // namespace lightwell
