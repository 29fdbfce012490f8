#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "scene/io/mitsuba/mitsuba_camera.h"
#include "scene/io/mitsuba/mitsuba_lamp.h"
#include "scene/io/mitsuba/mitsuba_shapes.h"
#include "scene/io/mitsuba/mitsuba_sky.h"
#include "scene/io/mitsuba/mitsuba_tree.h"
#include "scene/io/read_scene.h"
#include "scene/io/remarks.h"

namespace lightwell {
namespace {

constexpr std::array used_where_they_are_named = {"bsdf",    "texture",  "film",  "sampler",
                                                  "rfilter", "spectrum", "alias", "path"};

void read_element(const MitsubaNode& node, const MitsubaTree& tree, MitsubaShapes& shapes,
                  Scene& scene, Remarks& remarks) {
  const std::string_view tag = node.tag;
  if (tag == "shape") return shapes.add(node);
  if (tag == "sensor" || tag == "camera") return add_mitsuba_camera(node, tree, scene, remarks);
  if (tag == "emitter" || tag == "luminaire") {
    if (add_mitsuba_sky(node, tree, scene, remarks)) return;
    MitsubaColors colors(tree, remarks);
    if (add_mitsuba_lamp(node, colors, scene)) return;
    remarks.add(fmt::format("Emitters of the plugin '{}' give no light here", node.type),
                node.label());
  } else if (tag == "integrator") {
    remarks.mention("Integrators have no meaning here and were passed over", node.type);
  } else if (std::ranges::find(used_where_they_are_named, tag) == used_where_they_are_named.end()) {
    remarks.add("Elements that have no effect", fmt::format("<{} type=\"{}\">", tag, node.type));
  }
}

}  // namespace

Scene read_mitsuba(const std::filesystem::path& path) {
  const MitsubaTree tree(path);
  Scene scene{.file = path, .title = path.stem().string(), .relative_units = true};
  scene.notes.emplace_back(
      "Mitsuba files name no units: lengths were read as metres, radiance as relative.");
  Remarks remarks;
  MitsubaShapes shapes(tree, scene, remarks);
  for (const MitsubaGap& gap : tree.gaps()) remarks.add_unusable(gap.what, gap.name, gap.why);
  for (const MitsubaNode& node : tree.root().children) {
    remarks.attempt(fmt::format("<{}> elements that cannot be used were left out", node.tag),
                    node.label(), [&] { read_element(node, tree, shapes, scene, remarks); });
  }
  if (scene.surfaces.empty()) {
    fail_without_surfaces(path,
                          tree.root().children.empty()
                              ? "the scene has no shapes that can be read; it is empty"
                              : "the scene has no shapes that can be read",
                          remarks);
  }
  finish_scene(shapes.repairs(), remarks, scene);
  return scene;
}

}  // namespace lightwell
