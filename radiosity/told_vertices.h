#pragma once

#include <array>
#include <span>
#include <vector>

#include "mesh/patch_mesh.h"
#include "radiosity/final_gather.h"

namespace lightwell {

/// A vertex whose indirect light is told by others: it is their mean, and nothing is gathered
/// there. (Elements are mostly split for the edges of shadows, across which indirect light hardly
/// changes.)
struct ToldVertex {
  int vertex = 0;
  std::array<int, 4> ends{-1, -1, -1, -1};  ///< 2 or 4 vertices, the rest -1

  int end_count() const { return ends[2] < 0 ? 2 : 4; }
};

/// Sets the rows of told vertices, which come after all of their ends in the list.
void tell(std::span<const ToldVertex> told, BandArray& values);

/// Per vertex, m^2: the share of the elements around that is nearer to it than to their other
/// corners.
std::vector<double> vertex_areas(const PatchMesh& mesh);

/// Gives each point a share of the rays that falls with the square root of the area it stands for,
/// which makes the mean noise over all area least for the work: `rays` where those are that make up
/// half of all area, at most twice as many on still larger ones, at least an eighth anywhere;
/// powers of two.
void share_rays(std::span<const double> area, int rays, std::span<GatherPoint> points);

/// The same, with the areas of told vertices added to their ends'; they themselves get 0 rays.
void share_rays(const PatchMesh& mesh, std::span<const ToldVertex> told, int rays,
                std::span<GatherPoint> points);

}  // namespace lightwell
