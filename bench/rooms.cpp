#include "bench/rooms.h"

#include <array>
#include <cmath>
#include <vector>

#include "bench/grey_scene.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

int add_lamp(Scene& scene, float exitance) {
  Material lamp = scene.materials[0];
  lamp.name = "lamp";
  lamp.emission = constant_spectrum(scene.bands, exitance);
  scene.materials.push_back(lamp);
  return static_cast<int>(scene.materials.size()) - 1;
}

// Lines from 0 to 1: the `given` ones for `cells` 0, otherwise `cells` + 1 even ones.
std::vector<double> lines(const std::vector<double>& given, int cells) {
  if (cells == 0) return given;
  std::vector<double> even(cells + 1);
  for (int i = 0; i <= cells; ++i) even[i] = static_cast<double>(i) / cells;
  return even;
}

struct Rectangle {
  Eigen::Vector3d corner, u, v;
};

// Adds the rectangle `whole` cut along lines at shares of u and v. material_of(middle) is the
// material of a piece; -1 leaves the piece out.
template <class MaterialOf>
void add_cut(Scene& scene, const Rectangle& whole, const std::vector<double>& u,
             const std::vector<double>& v, MaterialOf material_of) {
  for (std::size_t i = 0; i + 1 < u.size(); ++i) {
    for (std::size_t j = 0; j + 1 < v.size(); ++j) {
      const Eigen::Vector3d corner = whole.corner + u[i] * whole.u + v[j] * whole.v;
      const Eigen::Vector3d along = (u[i + 1] - u[i]) * whole.u, up = (v[j + 1] - v[j]) * whole.v;
      const int material = material_of(corner + 0.5 * along + 0.5 * up);
      if (material >= 0) add_rectangle(scene, material, corner, along, up);
    }
  }
}

struct Block {
  Eigen::Vector3d low, size;
  bool covers(const Eigen::Vector3d& p) const {
    return p.x() > low.x() && p.x() < low.x() + size.x() && p.y() > low.y() &&
           p.y() < low.y() + size.y();
  }
};

void add_block(Scene& scene, const Block& block, int cells) {
  const Eigen::Vector3d x(block.size.x(), 0, 0), y(0, block.size.y(), 0), z(0, 0, block.size.z());
  const Eigen::Vector3d& low = block.low;
  const auto cut = [&](const Rectangle& side) {
    const auto pieces = [&](const Eigen::Vector3d& edge) {
      return lines({0, 1}, static_cast<int>(std::lround(edge.norm() * cells)));
    };
    add_cut(scene, side, pieces(side.u), pieces(side.v), [](const Eigen::Vector3d&) { return 0; });
  };
  for (const Rectangle& side :
       {Rectangle{low + z, x, y}, Rectangle{low, x, z}, Rectangle{low + y, z, x},
        Rectangle{low, z, y}, Rectangle{low + x, y, z}}) {
    cut(side);
  }
}

// `scene` with one surface per material, as in files of modelling programs.
Scene one_object_each(Scene scene) {
  std::vector<Surface> joined(scene.materials.size());
  for (std::size_t m = 0; m < joined.size(); ++m) {
    joined[m] = {
        .name = scene.materials[m].name, .material = static_cast<int>(m), .shape = PolygonMesh{}};
  }
  for (const Surface& surface : scene.surfaces) {
    auto& into = std::get<PolygonMesh>(joined[surface.material].shape);
    const auto& from = std::get<PolygonMesh>(surface.shape);
    const auto first = static_cast<int>(into.vertices.size());
    into.vertices.insert(into.vertices.end(), from.vertices.begin(), from.vertices.end());
    for (Facet facet : from.facets) {
      for (int& vertex : facet.boundary) vertex += first;
      into.facets.push_back(std::move(facet));
    }
  }
  scene.surfaces = std::move(joined);
  return scene;
}

}  // namespace

Scene room_of_boxes() {
  Scene scene = grey_scene();
  const int lamp = add_lamp(scene, 100.0f);
  add_box(scene, {0, 0, 0}, {10.0, 10.0, 3.0}, true);
  add_rectangle(scene, lamp, {4.5, 4.5, 2.9}, Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitX());
  constexpr int rows = 10;
  for (int i = 0; i < rows * rows; ++i) {
    const auto key = static_cast<std::uint64_t>(i);
    const double width = 0.2 + 0.4 * random_uniform(random_key(key, 1));
    const double height = 0.3 + 1.2 * random_uniform(random_key(key, 2));
    add_box(scene, {i % rows + 0.2, i / rows + 0.2, 0.0}, {width, width, height}, false);
  }
  return scene;
}

Scene room_of_polygons(int cells, bool own_names) {
  Scene scene = grey_scene();
  const int lamp = add_lamp(scene, 10.0f);
  scene.materials[lamp].reflectance.setZero();
  const std::array<Block, 2> blocks{
      {{{0.2, 0.2, 0.0}, {0.3, 0.3, 0.6}}, {{0.6, 0.5, 0.0}, {0.3, 0.3, 0.3}}}};
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ(), origin = Eigen::Vector3d::Zero();
  const auto grey = [](const Eigen::Vector3d&) { return 0; };
  // The floor has holes below the blocks, where no light could arrive.
  add_cut(scene, {origin, x, y}, lines({0, 0.2, 0.5, 0.6, 0.9, 1}, cells),
          lines({0, 0.2, 0.5, 0.8, 1}, cells), [&](const Eigen::Vector3d& p) {
            return blocks[0].covers(p) || blocks[1].covers(p) ? -1 : 0;
          });
  const std::vector<double> of_ceiling = lines({0, 0.4, 0.6, 1}, cells),
                            of_wall = lines({0, 1}, cells);
  add_cut(scene, {z, y, x}, of_ceiling, of_ceiling, [&](const Eigen::Vector3d& p) {
    return std::abs(p.x() - 0.5) < 0.1 && std::abs(p.y() - 0.5) < 0.1 ? lamp : 0;
  });
  for (const Rectangle& wall :
       {Rectangle{origin, y, z}, Rectangle{x, z, y}, Rectangle{origin, z, x}, Rectangle{y, x, z}}) {
    add_cut(scene, wall, of_wall, of_wall, grey);
  }
  for (const Block& block : blocks) add_block(scene, block, cells);
  return own_names ? scene : one_object_each(std::move(scene));
}

}  // namespace lightwell
