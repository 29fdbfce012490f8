#include "scene/io/camera_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace lightwell {

std::string camera_name(std::string name, const Scene& scene) {
  std::ranges::replace_if(
      name, [](char c) { return c == '/' || c == '\\' || c == '\0'; }, '_');
  const auto is_taken = [&] {
    return std::ranges::find(scene.cameras, name, &Camera::name) != scene.cameras.end();
  };
  // File systems end names at 255 bytes, endings included.
  constexpr std::size_t longest = 200;
  if (name.empty() || name.starts_with('.') || name.size() > longest || is_taken()) {
    name = fmt::format("camera{}", scene.cameras.size() + 1);
  }
  while (is_taken()) name += '_';
  return name;
}

}  // namespace lightwell
