#include "raytrace/readings/ugr_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validation/cases/case_lists.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

constexpr const char* tables_from = "github.com/123VincentB/eulumdat-ugr, data";

// Half of the largest difference between the tables of DIALux and Relux for the six luminaires,
// 0.8, since the expected value is the mean of both; and the rounding of their printed digit.
constexpr double tolerance_of_tables = 0.8 / 2 + 0.05;

std::string cell_name(std::size_t row, std::size_t column) {
  const UgrRoom room = ugr_rooms[row];
  const UgrReflectances rho = ugr_reflectances[column % ugr_reflectances.size()];
  return fmt::format("{}H x {}H, {:g}/{:g}/{:g}, {}", room.across, room.along, 100 * rho.ceiling,
                     100 * rho.walls, 100 * rho.floor,
                     column < ugr_reflectances.size() ? "crosswise" : "endwise");
}

struct UgrCell {
  std::size_t row, column;
  double dialux, relux;
};

// Cells for which both programs print a number; below 10 they print "<10".
std::vector<UgrCell> printed_cells(const ReferenceValue& c) {
  std::vector<UgrCell> cells;
  for (std::size_t row = 0; row < ugr_rooms.size(); ++row) {
    for (std::size_t column = 0; column < 2 * ugr_reflectances.size(); ++column) {
      const ReferenceValue &a = c.at("dialux").at(row).at(column),
                           &b = c.at("relux").at(row).at(column);
      constexpr double least_printed = 10.0;
      if (a.is_null() || b.is_null() || a < least_printed || b < least_printed) continue;
      cells.push_back({row, column, a, b});
    }
  }
  return cells;
}

ComparedValues ugr_table_of(const ReferenceValue& c) {
  const EmbeddedFile file("luminaire.ldt", c.at("ldt").get_ref<const std::string&>());
  const UgrTable table = ugr_table(read_luminaire(file.path()));
  ComparedValues values;
  for (const UgrCell& cell : printed_cells(c)) {
    const std::size_t across = ugr_reflectances.size();
    const auto row = static_cast<Eigen::Index>(cell.row),
               column = static_cast<Eigen::Index>(cell.column % across);
    const double found =
        cell.column < across ? table.along_c0(row, column) : table.along_c90(row, column);
    values.push_back({cell_name(cell.row, cell.column), 0.5 * (cell.dialux + cell.relux), found,
                      tolerance_of_tables});
  }
  return values;
}

// The cells in which both programs are furthest apart.
std::vector<PublishedValue> published_ratings(const ReferenceValue& c) {
  const std::vector<UgrCell> cells = printed_cells(c);
  const auto furthest =
      std::max_element(cells.begin(), cells.end(), [](const UgrCell& a, const UgrCell& b) {
        return std::abs(a.dialux - a.relux) < std::abs(b.dialux - b.relux);
      });
  if (furthest == cells.end()) return {};
  const std::string place = cell_name(furthest->row, furthest->column);
  return {{.place = place, .program = "DIALux", .value = furthest->dialux, .source = tables_from},
          {.place = place, .program = "Relux", .value = furthest->relux, .source = tables_from}};
}

}  // namespace

std::vector<ValidationCase> ugr_table_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::ugr_tables_json)) {
    cases.push_back({.id = c.at("id"),
                     .group = "UGR tables",
                     .title = fmt::format("UGR table of luminaire {}, 19 rooms x 5 reflectances x "
                                          "2 directions",
                                          cases.size() + 1),
                     .source = std::string("mean of the tables that DIALux and Relux print (") +
                               tables_from + ")",
                     .reason = "0.8: the largest difference between the two programs",
                     .note = "cells in which a program prints '<10' are left out",
                     .published = published_ratings(c),
                     .compute = [c](const Progress&) { return ugr_table_of(c); }});
  }
  return cases;
}

}  // namespace lightwell
