#include "scene/io/toml/toml_motions.h"

#include <fmt/format.h>

#include <cmath>

#include "scene/io/nearest_name.h"
#include "scene/io/remarks.h"
#include "scene/place_at_rest.h"

namespace lightwell {
namespace {

MotionKey read_key(const TomlValue& value, double metres_per_unit) {
  const TomlTable table = value.table({"time", "degrees", "translate"});
  MotionKey key{.time = table.require("time").number()};
  if (const auto degrees = table.find("degrees")) key.degrees = degrees->number();
  if (const auto translate = table.find("translate")) {
    key.translation = metres_per_unit * translate->vector();
  }
  return key;
}

RigidMotion read_motion(const TomlValue& value, const std::string& name, double metres_per_unit) {
  const TomlTable table = value.table({"pivot", "axis", "keys"});
  RigidMotion motion{.name = name};
  if (const auto pivot = table.find("pivot")) motion.pivot = metres_per_unit * pivot->vector();
  if (const auto axis = table.find("axis")) {
    motion.axis = axis->vector();
    if (!(motion.axis.stableNorm() > 0.0)) axis->fail("has no length; give the axis to turn about");
    motion.axis = motion.axis.stableNormalized();
  }
  const TomlValue keys = table.require("keys");
  for (const TomlValue& key : keys.elements("key")) {
    motion.keys.push_back(read_key(key, metres_per_unit));
  }
  if (const std::string what = fault(motion); !what.empty()) value.fail(what);
  return motion;
}

}  // namespace

std::vector<RigidMotion> read_toml_motions(const TomlValue& value, double metres_per_unit) {
  std::vector<RigidMotion> motions;
  for (const auto& [name, motion] : value.members("motion")) {
    motions.push_back(read_motion(motion, name, metres_per_unit));
  }
  return motions;
}

int find_toml_motion(const TomlValue& value, const Scene& scene) {
  const std::string name = value.name();
  std::vector<std::string> known;
  for (const RigidMotion& motion : scene.motions) {
    if (motion.name == name) return static_cast<int>(&motion - scene.motions.data());
    known.push_back(motion.name);
  }
  value.fail(fmt::format("is '{}', which is not among the motions of this file.{}", name,
                         did_you_mean(name, known)));
}

void read_toml_shutter(const TomlValue& value, Camera& camera) {
  const auto times = value.elements("time");
  if (times.size() != 2) value.fail("must be two times [open, close] in seconds");
  camera.shutter_open = times[0].number();
  camera.shutter_close = times[1].number();
  if (!(camera.shutter_open <= camera.shutter_close)) {
    value.fail(fmt::format("opens at {:g} s and closes at {:g} s, before it has opened",
                           camera.shutter_open, camera.shutter_close));
  }
}

void settle_toml_motions(const TomlTable& document, const std::vector<char>& have_shutter,
                         Scene& scene) {
  if (scene.motions.empty()) return;
  const Camera* first = nullptr;
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    const Camera& camera = scene.cameras[c];
    if (!have_shutter[c]) continue;
    if (!first) first = &camera;
    if (camera.shutter_middle() == first->shutter_middle()) continue;
    document.fail(fmt::format(
        "the shutters of cameras '{}' and '{}' have their middles at {:g} s and {:g} s; light is "
        "solved for one instant, so give them the same, or each a file of its own",
        first->name, camera.name, first->shutter_middle(), camera.shutter_middle()));
  }
  const double instant = first ? first->shutter_middle() : 0.0;
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    if (have_shutter[c]) continue;
    scene.cameras[c].shutter_open = scene.cameras[c].shutter_close = instant;
  }
  place_at_rest(scene, instant);
  Remarks moving;
  for (const Surface& surface : scene.surfaces) {
    if (surface.motion < 0) continue;
    moving.add(fmt::format("Surfaces move; light is solved for where they are at {:g} s{}", instant,
                           first ? ", the middle of the shutter" : ""),
               surface.name);
  }
  for (const std::string& note : moving.sentences()) scene.notes.push_back(note);
}

}  // namespace lightwell
