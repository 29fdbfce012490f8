#include "scene/io/stf/stf_shells.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "scene/io/default_material.h"
#include "scene/io/placed_mesh.h"
#include "scene/io/stf/stf_luminaires.h"

namespace lightwell {
namespace {

using StfKind = StfOpening::Kind;

constexpr double usual_reflectance = 0.5;  // of furniture, that of default_material()

std::optional<StfKind> opening_kind(const std::string& given) {
  const std::string name = lower_case(given);
  if (name == "win") return StfKind::window;
  if (name == "door") return StfKind::door;
  if (name == "skylight") return StfKind::skylight;
  return std::nullopt;
}

std::string place_of(const StfSection& room, const std::string& key) {
  return fmt::format("[{}] {}", room.name(), key);
}

}  // namespace

void StfShells::add(StfSection& room, const StfPlan& plan) {
  StfOpenings openings(plan, remarks_);
  const std::vector<std::string> boxes = read_openings(room, plan, openings);
  add_surface(plan.name + " floor", diffuse("floor", plan.floor), {plan.outline(0.0)});
  add_ceiling(plan, openings);
  add_walls(plan, openings);
  for (const std::string& key : boxes) {
    remarks_.attempt("Furniture that cannot be used was left out", place_of(room, key),
                     [&] { add_box(room, key, plan); });
  }
  if (room.counted("Struct", "NrStruct") > 0) {
    remarks_.add("Structures, such as beams and columns (NrStruct), were left out",
                 fmt::format("[{}]", room.name()));
  }
}

// Adds windows, doors and skylights; returns the keys of the other furniture.
std::vector<std::string> StfShells::read_openings(StfSection& room, const StfPlan& plan,
                                                  StfOpenings& openings) {
  std::vector<std::string> others;
  std::size_t found = 0;
  const std::size_t count = room.counted("Furn", "NrFurns");
  for (std::size_t i = 1; i <= count; ++i) {
    const std::string key = fmt::format("Furn{}", i);
    const auto kind = opening_kind(room.text(key));
    if (!kind) {
      others.push_back(key);
      continue;
    }
    ++found;
    if (found > StfOpenings::most || found * plan.corners.size() > StfOpenings::most_pairs) {
      room.fail_limit(fmt::format(
          "has {} or more windows and doors for its {} walls, which would take minutes; divide it",
          found, plan.corners.size()));
    }
    remarks_.attempt("Openings that cannot be used were left out", place_of(room, key), [&] {
      const std::vector<double> position = room.numbers(key + ".Pos", 2);
      const std::vector<double> size = room.numbers(key + ".Size", 2);
      const Eigen::Vector3d turn = room.vector_or(key + ".Rot", Eigen::Vector3d::Zero());
      openings.add({.kind = *kind,
                    .name = place_of(room, key),
                    .position = {position[0], position[1], position.size() > 2 ? position[2] : 0.0},
                    .width = size[0],
                    .height = size[1],
                    .turn = turn.z(),
                    .reflectance = reflectance(room, key)});
    });
  }
  return others;
}

void StfShells::add_ceiling(const StfPlan& plan, const StfOpenings& openings) {
  Polygon ceiling{.boundary = plan.outline(plan.height)};
  std::ranges::reverse(ceiling.boundary);
  for (const PlacedOpening& placed : openings.in_ceiling()) ceiling.holes.push_back(placed.outline);
  add_surface(plan.name + " ceiling", diffuse("ceiling", plan.ceiling), ceiling);
  add_openings(plan, openings.in_ceiling(), plan.ceiling);
}

void StfShells::add_walls(const StfPlan& plan, const StfOpenings& openings) {
  for (std::size_t i = 0; i < plan.walls.size(); ++i) {
    const double length = (plan.corner(i + 1) - plan.corner(i)).norm();
    Polygon wall{.boundary = stf_wall_rectangle(plan, i, {0.0, length}, {0.0, plan.height})};
    for (const PlacedOpening& placed : openings.in_wall(i)) wall.holes.push_back(placed.outline);
    add_surface(fmt::format("{} wall {}", plan.name, i + 1), diffuse("wall", plan.walls[i]), wall);
    add_openings(plan, openings.in_wall(i), plan.walls[i]);
  }
}

// Panes and doors. A door without a colour reflects like its wall.
void StfShells::add_openings(const StfPlan& plan, const std::vector<PlacedOpening>& placed,
                             double wall) {
  for (const auto& [opening, outline] : placed) {
    if (opening.kind == StfKind::door) {
      remarks_.mention("Doors were read as closed faces in their wall", opening.name);
      add_surface(plan.name + " door", diffuse("door", opening.reflectance.value_or(wall)),
                  {outline});
    } else {
      remarks_.mention(
          "Windows and skylights were read as clear panes of glass of the index 1.52, with black "
          "behind them unless a sky is added",
          opening.name);
      add_surface(plan.name + (opening.kind == StfKind::window ? " window" : " skylight"), glass(),
                  {outline});
    }
  }
}

void StfShells::add_box(StfSection& room, const std::string& key, const StfPlan& plan) {
  const std::vector<double> position = room.numbers(key + ".Pos", 3);
  const std::vector<double> size = room.numbers(key + ".Size", 3);
  const Eigen::Vector3d angles = room.vector_or(key + ".Rot", Eigen::Vector3d::Zero());
  const Eigen::Vector3d half(0.5 * size[0], 0.5 * size[1], 0.5 * size[2]);
  if (!(half.minCoeff() > 0.0)) room.fail(key + ".Size", "must be three numbers above 0");
  Eigen::Vector3d middle(position[0], position[1], position[2]);
  constexpr double sunk = 1e-3;  // m
  if (angles.head<2>().isZero() && middle.z() < half.z() - sunk) {
    remarks_.mention(
        "Furniture that would reach below the floor with its position in the middle stands on its "
        "position",
        place_of(room, key));
    middle.z() += half.z();
  }
  middle.z() += plan.level;
  const Eigen::Affine3d at =
      Eigen::Translation3d(middle) * Eigen::Affine3d(stf_rotation(angles)) * Eigen::Scaling(half);
  const std::string name = room.text(key);
  add_mesh(fmt::format("{} {}", plan.name, name.empty() ? "furniture" : name),
           diffuse("furniture", reflectance(room, key).value_or(usual_reflectance)),
           placed_loops(cube_loops(), at, false, repairs_));
}

// The reflectance of furniture: the first number, in percent, of the key Poly.Color of the section
// that its key Ref names. Empty if it has none.
std::optional<double> StfShells::reflectance(StfSection& room, const std::string& key) {
  const std::string reference = room.text(key + ".Ref");
  StfSection* section = reference.empty() ? nullptr : file_.find(reference);
  if (!section) return std::nullopt;
  references_.push_back(reference);
  if (section->text("Poly.Color").empty()) return std::nullopt;
  const double percent = section->numbers("Poly.Color", 1)[0];
  if (!(percent >= 0.0 && percent <= 100.0)) {
    section->fail("Poly.Color", fmt::format("begins with {:g}; the reflectance comes first, "
                                            "between 0 and 100 percent",
                                            percent));
  }
  return percent / 100.0;
}

void StfShells::remark_unread() {
  for (const std::string& reference : references_) file_.find(reference)->remark_unread({});
}

void StfShells::add_surface(const std::string& name, int material, const Polygon& polygon) {
  MeshBuilder mesh;
  add_with_holes(mesh, polygon, repairs_);
  add_mesh(name, material, mesh.mesh());
}

void StfShells::add_mesh(const std::string& name, int material, PolygonMesh mesh) {
  if (mesh.facets.empty()) return;  // a wall of nothing but openings
  scene_.surfaces.push_back(
      {.name = names_.unique(name), .material = material, .shape = std::move(mesh)});
}

int StfShells::diffuse(const std::string& kind, double reflectance) {
  const std::string name = fmt::format("{} {}", kind, reflectance);
  const auto [at, is_new] = materials_.emplace(name, static_cast<int>(scene_.materials.size()));
  if (is_new) {
    Material material = default_material(scene_.bands);
    material.name = name;
    material.reflectance = constant_spectrum(scene_.bands, static_cast<float>(reflectance));
    material.one_sided = true;
    scene_.materials.push_back(std::move(material));
  }
  return at->second;
}

int StfShells::glass() {
  const auto [at, is_new] = materials_.emplace("glass", static_cast<int>(scene_.materials.size()));
  if (is_new) {
    Material material = default_material(scene_.bands);
    material.name = "glass";
    material.reflectance = constant_spectrum(scene_.bands, 0.0f);
    material.dielectric = Dielectric{
        .index_of_refraction = 1.52f, .tint = constant_spectrum(scene_.bands, 1.0f), .thin = true};
    scene_.materials.push_back(std::move(material));
  }
  return at->second;
}

}  // namespace lightwell
