#pragma once

#include <span>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/refine/interpolated_vertices.h"

namespace lightwell {

/// Lets neighbouring vertices even out the noise of what they gathered, so that it does not show as
/// blotches of an element's size. The sum of area times value stays: what a vertex loses, its
/// neighbours gain, so a rare bright ray counts as much as before.
///
/// The neighbours of a vertex are the corners of the elements around the vertex. A vertex with
/// noise of variance s^2 takes the share s^2 / (s^2 + n^2 + d^2) of its neighbours' mean (Wiener
/// 1949), where n^2 is the noise of the mean and d^2 the squared difference to the mean that noise
/// does not explain. That difference is a mean of medians over neighbourhoods, so that one outlier
/// does not count as a feature and the edge of a shadow does. Of two neighbours with different
/// shares, the smaller holds for both.
///
/// `values` are vertices x columns (`bands` for each channel), W/m^2; `variance` is that of
/// `values`, (W/m^2)^2, mean of the bands, channels added, and becomes the remaining one. Vertices
/// without variance have no gather and take no part. Vertices of `predictions` that are
/// interpolated get the mean of their ends afterwards; their ends are neighbours in their place,
/// and share their area. Each entry must come after the entries of its ends.
void even_out_noise(const PatchMesh& mesh, std::span<const VertexPrediction> predictions, int bands,
                    BandArray& values, Eigen::ArrayXf& variance);

}  // namespace lightwell
