#pragma once

#include <vector>

#include "mesh/facets/group_facets.h"

namespace lightwell {

/// Joins groups of less than 15 % of a patch, connected or not, with others of their surface and
/// their cell of a grid of the patch size. `group` holds per patch a member that names its group,
/// and is updated. A group joins the first cluster in its cell if all its normals are within the
/// options' angle of the cluster's seed and it shares none of the cluster's facets. Groups with
/// normals outside the angle of the cluster's mean are then released, and join others.
void merge_small_groups(const std::vector<FacetPatch>& patches, const FacetGroupOptions& options,
                        std::vector<int>& group);

}  // namespace lightwell
