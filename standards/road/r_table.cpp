#include "standards/road/r_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "scene/degree.h"
#include "scene/io/comma_fields.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr double printed_factor = 1e4;  // tables list r times 10^4

constexpr std::array<std::pair<const char*, double>, 6> standard_q0 = {
    {{"R1", 0.10}, {"R2", 0.07}, {"R3", 0.07}, {"R4", 0.08}, {"C1", 0.10}, {"C2", 0.07}}};

// The interval of rising `knots` that holds x, and the place of x in that interval.
std::pair<std::size_t, double> interval_of(const std::vector<double>& knots, double x) {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
  const auto i = static_cast<std::size_t>(above - knots.begin()) - 1;
  return {i, (x - knots[i]) / (knots[i + 1] - knots[i])};
}

// The numbers of a line; `has_word` permits a first field that is none.
std::optional<std::vector<double>> line_numbers(std::string_view line, bool has_word) {
  std::string text(line);
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == ';' || c == '\t'; }, ' ');
  std::string_view rest = text;
  std::vector<double> numbers;
  for (bool is_first = true;; is_first = false) {
    const std::string_view word = next_word(rest);
    if (word.empty()) return numbers;
    const auto number = parse_finite(word);
    if (number) {
      numbers.push_back(*number);
    } else if (!(is_first && has_word)) {
      return {};
    }
  }
}

/// Lines of a table while they are read.
struct RTableLines {
  const TextFile& file;
  RTable table{};
  std::vector<std::vector<double>> rows{};

  void add(int line, std::string_view text);
  void add_angles(int line, std::vector<double> beta);
  void add_row(int line, std::vector<double> row);
};

void RTableLines::add(int line, std::string_view text) {
  text = trimmed(text);
  if (text.empty() || text.front() == '#') return;
  const auto numbers = line_numbers(text, table.beta.empty());
  if (!numbers) file.fail(line, fmt::format("'{}' has a field that is no number", excerpt(text)));
  if (table.beta.empty()) {
    add_angles(line, *numbers);
  } else {
    add_row(line, *numbers);
  }
}

void RTableLines::add_angles(int line, std::vector<double> beta) {
  constexpr double half_turn = 180.0;
  const bool rises = std::ranges::adjacent_find(beta, std::greater_equal<>()) == beta.end();
  if (beta.size() < 2 || beta.front() != 0.0 || beta.back() != half_turn || !rises) {
    file.fail(line, "must hold the angles beta, rising from 0 to 180 degrees");
  }
  table.beta = std::move(beta);
}

void RTableLines::add_row(int line, std::vector<double> row) {
  if (row.size() != table.beta.size() + 1) {
    file.fail(line, fmt::format("has {} numbers; a line needs tan(gamma) and {} values", row.size(),
                                table.beta.size()));
  }
  const double tangent = row.front();
  if (table.tan_gamma.empty() ? tangent != 0.0 : !(tangent > table.tan_gamma.back())) {
    file.fail(line, "must have a tan(gamma) that rises from line to line, from 0");
  }
  row.erase(row.begin());
  if (std::ranges::any_of(row, [](double r) { return r < 0.0; })) {
    file.fail(line, "has a negative value; r is 0 or more");
  }
  table.tan_gamma.push_back(tangent);
  rows.push_back(std::move(row));
}

Eigen::ArrayXXd array_of(const std::vector<std::vector<double>>& rows) {
  Eigen::ArrayXXd r(static_cast<Eigen::Index>(rows.size()),
                    static_cast<Eigen::Index>(rows.front().size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < rows[i].size(); ++k) {
      r(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = rows[i][k] / printed_factor;
    }
  }
  return r;
}

// Each line of the table that the program holds: its fields.
template <class Visit>
void for_each_known_line(Visit&& visit) {
  std::string_view rest = standards_data::r_tables;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const auto fields = comma_fields(rest.substr(0, end));
    if (fields.size() > 2) visit(fields);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

}  // namespace

double reduced_luminance_coefficient(const RTable& table, double tan_gamma, double beta) {
  constexpr double rounding = 1e-9;
  if (tan_gamma > table.tan_gamma.back() + rounding) return 0.0;
  const auto [row, t] = interval_of(table.tan_gamma, std::min(tan_gamma, table.tan_gamma.back()));
  const auto [column, s] = interval_of(table.beta, beta);
  const auto i = static_cast<Eigen::Index>(row), k = static_cast<Eigen::Index>(column);
  const double low = (1.0 - s) * table.r(i, k) + s * table.r(i, k + 1);
  const double high = (1.0 - s) * table.r(i + 1, k) + s * table.r(i + 1, k + 1);
  return (1.0 - t) * low + t * high;
}

double average_luminance_coefficient(const RTable& table) {
  constexpr int squares = 20;  // for each length of 1
  constexpr double before = 4.0, beyond = heights_beyond_point, beside = 3.0, side = 1.0 / squares;
  constexpr int along = static_cast<int>((before + beyond) * squares);
  constexpr int across = static_cast<int>(beside * squares);
  double sum = 0.0, solid_angle = 0.0;
  for (int i = 0; i < along; ++i) {
    for (int k = 0; k < across; ++k) {
      const double x = (i + 0.5) * side - before, y = (k + 0.5) * side;
      const double tangent = std::hypot(x, y), cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
      // q dw = (r / cos^3) (cos^3 dx dy)
      sum += reduced_luminance_coefficient(table, tangent, std::atan2(y, x) / degree);
      solid_angle += cosine * cosine * cosine;
    }
  }
  return sum / solid_angle;
}

double specular_factor(const RTable& table) {
  constexpr double mirror = 2.0;  // tan(gamma) of the specular direction that CIE 66 picks
  return reduced_luminance_coefficient(table, mirror, 0.0) /
         reduced_luminance_coefficient(table, 0.0, 0.0);
}

RTable scaled_to(RTable table, double q0) {
  table.r *= q0 / table.q0;
  table.q0 = q0;
  return table;
}

std::vector<std::string> r_table_names() {
  std::vector<std::string> names;
  for (const auto& [name, q0] : standard_q0) names.emplace_back(name);
  return names;
}

RTable standard_r_table(const std::string& name) {
  RTable table{.name = name};
  for (const auto& [known, q0] : standard_q0) {
    if (name == known) table.q0 = q0;
  }
  std::vector<std::vector<double>> rows;
  for_each_known_line([&](const std::vector<std::string_view>& fields) {
    const bool is_head = fields[0] == "surface";
    if (!is_head && fields[0] != name) return;
    std::vector<double> numbers;
    for (std::size_t i = 2; i < fields.size(); ++i) numbers.push_back(*parse_finite(fields[i]));
    if (is_head) {
      table.beta = std::move(numbers);
    } else {
      table.tan_gamma.push_back(*parse_finite(fields[1]));
      rows.push_back(std::move(numbers));
    }
  });
  table.r = array_of(rows);
  return table;
}

RTable read_r_table(const std::filesystem::path& path) {
  const TextFile file(path);
  RTableLines lines{.file = file};
  int last = 1;
  file.for_each_line([&](int line, std::string_view text) {
    lines.add(line, text);
    last = line;
  });
  if (lines.rows.size() < 2) {
    file.fail(last, "holds fewer than two lines of values; an r-table has one for each tan(gamma)");
  }
  RTable table = std::move(lines.table);
  if (table.tan_gamma.back() < heights_beyond_point) {
    file.fail(last,
              fmt::format("ends the table at a tan(gamma) of {:g}, and luminaires count up to "
                          "{:g}; add the lines up to there, with 0 where r is not known",
                          table.tan_gamma.back(), heights_beyond_point));
  }
  table.name = path.filename().string();
  table.r = array_of(lines.rows);
  table.q0 = average_luminance_coefficient(table);
  if (!(table.q0 >= darkest_road && table.q0 <= lightest_road) || !(table.r(0, 0) > 0.0)) {
    file.fail(last, fmt::format("ends a table of Q0 {:.3g} per steradian, which is no road; write "
                                "r times 10^4, as CIE 144 does",
                                table.q0));
  }
  return table;
}

}  // namespace lightwell
