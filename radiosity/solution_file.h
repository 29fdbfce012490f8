#pragma once

#include <filesystem>

#include "radiosity/solve.h"

namespace lightwell {

/// Writes VTK XML PolyData (.vtp) that ParaView opens: elements as polygons with point data
/// `irradiance`, `radiosity` (W/m^2 per band), `illuminance` (lx), `rgb`; and all that
/// read_solution needs to restore mesh and solution bit for bit. Written to a temporary name and
/// renamed; throws std::runtime_error naming the file if that fails.
void write_solution(const std::filesystem::path& path, const SolvedScene& solved);

/// Throws InputError if the file is missing, torn, or not a Lightwell solution.
SolvedScene read_solution(const std::filesystem::path& path);

/// Throws InputError, with the reason, unless the solution was made from this scene.
void check_matches(const Scene& scene, const RadiositySolution& solution);

}  // namespace lightwell
