#include "radiosity/refine/element_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "mesh/patches/mesh_bounds.h"
#include "scene/errors.h"

namespace lightwell {
namespace {

// The limit that is asked for, or its default.
std::int64_t wanted_elements(const RefinedElements& elements, const RefineOptions& options) {
  if (options.max_elements > 0) return options.max_elements;
  const double typical = typical_leaf_area(elements);
  std::int64_t count = elements.element_count();
  for (const int cell : elements.leaves()) {
    if (elements.area(cell) > 0.25 * typical) count += 15 * elements.side_count(cell);
  }
  return count;
}

}  // namespace

void require_room(const PatchMesh& mesh, const RefineOptions& options) {
  if (options.max_elements == 0 || mesh.element_count() <= options.max_elements) return;
  throw InputError(fmt::format(
      "at most {} elements are allowed, but the scene makes {} before any is refined; allow more, "
      "or use a larger patch size",
      options.max_elements, mesh.element_count()));
}

std::int64_t most_elements(const RefinedElements& elements, const RefineOptions& options) {
  const std::int64_t wanted = wanted_elements(elements, options);
  if (options.room < 0 || options.room >= wanted) return wanted;
  return std::max(options.room, elements.element_count());
}

bool is_memory_short(const RefinedElements& elements, const RefineOptions& options) {
  return options.room >= 0 && options.room < wanted_elements(elements, options);
}

double typical_leaf_area(const RefinedElements& elements) {
  std::vector<double> areas;
  double total = 0.0;
  const std::vector<char> is_near = near_facets(elements.base());
  for (const int cell : elements.leaves()) {
    const auto element = static_cast<std::size_t>(elements.element(cell, 0));
    if (is_near[static_cast<std::size_t>(elements.base().facet[element])] == 0) continue;
    areas.push_back(elements.area(cell));
    total += elements.area(cell);
  }
  std::sort(areas.begin(), areas.end(), std::greater<>());
  double typical = 0.0, larger = 0.0;
  for (std::size_t i = 0; i < areas.size() && larger < 0.5 * total; ++i) {
    typical = areas[i];
    larger += areas[i];
  }
  return typical;
}

}  // namespace lightwell
