// Generators of bodies with flat faces: genbox, genprism, genblinds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/io/convex_cut.h"
#include "scene/io/radiance/generators/radiance_generators.h"
#include "scene/io/radiance/text/radiance_text.h"

namespace lightwell {
namespace {

constexpr double right_angle = std::numbers::pi / 2.0;

// A box with bevelled or rounded edges and corners: a core box, offset outwards by `radius`.
class RoundedBox {
 public:
  RoundedBox(const Eigen::Vector3d& size, double radius, int segments, bool inward,
             GeneratedPolygons& polygons)
      : center_(0.5 * size),
        core_(center_ - Eigen::Vector3d::Constant(radius)),
        radius_(radius),
        segments_(segments),
        inward_(inward),
        polygons_(polygons) {}

  void add_all() {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) add_face(axis, side);
    }
    if (!(radius_ > 0.0)) return;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double j : {-1.0, 1.0}) {
        for (const double k : {-1.0, 1.0}) add_edge(axis, j, k);
      }
    }
    for (int corner = 0; corner < 8; ++corner) {
      add_corner({corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0});
    }
  }

 private:
  // Point of the surface at the corner with these signs, offset in the (absolute) direction.
  Eigen::Vector3d point(const Eigen::Vector3d& signs, const Eigen::Vector3d& direction) const {
    return center_ + signs.cwiseProduct(core_ + radius_ * direction);
  }

  // The body is convex, so a face points outwards if it faces away from the centre.
  void add(Loop loop) {
    const bool outward = area_vector(loop).dot(loop[0] - center_) > 0.0;
    if (outward == inward_) std::reverse(loop.begin(), loop.end());
    polygons_.add(loop);
  }

  void add_face(int axis, double side) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    Loop loop;
    for (const auto& [sj, sk] : {std::pair(-1.0, -1.0), {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
      Eigen::Vector3d signs;
      signs[axis] = side;
      signs[j] = sj;
      signs[k] = sk;
      loop.push_back(point(signs, Eigen::Vector3d::Unit(axis)));
    }
    add(std::move(loop));
  }

  void add_edge(int axis, double sj, double sk) {
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    Eigen::Vector3d signs;
    signs[j] = sj;
    signs[k] = sk;
    const auto at = [&](double end, int segment) {
      signs[axis] = end;
      Eigen::Vector3d direction = Eigen::Vector3d::Zero();
      direction[j] = std::cos(right_angle * segment / segments_);
      direction[k] = std::sin(right_angle * segment / segments_);
      return point(signs, direction);
    };
    for (int s = 0; s < segments_; ++s) {
      add({at(-1.0, s), at(1.0, s), at(1.0, s + 1), at(-1.0, s + 1)});
    }
  }

  // An eighth of a sphere in triangles; corners on its sides coincide with those of the edges.
  void add_corner(const Eigen::Vector3d& signs) {
    const auto at = [&](int i, int j) {
      const auto part = [&](int n) { return std::sin(right_angle * n / segments_); };
      const Eigen::Vector3d direction(part(i), part(j), part(segments_ - i - j));
      return point(signs, direction.normalized());
    };
    for (int i = 0; i < segments_; ++i) {
      for (int j = 0; i + j < segments_; ++j) {
        add({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < segments_) add({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
    }
  }

  Eigen::Vector3d center_, core_;
  double radius_;
  int segments_;
  bool inward_;
  GeneratedPolygons& polygons_;
};

std::vector<Eigen::Vector2d> corners_from_file(const RadianceCall& call, const std::string& name) {
  if (name == "-") call.fail("reads corners from a pipe, which is not supported; name a file");
  const TextFile file = call.open(name);
  RadianceText text(file.text(), file.path());
  std::vector<double> numbers;
  for (auto word = text.next_word(); !word.empty(); word = text.next_word()) {
    const auto value = parse_finite(word);
    if (!value) {
      text.location().fail("this is not a finite number, as the coordinates of a prism must be");
    }
    numbers.push_back(*value);
  }
  if (numbers.size() % 2 != 0) {
    call.fail(
        fmt::format("'{}' holds {} numbers; pairs of x and y are needed", name, numbers.size()));
  }
  std::vector<Eigen::Vector2d> corners;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    corners.emplace_back(numbers[i], numbers[i + 1]);
  }
  return corners;
}

std::vector<Eigen::Vector2d> prism_corners(const RadianceCall& call, std::size_t& next) {
  std::vector<Eigen::Vector2d> corners;
  if (parse_finite(call.words[3])) {
    const int count = call.count(3, "number of corners");
    next = 4;
    for (int i = 0; i < count; ++i, next += 2) {
      corners.emplace_back(call.number(next, "corner"), call.number(next + 1, "corner"));
    }
  } else {
    next = 4;
    corners = corners_from_file(call, call.words[3]);
  }
  // Checks are quadratic in the number of corners.
  constexpr std::size_t most = 2000;
  if (corners.size() < 3 || corners.size() > most) {
    call.fail(fmt::format("has {} corners; give from 3 to {}", corners.size(), most));
  }
  return corners;
}

}  // namespace

void run_genbox(const RadianceCall& call, const RadianceSink& sink) {
  call.require_words(6, "genbox material name x y z");
  Eigen::Vector3d size;
  for (int axis = 0; axis < 3; ++axis) {
    size[axis] = call.positive(static_cast<std::size_t>(axis) + 3, "length of a side");
  }
  double radius = 0.0;
  int segments = 0;
  bool inward = false, rounded = false;
  for (std::size_t i = 6; i < call.words.size(); ++i) {
    const std::string& option = call.words[i];
    if (option == "-i") {
      inward = true;
    } else if (option == "-r" || option == "-b") {
      radius = call.positive(++i, "radius or bevel");
      rounded = option == "-r";
    } else if (option == "-n") {
      segments = call.count(++i, "number of segments");
    } else if (option != "-s") {
      call.fail(
          fmt::format("the option '{}' is not read; known are -i, -r, -b, -n and -s", option));
    }
  }
  if (!(2.0 * radius <= size.minCoeff())) {
    call.fail(fmt::format("edges cannot be cut by {}, more than half of a side", radius));
  }
  // Four segments keep within 2 % of the radius; more than 16 are not visible.
  constexpr int usual = 4, most = 16;
  if (segments == 0) segments = usual;
  if (rounded) call.remarks.add("Rounded edges of boxes were read as facets", call.words[2]);
  GeneratedPolygons polygons(call, sink);
  RoundedBox(size, radius, rounded ? std::min(segments, most) : 1, inward, polygons).add_all();
}

void run_genprism(const RadianceCall& call, const RadianceSink& sink) {
  call.require_words(4, "genprism material name file -l x y z");
  std::size_t next = 0;
  const std::vector<Eigen::Vector2d> corners = prism_corners(call, next);
  Eigen::Vector3d along = Eigen::Vector3d::UnitZ();
  bool has_ends = true, is_closed = true;
  for (; next < call.words.size(); ++next) {
    const std::string& option = call.words[next];
    if (option == "-l") {
      for (double& coordinate : along) coordinate = call.number(++next, "length");
    } else if (option == "-r") {
      call.positive(++next, "radius");
      call.remarks.add("Rounded edges of prisms were left sharp", call.words[2]);
    } else if (option == "-e") {
      has_ends = !has_ends;
    } else if (option == "-c") {
      is_closed = !is_closed;
    } else {
      call.fail(fmt::format("the option '{}' is not read; known are -l, -r, -e and -c", option));
    }
  }
  if (!(along.z() != 0.0)) call.fail("the prism has no height: z of -l is 0");
  GeneratedPolygons polygons(call, sink);
  Loop bottom, top;
  for (const Eigen::Vector2d& p : corners) bottom.emplace_back(p.x(), p.y(), 0.0);
  for (const Eigen::Vector3d& p : bottom) top.push_back(p + along);
  if (has_ends) {
    polygons.add(bottom);
    polygons.add(Loop(top.rbegin(), top.rend()));
  }
  const std::size_t sides = is_closed ? corners.size() : corners.size() - 1;
  for (std::size_t i = 0; i < sides; ++i) {
    const std::size_t j = (i + 1) % corners.size();
    polygons.add({bottom[i], top[i], top[j], bottom[j]});
  }
}

void run_genblinds(const RadianceCall& call, const RadianceSink& sink) {
  call.require_words(8, "genblinds material name depth width height slats angle");
  const double depth = call.positive(3, "depth"), width = call.positive(4, "width");
  const double height = call.positive(5, "height");
  const int slats = call.count(6, "number of slats");
  const double angle = call.number(7, "angle") * std::numbers::pi / 180.0;
  double bulge = 0.0;  // radius of a curved slat; > 0: bulges upwards
  if (call.words.size() > 8) {
    const std::string& option = call.words[8];
    if (option != "-r" && option != "+r") {
      call.fail(fmt::format("the option '{}' is not read; known are -r and +r", option));
    }
    const double radius = call.number(9, "radius");
    bulge = option == "+r" ? radius : -radius;
    if (bulge != 0.0 && !(depth <= 2.0 * std::abs(bulge))) {
      call.fail(fmt::format("a slat of depth {} cannot be curved with radius {}", depth, radius));
    }
  }
  // The cross-section of a slat: a chord of length `depth`, or facets along its arc. Facets span 3
  // degrees, as in RADIANCE.
  const double half = bulge != 0.0 ? std::asin(depth / (2.0 * std::abs(bulge))) : 0.0;
  constexpr double rounding = 1e-9;
  const int facets =
      bulge != 0.0 ? static_cast<int>(std::ceil(half * 120.0 / std::numbers::pi - rounding)) : 1;
  call.account(static_cast<std::int64_t>(slats) * facets);
  const auto across = [&](int i) -> Eigen::Vector3d {
    const double turn = half * (2.0 * i / facets - 1.0);
    const double along =
        bulge != 0.0 ? std::abs(bulge) * (std::sin(turn) + std::sin(half)) : depth * i;
    const double up = bulge * (std::cos(turn) - std::cos(half));
    return {along * std::cos(angle) - up * std::sin(angle), 0.0,
            along * std::sin(angle) + up * std::cos(angle)};
  };
  GeneratedPolygons polygons(call, sink);
  const Eigen::Vector3d to_side(0.0, width, 0.0);
  for (int slat = 0; slat < slats; ++slat) {
    const Eigen::Vector3d center(0.0, 0.0, height * (slat + 0.5) / slats);
    for (int i = 0; i < facets; ++i) {
      const Eigen::Vector3d a = center + across(i), b = center + across(i + 1);
      polygons.add({a, a + to_side, b + to_side, b});
    }
  }
}

}  // namespace lightwell
