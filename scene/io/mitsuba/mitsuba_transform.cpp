#include "scene/io/mitsuba/mitsuba_transform.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/limits.h"

namespace lightwell {
namespace {

Eigen::Vector3d components(const MitsubaNode& node, double otherwise) {
  if (const std::string* value = node.attribute("value")) {
    const auto numbers = parse_numbers(node, *value);
    if (numbers.size() == 1) return Eigen::Vector3d::Constant(numbers[0]);
    if (numbers.size() != 3) node.fail(fmt::format("has {} numbers; give three", numbers.size()));
    return {numbers[0], numbers[1], numbers[2]};
  }
  Eigen::Vector3d result;
  constexpr std::array keys = {"x", "y", "z"};
  for (int c = 0; c < 3; ++c) {
    result[c] = node.attribute(keys[c]) ? node.number_attribute(keys[c]) : otherwise;
  }
  return result;
}

Eigen::Affine3d rotation(const MitsubaNode& node) {
  const Eigen::Vector3d axis = components(node, 0.0);
  if (!(axis.stableNorm() > 0.0)) node.fail("has no axis; give x, y or z");
  const double angle = node.number_attribute("angle") * std::numbers::pi / 180.0;
  return Eigen::Affine3d(Eigen::AngleAxisd(angle, axis.stableNormalized()));
}

Eigen::Vector3d vector_attribute(const MitsubaNode& node, const char* key) {
  const std::string* text = node.attribute(key);
  if (!text) node.fail(fmt::format("lacks the attribute '{}'", key));
  const auto numbers = parse_numbers(node, *text);
  if (numbers.size() != 3) {
    node.fail(fmt::format("has {} numbers in '{}'; give three", numbers.size(), key));
  }
  return {numbers[0], numbers[1], numbers[2]};
}

// Maps +z to the view direction, +y to the up direction and +x to the left.
Eigen::Affine3d look_at(const MitsubaNode& node) {
  const Eigen::Vector3d origin = vector_attribute(node, "origin");
  const Eigen::Vector3d ahead = vector_attribute(node, "target") - origin;
  if (!(ahead.stableNorm() > 0.0)) node.fail("looks at its own origin; give another target");
  const Eigen::Vector3d direction = ahead.stableNormalized();
  const Eigen::Vector3d up = node.attribute("up")            ? vector_attribute(node, "up")
                             : std::abs(direction.y()) < 0.9 ? Eigen::Vector3d::UnitY().eval()
                                                             : Eigen::Vector3d::UnitZ().eval();
  const Eigen::Vector3d left = up.stableNormalized().cross(direction);
  if (!(left.norm() > parallel_sine)) node.fail("looks along its 'up'; choose another");
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  result.linear().col(0) = left.normalized();
  result.linear().col(1) = direction.cross(left.normalized());
  result.linear().col(2) = direction;
  result.translation() = origin;
  return result;
}

Eigen::Affine3d matrix(const MitsubaNode& node) {
  const std::string* text = node.attribute("value");
  if (!text) node.fail("lacks the attribute 'value'");
  const auto numbers = parse_numbers(node, *text);
  if (numbers.size() != 16 && numbers.size() != 9) {
    node.fail(fmt::format("has {} numbers; give 16, row by row", numbers.size()));
  }
  const std::size_t columns = numbers.size() == 16 ? 4 : 3;
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      result.matrix()(static_cast<int>(r), static_cast<int>(c)) = numbers[columns * r + c];
    }
  }
  if (columns == 4 &&
      !(numbers[12] == 0.0 && numbers[13] == 0.0 && numbers[14] == 0.0 && numbers[15] == 1.0)) {
    node.fail("is no affine transformation: its last row must be 0 0 0 1");
  }
  return result;
}

Eigen::Affine3d step(const MitsubaNode& node) {
  if (node.tag == "translate") return Eigen::Affine3d(Eigen::Translation3d(components(node, 0.0)));
  if (node.tag == "scale") {
    return Eigen::Affine3d(Eigen::DiagonalMatrix<double, 3>(components(node, 1.0)));
  }
  if (node.tag == "rotate") return rotation(node);
  if (node.tag == "lookat" || node.tag == "look_at" || node.tag == "lookAt") return look_at(node);
  if (node.tag == "matrix") return matrix(node);
  node.fail("is no transformation; known are translate, rotate, scale, lookat and matrix");
}

}  // namespace

Eigen::Affine3d read_mitsuba_transform(const MitsubaNode& node) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (const MitsubaNode& child : node.children) result = step(child) * result;
  // Flattening is accepted: a rectangle scaled by 0 along its normal is a rectangle.
  if (!result.matrix().allFinite() || !(result.linear().norm() > 0.0)) {
    node.fail("shrinks everything to a point, or overflows");
  }
  return result;
}

Eigen::Affine3d read_to_world(const MitsubaNode& owner) {
  const MitsubaNode* node = owner.property("to_world");
  if (!node) return Eigen::Affine3d::Identity();
  if (node->tag == "animation") node->fail("moves; only scenes that stand still can be read");
  return read_mitsuba_transform(*node);
}

Eigen::Matrix3d read_turn(const MitsubaNode& owner) {
  Eigen::Matrix3d turn = read_to_world(owner).linear();
  const double size = std::cbrt(std::abs(turn.determinant()));
  turn /= size;
  constexpr double rounding = 1e-4;
  if (!(size > 0.0) || !(turn * turn.transpose()).isIdentity(rounding)) {
    owner.fail("has a transformation that is no rotation; a sky can only be turned");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(turn, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Vector3d read_mitsuba_point(const MitsubaNode& node) {
  return components(node, 0.0);
}

}  // namespace lightwell
