#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace lightwell {

/// A spectrum sampled at rising wavelengths (nm), linear between samples.
struct SpectrumSamples {
  std::vector<double> wavelengths_nm{};
  std::vector<double> values{};
};

/// Lower and upper edge of every band, nm.
using BandEdges = std::vector<std::array<double, 2>>;

/// Mean over [low, high] nm by the trapezium rule over the samples inside and the two ends, which
/// is exact for a piecewise linear spectrum. The samples must cover the interval (covers()).
double mean(const SpectrumSamples& spectrum, double low, double high);

/// True if the samples reach from `low` to `high` nm, with a tolerance of 1e-6 nm.
bool covers(const SpectrumSamples& spectrum, double low, double high);

/// Reads column `column` of a CSV file whose first column is wavelength_nm; with an empty `column`,
/// the only other column. Throws InputError naming file, line and column.
SpectrumSamples read_spectrum_csv(const std::filesystem::path& path, const std::string& column);

}  // namespace lightwell
