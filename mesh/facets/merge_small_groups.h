#pragma once

#include <vector>

#include "mesh/facets/group_facets.h"

namespace lightwell {

/// Joins groups of less than 15 % of a patch, connected or not, with others of their surface and
/// their cell of a grid of the patch size. `group` says by patch which group it is in, named by a
/// member. A group joins the first one there whose seed all its normals face as to the options'
/// angle and none of whose facets it shares; what then is not within the angle of the mean is let
/// go of, and joins others.
void merge_small_groups(const std::vector<FacetPatch>& patches, const FacetGroupOptions& options,
                        std::vector<int>& group);

}  // namespace lightwell
