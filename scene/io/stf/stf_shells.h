#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/io/mesh_builder.h"
#include "scene/io/numbered_names.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/remarks.h"
#include "scene/io/stf/stf_openings.h"
#include "scene/io/stf/stf_plan.h"
#include "scene/scene.h"

namespace lightwell {

/// Converts rooms to surfaces whose fronts face into the room, and furniture to boxes. Windows and
/// skylights are panes, doors are faces; both are cut out of their wall or ceiling.
class StfShells {
 public:
  /// Keeps references.
  StfShells(StfFile& file, Scene& scene, Remarks& remarks)
      : file_(file), scene_(scene), remarks_(remarks) {}

  /// Adds the surfaces of a room, the floor first. Parts that cannot be used are left out, with a
  /// remark. Throws LimitError for more openings than StfOpenings takes.
  void add(StfSection& room, const StfPlan& plan);
  /// Remarks on keys of furniture that were not read.
  void remark_unread();
  const Repairs& repairs() const { return repairs_; }

 private:
  std::vector<std::string> read_openings(StfSection& room, const StfPlan& plan,
                                         StfOpenings& openings);
  void add_ceiling(const StfPlan& plan, const StfOpenings& openings);
  void add_walls(const StfPlan& plan, const StfOpenings& openings);
  void add_openings(const StfPlan& plan, const std::vector<PlacedOpening>& placed, double wall);
  void add_box(StfSection& room, const std::string& key, const StfPlan& plan);
  std::optional<double> reflectance(StfSection& room, const std::string& key);
  void add_surface(const std::string& name, int material, const Polygon& polygon);
  void add_mesh(const std::string& name, int material, PolygonMesh mesh);
  int diffuse(const std::string& kind, double reflectance);
  int glass();

  StfFile& file_;
  Scene& scene_;
  Remarks& remarks_;
  Repairs repairs_;
  NumberedNames names_;
  std::map<std::string, int> materials_{};  // by name
  std::vector<std::string> references_{};   // of furniture to sections
};

}  // namespace lightwell
