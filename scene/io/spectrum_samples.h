#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace lightwell {

/// A spectrum known at some wavelengths (rising, nm) and linear between them.
struct SpectrumSamples {
  std::vector<double> wavelengths_nm{};
  std::vector<double> values{};
};

/// Lower and upper edge of every band, nm.
using BandEdges = std::vector<std::array<double, 2>>;

/// Mean of the broken line over [low, high]: the trapezium rule over the samples inside and the two
/// edges, which is exact. The samples must cover the interval (checked by covers()).
double mean(const SpectrumSamples& spectrum, double low, double high);

/// Whether the samples reach from `low` to `high`, but for a rounding of 1e-6 nm.
bool covers(const SpectrumSamples& spectrum, double low, double high);

/// Column `column` of a CSV file whose first column is wavelength_nm; with an empty `column` the
/// only other one. Throws InputError naming file, line and column.
SpectrumSamples read_spectrum_csv(const std::filesystem::path& path, const std::string& column);

}  // namespace lightwell
