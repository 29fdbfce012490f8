#include "radiosity/start_radiosity.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "scene/errors.h"

namespace lightwell {
namespace {

// Bounding box of each patch's elements, whose union is the same however they are split.
std::vector<Eigen::AlignedBox3d> patch_boxes(const PatchMesh& mesh) {
  std::vector<Eigen::AlignedBox3d> boxes(static_cast<std::size_t>(mesh.patch_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    for (int c = 0; c < mesh.corner_count(e); ++c) {
      boxes[static_cast<std::size_t>(mesh.patch[e])].extend(mesh.position(mesh.corners[e][c]));
    }
  }
  return boxes;
}

}  // namespace

BandArray start_radiosity(const PatchMesh& mesh, const SolvedScene& start) {
  const auto fail = [](const std::string& what) {
    throw InputError(fmt::format(
        "the solution to start from {}; start from one of the same geometry, made with the same "
        "--max-patch-size and --discontinuity, or solve without --start-from",
        what));
  };
  const PatchMesh& old = start.mesh;
  if (old.emission.cols() != mesh.emission.cols()) {
    fail(fmt::format("has {} bands, and the scene {}", old.emission.cols(), mesh.emission.cols()));
  }
  if (old.patch_count() != mesh.patch_count()) {
    fail(fmt::format("has {} patches, and the scene makes {}", old.patch_count(),
                     mesh.patch_count()));
  }
  const auto boxes = patch_boxes(mesh), old_boxes = patch_boxes(old);
  constexpr double rounding = 1e-9;
  for (int i = 0; i < mesh.patch_count(); ++i) {
    const auto& box = boxes[static_cast<std::size_t>(i)];
    const auto& old_box = old_boxes[static_cast<std::size_t>(i)];
    const double size = box.diagonal().norm() + box.max().norm();
    const bool same = old.surface[i] == mesh.surface[i] && old.is_back[i] == mesh.is_back[i] &&
                      std::abs(old.area[i] - mesh.area[i]) <= rounding * mesh.area[i] &&
                      (old_box.min() - box.min()).norm() <= rounding * size &&
                      (old_box.max() - box.max()).norm() <= rounding * size;
    if (!same) fail(fmt::format("has another patch {} than the scene", i));
  }
  if (!start.solution.patch_radiosity.allFinite()) fail("has radiosities that are not finite");
  return start.solution.patch_radiosity;
}

BandArray start_by_channel(const SolvedScene* start, const EmitterChannels& channels) {
  if (!start || start->solution.channels.size() != channels.names.size()) return {};
  for (std::size_t c = 0; c < channels.names.size(); ++c) {
    if (start->solution.channels[c].name != channels.names[c]) return {};
  }
  return side_by_side(start->solution.channels, &LightChannel::patch_radiosity);
}

}  // namespace lightwell
