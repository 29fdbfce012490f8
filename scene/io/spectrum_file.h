#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/spectrum_samples.h"

namespace lightwell {

/// Lower and upper edge of every band, nm.
using BandEdges = std::vector<std::array<double, 2>>;

/// Reads column `column` of a CSV file whose first column is wavelength_nm; with an empty `column`,
/// the only other column. Throws InputError naming file, line and column.
SpectrumSamples read_spectrum_csv(const std::filesystem::path& path, const std::string& column);

/// Reads the spectrum of an IES TM-27-14 file (.spdx, XML), in the file's unit for each nm. Throws
/// InputError naming file and line.
SpectrumSamples read_tm27(const std::filesystem::path& path);

}  // namespace lightwell
