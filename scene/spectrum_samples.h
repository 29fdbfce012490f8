#pragma once

#include <string_view>
#include <vector>

namespace lightwell {

/// A spectrum sampled at rising wavelengths (nm), linear between samples.
struct SpectrumSamples {
  std::vector<double> wavelengths_nm{};
  std::vector<double> values{};
};

/// Mean over [low, high] nm by the trapezium rule over the samples inside and the two ends, which
/// is exact for a piecewise linear spectrum. The samples must cover the interval (covers()).
double mean(const SpectrumSamples& spectrum, double low, double high);

/// True if the samples reach from `low` to `high` nm, with a tolerance of 1e-6 nm.
bool covers(const SpectrumSamples& spectrum, double low, double high);

/// The columns of a table that is part of the program: a header line, then the wavelength and a
/// number for each column.
std::vector<SpectrumSamples> spectra_of_table(std::string_view csv);

}  // namespace lightwell
