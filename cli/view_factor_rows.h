#pragma once

#include <string>
#include <vector>

#include "mesh/cleaning/facet_check.h"
#include "radiosity/form_factors/view_factor_scene.h"
#include "scene/io/numbered_scene.h"

namespace lightwell {

/// What the rows of a matrix of view factors are.
struct ViewFactorRows {
  std::vector<int> of_patch{};      ///< -1: none
  std::vector<std::string> name{};  ///< of the surface
  std::vector<int> facet{};         ///< of the file, counted from 1
  std::vector<char> is_back{};
  std::vector<double> emittance{};

  int count() const { return static_cast<int>(name.size()); }
};

/// A row for each facet of the file; with two sides the backs come after all fronts.
ViewFactorRows facet_rows(const NumberedScene& numbered, const ViewFactorScene& view,
                          const PatchMesh& mesh);

/// A row for each patch of a facet that has one.
ViewFactorRows patch_rows(const NumberedScene& numbered, const ViewFactorScene& view,
                          const PatchMesh& mesh);

/// What was found in the file and done about it, a sentence each.
std::vector<std::string> findings(const NumberedScene& numbered, const FacetCheck& check);

}  // namespace lightwell
