#include "scene/io/pov/pov_transform.h"

#include "scene/degree.h"

namespace lightwell {
namespace {

Eigen::Affine3d pov_matrix(const PovNode& node, const PovItem& item) {
  const auto* array = std::get_if<std::shared_ptr<PovArray>>(&item.value);
  constexpr std::size_t count = 12;
  if (!array || (*array)->values.size() != count) {
    node.fail("has a matrix without twelve numbers");
  }
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  for (std::size_t i = 0; i < count; ++i) {
    const auto* number = std::get_if<PovVector>(&(*array)->values[i]);
    if (!number) node.fail("has a matrix without twelve numbers");
    result(static_cast<Eigen::Index>(i % 3), static_cast<Eigen::Index>(i / 3)) = number->c[0];
  }
  return result;
}

Eigen::Affine3d pov_transform_block(const PovNode& node) {
  PovCursor cursor(node);
  Eigen::Affine3d all = Eigen::Affine3d::Identity();
  bool is_inverse = false;
  while (!cursor.at_end()) {
    if (take_pov_transform(cursor, all)) continue;
    if (cursor.next().word == "inverse") is_inverse = true;
  }
  if (!is_inverse) return all;
  if (!(std::abs(all.linear().determinant()) > 0.0)) node.fail("has no inverse");
  return all.inverse();
}

Eigen::Affine3d turned(const Eigen::Vector3d& degrees) {
  const auto about = [&](Eigen::Index axis) {
    // Quarter turns are exact.
    const double angle = degrees[axis], quarter = angle / 90.0;
    const bool is_even = quarter == std::round(quarter);
    const double c = is_even ? std::round(std::cos(angle * degree)) : std::cos(angle * degree);
    const double s = is_even ? std::round(std::sin(angle * degree)) : std::sin(angle * degree);
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    const Eigen::Index a = (axis + 1) % 3, b = (axis + 2) % 3;
    turn(a, a) = turn(b, b) = c;
    turn(a, b) = -s;
    turn(b, a) = s;
    return turn;
  };
  return Eigen::Affine3d(Eigen::Matrix3d(about(2) * about(1) * about(0)));
}

}  // namespace

bool take_pov_transform(PovCursor& cursor, Eigen::Affine3d& all) {
  if (cursor.at_end()) return false;
  if (cursor.take("translate")) {
    all = Eigen::Translation3d(cursor.need_point("translation")) * all;
  } else if (cursor.take("rotate")) {
    all = turned(cursor.need_point("rotation")) * all;
  } else if (cursor.take("scale")) {
    Eigen::Vector3d factors = cursor.need_point("scale");
    for (double& factor : factors) {
      if (factor == 0.0) factor = 1.0;  // the language's rule, so that "scale x*2" works
    }
    all = Eigen::Scaling(factors) * all;
  } else if (cursor.take("matrix")) {
    if (cursor.at_end()) cursor.node().fail("has a matrix without twelve numbers");
    all = pov_matrix(cursor.node(), cursor.next()) * all;
  } else if (const PovNode* block = cursor.look()->node(); block && block->keyword == "transform") {
    cursor.next();
    all = pov_transform_block(*block) * all;
  } else {
    return false;
  }
  return true;
}

Eigen::Affine3d from_pov_axes() {
  return Eigen::Affine3d(Eigen::Scaling(1.0, 1.0, -1.0));
}

}  // namespace lightwell
