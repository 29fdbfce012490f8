#pragma once

#include <vector>

#include "viewer/export/lightmap.h"

namespace lightwell {

/// Cuts a model into charts, in the order of its parts. A chart is cut in two where two of its
/// border edges, for example along a thin wall's foot, are nearer to each other than `gap`, metres
/// (see narrow_gaps): no texel lies on both sides.
std::vector<LightmapChart> cut_charts(const BakedModel& model, const PatchMesh& mesh, double gap);

}  // namespace lightwell
