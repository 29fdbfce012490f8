#include "bench/random_rooms.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "bench/grey_scene.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A sequence of random numbers.
class Numbers {
 public:
  explicit Numbers(std::uint64_t key) : key_(key) {}
  double next() { return random_uniform(random_key(key_, count_++)); }
  double between(double low, double high) { return low + (high - low) * next(); }
  double log_between(double low, double high) { return low * std::pow(high / low, next()); }
  int count(int low, int high) { return low + static_cast<int>(next() * (high - low + 1)); }

 private:
  std::uint64_t key_, count_ = 0;
};

// A box at its place; `from` turns and moves a box about the origin's corner.
struct PlacedBox {
  Isometry3d from = Isometry3d::Identity();
  Vector3d size = Vector3d::Ones();

  bool covers(const Vector3d& p) const {
    const Vector3d q = from.inverse() * p;
    return (q.array() > 0.0).all() && (q.array() < size.array()).all();
  }
};

struct Face {
  Vector3d corner, u, v;
  Vector3d normal() const { return u.cross(v).normalized(); }
  double area() const { return u.cross(v).norm(); }
};

std::array<Face, 6> faces_of(const PlacedBox& box, bool inwards) {
  std::array<Face, 6> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      Vector3d corner = Vector3d::Zero(), u = corner, v = corner;
      corner[axis] = side * box.size[axis];
      u[(axis + 1) % 3] = box.size[(axis + 1) % 3];
      v[(axis + 2) % 3] = box.size[(axis + 2) % 3];
      if ((side == 0) != inwards) std::swap(u, v);
      faces[2 * axis + side] = {box.from * corner, box.from.linear() * u, box.from.linear() * v};
    }
  }
  return faces;
}

// A region of a face in which places of a gap are drawn.
struct GapFace {
  Face face;
  double width;
};

class RoomBuilder {
 public:
  explicit RoomBuilder(std::uint64_t key) : numbers(key) {
    room_.scene = grey_scene();
    room_.scene.materials.clear();
  }

  int material(double reflectance, double exitance = 0.0) {
    Scene& scene = room_.scene;
    Material m;
    m.name = fmt::format("material {}", scene.materials.size());
    m.reflectance = constant_spectrum(scene.bands, static_cast<float>(reflectance));
    m.specular = constant_spectrum(scene.bands, 0.0f);
    m.emission = constant_spectrum(scene.bands, static_cast<float>(exitance));
    m.one_sided = true;
    scene.materials.push_back(m);
    return static_cast<int>(scene.materials.size()) - 1;
  }

  void add(const PlacedBox& box, int material) {
    for (const Face& face : faces_of(box, false)) add_face(face, material);
    boxes_.push_back(box);
  }

  // Adds the walls, floor and ceiling; `material_of` is called for each.
  template <class MaterialOf>
  void add_room(const Vector3d& size, MaterialOf material_of) {
    whole_ = {.size = size};
    for (const Face& face : faces_of(whole_, true)) add_face(face, material_of());
  }

  // A face that emits carries no places.
  void add_face(const Face& face, int material) {
    add_rectangle(room_.scene, material, face.corner, face.u, face.v);
    const Material& m = room_.scene.materials[static_cast<std::size_t>(material)];
    if (!m.is_emitter()) faces_.push_back(face);
  }

  // The part of both faces of a gap between the parallel faces `small` and `large`, where `small`
  // lies before `large` at distance `width`.
  void add_gap(const Face& small, double width) {
    gaps_.push_back({small, width});
    const Vector3d step = width * small.normal();
    gaps_.push_back({{small.corner + step, small.v, small.u}, width});
  }

  RandomRoom finish(int places, double in_gaps) {
    const int gap_places = gaps_.empty() ? 0 : static_cast<int>(in_gaps * places);
    for (int i = 0; i < gap_places;) {
      const GapFace& gap =
          gaps_[static_cast<std::size_t>(numbers.count(0, static_cast<int>(gaps_.size()) - 1))];
      if (auto place = draw(gap.face)) {
        place->gap = gap.width;
        room_.places.push_back(*place);
        ++i;
      }
    }
    double total = 0.0;
    for (const Face& face : faces_) total += face.area();
    while (static_cast<int>(room_.places.size()) < places) {
      const Face* face =
          &faces_[static_cast<std::size_t>(numbers.count(0, static_cast<int>(faces_.size()) - 1))];
      if (room_.places.size() % 2 == 0) {
        double at = numbers.between(0.0, total);
        for (const Face& f : faces_) {
          face = &f;
          if ((at -= f.area()) < 0.0) break;
        }
      }
      if (const auto place = draw(*face)) room_.places.push_back(*place);
    }
    turn();
    return std::move(room_);
  }

  Numbers numbers;

 private:
  std::optional<RoomPlace> draw(const Face& face) {
    constexpr double margin = 0.002;
    const Vector3d p = face.corner + numbers.between(margin, 1 - margin) * face.u +
                       numbers.between(margin, 1 - margin) * face.v;
    const Vector3d n = face.normal();
    // A point beneath a box, or within one, is covered.
    const Vector3d above = p + 1e-5 * (face.u.norm() + face.v.norm()) * n;
    for (const PlacedBox& box : boxes_) {
      if (box.covers(above)) return std::nullopt;
    }
    if (!whole_.covers(above)) return std::nullopt;
    return RoomPlace{.position = p, .normal = n};
  }

  // Turns the whole room at random.
  void turn() {
    const Eigen::Quaterniond q = Eigen::Quaterniond(numbers.between(-1, 1), numbers.between(-1, 1),
                                                    numbers.between(-1, 1), numbers.between(-1, 1))
                                     .normalized();
    const Vector3d shift(numbers.between(-1, 1), numbers.between(-1, 1), numbers.between(-1, 1));
    for (Surface& surface : room_.scene.surfaces) {
      for (Vector3d& v : std::get<PolygonMesh>(surface.shape).vertices) v = q * v + shift;
    }
    for (RoomPlace& place : room_.places) {
      place.position = q * place.position + shift;
      place.normal = q * place.normal;
    }
  }

  RandomRoom room_{};
  PlacedBox whole_{};
  std::vector<PlacedBox> boxes_{};
  std::vector<Face> faces_{};
  std::vector<GapFace> gaps_{};
};

PlacedBox box_at(const Vector3d& low, const Vector3d& size, double turn = 0.0) {
  PlacedBox box{.size = size};
  box.from = Eigen::Translation3d(low + 0.5 * size) * Eigen::AngleAxisd(turn, Vector3d::UnitZ()) *
             Eigen::Translation3d(-0.5 * size);
  return box;
}

void add_lamp(RoomBuilder& room, const Vector3d& size) {
  Numbers& n = room.numbers;
  const double a = n.between(0.05, 0.3) * size.x(), b = n.between(0.05, 0.3) * size.y();
  const Vector3d corner(n.between(0.05 * size.x(), 0.95 * size.x() - a),
                        n.between(0.05 * size.y(), 0.95 * size.y() - b),
                        n.between(0.9, 0.99) * size.z());
  room.add_face({corner, b * Vector3d::UnitY(), a * Vector3d::UnitX()},
                room.material(0.0, n.log_between(20.0, 200.0)));
}

}  // namespace

RandomRoom random_room(std::uint64_t number, int places) {
  RoomBuilder room(random_key(number, 0x400));
  Numbers& n = room.numbers;
  const double scale = n.log_between(0.1, 30.0);
  const Vector3d size =
      scale * Vector3d(n.between(0.4, 1.0), n.between(0.4, 1.0), n.between(0.25, 0.8));
  room.add_room(size, [&] { return room.material(n.between(0.1, 0.85)); });
  for (int lamps = n.count(1, 3); lamps > 0; --lamps) add_lamp(room, size);
  for (int boxes = n.count(2, 8); boxes > 0; --boxes) {
    const Vector3d s(n.between(0.04, 0.3) * size.x(), n.between(0.04, 0.3) * size.y(),
                     n.between(0.05, 0.6) * size.z());
    const double reach = 0.5 * std::hypot(s.x(), s.y());
    const bool floats = n.next() < 0.3;
    const Vector3d low(n.between(reach, size.x() - reach) - 0.5 * s.x(),
                       n.between(reach, size.y() - reach) - 0.5 * s.y(),
                       floats ? n.between(0.1, 0.8) * (0.85 * size.z() - s.z()) : 0.0);
    room.add(box_at(low, s, n.between(0.0, std::numbers::pi)), room.material(n.between(0.1, 0.85)));
  }
  return room.finish(places, 0.0);
}

RandomRoom gap_room(std::uint64_t number, int places) {
  RoomBuilder room(random_key(number, 0x9a9));
  Numbers& n = room.numbers;
  const Vector3d size(n.between(3.0, 5.0), n.between(2.5, 4.0), n.between(2.4, 3.0));
  const int walls = room.material(n.between(0.4, 0.8));
  room.add_room(size, [&] { return walls; });
  for (int lamps = n.count(1, 2); lamps > 0; --lamps) add_lamp(room, size);
  const auto grey = [&] { return room.material(n.between(0.2, 0.8)); };
  const auto width = [&] { return n.log_between(2e-4, 1e-2); };

  // A desk of a board on two legs, 1 mm to 10 mm before the wall.
  const double behind = width(), top = 0.74;
  const Vector3d desk_low(n.between(0.2, 0.5), behind, top - 0.03);
  const Vector3d board(n.between(1.2, 1.8), 0.8, 0.03);
  room.add(box_at(desk_low, board), grey());
  const auto on_desk = [&](const Vector3d& foot, double x, double y) {
    const double gap = width();
    const Vector3d low = desk_low + Vector3d(x, y, board.z() + gap);
    const PlacedBox box = box_at(low, foot, n.between(-0.5, 0.5));
    room.add(box, grey());
    room.add_gap(faces_of(box, false)[4], gap);
  };
  on_desk({n.between(0.2, 0.45), n.between(0.15, 0.3), 0.02}, 0.3, 0.2);
  on_desk({0.2, 0.15, 0.03}, board.x() - 0.3, 0.3);

  // A cupboard before the wall opposite, and a box beside it.
  const double back = width(), beside = width();
  const Vector3d cupboard(n.between(0.6, 1.0), 0.4, n.between(1.0, 1.8));
  const double x = n.between(0.2, size.x() - cupboard.x() - 0.7);
  const PlacedBox tall = box_at({x, size.y() - back - cupboard.y(), 0.0}, cupboard);
  room.add(tall, grey());
  room.add_gap(faces_of(tall, false)[3], back);
  const Vector3d crate(0.4, 0.35, 0.5);
  const PlacedBox low =
      box_at({x + cupboard.x() + beside, size.y() - 0.02 - crate.y(), 0.0}, crate);
  room.add(low, grey());
  room.add_gap(faces_of(low, false)[0], beside);

  // A crate above the floor.
  const double under = width();
  const PlacedBox floats =
      box_at({n.between(0.8, 1.5), n.between(1.2, 1.5), under},
             {n.between(0.3, 0.6), n.between(0.3, 0.6), 0.4}, n.between(0.0, 1.5));
  room.add(floats, grey());
  room.add_gap(faces_of(floats, false)[4], under);
  return room.finish(places, 0.5);
}

}  // namespace lightwell
