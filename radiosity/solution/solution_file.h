#pragma once

#include <filesystem>

#include "radiosity/solution/solution.h"

namespace lightwell {

/// Writes VTK XML PolyData (.vtp) that ParaView opens: elements as polygons with point data
/// `irradiance`, `radiosity` (W/m^2 per band), `illuminance_lux`, `rgb` (8-bit sRGB, the active
/// scalars) and more, and all that read_solution needs to restore mesh and solution bit for bit.
/// Every array is described in docs/solution-file.md. The file begins with text for people and ends
/// with a checksum. Written to a temporary name and renamed; throws std::runtime_error naming the
/// file and the system's reason if that fails.
void write_solution(const std::filesystem::path& path, const SolvedScene& solved);

/// Throws InputError, with the reason, if the file is missing, torn, damaged, of another version,
/// or not a Lightwell solution. No file can make it crash: indices are checked before use.
SolvedScene read_solution(const std::filesystem::path& path);

/// Throws InputError, naming both files, unless the solution was made from this scene (scene_hash).
void check_matches(const Scene& scene, const RadiositySolution& solution);

}  // namespace lightwell
