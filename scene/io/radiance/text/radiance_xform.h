#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"

namespace lightwell {

/// Effect of an xform command on the primitives of its input.
struct RadianceXform {
  /// One copy made by an array (-a).
  struct Copy {
    Eigen::Affine3d to_world = Eigen::Affine3d::Identity();
    double scale = 1.0;        ///< > 0
    bool is_mirrored = false;  ///< the determinant is negative
    std::string prefix{};      ///< prefix of the names of surfaces, with its dot
  };
  std::vector<Copy> copies{};
  bool inverts = false;              ///< -I: fronts become backs
  std::string modifier{};            ///< -m: replaces the modifier of all surfaces; empty: none
  std::vector<std::string> files{};  ///< input files; empty: the output of the previous program
};

/// Parses xform's arguments. Transformations apply from left to right. "-i n" repeats the following
/// transformations n times. "-a n" makes n copies, the k-th (from 0) with the following
/// transformations repeated k times. Throws InputError naming the place, also for more copies or
/// repetitions than the limits allow.
RadianceXform parse_radiance_xform(std::span<const std::string> arguments,
                                   const RadianceLocation& location);

/// True if the copies of an array are turned against each other.
bool copies_turn(const RadianceXform& xform);

/// Passes all copies of a primitive to `sink`. Other primitives than surfaces are passed once,
/// placed as the first copy.
void apply_xform(const RadianceXform& xform, const RadiancePrimitive& primitive,
                 const RadianceSink& sink);

}  // namespace lightwell
