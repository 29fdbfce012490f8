#include "scene/io/clean_names.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "scene/io/camera_name.h"
#include "scene/io/numbered_names.h"
#include "scene/utf8.h"

namespace lightwell {

void clean_names(Scene& scene) {
  scene.title = plain_text(scene.title);
  for (Material& material : scene.materials) material.name = plain_text(material.name);
  for (Surface& surface : scene.surfaces) surface.name = plain_text(surface.name);
  for (Lamp& lamp : scene.lamps) lamp.name = plain_text(lamp.name);
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    std::string& name = scene.cameras[i].name;
    const std::string before = name;
    name = shortened(plain_text(name), longest_camera_name);
    if (name == before) continue;
    const auto is_taken = [&] {
      return std::ranges::count(scene.cameras, name, &Camera::name) > 1;
    };
    while (name.empty() || is_taken()) name += '_';
  }
}

}  // namespace lightwell
