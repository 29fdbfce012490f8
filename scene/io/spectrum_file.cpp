#include "scene/io/spectrum_file.h"

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
