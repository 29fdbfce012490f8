#include "scene/spectrum_samples.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace lightwell {
namespace {

constexpr double edge_rounding_nm = 1e-6;

double value_at(const SpectrumSamples& s, double nm) {
  const auto after = std::lower_bound(s.wavelengths_nm.begin(), s.wavelengths_nm.end(), nm);
  if (after == s.wavelengths_nm.begin()) return s.values.front();
  if (after == s.wavelengths_nm.end()) return s.values.back();
  const auto i = static_cast<std::size_t>(after - s.wavelengths_nm.begin());
  const double t = (nm - s.wavelengths_nm[i - 1]) / (s.wavelengths_nm[i] - s.wavelengths_nm[i - 1]);
  return std::lerp(s.values[i - 1], s.values[i], t);
}

}  // namespace

double mean(const SpectrumSamples& s, double low, double high) {
  double sum = 0.0, previous_nm = low, previous = value_at(s, low);
  const auto add_up_to = [&](double nm, double value) {
    sum += 0.5 * (previous + value) * (nm - previous_nm);
    previous_nm = nm;
    previous = value;
  };
  const auto& nm = s.wavelengths_nm;
  const auto first = std::upper_bound(nm.begin(), nm.end(), low) - nm.begin();
  for (auto i = static_cast<std::size_t>(first); i < nm.size() && nm[i] < high; ++i) {
    add_up_to(nm[i], s.values[i]);
  }
  add_up_to(high, value_at(s, high));
  return sum / (high - low);
}

bool covers(const SpectrumSamples& s, double low, double high) {
  return !s.wavelengths_nm.empty() && s.wavelengths_nm.front() <= low + edge_rounding_nm &&
         s.wavelengths_nm.back() >= high - edge_rounding_nm;
}

std::vector<SpectrumSamples> spectra_of_table(std::string_view csv) {
  std::vector<SpectrumSamples> columns;
  csv.remove_prefix(csv.find('\n') + 1);
  while (!csv.empty()) {
    const std::string_view line = csv.substr(0, csv.find('\n'));
    csv.remove_prefix(std::min(csv.size(), line.size() + 1));
    double nm = 0.0;
    const char* at = line.data();
    const char* const end = at + line.size();
    at = std::from_chars(at, end, nm).ptr;
    for (std::size_t column = 0; at < end; ++column) {
      double value = 0.0;
      at = std::from_chars(at + 1, end, value).ptr;  // after the comma
      if (column == columns.size()) columns.emplace_back();
      columns[column].wavelengths_nm.push_back(nm);
      columns[column].values.push_back(value);
    }
  }
  return columns;
}

}  // namespace lightwell
