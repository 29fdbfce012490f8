#include "cli/version.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

namespace lightwell {
namespace {

struct Library {
  std::string_view name;
  std::string_view version;  // as compiled; empty if the package has none
};

constexpr std::string_view jpeg_turbo = LIGHTWELL_JPEG_TURBO;

constexpr std::array<Library, 24> libraries = {
    {{"Embree", LIGHTWELL_EMBREE},
     {"oneTBB", LIGHTWELL_TBB},
     {"CGAL", LIGHTWELL_CGAL},
     {"CDT", LIGHTWELL_CDT},
     {"OpenMesh", LIGHTWELL_OPENMESH},
     {"Eigen", LIGHTWELL_EIGEN},
     {"VTK", LIGHTWELL_VTK},
     {"OpenEXR", LIGHTWELL_OPENEXR},
     {"libpng", LIGHTWELL_PNG},
     jpeg_turbo.empty() ? Library{"libjpeg", LIGHTWELL_JPEG} : Library{"libjpeg-turbo", jpeg_turbo},
     {"assimp", LIGHTWELL_ASSIMP},
     {"Draco", LIGHTWELL_DRACO},
     {"meshoptimizer", LIGHTWELL_MESHOPTIMIZER},
     {"pugixml", LIGHTWELL_PUGIXML},
     {"muParser", LIGHTWELL_MUPARSER},
     {"GLPK", LIGHTWELL_GLPK},
     {"MPI", LIGHTWELL_MPI_VERSION},
     {"cairo", LIGHTWELL_CAIRO},
     {"Pango", LIGHTWELL_PANGO},
     {"librsvg", LIGHTWELL_LIBRSVG},
     {"toml++", LIGHTWELL_TOMLPLUSPLUS},
     {"fmt", LIGHTWELL_FMT},
     {"CLI11", LIGHTWELL_CLI11},
     {"nlohmann-json", LIGHTWELL_NLOHMANN_JSON}}};

}  // namespace

std::string version_text() {
  std::string text = "lightwell " LIGHTWELL_VERSION;
  for (const auto& [name, version] : libraries) {
    if (!version.empty()) text += fmt::format("\n{} {}", name, version);
  }
  return text;
}

Json version_json() {
  Json versions = Json::object();
  for (const auto& [name, version] : libraries) {
    if (!version.empty()) versions[std::string(name)] = version;
  }
  return {{"version", LIGHTWELL_VERSION}, {"libraries", std::move(versions)}};
}

}  // namespace lightwell
