#include <array>

#include "tests/fuzz/target.h"

namespace lightwell::fuzz {

std::span<const Target> targets() {
  static constexpr auto all = std::to_array<Target>({
      {.name = "toml", .read = read_toml_scene, .sources = "scene/io/toml"},
      {.name = "obj", .read = read_obj_and_mtl, .sources = "scene/io/obj"},
      {.name = "gltf",
       .read = [](std::string_view b) { read_scene_file("scene.gltf", b); },
       .sources = "scene/io/gltf"},
      {.name = "glb",
       .read = [](std::string_view b) { read_scene_file("scene.glb", b); },
       .sources = "scene/io/gltf"},
      {.name = "dae", .read = [](std::string_view b) { read_scene_file("scene.dae", b); }},
      {.name = "fbx", .read = [](std::string_view b) { read_scene_file("scene.fbx", b); }},
      {.name = "radiance",
       .read = [](std::string_view b) { read_scene_file("scene.rad", b); },
       .sources = "scene/io/radiance"},
      {.name = "mgf",
       .read = [](std::string_view b) { read_scene_file("scene.mgf", b); },
       .sources = "scene/io/mgf"},
      {.name = "pov",
       .read = [](std::string_view b) { read_scene_file("scene.pov", b); },
       .sources = "scene/io/pov"},
      {.name = "hbjson", .read = read_honeybee_parts, .sources = "scene/io/honeybee"},
      {.name = "stf", .read = read_stf_design, .sources = "scene/io/stf"},
      {.name = "rif",
       .read = [](std::string_view b) { read_scene_file("scene.rif", b); },
       .sources = "scene/io/radiance"},
      {.name = "mitsuba",
       .read = [](std::string_view b) { read_scene_file("scene.xml", b); },
       .sources = "scene/io/mitsuba"},
      {.name = "serialized", .read = read_serialized, .mutate = mutate_serialized},
      {.name = "epw", .read = read_epw_year, .sources = "scene/io/weather"},
      {.name = "wea", .read = read_wea_year, .sources = "scene/io/weather"},
      {.name = "vs3",
       .read = [](std::string_view b) { read_scene_file("scene.vs3", b); },
       .sources = "scene/io/vs3"},
      {.name = "ply", .read = [](std::string_view b) { read_scene_file("scene.ply", b); }},
      {.name = "stl", .read = [](std::string_view b) { read_scene_file("scene.stl", b); }},
      {.name = "ies", .read = read_ies_luminaire, .sources = "scene/io/luminaires"},
      {.name = "ldt", .read = read_ldt_luminaire},
      {.name = "tm33", .read = read_tm33_luminaire, .sources = "scene/io/luminaires"},
      {.name = "png", .read = read_png_or_jpeg, .mutate = mutate_png},
      {.name = "jpeg", .read = read_png_or_jpeg},
      {.name = "exr", .read = read_exr_picture},
      {.name = "hdr", .read = read_hdr_picture},
      {.name = "spectrum", .read = read_spectrum},
      {.name = "points", .read = read_points},
      {.name = "cues", .read = read_cue_list, .sources = "scene/io/toml"},
      {.name = "road", .read = read_road_file, .sources = "standards/road"},
      {.name = "roadsurface", .read = read_road_surface},
      {.name = "sports", .read = read_sport_table, .sources = "standards"},
      {.name = "ratings", .read = read_rating_table},
      {.name = "rooms", .read = read_room_table},
      {.name = "colours", .read = read_colours},
      {.name = "solution",
       .read = read_solved,
       .mutate = mutate_solution,
       .sources = "radiosity/solution"},
      {.name = "checkpoint", .read = read_checkpoint, .mutate = mutate_journal},
  });
  return all;
}

}  // namespace lightwell::fuzz
