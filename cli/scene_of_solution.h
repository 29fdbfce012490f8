#pragma once

#include <filesystem>

namespace lightwell {

/// The scene file that a solution was made from: under the name by which the solution knows it, or
/// under the same name beside the solution. Throws InputError if neither exists, and if the
/// solution cannot be read.
std::filesystem::path scene_of_solution(const std::filesystem::path& solution);

}  // namespace lightwell
