#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/gather/final_gather.h"

namespace lightwell {

/// A vertex whose indirect light is interpolated from others: it is their mean, and nothing is
/// gathered there. (Elements are mostly split for the edges of shadows, across which indirect light
/// hardly changes.)
struct InterpolatedVertex {
  int vertex = 0;
  std::array<int, 4> ends{-1, -1, -1, -1};  ///< 2 or 4 vertices, the rest -1

  int end_count() const { return ends[2] < 0 ? 2 : 4; }
};

/// A vertex that a split made, and what a pilot gather says of its indirect light against the mean
/// of its ends; (W/m^2)^2, mean of the bands, channels added.
struct VertexPrediction {
  InterpolatedVertex at{};
  bool is_interpolated = false;                           ///< taken for the mean
  float spread = std::numeric_limits<float>::infinity();  ///< mean square of the difference
  float noise =
      std::numeric_limits<float>::infinity();  ///< of the pilot gather, left in the difference
};

/// Puts what was gathered at vertices (rows of `values`, of variance `variance`, which becomes what
/// is left of it) together with what the pilot gather predicts from their ends, each by how sure it
/// is; interpolated ones have their ends' mean. The pilot gather's rays go the same ways from
/// neighbours, so that little noise is in differences between them: small elements take their light
/// from many rays at large ones, and keep what sets them apart. Where predictions of a `group` of
/// vertices (such as a patch's) turn out worse than noise explains, they count for less. Entries
/// come after all of their ends. Columns of `bands` for each channel; each is a sum of gathers,
/// some of them less others, and may fall below 0 by their noise.
void combine_with_predictions(std::span<const VertexPrediction> predictions, const BandArray& pilot,
                              std::span<const int> group, int bands, BandArray& values,
                              Eigen::ArrayXf& variance);

/// Sets the rows of interpolated vertices, which come after all of their ends in the list.
void interpolate_vertices(std::span<const InterpolatedVertex> interpolated, BandArray& values);

/// Places in a list of `count` vertices that are not interpolated, in rising order; vertex numbers
/// of `interpolated` are places in the list.
std::vector<int> places_without(std::span<const InterpolatedVertex> interpolated,
                                std::size_t count);

/// Per vertex, m^2: the share of the elements around that is nearer to it than to their other
/// corners.
std::vector<double> vertex_areas(const PatchMesh& mesh);

/// What rays each vertex takes, by the area it stands for. They fall with its square root, which
/// makes the mean noise over all area least for the work: `rays` where those are that make up half
/// of all area, at most twice as many on still larger ones, at least an eighth anywhere; powers of
/// two times that.
std::vector<int> share_rays(std::span<const double> area, int rays);

/// The same, with the areas of interpolated vertices added to their ends'; they themselves get 0
/// rays.
std::vector<int> share_rays(const PatchMesh& mesh, std::span<const InterpolatedVertex> interpolated,
                            int rays);

}  // namespace lightwell
