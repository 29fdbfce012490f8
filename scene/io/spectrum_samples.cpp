#include "scene/io/spectrum_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "scene/errors.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"

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

std::vector<std::string_view> split_cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

std::size_t find_column(const TextFile& file, int line, const std::vector<std::string_view>& header,
                        const std::string& column) {
  if (header.front() != "wavelength_nm") {
    file.fail(line, "the first column must be called 'wavelength_nm'");
  }
  const std::vector<std::string> names(header.begin() + 1, header.end());
  if (names.empty()) file.fail(line, "there is no column beside the wavelength");
  if (column.empty()) {
    if (names.size() == 1) return 1;
    file.fail(line,
              fmt::format("there are {} spectra here; say which with 'column'", names.size()));
  }
  const auto found = std::find(names.begin(), names.end(), column);
  if (found == names.end()) {
    file.fail(line, fmt::format("there is no column '{}'.{}", column, did_you_mean(column, names)));
  }
  return static_cast<std::size_t>(found - names.begin()) + 1;
}

}  // namespace

double mean(const SpectrumSamples& s, double low, double high) {
  double sum = 0.0, previous_nm = low, previous = value_at(s, low);
  const auto add_up_to = [&](double nm, double value) {
    sum += 0.5 * (previous + value) * (nm - previous_nm);
    previous_nm = nm;
    previous = value;
  };
  for (std::size_t i = 0; i < s.wavelengths_nm.size(); ++i) {
    const double nm = s.wavelengths_nm[i];
    if (nm > low && nm < high) add_up_to(nm, s.values[i]);
  }
  add_up_to(high, value_at(s, high));
  return sum / (high - low);
}

bool covers(const SpectrumSamples& s, double low, double high) {
  return !s.wavelengths_nm.empty() && s.wavelengths_nm.front() <= low + edge_rounding_nm &&
         s.wavelengths_nm.back() >= high - edge_rounding_nm;
}

SpectrumSamples read_spectrum_csv(const std::filesystem::path& path, const std::string& column) {
  const TextFile file(path);
  SpectrumSamples samples;
  std::vector<std::string_view> header;
  std::size_t wanted = 0;
  file.for_each_line([&](int line, std::string_view text) {
    if (trimmed(text).empty() || trimmed(text).front() == '#') return;
    const auto cells = split_cells(text);
    if (header.empty()) {
      header = cells;
      wanted = find_column(file, line, header, column);
      return;
    }
    if (cells.size() != header.size()) {
      file.fail(line, fmt::format("{} cells, but the header names {} columns", cells.size(),
                                  header.size()));
    }
    const auto number = [&](std::size_t c) {
      if (const auto value = parse_finite(cells[c])) return *value;
      file.fail(line,
                fmt::format("'{}' in column '{}' is not a finite number", cells[c], header[c]));
    };
    const double nm = number(0);
    if (!samples.wavelengths_nm.empty() && !(nm > samples.wavelengths_nm.back())) {
      file.fail(line, fmt::format("wavelength {} nm follows {} nm; wavelengths must rise", nm,
                                  samples.wavelengths_nm.back()));
    }
    samples.wavelengths_nm.push_back(nm);
    samples.values.push_back(number(wanted));
  });
  if (header.empty()) file.fail(1, "the file is empty; it must start with a line of column names");
  if (samples.values.size() < 2) file.fail(1, "a spectrum needs at least two wavelengths");
  return samples;
}

}  // namespace lightwell
