// Parts of a scene file beside the scene itself, whose reader follows from the file's extension.
#include "scene/io/lighting_design.h"
#include "scene/io/sensor_grids.h"
#include "scene/io/text_file.h"
#include "scene/io/window_states.h"

namespace lightwell {

OperatedWindows read_windows(const Scene& scene) {
  const std::string extension = lower_extension(scene.file);
  if (extension == ".toml") return read_toml_windows(scene);
  if (extension == ".hbjson") return read_honeybee_windows(scene);
  return {};
}

LightingDesign read_lighting_design(const Scene& scene) {
  const std::string extension = lower_extension(scene.file);
  if (extension == ".toml") return read_toml_lighting(scene);
  if (extension == ".stf") return read_stf_lighting(scene);
  return {};
}

std::vector<SensorGrid> read_sensor_grids(const Scene& scene) {
  if (lower_extension(scene.file) != ".hbjson") return {};
  return read_honeybee_grids(scene.file);
}

}  // namespace lightwell
