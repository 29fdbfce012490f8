#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "scene/io/json_object.h"

namespace lightwell {

/// The JSON document of a Honeybee model. Throws InputError for a file that is no JSON, or holds no
/// model.
nlohmann::json read_honeybee_document(const std::filesystem::path& file);

/// Metres of one unit of a model. Throws InputError for a unit that is not known.
double metres_of(const JsonObject& model);

}  // namespace lightwell
