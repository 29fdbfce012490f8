#pragma once

#include <vector>

#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// Which patches exchange light with each other at all, directly or by way of others: rooms without
/// a door between them stay apart. Groups are numbered from 0 in the order of their first patches.
struct ExchangeGroups {
  explicit ExchangeGroups(const FormFactors& form_factors);

  std::vector<int> group_of{};  ///< per patch
  int count = 0;
};

}  // namespace lightwell
