#pragma once

#include <string>
#include <vector>

namespace lightwell {

struct FacetCheck;
struct NumberedScene;
struct PatchMesh;
struct ViewFactorScene;

/// Surface, facet and side of each row of a view-factor matrix.
struct ViewFactorRows {
  std::vector<int> of_patch{};      ///< row of each patch; -1: none
  std::vector<std::string> name{};  ///< of the surface
  std::vector<int> facet{};         ///< number in the file, counted from 1
  std::vector<char> is_back{};
  std::vector<double> emittance{};

  int count() const { return static_cast<int>(name.size()); }
};

/// One row per facet of the file; in a two-sided scene the rows of the backs follow those of all
/// fronts.
ViewFactorRows facet_rows(const NumberedScene& numbered, const ViewFactorScene& view,
                          const PatchMesh& mesh);

/// One row per patch whose facet has a row.
ViewFactorRows patch_rows(const NumberedScene& numbered, const ViewFactorScene& view,
                          const PatchMesh& mesh);

/// Notes on the file, a sentence each: the reader's notes, empty and duplicate facets, edges.
std::vector<std::string> findings(const NumberedScene& numbered, const FacetCheck& check);

}  // namespace lightwell
