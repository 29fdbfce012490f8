#include <array>

#include "tests/fuzz/target.h"

namespace lightwell::fuzz {

std::span<const Target> targets() {
  static constexpr auto all = std::to_array<Target>({
      {.name = "toml", .read = read_toml_scene, .sources = "scene/io/toml"},
      {.name = "obj", .read = read_obj_and_mtl, .sources = "scene/io/obj"},
      {.name = "gltf", .read = read_gltf_scene, .sources = "scene/io/gltf"},
      {.name = "glb", .read = read_glb_scene, .sources = "scene/io/gltf"},
      {.name = "radiance", .read = read_radiance_scene, .sources = "scene/io/radiance"},
      {.name = "rif", .read = read_radiance_project, .sources = "scene/io/radiance"},
      {.name = "mitsuba", .read = read_mitsuba_scene, .sources = "scene/io/mitsuba"},
      {.name = "serialized", .read = read_serialized, .mutate = mutate_serialized},
      {.name = "vs3", .read = read_view3d, .sources = "scene/io/vs3"},
      {.name = "ply", .read = read_ply},
      {.name = "stl", .read = read_stl},
      {.name = "ies", .read = read_ies_luminaire, .sources = "scene/io/luminaires"},
      {.name = "ldt", .read = read_ldt_luminaire},
      {.name = "png", .read = read_png_or_jpeg, .mutate = mutate_png},
      {.name = "jpeg", .read = read_png_or_jpeg},
      {.name = "exr", .read = read_exr_picture},
      {.name = "hdr", .read = read_hdr_picture},
      {.name = "spectrum", .read = read_spectrum},
      {.name = "points", .read = read_points},
      {.name = "solution",
       .read = read_solved,
       .mutate = mutate_solution,
       .sources = "radiosity/solution"},
      {.name = "checkpoint", .read = read_checkpoint, .mutate = mutate_journal},
  });
  return all;
}

}  // namespace lightwell::fuzz
