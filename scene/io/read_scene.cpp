#include "scene/io/read_scene.h"

#include <fmt/format.h>

#include "scene/errors.h"
#include "scene/io/clean_names.h"
#include "scene/io/round_facets.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

Scene read_any(const std::filesystem::path& path) {
  require_readable(path);
  const std::string extension = lower_extension(path);
  if (extension == ".toml") return read_toml(path);
  if (extension == ".obj") return read_obj(path);
  if (extension == ".ply" || extension == ".stl") return read_geometry(path);
  if (extension == ".vs3") return read_vs3(path);
  if (extension == ".xml") return read_mitsuba(path);
  if (extension == ".gltf" || extension == ".glb") return read_gltf(path);
  if (extension == ".dae" || extension == ".fbx") return read_interchange(path);
  if (extension == ".rad" || extension == ".rif") return read_radiance(path);
  if (extension == ".mgf") return read_mgf(path);
  if (extension == ".pov" || extension == ".inc") return read_pov(path);
  if (extension == ".hbjson") return read_honeybee(path);
  if (extension == ".stf") return read_stf(path);
  if (extension == ".oct") {
    throw InputError(
        fmt::format("{}: an octree is compiled from RADIANCE's scene files; read those: a .rad, or "
                    "a .rif that names several",
                    path.string()));
  }
  throw InputError(
      fmt::format("{}: the extension '{}' is of no known scene format; readable are "
                  ".toml (native), .obj, .ply and .stl, .gltf and .glb, .dae (COLLADA), .fbx, "
                  "Mitsuba's .xml, RADIANCE's .rad and .rif, .mgf, POV-Ray's .pov and .inc, "
                  "Honeybee's .hbjson, DIALux's .stf, and View3D's .vs3",
                  path.string(), extension));
}

}  // namespace

Scene read_scene(const std::filesystem::path& path, References references) {
  const FilesRead read =
      references == References::inside_folder ? FilesRead::inside_folder_of(path) : FilesRead();
  Scene scene = read_any(path);
  scene.files = read.files();
  clean_names(scene);
  replace_by_facets(scene);
  return scene;
}

}  // namespace lightwell
