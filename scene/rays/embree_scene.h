#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "scene/rays/cast_round_shapes.h"
#include "scene/rays/cell_sheets.h"
#include "scene/rays/coplanar_groups.h"
#include "scene/rays/embree_queries.h"
#include "scene/rays/float_rounding.h"

namespace lightwell {

/// Embree's tree over a CastGeometry, and the planes of its groups.
struct EmbreeScene {
  // Embree's geometry IDs. Polygons with holes are a geometry of their own: its filter costs the
  // others nothing.
  enum GeometryId : unsigned { polygons_id, round_id, porous_id };
  enum Hidden : std::uint8_t { from_front = 1, from_back = 2 };

  explicit EmbreeScene(const CastGeometry& geometry);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // Embree's origin
  double rounding = 0.0;  // largest error of a point of the scenery by float coordinates, metres
  std::vector<double> roundings{};  // the same by group; empty without a backdrop (scenery_box)
  std::vector<int> group;
  std::unique_ptr<CoplanarGroups> planes;
  std::vector<std::uint8_t> hidden;  // per triangle and quad: sides hidden by another group
  bool is_any_hidden = false;        // saves rays the access to `hidden`
  RoundShapeSet round_set;
  int triangles = 0, quads = 0;
  // Primitives of Embree's two geometries of polygons.
  std::vector<int> solid, porous;
  CellSheets sheets;  // the last entries of `solid` are their first cells
  std::function<bool(int group, const Eigen::Vector3d& point)> is_hole;

  double rounding_of(int of_group) const {
    return roundings.empty() ? rounding : roundings[of_group];
  }
  double rounding_at(const Eigen::Vector3d& point) const {
    return roundings.empty() ? rounding
                             : std::max(rounding, ray_rounding(2.0 * (point - center).norm()));
  }

  // Number of the primitive that was met. For a sheet: any cell, since all cells are of one group
  // and nothing lies on them.
  int primitive(const RTCHit& hit) const {
    if (hit.geomID == round_id) return static_cast<int>(hit.primID) + triangles + quads;
    return (hit.geomID == porous_id ? porous : solid)[hit.primID];
  }

  // Sheet that was met; null if a single primitive was met.
  const CellSheet* sheet(const RTCHit& hit) const {
    const std::size_t alone = solid.size() - sheets.sheets.size();
    if (hit.geomID != polygons_id || hit.primID < alone) return nullptr;
    return &sheets.sheets[hit.primID - alone];
  }

  static void clear(RTCHit& hit) {
    hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  }

 private:
  EmbreeScene() = default;
  void check() const;
  void find_roundings(const CastGeometry& source);
  void attach(RTCGeometry geometry, GeometryId id);
  void add_polygons(const CastGeometry& source);
  bool may_join(const CastGeometry& source, int quad) const;
  RTCGeometry polygon_geometry(const CastGeometry& source, std::span<const int> primitives,
                               std::span<const CellSheet> with) const;
  static void skip_holes(const RTCFilterFunctionNArguments* args);
  void add_round_shapes(const CastGeometry& source);
  void find_hidden(const CastGeometry& source);
  std::vector<int> groups_at(const Eigen::Vector3d& place, int on) const;
};

}  // namespace lightwell
