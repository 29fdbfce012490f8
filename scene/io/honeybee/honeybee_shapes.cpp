#include "scene/io/honeybee/honeybee_shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "scene/errors.h"
#include "scene/io/flat_loop.h"

namespace lightwell {
namespace {

std::string name_of(const JsonObject& object) {
  return object.string_or("identifier", object.place());
}

std::string boundary_of(const JsonObject& object) {
  const auto boundary = object.object("boundary_condition");
  return boundary ? boundary->string_or("type", "") : "";
}

// True for what has another room behind it.
bool is_inner(const JsonObject& opening) {
  return boundary_of(opening) == "Surface";
}

// Honeybee reads a face that does not face the outside, such as one on the ground, as an inner one.
HoneybeeKind face_kind(const JsonObject& face) {
  const std::string type = face.string_or("face_type", "Wall"), boundary = boundary_of(face);
  const bool inner = !boundary.empty() && boundary != "Outdoors";
  if (type == "Floor") return inner ? HoneybeeKind::inner_floor : HoneybeeKind::floor;
  if (type == "RoofCeiling") return inner ? HoneybeeKind::ceiling : HoneybeeKind::roof;
  return inner ? HoneybeeKind::inner_wall : HoneybeeKind::wall;
}

bool is_wall(HoneybeeKind face) {
  return face == HoneybeeKind::wall || face == HoneybeeKind::inner_wall;
}

HoneybeeKind aperture_kind(const JsonObject& aperture, HoneybeeKind face) {
  if (is_inner(aperture)) return HoneybeeKind::inner_window;
  if (aperture.boolean_or("is_operable", false)) return HoneybeeKind::operable_window;
  return is_wall(face) ? HoneybeeKind::window : HoneybeeKind::skylight;
}

HoneybeeKind door_kind(const JsonObject& door, HoneybeeKind face) {
  const bool is_glass = door.boolean_or("is_glass", false);
  if (is_inner(door)) return is_glass ? HoneybeeKind::inner_glass_door : HoneybeeKind::inner_door;
  if (is_glass) return HoneybeeKind::glass_door;
  return is_wall(face) ? HoneybeeKind::door : HoneybeeKind::overhead_door;
}

// The kind of a shade that belongs to no room.
HoneybeeKind free_shade_kind(const JsonObject& shade, bool usually_detached) {
  return shade.boolean_or("is_detached", usually_detached) ? HoneybeeKind::context
                                                           : HoneybeeKind::outdoor_shade;
}

}  // namespace

void HoneybeeShapes::add(const JsonObject& model) {
  if (const double tolerance = model.number_or("tolerance", 0.0); tolerance > 0.0) {
    gap_ = 2.0 * metres_per_unit_ * tolerance;
  }
  for_each(model, "rooms", [&](const JsonObject& room) { add_room(room); });
  for_each(model, "orphaned_faces", [&](const JsonObject& face) { add_face(face, "", false); });
  for_each(model, "orphaned_apertures", [&](const JsonObject& aperture) {
    add_opening(aperture, aperture_kind(aperture, HoneybeeKind::wall), "");
  });
  for_each(model, "orphaned_doors", [&](const JsonObject& door) {
    add_opening(door, door_kind(door, HoneybeeKind::wall), "");
  });
  for_each(model, "orphaned_shades", [&](const JsonObject& shade) {
    add_polygon(shade, free_shade_kind(shade, false), "", polygon_of(shade));
  });
  for_each(model, "shade_meshes", [&](const JsonObject& mesh) { add_shade_mesh(mesh); });
}

// Uses each object of a list that can be used.
template <class Use>
void HoneybeeShapes::for_each(const JsonObject& parent, const char* list, Use use) {
  for (const JsonObject& each : parent.objects(list)) {
    remarks_.attempt("Objects that cannot be read were left out", each.place(), [&] { use(each); });
  }
}

void HoneybeeShapes::add_room(const JsonObject& room) {
  if (room.number_or("multiplier", 1.0) > 1.0) {
    remarks_.mention("Rooms that stand for several (multiplier) were read once", name_of(room));
  }
  const auto radiance = radiance_properties(room);
  const std::string set = radiance ? radiance->string_or("modifier_set", "") : "";
  const bool is_turned = faces_outward(room);
  for_each(room, "faces", [&](const JsonObject& face) { add_face(face, set, is_turned); });
  add_shades(room, set);
}

// True if the faces of a room enclose a positive volume: a third of the sum of (p - m) . n dA
// (Gauss). With the room's middle as m, the sign is right also if a face is missing.
bool HoneybeeShapes::faces_outward(const JsonObject& room) const {
  std::vector<Loop> loops;
  Loop all;
  for (const JsonObject& face : room.objects("faces")) {
    try {
      loops.push_back(polygon_of(face).boundary);
      all.insert(all.end(), loops.back().begin(), loops.back().end());
    } catch (const InputError&) {
      continue;  // add_face() names the fault
    }
  }
  if (all.empty()) return false;
  const Eigen::Vector3d middle = mean_point(all);
  double volume = 0.0;
  for (const Loop& loop : loops) volume += (loop.front() - middle).dot(area_vector(loop)) / 3.0;
  return volume > 0.0;
}

// True if a face or opening lies between two rooms, and the other room had it.
bool HoneybeeShapes::is_read_already(const JsonObject& object) {
  const auto boundary = object.object("boundary_condition");
  if (boundary && boundary->string_or("type", "") == "Surface") {
    const std::vector<std::string> behind = boundary->strings("boundary_condition_objects");
    if (!behind.empty() && read_.contains(behind.front())) return true;
  }
  read_.insert(name_of(object));
  return false;
}

void HoneybeeShapes::add_face(const JsonObject& face, const std::string& set, bool is_turned) {
  add_shades(face, set);
  const HoneybeeKind kind = face_kind(face);
  Polygon polygon = polygon_of(face);
  for (const char* list : {"apertures", "doors"}) {
    const bool is_door = *list == 'd';
    for_each(face, list, [&](const JsonObject& opening) {
      polygon.holes.push_back(polygon_of(opening).boundary);
      add_opening(opening, is_door ? door_kind(opening, kind) : aperture_kind(opening, kind), set);
    });
  }
  if (face.string_or("face_type", "") == "AirBoundary") {
    remarks_.mention("Air boundaries were read as open", name_of(face));
    return;
  }
  if (is_turned) std::ranges::reverse(polygon.boundary);
  if (is_read_already(face)) {
    const Eigen::Vector3d inward = gap_ * area_vector(polygon.boundary).stableNormalized();
    for (Eigen::Vector3d& point : polygon.boundary) point += inward;
    for (Loop& hole : polygon.holes) {
      for (Eigen::Vector3d& point : hole) point += inward;
    }
  }
  add_polygon(face, kind, set, std::move(polygon));
}

void HoneybeeShapes::add_opening(const JsonObject& opening, HoneybeeKind kind,
                                 const std::string& set) {
  add_shades(opening, set);
  if (is_read_already(opening)) return;
  const std::size_t before = scene_.surfaces.size();
  add_polygon(opening, kind, set, polygon_of(opening));
  if (scene_.surfaces.size() > before) add_states(opening, kind, set);
}

// Records the states of the opening that became the last surface.
void HoneybeeShapes::add_states(const JsonObject& opening, HoneybeeKind kind,
                                const std::string& set) {
  std::vector<std::string> states = modifiers_.of_states(opening, kind, set);
  if (states.size() < 2) return;
  const auto radiance = radiance_properties(opening);
  dynamic_openings_.push_back(
      {.surface = scene_.surfaces.back().name,
       .group = radiance->string_or("dynamic_group_identifier", name_of(opening)),
       .states = std::move(states)});
}

void HoneybeeShapes::add_shades(const JsonObject& parent, const std::string& set) {
  for (const bool is_outdoor : {true, false}) {
    const HoneybeeKind kind = is_outdoor ? HoneybeeKind::outdoor_shade : HoneybeeKind::indoor_shade;
    for_each(parent, is_outdoor ? "outdoor_shades" : "indoor_shades",
             [&](const JsonObject& shade) { add_polygon(shade, kind, set, polygon_of(shade)); });
  }
}

Loop HoneybeeShapes::scaled(Loop loop) const {
  for (Eigen::Vector3d& point : loop) point *= metres_per_unit_;
  return loop;
}

Polygon HoneybeeShapes::polygon_of(const JsonObject& object) const {
  const auto geometry = object.object("geometry");
  if (!geometry) object.fail("has no 'geometry'");
  Polygon polygon{.boundary = scaled(geometry->points("boundary"))};
  if (polygon.boundary.size() < 3) {
    geometry->fail(fmt::format("'boundary' has {} points; a face needs at least three",
                               polygon.boundary.size()));
  }
  for (const Loop& hole : geometry->point_lists("holes")) polygon.holes.push_back(scaled(hole));
  // The order of the points says less than the plane, where that is given.
  const auto plane = geometry->object("plane");
  const auto normal = plane ? plane->point("n") : std::nullopt;
  if (normal && normal->dot(area_vector(polygon.boundary)) < 0.0) {
    std::ranges::reverse(polygon.boundary);
  }
  return polygon;
}

void HoneybeeShapes::account(const JsonObject& object, std::size_t corners) {
  size_.add(triangles_of(corners),
            [&](const std::string& sentence) { object.fail_limit(sentence); });
}

void HoneybeeShapes::add_polygon(const JsonObject& object, HoneybeeKind kind,
                                 const std::string& set, Polygon polygon) {
  std::size_t corners = polygon.boundary.size();
  for (const Loop& hole : polygon.holes) corners += hole.size();
  account(object, corners);
  MeshBuilder mesh;
  add_with_holes(mesh, std::move(polygon), repairs_);
  add_surface(object, kind, set, mesh);
}

void HoneybeeShapes::add_shade_mesh(const JsonObject& object) {
  const auto geometry = object.object("geometry");
  if (!geometry) object.fail("has no 'geometry'");
  const Loop vertices = scaled(geometry->points("vertices"));
  MeshBuilder mesh;
  for (const std::vector<std::size_t>& face : geometry->index_lists("faces")) {
    account(object, face.size());
    Loop loop;
    for (const std::size_t v : face) {
      if (v >= vertices.size()) {
        geometry->fail(fmt::format("'faces' has the vertex {}; there are {}, counted from 0", v,
                                   vertices.size()));
      }
      loop.push_back(vertices[v]);
    }
    add_repaired(mesh, std::move(loop), repairs_);
  }
  add_surface(object, free_shade_kind(object, true), "", mesh);
}

void HoneybeeShapes::add_surface(const JsonObject& object, HoneybeeKind kind,
                                 const std::string& set, const MeshBuilder& mesh) {
  const auto material = modifiers_.of(object, kind, set);
  if (!material) return;
  // A face of nothing but openings, as a glazed front, has no area left.
  if (mesh.empty()) return;
  scene_.surfaces.push_back(
      {.name = names_.unique(name_of(object)), .material = *material, .shape = mesh.mesh()});
}

}  // namespace lightwell
