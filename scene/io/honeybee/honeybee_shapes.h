#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "scene/io/honeybee/honeybee_modifiers.h"
#include "scene/io/json_object.h"
#include "scene/io/mesh_builder.h"
#include "scene/io/numbered_names.h"
#include "scene/io/polygon_repair.h"
#include "scene/io/remarks.h"
#include "scene/io/scene_size.h"
#include "scene/scene.h"

namespace lightwell {

/// An opening whose modifier changes with the state of its group.
struct DynamicOpening {
  std::string surface{};              ///< name in the scene
  std::string group{};                ///< identifier of the dynamic group
  std::vector<std::string> states{};  ///< names of the modifiers; the scene has the first
};

/// Converts the rooms, faces, openings and shades of a Honeybee model to surfaces, one for each
/// object, with the identifier of the object as name. Openings are cut out of their face. The
/// fronts of a room's faces face into the room. Of two faces between two rooms, the second is moved
/// into its room by twice the model's tolerance, as Honeybee does for RADIANCE, so that each room
/// sees its own; openings between two rooms are read once. Air boundaries are open.
class HoneybeeShapes {
 public:
  /// Keeps references. `metres_per_unit` scales all coordinates.
  HoneybeeShapes(double metres_per_unit, HoneybeeModifiers& modifiers, Scene& scene,
                 Remarks& remarks)
      : metres_per_unit_(metres_per_unit),
        gap_(usual_gap),
        modifiers_(modifiers),
        scene_(scene),
        remarks_(remarks) {}

  /// Adds all objects of a model; those that cannot be read are left out, with a remark. Throws
  /// InputError for lists of objects that are none.
  void add(const JsonObject& model);
  const Repairs& repairs() const { return repairs_; }
  /// The openings of two and more states so far.
  const std::vector<DynamicOpening>& dynamic_openings() const { return dynamic_openings_; }

 private:
  template <class Use>
  void for_each(const JsonObject& parent, const char* list, Use use);
  void add_room(const JsonObject& room);
  bool faces_outward(const JsonObject& room) const;
  void add_face(const JsonObject& face, const std::string& set, bool is_turned);
  void add_opening(const JsonObject& opening, HoneybeeKind kind, const std::string& set);
  void add_shades(const JsonObject& parent, const std::string& set);
  void add_shade_mesh(const JsonObject& mesh);
  void add_states(const JsonObject& opening, HoneybeeKind kind, const std::string& set);
  void add_polygon(const JsonObject& object, HoneybeeKind kind, const std::string& set,
                   Polygon polygon);
  void add_surface(const JsonObject& object, HoneybeeKind kind, const std::string& set,
                   const MeshBuilder& mesh);
  Loop scaled(Loop loop) const;
  Polygon polygon_of(const JsonObject& object) const;
  void account(const JsonObject& object, std::size_t corners);
  bool is_read_already(const JsonObject& object);

  static constexpr double usual_gap = 0.02;  // m, for the usual tolerance of 1 cm

  double metres_per_unit_;
  double gap_;  // m, between the two faces between two rooms
  HoneybeeModifiers& modifiers_;
  Scene& scene_;
  Remarks& remarks_;
  Repairs repairs_;
  NumberedNames names_;
  SceneSize size_;
  std::set<std::string, std::less<>> read_{};  // identifiers of faces and openings
  std::vector<DynamicOpening> dynamic_openings_{};
};

}  // namespace lightwell
