#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include "raytrace/readings/probe.h"
#include "scene/atomic_file.h"
#include "scene/errors.h"
#include "scene/io/comma_fields.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::array<std::string_view, 6> column_names = {"x", "y", "z", "nx", "ny", "nz"};
using Columns = std::array<int, 6>;

// Position of an error, which precedes every message.
struct FileLocation {
  std::string file{};
  int line = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file, line, what));
  }
};

// The fields of a line: between commas, or between spaces where there are none.
std::vector<std::string_view> fields_of(std::string_view text) {
  if (text.find(',') != std::string_view::npos) return comma_fields(text);
  std::vector<std::string_view> fields;
  constexpr std::string_view space = " \t";
  for (auto begin = text.find_first_not_of(space); begin != std::string_view::npos;) {
    const auto end = text.find_first_of(space, begin);
    fields.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(space, end);
  }
  return fields;
}

// True for a line that names no columns, as those of RADIANCE's files of points are.
bool is_all_numbers(const std::vector<std::string_view>& cells) {
  return std::ranges::all_of(cells, [](std::string_view cell) {
    return cell.find_first_not_of("+-.0123456789eE") == std::string_view::npos &&
           cell.find_first_of("0123456789") != std::string_view::npos;
  });
}

Columns read_header(const std::vector<std::string_view>& cells, const FileLocation& location) {
  Columns columns{};
  for (std::size_t c = 0; c < column_names.size(); ++c) {
    const auto found = std::find(cells.begin(), cells.end(), column_names[c]);
    if (found == cells.end()) {
      location.fail(
          fmt::format("no column is named '{}'; the first line must name x,y,z,nx,ny,nz (in any "
                      "order, others are ignored), or each line must be these six numbers",
                      column_names[c]));
    }
    if (std::find(found + 1, cells.end(), column_names[c]) != cells.end()) {
      location.fail(fmt::format("two columns are named '{}'", column_names[c]));
    }
    columns[c] = static_cast<int>(found - cells.begin());
  }
  return columns;
}

double number(std::string_view text, std::string_view column, const FileLocation& location) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) {
    location.fail(fmt::format("{} is '{}', which is not a finite number", column, text));
  }
  return value;
}

Probe read_row(const std::vector<std::string_view>& cells, const Columns& columns,
               double metres_per_unit, const FileLocation& location) {
  std::array<double, 6> values{};
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c] >= static_cast<int>(cells.size())) {
      location.fail(fmt::format("has {} values; column '{}' is number {}", cells.size(),
                                column_names[c], columns[c] + 1));
    }
    values[c] = number(cells[columns[c]], column_names[c], location);
  }
  const Eigen::Vector3d normal(values[3], values[4], values[5]);
  const double length = normal.stableNorm();
  if (!(length > 0.0)) {
    location.fail("the normal nx,ny,nz has no length; give the direction that the probe faces");
  }
  return {.position = metres_per_unit * Eigen::Vector3d(values[0], values[1], values[2]),
          .normal = normal / length};
}

}  // namespace

std::vector<Probe> read_probes(const std::filesystem::path& csv, double metres_per_unit) {
  constexpr Columns in_order = {0, 1, 2, 3, 4, 5};
  FileLocation location{.file = csv.string()};
  std::ifstream stream(csv);
  if (!stream || std::filesystem::is_directory(csv)) {
    throw InputError(fmt::format("{}: cannot be opened; is it there?", location.file));
  }
  std::vector<Probe> probes;
  std::optional<Columns> columns;
  std::string line;
  while (std::getline(stream, line)) {
    ++location.line;
    constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";
    std::string_view text = line;
    if (location.line == 1 && text.starts_with(byte_order_mark)) text.remove_prefix(3);
    text = trimmed(text);
    if (text.empty() || text.starts_with('#')) continue;
    const auto cells = fields_of(text);
    if (!columns && is_all_numbers(cells)) columns = in_order;
    if (!columns) {
      columns = read_header(cells, location);
    } else {
      probes.push_back(read_row(cells, *columns, metres_per_unit, location));
    }
  }
  if (!columns) {
    throw InputError(
        fmt::format("{}: is empty; the first line must name x,y,z,nx,ny,nz", location.file));
  }
  if (probes.empty()) throw InputError(fmt::format("{}: has no probes", location.file));
  return probes;
}

void write_probes(const std::filesystem::path& csv, std::span<const Probe> probes,
                  const BandArray& irradiance, const Bands& bands, double metres_per_unit,
                  const Eigen::ArrayXd& lux_within) {
  AtomicStream file(csv);
  std::ostream& stream = file.stream();
  stream << "x,y,z,nx,ny,nz";
  for (const std::string& name : bands.names) stream << ",E_" << name;
  stream << (lux_within.size() > 0 ? ",lux,lux_within\n" : ",lux\n");
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const Eigen::Vector3d p = probes[i].position / metres_per_unit;
    const Eigen::Vector3d& n = probes[i].normal;
    stream << fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", p.x(), p.y(), p.z(), n.x(),
                          n.y(), n.z());
    const Spectrum E = irradiance.row(static_cast<Eigen::Index>(i)).transpose();
    for (float E_k : E) stream << fmt::format(",{:.9g}", E_k);
    stream << fmt::format(",{:.9g}", luminous(bands, E));
    if (lux_within.size() > 0) {
      const double within = lux_within[static_cast<Eigen::Index>(i)];
      stream << (std::isnan(within) ? "," : fmt::format(",{:.3g}", within));
    }
    stream << '\n';
  }
  file.commit();
}

}  // namespace lightwell
