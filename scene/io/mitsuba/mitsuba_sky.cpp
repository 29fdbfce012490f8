#include "scene/io/mitsuba/mitsuba_sky.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "scene/errors.h"
#include "scene/io/directional_light.h"
#include "scene/io/mitsuba/mitsuba_sunsky.h"
#include "scene/io/mitsuba/mitsuba_transform.h"
#include "scene/io/pictures/environment_file.h"

namespace lightwell {
namespace {

// The scene's sky; created black if neither a sky nor a sun has been read before.
Sky& sky_of(Scene& scene) {
  if (!scene.sky) scene.sky = dark_sky(scene.bands);
  return *scene.sky;
}

bool scene_has_dome(const Scene& scene) {
  return scene.sky && (scene.sky->kind == SkyKind::map || (scene.sky->scale > 0.0f).any());
}

void add_map(const MitsubaNode& emitter, const MitsubaTree& tree, Sky& sky) {
  const std::string name = emitter.string_or("filename", "");
  if (name.empty()) emitter.fail("names no file; give a <string name=\"filename\">");
  const auto path = tree.file_named(emitter, name);
  try {
    sky.map = read_environment_map(path);
  } catch (const LimitError&) {
    throw;
  } catch (const InputError& error) {
    emitter.fail(fmt::format("cannot be used: {}", error.what()));
  }
  sky.to_map = read_turn(emitter).transpose();
  sky.kind = SkyKind::map;
  sky.name = fmt::format("map '{}', {} x {}", path.filename().string(), sky.map->width(),
                         sky.map->height());
  sky.scale.setConstant(static_cast<float>(emitter.number_or("scale", 1.0)));
  if (!(sky.scale >= 0.0f).all()) emitter.fail("has a scale below 0");
}

void add_directional(const MitsubaNode& emitter, MitsubaColors& colors, Scene& scene,
                     Remarks& remarks) {
  const MitsubaNode* along = emitter.property("direction");
  const Eigen::Affine3d to_world = read_to_world(emitter);
  const Eigen::Vector3d way =
      to_world.linear() * (along ? read_mitsuba_point(*along) : Eigen::Vector3d::UnitZ());
  if (!(way.stableNorm() > 0.0)) emitter.fail("has a direction without length");
  add_directional_light(-way, colors.positive_or(emitter, "irradiance", 1.0f), emitter.label(),
                        scene, remarks);
}

// Adds the parts of the emitter.
void add_parts(const MitsubaNode& emitter, const MitsubaTree& tree, const SkyParts& parts,
               Scene& scene, Remarks& remarks) {
  MitsubaColors colors(tree, remarks);
  if (emitter.type == "directional") return add_directional(emitter, colors, scene, remarks);
  Sky& sky = sky_of(scene);
  const SkyParts clear = clear_day_parts(emitter);
  if (clear.dome || clear.sun) {
    set_clear_day(emitter, tree, colors, remarks, parts, sky);
  } else if (emitter.type == "envmap") {
    add_map(emitter, tree, sky);
  } else {
    sky.name = "uniform all around";
    sky.scale = sky.ground = colors.positive_or(emitter, "radiance", 1.0f);
  }
}

SkyParts parts_of(const MitsubaNode& emitter) {
  SkyParts parts = clear_day_parts(emitter);
  if (emitter.type == "constant" || emitter.type == "envmap") parts.dome = true;
  if (emitter.type == "directional") parts.sun = true;
  return parts;
}

}  // namespace

bool add_mitsuba_sky(const MitsubaNode& emitter, const MitsubaTree& tree, Scene& scene,
                     Remarks& remarks) {
  SkyParts parts = parts_of(emitter);
  if (!parts.dome && !parts.sun) return false;
  const auto leave_second = [&](bool& part, bool is_there, const char* what) {
    if (!part || !is_there) return;
    part = false;
    remarks.add(fmt::format("A scene has one {} here; further ones were left out", what),
                emitter.label());
  };
  leave_second(parts.dome, scene_has_dome(scene), "sky");
  leave_second(parts.sun, scene.sky && scene.sky->sun, "sun");
  if (!parts.dome && !parts.sun) return true;
  const std::optional<Sky> before = scene.sky;
  try {
    add_parts(emitter, tree, parts, scene, remarks);
  } catch (const InputError&) {
    scene.sky = before;
    throw;
  }
  return true;
}

}  // namespace lightwell
