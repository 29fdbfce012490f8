#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radiosity/form_factors/facet_view_factors.h"

namespace lightwell::python {

/// View factors, and the notes on the facets they are of.
struct FoundFormFactors {
  FacetViewFactors factors{};
  std::vector<std::string> notes{};
  std::size_t facets = 0;
};

}  // namespace lightwell::python
