#pragma once

#include <vector>

#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// Groups of patches that exchange light, directly, through sheets or through other patches. Rooms
/// without a common opening are separate groups. Groups are numbered from 0 in the order of their
/// first patches.
struct ExchangeGroups {
  /// `behind` is PatchMesh::behind.
  explicit ExchangeGroups(const FormFactors& form_factors, const std::vector<int>& behind = {});

  std::vector<int> group_of{};  ///< per patch
  int count = 0;
};

}  // namespace lightwell
