#pragma once

#include <Eigen/Geometry>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/radiance_primitive.h"

namespace lightwell {

/// What an xform command does to the primitives that pass through it.
struct RadianceXform {
  /// One of the copies that an array (-a) makes.
  struct Copy {
    Eigen::Affine3d to_world = Eigen::Affine3d::Identity();
    double scale = 1.0;        ///< > 0
    bool is_mirrored = false;  ///< the determinant is negative
    std::string prefix{};      ///< of the names of surfaces, with its dot
  };
  std::vector<Copy> copies{};
  bool inverts = false;              ///< -I: fronts become backs
  std::string modifier{};            ///< -m: of all surfaces; empty: none
  std::vector<std::string> files{};  ///< what is read; nothing: what is piped in
};

/// Reads xform's arguments. Transformations apply from left to right; -i n repeats n times what
/// follows it, -a n makes n copies, the k-th (from 0) with what follows repeated k times. Throws
/// InputError naming the place, also where there are more copies or repetitions than any scene has.
RadianceXform parse_radiance_xform(std::span<const std::string> arguments,
                                   const RadianceLocation& location);

/// Gives `sink` all copies of a primitive. Materials pass once, unmoved.
void apply_xform(const RadianceXform& xform, const RadiancePrimitive& primitive,
                 const RadianceSink& sink);

}  // namespace lightwell
