#pragma once

#include <filesystem>

#include "radiosity/solution/solution.h"

namespace lightwell {

/// Writes VTK XML PolyData (.vtp) that ParaView opens. Elements are polygons. Point data are
/// `irradiance`, `radiosity` (W/m^2 per band), `illuminance_lux`, `rgb` (8-bit sRGB, the active
/// scalars) and more. The file holds all that read_solution needs to restore mesh and solution bit
/// for bit; docs/solution-file.md describes every array. The file begins with readable text and
/// ends with a checksum. The file is written under a temporary name and renamed. Throws
/// std::runtime_error naming the file and the system's reason if writing fails.
void write_solution(const std::filesystem::path& path, const SolvedScene& solved);

/// Reads mesh and solution. Throws InputError with the reason if the file is missing, torn,
/// damaged, of another version, or not a Lightwell solution. Safe for any file: indices are checked
/// before use.
SolvedScene read_solution(const std::filesystem::path& path);

/// Throws InputError, naming both files, unless the solution was made from this scene (scene_hash).
void check_matches(const Scene& scene, const RadiositySolution& solution);

}  // namespace lightwell
