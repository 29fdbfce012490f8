#include "cli/radiating_surfaces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>

#include "cli/arguments.h"
#include "radiosity/radiation/shortwave.h"
#include "scene/errors.h"
#include "scene/io/comma_fields.h"
#include "scene/io/matches_glob.h"
#include "scene/io/nearest_name.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::array<std::string_view, 5> columns_of_exchange{"surface", "emittance", "kelvin",
                                                              "celsius", "heat"};
constexpr std::array<std::string_view, 2> columns_of_albedos{"surface", "albedo"};
constexpr double zero_celsius = 273.15;  // K

// Number of each named column.
using Columns = std::map<std::string, std::size_t, std::less<>>;

struct SurfaceLine {
  int line = 0;
  std::string pattern{};
  std::optional<double> emittance{};
  RadiatingSurface surface{};
  double albedo = 0.0;
};

Columns read_columns(const TextFile& file, int line, const std::vector<std::string_view>& cells,
                     std::span<const std::string_view> known_columns) {
  Columns columns;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::string name(cells[c]);
    if (std::ranges::count(known_columns, cells[c]) == 0) {
      file.fail(line, fmt::format("there is no column '{}'; columns are {}", excerpt(name),
                                  fmt::join(known_columns, ", ")));
    }
    if (!columns.emplace(name, c).second) {
      file.fail(line, fmt::format("two columns are named '{}'", name));
    }
  }
  if (!columns.contains("surface")) file.fail(line, "no column is named 'surface'");
  return columns;
}

// The number in a column; empty if the column is missing or the cell is empty.
std::optional<double> number_in(const TextFile& file, int line, const Columns& columns,
                                const std::vector<std::string_view>& cells, std::string_view name) {
  const auto column = columns.find(name);
  if (column == columns.end() || column->second >= cells.size()) return std::nullopt;
  const std::string text(cells[column->second]);
  if (text.empty()) return std::nullopt;
  const auto value = parsed_number(text);
  if (!value || !std::isfinite(*value)) {
    file.fail(line, fmt::format("{} is '{}', which is not a number", name, excerpt(text)));
  }
  return value;
}

// A line whose surfaces are known, and nothing else.
SurfaceLine named_line(const TextFile& file, int line, const Columns& columns,
                       const std::vector<std::string_view>& cells) {
  if (cells.size() > columns.size()) {
    file.fail(line, fmt::format("has {} values; the first line names {} columns", cells.size(),
                                columns.size()));
  }
  SurfaceLine read{.line = line};
  const std::size_t name = columns.find("surface")->second;
  if (name < cells.size()) read.pattern = cells[name];
  if (read.pattern.empty()) file.fail(line, "has no surface");
  return read;
}

SurfaceLine read_albedo_line(const TextFile& file, int line, const Columns& columns,
                             const std::vector<std::string_view>& cells) {
  SurfaceLine read = named_line(file, line, columns, cells);
  const auto albedo = number_in(file, line, columns, cells, "albedo");
  if (!albedo) file.fail(line, "has no albedo");
  if (!(*albedo >= 0.0 && *albedo <= highest_albedo)) {
    file.fail(line,
              fmt::format("the albedo is {:g}; it lies from 0 to {:g}", *albedo, highest_albedo));
  }
  read.albedo = *albedo;
  return read;
}

SurfaceLine read_exchange_line(const TextFile& file, int line, const Columns& columns,
                               const std::vector<std::string_view>& cells) {
  const auto number = [&](std::string_view name) {
    return number_in(file, line, columns, cells, name);
  };
  SurfaceLine read = named_line(file, line, columns, cells);
  read.emittance = number("emittance");
  const auto kelvin = number("kelvin"), celsius = number("celsius"), heat = number("heat");
  if (kelvin.has_value() + celsius.has_value() + heat.has_value() != 1) {
    file.fail(line, "needs one of kelvin, celsius and heat");
  }
  if (kelvin) read.surface.kelvin = kelvin;
  if (celsius) read.surface.kelvin = *celsius + zero_celsius;
  if (const auto T = read.surface.kelvin; T && !(*T >= 0.0 && *T <= hottest_surface)) {
    file.fail(line, fmt::format("the temperature is {:g} K; it lies from 0 to {:g} K", *T,
                                hottest_surface));
  }
  if (heat) read.surface.heat = *heat;
  if (read.emittance && !(*read.emittance >= 0.0 && *read.emittance <= 1.0)) {
    file.fail(line, fmt::format("the emittance is {:g}; it lies from 0 to 1", *read.emittance));
  }
  return read;
}

using LineReader = SurfaceLine(const TextFile&, int, const Columns&,
                               const std::vector<std::string_view>&);

std::vector<SurfaceLine> read_lines(const TextFile& file, std::span<const std::string_view> known,
                                    LineReader* read_line) {
  std::optional<Columns> columns;
  std::vector<SurfaceLine> lines;
  file.for_each_line([&](int line, std::string_view text) {
    text = trimmed(text);
    if (text.empty() || text.starts_with('#')) return;
    const auto cells = comma_fields(text);
    if (!columns) {
      columns = read_columns(file, line, cells, known);
    } else {
      lines.push_back(read_line(file, line, *columns, cells));
    }
  });
  if (lines.empty()) {
    throw InputError(fmt::format(
        "{}: describes no surface; the first line names columns, such as "
        "{}",
        file.path().string(), fmt::join(known.first(std::min<std::size_t>(known.size(), 3)), ",")));
  }
  return lines;
}

// The line that describes each row.
std::vector<const SurfaceLine*> lines_of_rows(const TextFile& file,
                                              const std::vector<SurfaceLine>& lines,
                                              const ViewFactorRows& rows) {
  std::vector<const SurfaceLine*> of_row;
  std::set<int> used;
  std::vector<std::string> left_out;
  for (const std::string& name : rows.name) {
    const auto found = std::find_if(lines.rbegin(), lines.rend(), [&](const SurfaceLine& line) {
      return matches_glob(line.pattern, name);
    });
    if (found == lines.rend()) {
      left_out.push_back(name);
      continue;
    }
    of_row.push_back(&*found);
    used.insert(found->line);
  }
  for (const SurfaceLine& line : lines) {
    if (used.contains(line.line)) continue;
    file.fail(line.line,
              fmt::format("describes no surface: none is named '{}', or later lines describe all "
                          "that are.{}",
                          excerpt(line.pattern), did_you_mean(line.pattern, rows.name)));
  }
  if (!left_out.empty()) {
    throw InputError(fmt::format(
        "{}: {} of {} rows have no line, the first of them of surface '{}'; a first line with the "
        "surface '*' describes all that no other line does",
        file.path().string(), left_out.size(), rows.name.size(), left_out.front()));
  }
  return of_row;
}

}  // namespace

std::vector<RadiatingSurface> read_radiating_surfaces(const std::filesystem::path& csv,
                                                      const ViewFactorRows& rows,
                                                      const std::vector<double>& area) {
  const TextFile file(csv);
  const auto lines = read_lines(file, columns_of_exchange, read_exchange_line);
  const std::vector<const SurfaceLine*> of_row = lines_of_rows(file, lines, rows);
  std::map<const SurfaceLine*, double> area_of;
  for (std::size_t i = 0; i < of_row.size(); ++i) area_of[of_row[i]] += area[i];
  std::vector<RadiatingSurface> surfaces;
  for (std::size_t i = 0; i < of_row.size(); ++i) {
    const SurfaceLine& line = *of_row[i];
    RadiatingSurface surface = line.surface;
    surface.emittance = line.emittance.value_or(rows.emittance[i]);
    if (line.surface.heat != 0.0 && !(surface.emittance > 0.0)) {
      file.fail(line.line, "gives off heat, but has no emittance; give an emittance above 0");
    }
    const double all = area_of[&line];
    if (all > 0.0) surface.heat *= area[i] / all;
    surfaces.push_back(surface);
  }
  return surfaces;
}

Eigen::ArrayXd read_albedos(const std::filesystem::path& csv, const ViewFactorRows& rows) {
  const TextFile file(csv);
  const auto lines = read_lines(file, columns_of_albedos, read_albedo_line);
  Eigen::ArrayXd albedo(rows.count());
  Eigen::Index row = 0;
  for (const SurfaceLine* line : lines_of_rows(file, lines, rows)) albedo[row++] = line->albedo;
  return albedo;
}

}  // namespace lightwell
