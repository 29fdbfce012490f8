#pragma once

#include <filesystem>

namespace lightwell {

/// The scene file that a solution was made from: beside the solution under its own name, or under
/// the path by which the solution knows it. Throws InputError if neither exists, and if the
/// solution cannot be read.
std::filesystem::path scene_of_solution(const std::filesystem::path& solution);

}  // namespace lightwell
