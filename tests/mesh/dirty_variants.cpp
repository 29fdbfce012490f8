#include "tests/mesh/dirty_variants.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "scene/io/remarks.h"
#include "tests/mesh/mesh_scenes.h"

namespace lightwell::test {
namespace {

using Eigen::Vector3d;
using Polygons = std::vector<Loop>;

constexpr int grey = 0, grey_front = 1, lamp = 2;

Loop rectangle(const Vector3d& at, const Vector3d& u, const Vector3d& v) {
  return {at, at + u, at + u + v, at + v};
}

// Six rectangles that face outwards, or inwards.
Polygons box(const Vector3d& low, const Vector3d& high, bool inward = false) {
  const Vector3d d = high - low, x(d.x(), 0, 0), y(0, d.y(), 0), z(0, 0, d.z());
  Polygons sides{rectangle(low, y, x),     rectangle(low + z, x, y), rectangle(low, x, z),
                 rectangle(low + y, z, x), rectangle(low, z, y),     rectangle(low + x, y, z)};
  for (Loop& side : sides) {
    if (inward) std::reverse(side.begin(), side.end());
  }
  return sides;
}

void append(Polygons& to, const Polygons& more) {
  to.insert(to.end(), more.begin(), more.end());
}

// A grid of triangles over the height z(x, y).
template <class Height>
Polygons height_field(const Vector3d& low, double side, int n, const Height& z) {
  Polygons field;
  const auto at = [&](int i, int j) {
    const double x = low.x() + side * i / n, y = low.y() + side * j / n;
    return Vector3d(x, y, low.z() + z(x, y));
  };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      field.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      field.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return field;
}

Polygons ball(const Vector3d& center, double radius) {
  Polygons result;
  constexpr int n = 8, rings = 4;
  const auto at = [&](int j, int i) {
    const double theta = std::numbers::pi * j / rings, phi = 2.0 * std::numbers::pi * (i % n) / n;
    return Vector3d(center + radius * Vector3d(std::sin(theta) * std::cos(phi),
                                               std::sin(theta) * std::sin(phi), std::cos(theta)));
  };
  for (int j = 0; j < rings; ++j) {
    for (int i = 0; i < n; ++i) {
      result.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  }
  return result;
}

RawModel room_with_table() {
  Polygons table = box({1.0, 1.0, 0.7}, {2.2, 1.8, 0.75});
  for (const double x : {1.05, 2.1}) {
    for (const double y : {1.05, 1.7}) append(table, box({x, y, 0.0}, {x + 0.05, y + 0.05, 0.7}));
  }
  return {{{"room", grey_front, box({0, 0, 0}, {3, 3, 2.5}, true)},
           {"lamp", lamp, {rectangle({1.2, 1.2, 2.4}, {0, 0.6, 0}, {0.6, 0, 0})}},
           {"table", grey, table},
           {"ball", grey, ball({1.5, 1.4, 0.9}, 0.15)}}};
}

RawModel fringed_cloth() {
  const auto bend = [](double x, double y) { return 0.1 * std::sin(5 * x) + 0.05 * y * y; };
  Polygons fringe;
  for (int i = 0; i < 20; ++i) {
    const Vector3d at(0.3 + 0.002 * i, 0.0, bend(0.3, 0));
    fringe.push_back({at, at + Vector3d(0.001, -0.3, 0), at + Vector3d(0.002, 0, 0.0001)});
  }
  return {{{"cloth", grey, height_field({0, 0, 0}, 1.0, 8, bend)},
           {"fringe", grey, fringe},
           {"lamp", lamp, {rectangle({0.4, 0.4, 1.0}, {0, 0.2, 0}, {0.2, 0, 0})}}}};
}

RawModel terrain_under_sheet() {
  const auto hills = [](double x, double y) { return 0.3 * std::sin(7 * x) * std::cos(6 * y); };
  return {{{"hills", grey, height_field({0, 0, 0}, 2.0, 10, hills)},
           {"water", grey_front, {rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0})}},
           {"lamp", lamp, {rectangle({0, 0, 1.5}, {0, 2, 0}, {2, 0, 0})}}}};
}

RawModel stairs() {
  Polygons steps;
  for (int i = 0; i < 6; ++i)
    append(steps, box({0.3 * i, 0, 0}, {0.3 * (i + 1), 1, 0.2 * (i + 1)}));
  Polygons rail;
  for (int i = 0; i < 6; ++i) {
    const double x = 0.3 * i + 0.15;
    append(rail, box({x - 0.01, 0.05, 0.2 * (i + 1)}, {x + 0.01, 0.07, 0.2 * (i + 1) + 0.8}));
  }
  rail.push_back({{0, 0.05, 1.0}, {1.8, 0.05, 2.2}, {1.8, 0.07, 2.2}, {0, 0.07, 1.0}});
  return {{{"stairs", grey_front, steps},
           {"rail", grey, rail},
           {"hall", grey, box({-0.5, -0.5, 0}, {2.5, 1.5, 3}, true)},
           {"lamp", lamp, {rectangle({0.5, 0.3, 2.9}, {0, 0.4, 0}, {0.4, 0, 0})}}}};
}

RawModel crossing_blocks() {
  RawModel model = raw_model(boxes_under_a_lamp(7));
  append(model.surfaces[0].polygons, ball({0.5, 0.5, 0.0}, 0.2));
  return model;
}

RawModel room_of_six_corners() {
  const double h = 2.4;
  const Loop floor{{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {2, 2, 0}, {2, 4, 0}, {0, 4, 0}};
  Loop ceiling = floor;
  for (Vector3d& p : ceiling) p.z() = h;
  std::reverse(ceiling.begin(), ceiling.end());
  Polygons walls;
  for (std::size_t i = 1; i < floor.size(); ++i) {
    const Vector3d &a = floor[i], &b = floor[(i + 1) % floor.size()], up(0, 0, h);
    walls.push_back({b, a, a + up, b + up});
  }
  // The first wall has a window, joined to its boundary by a bridge.
  walls.push_back({{4, 0, 0},
                   {0, 0, 0},
                   {0, 0, h},
                   {4, 0, h},
                   {4, 0, 0},
                   {3, 0, 1},
                   {3, 0, 2},
                   {1, 0, 2},
                   {1, 0, 1},
                   {3, 0, 1}});
  return {{{"floor", grey, {floor}},
           {"ceiling", grey, {ceiling}},
           {"walls", grey_front, walls},
           {"lamp", lamp, {rectangle({0.5, 0.5, 2.3}, {0, 0.5, 0}, {0.5, 0, 0})}}}};
}

double diagonal_of(const RawModel& model) {
  Eigen::AlignedBox3d bounds;
  for (const RawSurface& surface : model.surfaces) {
    for (const Loop& loop : surface.polygons) {
      for (const Vector3d& p : loop) bounds.extend(p);
    }
  }
  return bounds.isEmpty() ? 1.0 : std::max(bounds.diagonal().norm(), 1e-12);
}

class Spoiler {
 public:
  Spoiler(RawModel model, std::uint32_t seed)
      : model_(std::move(model)), random_(seed), size_(diagonal_of(model_)) {}

  RawModel spoil(std::string& names) {
    struct Defect {
      const char* name;
      void (Spoiler::*apply)();
    };
    constexpr std::array<Defect, 18> defects{{{"cut", &Spoiler::cut},
                                              {"snap", &Spoiler::snap},
                                              {"mirror", &Spoiler::mirror},
                                              {"scale", &Spoiler::scale},
                                              {"float", &Spoiler::round_to_float},
                                              {"jitter", &Spoiler::jitter},
                                              {"tear", &Spoiler::tear},
                                              {"double", &Spoiler::double_some},
                                              {"turn", &Spoiler::turn_some},
                                              {"slivers", &Spoiler::add_slivers},
                                              {"copy", &Spoiler::copy_into_itself},
                                              {"hang", &Spoiler::hang_corners},
                                              {"holes", &Spoiler::add_holes},
                                              {"bow ties", &Spoiler::exchange_corners},
                                              {"spikes", &Spoiler::add_spikes},
                                              {"flat", &Spoiler::add_flat},
                                              {"heap", &Spoiler::add_heap},
                                              {"stars", &Spoiler::add_stars}}};
    for (int left = 1 + random_.below(4); left > 0; --left) {
      const Defect& defect = defects[static_cast<std::size_t>(random_.below(18))];
      names += names.empty() ? "" : ", ";
      names += defect.name;
      (this->*defect.apply)();
    }
    if (random_.below(8) == 0) {
      names += ", far";
      move_far();
    }
    return std::move(model_);
  }

 private:
  template <class Change>
  void for_each_point(const Change& change) {
    for (RawSurface& surface : model_.surfaces) {
      for (Loop& loop : surface.polygons) {
        for (Vector3d& p : loop) change(p);
      }
    }
  }
  template <class Change>
  void for_some_polygons(double share, const Change& change) {
    for (RawSurface& surface : model_.surfaces) {
      const std::size_t count = surface.polygons.size();  // `change` may append
      for (std::size_t i = 0; i < count; ++i) {
        if (random_.between(0, 1) < share) change(surface.polygons, i);
      }
    }
  }
  // 10^low to 10^high.
  double power(double low, double high) { return std::pow(10.0, random_.between(low, high)); }
  Vector3d direction() {
    Vector3d d;
    do {
      d = Vector3d(random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1));
    } while (d.norm() < 0.1);
    return d.normalized();
  }
  Vector3d place() {
    const RawSurface& s = model_.surfaces[below(model_.surfaces.size())];
    if (s.polygons.empty() || s.polygons.front().empty()) return Vector3d::Zero();
    return s.polygons[below(s.polygons.size())].front();
  }
  std::size_t below(std::size_t n) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(n)));
  }

  // Sutherland & Hodgman's clipping: the part of a loop before a plane.
  static Loop clipped(const Loop& loop, const Eigen::Hyperplane<double, 3>& plane) {
    Loop part;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vector3d &a = loop[i], &b = loop[(i + 1) % loop.size()];
      const double ha = plane.signedDistance(a), hb = plane.signedDistance(b);
      if (ha >= 0.0) part.push_back(a);
      if (ha * hb < 0.0) part.push_back(a + ha / (ha - hb) * (b - a));
    }
    return part;
  }
  void cut() {
    const Eigen::Hyperplane<double, 3> plane(direction(), place() + 1e-3 * size_ * direction());
    const Eigen::Hyperplane<double, 3> back(-plane.normal(), -plane.offset());
    const bool keeps_both = random_.below(2) == 0;
    for (RawSurface& surface : model_.surfaces) {
      Polygons parts;
      for (const Loop& loop : surface.polygons) {
        for (const auto& side : {plane, back}) {
          const Loop part = clipped(loop, side);
          if (part.size() >= 3) parts.push_back(part);
          if (!keeps_both) break;
        }
      }
      surface.polygons = std::move(parts);
    }
  }
  void snap() {
    const double cell = size_ * power(-6, -1.5);
    for_each_point([&](Vector3d& p) { p = cell * (p / cell).array().round().matrix(); });
  }
  void mirror() {
    const int axis = random_.below(3);
    for_each_point([&](Vector3d& p) { p[axis] = -p[axis]; });
  }
  void scale() {
    const double by = power(-3, 3);
    for_each_point([&](Vector3d& p) { p *= by; });
    size_ *= by;
  }
  void move_far() {
    const Vector3d by = 1e6 * size_ * direction();
    for_each_point([&](Vector3d& p) { p += by; });
  }
  void round_to_float() {
    for_each_point([](Vector3d& p) { p = p.cast<float>().cast<double>(); });
  }
  // Equal points move alike.
  void jitter() {
    const double by = size_ * power(-9, -3);
    const double turn = random_.between(1, 9);
    for_each_point([&](Vector3d& p) {
      const Vector3d q = p / size_;
      for (int c = 0; c < 3; ++c) {
        p[c] += by * std::sin(1e4 * turn * (q[c] + 3.1 * q[(c + 1) % 3] + 1.7 * q[(c + 2) % 3]));
      }
    });
  }
  // Each corner moves on its own.
  void tear() {
    const double by = size_ * power(-9, -3);
    for_each_point([&](Vector3d& p) { p += random_.between(0, by) * direction(); });
  }
  void double_some() {
    const bool turned = random_.below(2) == 0;
    for_some_polygons(0.2, [&](Polygons& polygons, std::size_t i) {
      Loop copy = polygons[i];
      if (turned) std::reverse(copy.begin(), copy.end());
      polygons.push_back(copy);
    });
  }
  void turn_some() {
    for_some_polygons(0.3, [](Polygons& polygons, std::size_t i) {
      std::reverse(polygons[i].begin(), polygons[i].end());
    });
  }
  void add_slivers() {
    const double share = power(-9, -2);
    for_some_polygons(0.2, [&](Polygons& polygons, std::size_t i) {
      const Loop loop = polygons[i];
      if (loop.size() < 3) return;
      const Vector3d middle = (loop[0] + loop[1]) / 2.0;
      const Vector3d inside = middle + share * (loop[2] - middle);
      polygons.push_back({loop[0], loop[1], inside});
      if (loop.size() > 3) return;
      polygons[i] = {loop[1], loop[2], inside};
      polygons.push_back({loop[2], loop[0], inside});
    });
  }
  void copy_into_itself() {
    RawSurface copy = model_.surfaces[below(model_.surfaces.size())];
    const Eigen::AngleAxisd turn(random_.below(2) * random_.between(0, 0.3), direction());
    const Vector3d by = random_.below(3) * size_ * power(-9, -1) * direction();
    for (Loop& loop : copy.polygons) {
      for (Vector3d& p : loop) p = turn * p + by;
    }
    copy.name += " copy";
    model_.surfaces.push_back(std::move(copy));
  }
  // Cuts polygons in two between a corner and an edge, which makes a corner inside a neighbour's
  // edge.
  void hang_corners() {
    for_some_polygons(0.3, [&](Polygons& polygons, std::size_t i) {
      const Loop loop = polygons[i];
      if (loop.size() < 3) return;
      const Vector3d on = loop[0] + random_.between(0, 1) * (loop[1] - loop[0]);
      Loop rest = loop;
      rest[0] = on;
      polygons[i] = rest;
      polygons.push_back({loop[0], on, loop.back()});
    });
  }
  void add_holes() {
    for_some_polygons(0.1, [&](Polygons& polygons, std::size_t i) {
      Loop& loop = polygons[i];
      if (loop.size() < 3) return;
      const Vector3d a = loop[0], u = loop[1] - a, v = loop.back() - a;
      const double s = random_.between(0.1, 0.9), t = random_.between(0.1, 0.9);
      const Vector3d at = a + s * u + t * v;
      Loop hole{at, at + 0.2 * v, at + 0.2 * u + 0.2 * v, at + 0.2 * u, at};
      if (random_.below(3) == 0) std::reverse(hole.begin(), hole.end());
      loop.push_back(a);
      loop.insert(loop.end(), hole.begin(), hole.end());
    });
  }
  void exchange_corners() {
    for_some_polygons(0.3, [&](Polygons& polygons, std::size_t i) {
      Loop& loop = polygons[i];
      if (loop.size() < 4) return;
      const std::size_t k = below(loop.size() - 1);
      std::swap(loop[k], loop[k + 1]);
    });
  }
  void add_spikes() {
    for_some_polygons(0.3, [&](Polygons& polygons, std::size_t i) {
      Loop& loop = polygons[i];
      if (loop.empty()) return;
      const std::size_t k = below(loop.size());
      const Vector3d p = loop[k],
                     tip = p + random_.between(-1, 1) * (loop[(k + 2) % loop.size()] - p);
      Loop more{tip, p};
      if (random_.below(2) == 0) more = {p, p};
      if (random_.below(3) == 0) more = {tip};
      loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(k) + 1, more.begin(), more.end());
    });
  }
  void add_flat() {
    for_some_polygons(0.1, [&](Polygons& polygons, std::size_t i) {
      const Loop loop = polygons[i];
      if (loop.size() < 3) return;
      polygons.push_back({loop[0], loop[1], loop[0] + 0.3 * (loop[1] - loop[0])});
      polygons.push_back({loop[0], loop[0], loop[0]});
      polygons.push_back({loop[0], loop[1]});
      polygons.push_back({loop[0], loop[1], loop[2], loop[1]});
    });
  }
  void add_heap() {
    RawSurface heap{.name = "heap", .material = grey};
    const Vector3d at = place();
    const double reach = size_ * power(-3, -0.5);
    const bool is_flat = random_.below(4) == 0;
    for (int i = 5 + random_.below(20); i > 0; --i) {
      Loop loop;
      for (int k = 3 + random_.below(2); k > 0; --k) loop.push_back(at + reach * direction());
      for (Vector3d& p : loop) p.z() = is_flat ? at.z() : p.z();
      heap.polygons.push_back(loop);
    }
    model_.surfaces.push_back(std::move(heap));
  }
  void add_stars() {
    RawSurface stars{.name = "stars", .material = random_.below(2)};
    for (int i = 1 + random_.below(4); i > 0; --i) {
      const Vector3d at = place(), x = direction(), y = x.unitOrthogonal();
      const double reach = size_ * power(-3, -1);
      Loop star;
      for (int k = 5 + random_.below(12); k > 0; --k) {
        star.push_back(at + reach * (random_.between(-1, 1) * x + random_.between(-1, 1) * y));
      }
      stars.polygons.push_back(star);
    }
    model_.surfaces.push_back(std::move(stars));
  }

  RawModel model_;
  Numbers random_;
  double size_;  // metres
};

}  // namespace

RawModel furnished(int number) {
  constexpr std::array<RawModel (*)(), furnished_models> models{
      room_with_table, fringed_cloth,   terrain_under_sheet,
      stairs,          crossing_blocks, room_of_six_corners};
  return models[static_cast<std::size_t>(number)]();
}

RawModel raw_model(const Scene& scene) {
  RawModel model;
  for (const Surface& surface : scene.surfaces) {
    const auto* mesh = std::get_if<PolygonMesh>(&surface.shape);
    if (!mesh) continue;
    RawSurface& raw = model.surfaces.emplace_back();
    raw.name = surface.name;
    const Material& material = scene.materials[static_cast<std::size_t>(surface.material)];
    raw.material = material.is_emitter() ? lamp : material.one_sided ? grey_front : grey;
    for (const Facet& facet : mesh->facets) {
      Loop& loop = raw.polygons.emplace_back();
      for (const int v : facet.boundary) {
        loop.push_back(mesh->vertices[static_cast<std::size_t>(v)]);
      }
    }
  }
  return model;
}

RawModel dirty_variant(const RawModel& model, std::uint32_t seed, std::string* defects) {
  std::string names;
  RawModel variant = Spoiler(model, seed).spoil(names);
  if (defects) *defects = names;
  return variant;
}

Scene read_model(const RawModel& model) {
  Scene scene = empty_scene();
  add_lamp(scene);
  Repairs repairs;
  for (const RawSurface& surface : model.surfaces) {
    MeshBuilder mesh;
    for (const Loop& loop : surface.polygons) add_repaired(mesh, loop, repairs);
    if (mesh.empty()) continue;
    scene.surfaces.push_back(
        {.name = surface.name, .material = surface.material, .shape = mesh.mesh()});
  }
  note_repairs(repairs, scene);
  return scene;
}

}  // namespace lightwell::test
