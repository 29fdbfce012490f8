#include "viewer/export/baked_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "mesh/cleaning/joined_surfaces.h"
#include "mesh/patches/mesh_bounds.h"
#include "mesh/patches/round_grid.h"
#include "radiosity/refine/illuminance_bound.h"
#include "raytrace/display/display.h"
#include "scene/errors.h"
#include "scene/io/numbered_names.h"
#include "scene/rotation_between.h"
#include "viewer/export/appearance.h"
#include "viewer/export/baked_channels.h"
#include "viewer/export/drawn_pictures.h"
#include "viewer/export/shown_sides.h"
#include "viewer/export/sky_grid.h"
#include "viewer/export/start_view.h"

namespace lightwell {
namespace {

constexpr int start_width = 1024, start_height = 768;
/// Largest side of a picture, texels: keeps files small enough to send.
constexpr int longest_picture = 1024;

std::string name_or_number(const std::string& name, const char* kind, int number) {
  return name.empty() ? fmt::format("{} {}", kind, number) : name;
}

void check_input(const SolvedScene& solved, const Scene& scene) {
  const Bands& bands = solved.solution.bands;
  if (bands.wavelengths_nm.empty() && bands.count() != 3) {
    throw InputError(fmt::format(
        "a solution of {} bands without wavelengths has no colour; it takes red, green and blue",
        bands.count()));
  }
  if (scene.surfaces.empty()) return;
  const PatchMesh& mesh = solved.mesh;
  const auto surfaces =
      std::size_t{1} + *std::max_element(mesh.surface.begin(), mesh.surface.end());
  if (surfaces > scene.surfaces.size()) {
    throw InputError(fmt::format(
        "{}: has {} surfaces, but the solution at least {}; give the scene it was made from",
        scene.file.string(), scene.surfaces.size(), surfaces));
  }
}

struct Side {
  int surface = 0;
  bool is_back = false;
  int picture = -1;

  auto operator<=>(const Side&) const = default;
};

/// Elements of each side that are kept. Elements with a picture are in the order of texture maps.
std::map<Side, std::vector<int>> sides_of(const PatchMesh& mesh, const std::vector<SideUse>& use,
                                          const DrawnPictures& drawn, const JoinedSurfaces* names) {
  std::map<Side, std::vector<int>> sides;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const int p = mesh.patch[e];
    if (use[e] == SideUse::left_out) continue;
    const int surface =
        names ? names->surface_of(mesh, e, element_center(mesh, e).position) : mesh.surface[p];
    sides[{surface, mesh.is_back[p] != 0, drawn.of(mesh.facet[e])}].push_back(e);
  }
  for (auto& [side, elements] : sides) {
    if (side.picture < 0) continue;
    std::ranges::stable_sort(elements, {}, [&](int e) { return drawn.map_of(mesh.facet[e]); });
  }
  return sides;
}

/// Numbers vertices of the mesh in order of first use. Each group, a part or its elements of one
/// texture map, has numbers of its own.
class VertexNumbers {
 public:
  explicit VertexNumbers(int count) : number_(static_cast<std::size_t>(count), -1) {}
  void begin_group() { first_ = count(); }
  int operator()(int vertex) {
    int& number = number_[static_cast<std::size_t>(vertex)];
    if (number < first_) {
      number = count();
      order_.push_back(vertex);
    }
    return number;
  }
  int count() const { return static_cast<int>(order_.size()); }
  const std::vector<int>& order() const { return order_; }

 private:
  int first_ = 0;
  std::vector<int> number_, order_;
};

/// Numbers the materials in order of first use.
class MaterialNumbers {
 public:
  MaterialNumbers(const Scene& scene, std::vector<BakedMaterial>& materials)
      : scene_(scene), materials_(materials) {}
  int operator()(int material) {
    const auto [at, is_new] = number_.try_emplace(material, static_cast<int>(materials_.size()));
    if (is_new) {
      const auto m = static_cast<std::size_t>(material);
      const Material known = m < scene_.materials.size() ? scene_.materials[m] : Material{};
      materials_.push_back({.name = name_or_number(known.name, "material", material),
                            .is_glass = known.dielectric.has_value(),
                            .is_mirror = !known.dielectric && !known.coat && known.is_specular()});
    }
    return at->second;
  }

 private:
  const Scene& scene_;
  std::vector<BakedMaterial>& materials_;
  std::map<int, int> number_;
};

void add_face(const PatchMesh& mesh, const std::vector<SideUse>& use, const BandArray& radiance,
              int element, VertexNumbers& number, BakedModel& model) {
  const int count = mesh.corner_count(element);
  const int first = first_corner(mesh, element, radiance);
  std::array<int, 4> face{-1, -1, -1, -1};
  for (int c = 0; c < count; ++c) face[c] = number(mesh.corners[element][(first + c) % count]);
  const int twin = mesh.twin[element];
  model.faces.push_back(face);
  model.element.push_back(element);
  model.black_behind.push_back(twin >= 0 && use[twin] == SideUse::left_out ? 1 : 0);
}

std::optional<Sphere> sphere_of(const RoundGrid* grid) {
  const auto* sphere = grid ? std::get_if<Sphere>(&grid->shape) : nullptr;
  return sphere ? std::optional(*sphere) : std::nullopt;
}

/// Fills parts, materials and faces. Returns the mesh's vertex for each vertex of the model.
std::vector<int> add_parts(const PatchMesh& mesh, const Scene& scene,
                           const std::vector<SideUse>& use, const BandArray& radiance,
                           const DrawnPictures& drawn, const JoinedSurfaces* names,
                           BakedModel& model) {
  VertexNumbers vertex(mesh.vertex_count());
  MaterialNumbers material(scene, model.materials);
  for (const auto& [side, elements] : sides_of(mesh, use, drawn, names)) {
    const auto s = static_cast<std::size_t>(side.surface);
    const std::string name = s < scene.surfaces.size() ? scene.surfaces[s].name : std::string();
    const int first_face = model.face_count(), first_vertex = vertex.count();
    int map = -1;
    const RoundGrid* const grid = round_grid_of(mesh, mesh.facet[elements.front()]);
    vertex.begin_group();
    for (const int e : elements) {
      const int facet = mesh.facet[e];
      if (side.picture >= 0 && drawn.map_of(facet) != std::exchange(map, drawn.map_of(facet))) {
        vertex.begin_group();
      }
      add_face(mesh, use, radiance, e, vertex, model);
    }
    model.parts.push_back(
        {.name = name_or_number(name, "surface", side.surface),
         .surface = side.surface,
         .material = material(names ? scene.surfaces[s].material
                                    : mesh.material[mesh.patch[elements.front()]]),
         .picture = side.picture,
         .sphere = sphere_of(grid),
         .is_back = side.is_back,
         .first_vertex = first_vertex,
         .vertex_count = vertex.count() - first_vertex,
         .first_face = first_face,
         .face_count = model.face_count() - first_face});
  }
  return vertex.order();
}

void add_vertices(const SolvedScene& solved, const BandArray& radiance, BakedModel& model) {
  const std::vector<int>& mesh_vertex = model.mesh_vertex;
  const Bands& bands = solved.solution.bands;
  const auto count = static_cast<Eigen::Index>(mesh_vertex.size());
  const BandArray E = solved.solution.irradiance();
  const BandArray B = vertex_radiosity(solved.mesh, solved.solution);
  model.radiance.resize(count, 3);
  model.irradiance.resize(count, E.cols());
  model.radiosity.resize(count, B.cols());
  model.position.reserve(mesh_vertex.size());
  model.illuminance.reserve(mesh_vertex.size());
  for (Eigen::Index i = 0; i < count; ++i) {
    const int v = mesh_vertex[static_cast<std::size_t>(i)];
    model.position.push_back(solved.mesh.position(v));
    const Spectrum L = radiance.row(v).transpose();
    model.radiance.row(i) = linear_rgb(bands, L).unaryExpr(&finite_or_black).transpose();
    model.irradiance.row(i) = E.row(v);
    model.radiosity.row(i) = B.row(v);
    const auto lux = static_cast<float>(luminous(bands, E.row(v).transpose()));
    model.illuminance.push_back(finite_or_black(lux));
  }
}

void add_bounds(const SolvedScene& solved, BakedModel& model) {
  const Eigen::ArrayXf bounds = illuminance_bounds(solved.mesh, solved.solution);
  if (bounds.size() == 0) return;
  for (const int e : model.element) model.lux_within.push_back(finite_or_black(bounds[e]));
}

void add_baked_pictures(const PatchMesh& mesh, const DrawnPictures& drawn, BakedModel& model) {
  model.pictures = drawn.all();
  if (model.pictures.empty()) return;
  const auto gain = picture_gains(mesh, drawn);
  model.place.resize(model.mesh_vertex.size(), Eigen::Vector2f::Zero());
  model.picture_gain = RgbArray::Ones(static_cast<Eigen::Index>(model.mesh_vertex.size()), 3);
  for (const BakedPart& part : model.parts) {
    if (part.picture < 0) continue;
    for (int f = part.first_face; f < part.first_face + part.face_count; ++f) {
      const int facet = mesh.facet[model.element[static_cast<std::size_t>(f)]];
      for (int c = 0; c < model.corner_count(f); ++c) {
        const auto v = static_cast<std::size_t>(model.faces[static_cast<std::size_t>(f)][c]);
        model.place[v] = drawn.place(facet, model.position[v]);
        model.picture_gain.row(static_cast<Eigen::Index>(v)) = gain.row(model.mesh_vertex[v]);
      }
    }
  }
}

/// Moves two shown sides of a place apart, each along its normals. A vertex that both a moved and
/// another face have moves, so that no gap opens between the two.
void move_apart(const PatchMesh& mesh, const std::vector<SideUse>& use, BakedModel& model) {
  const double gap = half_gap(mesh);
  std::vector<char> is_moved(model.position.size(), 0);
  for (int f = 0; f < model.face_count(); ++f) {
    if (use[model.element[static_cast<std::size_t>(f)]] != SideUse::moved) continue;
    for (int c = 0; c < model.corner_count(f); ++c) {
      is_moved[static_cast<std::size_t>(model.faces[static_cast<std::size_t>(f)][c])] = 1;
    }
  }
  for (std::size_t v = 0; v < is_moved.size(); ++v) {
    if (is_moved[v]) model.position[v] += gap * mesh.vertex_normal[model.mesh_vertex[v]];
  }
}

void add_cameras(const SolvedScene& solved, const Scene& scene, const ElementCaster& caster,
                 const std::vector<ElementKind>& kinds, const BandArray& radiance,
                 const Eigen::Vector3d& up_axis, double exposure_ev, BakedModel& model) {
  std::vector<Camera> cameras = scene.cameras;
  model.cameras_are_given = !cameras.empty();
  if (cameras.empty()) {
    cameras = {find_start(caster, kinds, radiance, up_axis, start_width, start_height)};
    cameras.front().name = "start";
  }
  const Bands& bands = solved.solution.bands;
  const std::optional<Sky> sky = effective_sky(scene, solved.mesh);
  const BandArray irradiance = solved.solution.irradiance();
  for (const Camera& camera : cameras) {
    const double scale =
        metered_scale(caster, kinds, {irradiance, radiance}, bands, camera, sky ? &*sky : nullptr);
    model.cameras.push_back(
        {.camera = for_window(camera), .scale = scale * std::exp2(exposure_ev)});
  }
}

/// The largest channel of the radiance of each vertex that gets light and does not emit any.
std::vector<float> reflected_radiances(const BakedModel& model, const Bands& bands) {
  constexpr double rounding = 1e-3;  // of sums of bands in floats
  const Bands shown = shown_bands(bands);
  std::vector<float> largest;
  for (int v = 0; v < model.vertex_count(); ++v) {
    const double exitance = std::numbers::pi * luminous(shown, model.radiance.row(v).transpose());
    const auto arriving = static_cast<double>(model.illuminance[static_cast<std::size_t>(v)]);
    const bool is_reflected = exitance > 0.0 && exitance <= (1.0 + rounding) * arriving;
    if (is_reflected) largest.push_back(model.radiance.row(v).maxCoeff());
  }
  return largest;
}

/// BakedModel::color_scale for an exposure of `scale`. Below three stops less, a room with one
/// bright spot would look unlit.
double unclipped_scale(std::vector<float> radiances, double scale) {
  constexpr double unclipped = 0.99, least = 1.0 / 8.0;
  if (radiances.empty()) return scale;
  const auto last = static_cast<double>(radiances.size() - 1);
  const auto at = radiances.begin() + static_cast<std::ptrdiff_t>(std::ceil(unclipped * last));
  std::nth_element(radiances.begin(), at, radiances.end());
  return std::clamp(1.0 / static_cast<double>(*at), least * scale, scale);
}

/// Rotation from `up_axis`, a coordinate axis or its opposite, to +y.
Eigen::Matrix3d rotation_to_y_up(const Eigen::Vector3d& up_axis) {
  const Eigen::Quaterniond turn = rotation_between(up_axis, Eigen::Vector3d::UnitY());
  return turn.toRotationMatrix().array().round();
}

}  // namespace

BakedModel bake_model(const SolvedScene& solved, const Scene& scene, double exposure_ev,
                      const JoinedSurfaces* names, Sides sides) {
  check_input(solved, scene);
  const std::vector<ElementKind> kinds = kinds_with_all_on(solved, scene.materials);
  const BandArray radiance = shown_radiance(solved, scene.materials);
  const ElementCaster caster(solved.mesh);
  BakedModel model;
  model.title = scene.title;
  const DrawnPictures drawn(scene, longest_picture);
  const std::vector<SideUse> use = choose_sides(solved, scene, caster, kinds, sides);
  model.mesh_vertex = add_parts(solved.mesh, scene, use, radiance, drawn, names, model);
  add_vertices(solved, radiance, model);
  add_bounds(solved, model);
  add_baked_pictures(solved.mesh, drawn, model);
  move_apart(solved.mesh, use, model);
  model.channels = bake_channels(solved, scene.materials, model.mesh_vertex);
  model.sky = bake_sky(solved, scene);
  NumberedNames names_in_use;  // programs join objects of one name
  for (const Surface& surface : scene.surfaces) names_in_use.unique(surface.name);
  for (const Lamp& lamp : scene.lamps) model.lamp_names.push_back(names_in_use.unique(lamp.name));
  model.lamp_faces = bake_lamps(solved, scene.materials, DrawnLamps(scene, caster));
  const Eigen::Vector3d up_axis = guess_up_axis(scene.cameras, mesh_bounds(solved.mesh));
  model.to_y_up = rotation_to_y_up(up_axis);
  add_cameras(solved, scene, caster, kinds, radiance, up_axis, exposure_ev, model);
  model.bands = solved.solution.bands;
  const double stops = std::exp2(exposure_ev);
  model.color_scale = stops * unclipped_scale(reflected_radiances(model, model.bands),
                                              model.cameras.front().scale / stops);
  model.metres_per_unit = solved.solution.metres_per_unit;
  model.unit_name = solved.solution.unit_name;
  model.relative_units = solved.solution.relative_units;
  model.provenance = solved.solution.provenance;
  return model;
}

std::vector<std::uint8_t> srgb_colors(const BakedModel& model) {
  return display_colors(model.radiance, rgb_bands(), model.cameras.front().scale);
}

std::vector<std::array<int, 3>> triangles_of(const BakedModel& model, int first_face,
                                             int face_count) {
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(std::size_t{2} * face_count);
  for (int f = first_face; f < first_face + face_count; ++f) {
    const auto& c = model.faces[static_cast<std::size_t>(f)];
    triangles.push_back({c[0], c[1], c[2]});
    if (c[3] >= 0) triangles.push_back({c[0], c[2], c[3]});
  }
  return triangles;
}

}  // namespace lightwell
