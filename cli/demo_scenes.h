#pragma once

#include <string_view>

/// Scene files that the program holds, made from those in cornell/.
namespace lightwell::demo_scenes {

extern const std::string_view cornell, cornell_mirror_block, cornell_spheres;

}  // namespace lightwell::demo_scenes
