#include "scene/io/radiance/text/radiance_xform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "scene/io/numbered_names.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr int most_copies = 100'000;
constexpr int most_repetitions = 1'000'000;
constexpr std::size_t most_groups = 1000;  // groups are nested calls

// A group of transformations between two of the options -i and -a, with its repeat count.
struct Group {
  Eigen::Affine3d step = Eigen::Affine3d::Identity();
  int count = 1;
  bool is_array = false;
};

Eigen::Affine3d power(Eigen::Affine3d base, int exponent) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 == 1) result = base * result;
    base = base * base;
  }
  return result;
}

class XformParser {
 public:
  XformParser(std::span<const std::string> arguments, const RadianceLocation& location)
      : arguments_(arguments), location_(location) {}

  RadianceXform parse() {
    while (next_ < arguments_.size() && arguments_[next_].starts_with('-')) option();
    for (; next_ < arguments_.size(); ++next_) {
      if (arguments_[next_].starts_with('-')) {
        location_.fail(fmt::format("xform has the option '{}' after a file; options come first",
                                   arguments_[next_]));
      }
      result_.files.push_back(arguments_[next_]);
    }
    const std::string name = name_.empty() && copies_ > 1 ? "a" : name_;
    add_copies(0, Eigen::Affine3d::Identity(), shortened(name), name_.empty());
    return std::move(result_);
  }

 private:
  void option() {
    const std::string& option = arguments_[next_++];
    Eigen::Affine3d& step = groups_.back().step;
    if (option == "-t") {
      Eigen::Vector3d by;
      for (double& coordinate : by) coordinate = number(option);
      step = Eigen::Translation3d(by) * step;
    } else if (option == "-rx" || option == "-ry" || option == "-rz") {
      const double angle = number(option) * std::numbers::pi / 180.0;
      step = Eigen::AngleAxisd(angle, axis(option)) * step;
    } else if (option == "-mx" || option == "-my" || option == "-mz") {
      const Eigen::Vector3d sign = Eigen::Vector3d::Ones() - 2.0 * axis(option);
      step = Eigen::Scaling(sign) * step;
    } else if (option == "-s") {
      const double factor = number(option);
      if (!(factor != 0.0)) location_.fail("xform is to scale by 0 (-s); give another factor");
      step = Eigen::Scaling(factor) * step;
    } else if (option == "-i") {
      add_group({.count = std::max(0, whole(option, most_repetitions))});
    } else if (option == "-a") {
      add_array(whole(option, most_copies));
    } else if (option == "-n") {
      name_ += (name_.empty() ? "" : ".") + word(option);
    } else if (option == "-m") {
      const std::string& modifier = word(option);
      if (result_.modifier.empty()) result_.modifier = modifier;
    } else if (option == "-I") {
      result_.inverts = !result_.inverts;
    } else if (option != "-e" && option != "-c") {
      location_.fail(fmt::format(
          "xform has the option '{}', which is not read; known are -t, -rx, -ry, -rz, -s, -mx, "
          "-my, -mz, -i, -a, -n, -m, -I, -e and -c",
          option));
    }
  }

  static Eigen::Vector3d axis(const std::string& option) {
    return Eigen::Vector3d::Unit(option.back() - 'x');
  }

  const std::string& word(const std::string& option) {
    if (next_ == arguments_.size())
      location_.fail(fmt::format("xform lacks what '{}' needs", option));
    return arguments_[next_++];
  }

  double number(const std::string& option) {
    const std::string& given = word(option);
    const auto value = parse_finite(given);
    if (!value) {
      location_.fail(
          fmt::format("xform has '{}' after '{}', where a number is needed", given, option));
    }
    return *value;
  }

  int whole(const std::string& option, int most) {
    const double value = number(option);
    if (value != std::floor(value) || !(std::abs(value) <= most)) {
      location_.fail(
          fmt::format("xform has '{} {}'; a whole number up to {} is needed", option, value, most));
    }
    return static_cast<int>(value);
  }

  void add_array(int count) {
    if (count < 1) location_.fail("xform makes an array (-a) of no copies; give a positive number");
    if (count > most_copies / copies_) {
      location_.fail(fmt::format("xform makes more than {} copies (-a); make fewer", most_copies));
    }
    copies_ *= count;
    add_group({.count = count, .is_array = true});
  }

  void add_group(const Group& group) {
    if (groups_.size() > most_groups) {
      location_.fail(
          fmt::format("xform has more than {} of the options -i and -a; give fewer", most_groups));
    }
    groups_.push_back(group);
  }

  void add_copies(std::size_t group, const Eigen::Affine3d& before, const std::string& name,
                  bool is_numbered_at_once) {
    if (group == groups_.size()) return add_copy(before, name);
    const Group& g = groups_[group];
    if (!g.is_array) {
      return add_copies(group + 1, power(g.step, g.count) * before, name, is_numbered_at_once);
    }
    Eigen::Affine3d placed = before;
    for (int k = 0; k < g.count; ++k) {
      const char* dot = is_numbered_at_once ? "" : ".";  // "a0", but "desk.0"
      add_copies(group + 1, placed, fmt::format("{}{}{}", name, dot, k), false);
      placed = g.step * placed;
    }
  }

  void add_copy(const Eigen::Affine3d& to_world, const std::string& name) {
    const double determinant = to_world.linear().determinant();
    const double scale = std::cbrt(std::abs(determinant));
    if (!(scale > 0.0) || !to_world.matrix().allFinite()) {
      location_.fail("xform scales beyond the range of numbers");
    }
    result_.copies.push_back({.to_world = to_world,
                              .scale = scale,
                              .is_mirrored = determinant < 0.0,
                              .prefix = name.empty() ? "" : name + "."});
  }

  std::span<const std::string> arguments_;
  const RadianceLocation& location_;
  std::size_t next_ = 0;
  std::vector<Group> groups_ = {Group{}};
  int copies_ = 1;
  std::string name_;
  RadianceXform result_;
};

void transform(std::vector<double>& reals, std::size_t first, const Eigen::Affine3d& by) {
  if (reals.size() < first + 3) return;  // the reader of the primitive reports the fault
  Eigen::Map<Eigen::Vector3d> p(reals.data() + first);
  p = (by * p).eval();
}

void turn_reals(std::vector<double>& reals, std::size_t first, const Eigen::Matrix3d& by) {
  if (reals.size() < first + 3) return;
  Eigen::Map<Eigen::Vector3d> v(reals.data() + first);
  v = (by * v).eval();
}

void scale(std::vector<double>& reals, std::size_t first, double by) {
  for (std::size_t i = first; i < reals.size(); ++i) reals[i] *= by;
}

void transform_polygon(std::vector<double>& reals, const RadianceXform::Copy& copy, bool reverse) {
  for (std::size_t i = 0; i + 2 < reals.size(); i += 3) transform(reals, i, copy.to_world);
  if (!reverse || reals.size() % 3 != 0) return;
  const std::size_t n = reals.size() / 3;
  for (std::size_t i = 0; i < n / 2; ++i) {
    std::swap_ranges(reals.begin() + static_cast<std::ptrdiff_t>(3 * i),
                     reals.begin() + static_cast<std::ptrdiff_t>(3 * i + 3),
                     reals.begin() + static_cast<std::ptrdiff_t>(3 * (n - 1 - i)));
  }
}

std::string inverse_of(const std::string& type) {
  static const std::map<std::string, std::string> inverse = {
      {"sphere", "bubble"}, {"bubble", "sphere"}, {"cone", "cup"},
      {"cup", "cone"},      {"tube", "cylinder"}, {"cylinder", "tube"}};
  const auto found = inverse.find(type);
  return found == inverse.end() ? type : found->second;
}

// Transforms a surface by a copy; only arguments that are positions, directions or lengths change.
void place_surface(RadiancePrimitive& p, const RadianceXform::Copy& copy, bool inverts) {
  if (p.type == "polygon") {
    transform_polygon(p.reals, copy, copy.is_mirrored != inverts);
  } else if (p.type == "sphere" || p.type == "bubble") {
    transform(p.reals, 0, copy.to_world);
    scale(p.reals, 3, copy.scale);
  } else if (p.type == "ring") {
    transform(p.reals, 0, copy.to_world);
    const double side = inverts ? -1.0 : 1.0;
    turn_reals(p.reals, 3, copy.to_world.linear() * (side / copy.scale));
    scale(p.reals, 6, copy.scale);
  } else if (p.type == "source") {
    turn_reals(p.reals, 0, copy.to_world.linear());
  } else if (p.type != "instance" && p.type != "mesh") {  // cones, cups, cylinders, tubes
    transform(p.reals, 0, copy.to_world);
    transform(p.reals, 3, copy.to_world);
    scale(p.reals, 6, copy.scale);
  }
  if (inverts) p.type = inverse_of(p.type);
}

// Places what of a definition depends on coordinates: patterns and the beams of spotlights.
void place_definition(RadiancePrimitive& p, const RadianceXform::Copy& copy) {
  if (p.kind() == RadianceKind::pattern) p.frame = copy.to_world * p.frame;
  if (p.type == "spotlight") turn_reals(p.reals, 4, copy.to_world.linear() / copy.scale);
}

}  // namespace

RadianceXform parse_radiance_xform(std::span<const std::string> arguments,
                                   const RadianceLocation& location) {
  return XformParser(arguments, location).parse();
}

bool copies_turn(const RadianceXform& xform) {
  const auto turn = [](const RadianceXform::Copy& copy) {
    return Eigen::Matrix3d(copy.to_world.linear() / copy.scale);
  };
  return std::ranges::any_of(xform.copies, [&](const RadianceXform::Copy& copy) {
    return !turn(copy).isApprox(turn(xform.copies.front()), 1e-9);
  });
}

void apply_xform(const RadianceXform& xform, const RadiancePrimitive& primitive,
                 const RadianceSink& sink) {
  if (primitive.kind() != RadianceKind::surface) {
    RadiancePrimitive placed = primitive;
    place_definition(placed, xform.copies.front());
    return sink(placed);
  }
  for (const RadianceXform::Copy& copy : xform.copies) {
    RadiancePrimitive placed = primitive;
    if (!xform.modifier.empty()) placed.modifier = xform.modifier;
    placed.name = copy.prefix + placed.name;
    place_surface(placed, copy, xform.inverts);
    sink(placed);
  }
}

}  // namespace lightwell
