#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/scene_parts.h"

namespace lightwell {

/// A vertex that takes the mean indirect light of other vertices, its *ends*; no indirect light is
/// gathered there. (Elements are mostly split for the edges of shadows, across which indirect light
/// hardly changes.)
struct InterpolatedVertex {
  int vertex = 0;
  std::array<int, 4> ends{-1, -1, -1, -1};  ///< 2 or 4 vertices, the rest -1

  int end_count() const { return ends[2] < 0 ? 2 : 4; }
};

/// A vertex that a split made, and the difference that a pilot gather found between its indirect
/// light and the mean of its ends. Squares are in (W/m^2)^2, mean of the bands, channels added.
struct VertexPrediction {
  InterpolatedVertex at{};
  bool is_interpolated = false;  ///< the vertex takes its ends' mean
  bool is_shared = false;        ///< the vertex has no final gather of its own (see SharedGathers)
  float spread = std::numeric_limits<float>::infinity();  ///< mean square of the difference
  float noise = std::numeric_limits<float>::infinity();   ///< squared noise in the difference
};

/// Joins the light gathered at vertices with predictions, weighted by the inverse variance of each.
///
/// A prediction is the light of the vertex's ends plus the pilot gather's difference from these
/// ends, shrunk by its noise (Wiener 1949). Pilot rays take the same directions at neighbours, so
/// the difference has little noise. A small element thus takes its light from the many rays of
/// large ones, and keeps its own difference. Interpolated vertices get their ends' mean, and shared
/// ones the prediction alone.
///
/// Each entry of `predictions` must come after the entries of its ends. `pilot` and `values` are
/// vertices x columns (`bands` for each channel), W/m^2. `variance` is that of `values`, (W/m^2)^2,
/// and becomes the remaining one. Predictions for vertices of one `group` (such as a patch's) count
/// for less if their errors are larger than noise explains. A joined value may be negative by
/// noise.
void combine_with_predictions(std::span<const VertexPrediction> predictions, const BandArray& pilot,
                              std::span<const int> group, int bands, BandArray& values,
                              Eigen::ArrayXf& variance);

/// Sets the rows of interpolated vertices to the mean of their ends' rows. Each entry must come
/// after the entries of its ends.
void interpolate_vertices(std::span<const InterpolatedVertex> interpolated, BandArray& values);

/// Indices in a list of `count` vertices that are not interpolated, in rising order; vertex numbers
/// of `interpolated` are indices in the list.
std::vector<int> indices_without(std::span<const InterpolatedVertex> interpolated,
                                 std::size_t count);

/// `count` rows, of which row[i] is row i of `values`; the others are 0.
BandArray spread_rows(const BandArray& values, std::span<const int> row, Eigen::Index count);

/// Area that each vertex stands for, m^2: of every element around, its area over the number of its
/// corners.
std::vector<double> vertex_areas(const PatchMesh& mesh);

/// Rays of each vertex by the area that the vertex stands for. Rays proportional to the square root
/// of the area make the mean noise over all area least for the work. Vertices of typical area, the
/// large ones that make up about half of all area, take `rays`; others take `rays` times a power of
/// two from 1/8 to 2.
std::vector<int> share_rays(std::span<const double> area, int rays);

/// Per vertex, sqrt(typical_area() of the vertex's part / area that the vertex stands for), from 1
/// to 64: how many times fewer rays than a typical vertex the vertex needs (see share_rays()).
std::vector<float> vertex_fineness(const PatchMesh& mesh, const SceneParts& parts);

/// Rays of each vertex of a mesh, shared by area within each of the `parts`, whose `rays` are
/// given. Interpolated vertices take 0 rays, and their area counts for their ends.
std::vector<int> share_rays(const PatchMesh& mesh, std::span<const InterpolatedVertex> interpolated,
                            const SceneParts& parts, std::span<const int> rays);

}  // namespace lightwell
