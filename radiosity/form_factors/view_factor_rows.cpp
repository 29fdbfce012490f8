#include "radiosity/form_factors/view_factor_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "mesh/cleaning/facet_check.h"
#include "radiosity/form_factors/view_factor_scene.h"
#include "scene/io/numbered_scene.h"

namespace lightwell {
namespace {

void add_row(ViewFactorRows& rows, const NumberedScene& numbered, int facet_row, bool is_back) {
  const auto& row = numbered.rows[static_cast<std::size_t>(facet_row)];
  rows.name.push_back(row.name);
  rows.facet.push_back(facet_row + 1);
  rows.is_back.push_back(is_back ? 1 : 0);
  rows.emittance.push_back(row.emittance);
}

/// Facet numbers counted from 1, ten at most: "5, 9 and 3 more".
std::string some_of(const std::vector<int>& numbers) {
  constexpr std::size_t most_named = 10;
  std::vector<int> named;
  for (const int number : numbers) {
    if (named.size() < most_named) named.push_back(number + 1);
  }
  const std::string text = fmt::format("{}", fmt::join(named, ", "));
  return numbers.size() > named.size()
             ? fmt::format("{} and {} more", text, numbers.size() - named.size())
             : text;
}

std::vector<int> seconds_of(const std::vector<FacetPair>& pairs, const NumberedScene& numbered) {
  std::vector<int> rows;
  for (const FacetPair& pair : pairs) {
    const int row = numbered.row_of_facet[static_cast<std::size_t>(pair.second)];
    if (row >= 0) rows.push_back(row);
  }
  return rows;
}

}  // namespace

ViewFactorRows facet_rows(const NumberedScene& numbered, const ViewFactorScene& view,
                          const PatchMesh& mesh) {
  ViewFactorRows rows{.of_patch = rows_of_patches(view, mesh)};
  const int facets = static_cast<int>(numbered.rows.size());
  for (int row = 0; row < view.row_count; ++row)
    add_row(rows, numbered, row % facets, row >= facets);
  return rows;
}

ViewFactorRows patch_rows(const NumberedScene& numbered, const ViewFactorScene& view,
                          const PatchMesh& mesh) {
  ViewFactorRows rows;
  const int facets = static_cast<int>(numbered.rows.size());
  for (const int facet_row : rows_of_patches(view, mesh)) {
    rows.of_patch.push_back(facet_row < 0 ? -1 : rows.count());
    if (facet_row >= 0) add_row(rows, numbered, facet_row % facets, facet_row >= facets);
  }
  return rows;
}

std::vector<std::string> findings(const NumberedScene& numbered, const FacetCheck& check) {
  std::vector<std::string> notes = numbered.scene.notes;
  std::vector<char> has_facet(numbered.rows.size(), 0);
  for (const int row : numbered.row_of_facet) {
    if (row >= 0) has_facet[static_cast<std::size_t>(row)] = 1;
  }
  std::vector<int> empty;
  for (std::size_t r = 0; r < has_facet.size(); ++r) {
    if (!has_facet[r]) empty.push_back(static_cast<int>(r));
  }
  if (!empty.empty()) {
    notes.push_back(fmt::format(
        "Facets without area, or that cross themselves, keep empty rows: {}.", some_of(empty)));
  }
  if (const auto rows = seconds_of(check.duplicates, numbered); !rows.empty()) {
    notes.push_back(
        fmt::format("Facets that lie on an earlier one and face the same way are left "
                    "out and keep empty rows: {}.",
                    some_of(rows)));
  }
  if (const auto rows = seconds_of(check.opposites, numbered); !rows.empty()) {
    notes.push_back(fmt::format("Facets that are the back of an earlier one: {}.", some_of(rows)));
  }
  if (check.inconsistent_edges > 0) {
    notes.push_back(
        fmt::format("{} edges lie between facets that face opposite ways; the front of a facet is "
                    "where its corners run counter-clockwise.",
                    check.inconsistent_edges));
  }
  if (check.open_edges > 0) {
    notes.push_back(
        fmt::format("The surfaces are open along {} edges that belong to one facet "
                    "only.",
                    check.open_edges));
  }
  return notes;
}

}  // namespace lightwell
