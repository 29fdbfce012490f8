#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/temporary_folder.h"

// One small file for each kind of error, and the required parts of its message: the place
// (file:line:column), the object and the remedy.

namespace lightwell::bad_files_test {
namespace {

const std::filesystem::path folder = LIGHTWELL_TEST_DATA "/scene/bad";

struct BadFile {
  const char* name;
  std::vector<const char*> message;
};

void PrintTo(const BadFile& file, std::ostream* out) {
  *out << file.name;
}

// clang-format off
const std::vector<BadFile> bad_files = {
    {"malformed.toml", {"malformed.toml:1:", "string"}},
    {"duplicate-key.toml", {"duplicate-key.toml:2:", "title"}},
    {"unknown-key-top.toml", {"unknown-key-top.toml:1:1:", "unknown key 'unitt'", "Did you mean 'unit'?"}},
    {"unknown-key-material.toml", {"unknown-key-material.toml:2:1:", "unknown key 'reflectence' in material 'white'", "Did you mean 'reflectance'?"}},
    {"unknown-key-surface.toml", {"unknown-key-surface.toml:7:1:", "surface 'floor'", "Did you mean 'polygon'?"}},
    {"unknown-key-camera.toml", {"unknown-key-camera.toml:12:1:", "camera 'eye'", "Did you mean 'look_at'?"}},
    {"unknown-key-far.toml", {"unknown key 'zzzzzzzz'", "Known are 'title', 'unit'"}},
    {"material-singular.toml", {"material-singular.toml:1:", "Did you mean 'materials'?"}},
    {"surfaces-not-array.toml", {"surfaces-not-array.toml:4:", "write [[surfaces]]"}},
    {"no-surfaces.toml", {"no-surfaces.toml:1:1:", "no surfaces"}},
    {"empty-surfaces.toml", {"empty-surfaces.toml:1:", "is empty"}},
    {"unit-unknown.toml", {"unit-unknown.toml:1:8:", "'metre'", "'mm', 'cm', 'm', 'in' or 'ft'"}},
    {"unit-type.toml", {"unit-type.toml:1:8:", "unit must be a string, but is a whole number"}},
    {"nan.toml", {"nan.toml:2:15:", "reflectance of material 'white'", "nan", "finite"}},
    {"infinite.toml", {"infinite.toml:7:", "y of center of sphere of surface 'floor'", "finite"}},
    {"nan-coordinate.toml", {"nan-coordinate.toml:7:", "z of vertex 2 of polygon of surface 'floor'"}},
    {"string-for-number.toml", {"string-for-number.toml:2:15:", "must be a number, an array"}},
    {"two-coordinates.toml", {"two-coordinates.toml:7:", "vertex 1 of polygon of surface 'floor'", "[x, y, z]", "has 2"}},
    {"bands-both.toml", {"bands-both.toml:1:", "exactly one of 'count' and 'step'"}},
    {"bands-step.toml", {"bands-step.toml:3:8:", "step of bands", "whole number"}},
    {"bands-many.toml", {"bands-many.toml:3:9:", "97", "between 1 and 96"}},
    {"bands-reversed.toml", {"bands-reversed.toml:1:", "'to' must be greater"}},
    {"bands-range.toml", {"bands-range.toml:3:8:", "200", "between 360 and 830"}},
    {"bands-rgb-count.toml", {"bands-rgb-count.toml:2:9:", "spectral"}},
    {"bands-efficacy.toml", {"bands-efficacy.toml:2:19:", "greater than 0"}},
    {"reflectance-above-one.toml", {"reflectance-above-one.toml:2:15:", "reflectance of material 'white' is 1.2", "between 0 and 1"}},
    {"reflectance-negative.toml", {"reflectance-negative.toml:2:21:", "band 2 of reflectance", "-0.1"}},
    {"reflectance-band-count.toml", {"reflectance-band-count.toml:2:15:", "2 numbers", "3 bands"}},
    {"energy-gain.toml", {"energy-gain.toml:3:12:", "specular of material 'white'", "exceed 1", "more light would leave"}},
    {"glass-and-diffuse.toml", {"glass-and-diffuse.toml:2:15:", "contradicts 'glass'"}},
    {"glass-no-ior.toml", {"glass-no-ior.toml:2:9:", "lacks the key 'ior'"}},
    {"glass-ior-zero.toml", {"glass-ior-zero.toml:2:17:", "ior of glass", "greater than 0"}},
    {"glass-ior-huge.toml", {"glass-ior-huge.toml:2:17:", "ior of glass", "1e+09", "between 0.1 and 10"}},
    {"glass-thin-absorption.toml", {"glass-thin-absorption.toml:2:48:", "thin pane", "'tint'"}},
    {"coat-and-specular.toml", {"coat-and-specular.toml:3:12:", "contradicts 'coat'"}},
    {"coat-index.toml", {"coat-index.toml:3:8:", "is 0.5", "between 1 and 10"}},
    {"coat-roughness.toml", {"coat-roughness.toml:3:33:", "is 2", "between 0 and 1"}},
    {"coat-too-much.toml", {"coat-too-much.toml:3:8:", "0.0918", "at most 0.9082"}},
    {"coat-two-bases.toml", {"coat-two-bases.toml:3:28:", "second statement"}},
    {"roughness-alone.toml", {"roughness-alone.toml:2:13:", "'specular'"}},
    {"roughness-above-one.toml", {"roughness-above-one.toml:3:13:", "roughness of material 'white' is 2", "between 0 and 1"}},
    {"two-emissions.toml", {"two-emissions.toml:3:9:", "after 'radiance'"}},
    {"emission-negative.toml", {"emission-negative.toml:2:12:", "-1", "at least 0"}},
    {"emission-huge.toml", {"emission-huge.toml:2:12:", "too large"}},
    {"emits-nothing.toml", {"emits-nothing.toml:2:9:", "needs an emission"}},
    {"emits-behind-black.toml", {"emits-behind-black.toml:4:9:", "sides is 'one'"}},
    {"sides-unknown.toml", {"sides-unknown.toml:2:9:", "'one' or 'two'"}},
    {"spectrum-missing-file.toml", {"spectrum-missing-file.toml:2:", "nowhere.csv", "no such file"}},
    {"spectrum-missing-column.toml", {"spectrum-missing-column.toml:2:", "spectra.csv:", "no column", "Did you mean 'white'?"}},
    {"spectrum-no-column.toml", {"spectrum-no-column.toml:2:", "spectra.csv:", "say which with 'column'"}},
    {"spectrum-too-short.toml", {"spectrum-too-short.toml:8:15:", "covers 400-700 nm", "380-390"}},
    {"spectrum-not-number.toml", {"spectrum-not-number.toml:2:", "spectrum-not-number.csv:3:", "'lots'", "column 'white'"}},
    {"spectrum-not-rising.toml", {"spectrum-not-rising.toml:2:", "spectrum-not-rising.csv:3:", "must rise"}},
    {"spectrum-short-row.toml", {"spectrum-short-row.toml:2:", "spectrum-short-row.csv:2:", "2 cells", "3 columns"}},
    {"spectrum-empty.toml", {"spectrum-empty.toml:2:", "spectrum-empty.csv", "empty"}},
    {"spectrum-first-column.toml", {"spectrum-first-column.toml:2:", "spectrum-first-column.csv:1:", "'wavelength_nm'"}},
    {"spectrum-unequal.toml", {"spectrum-unequal.toml:2:", "2 numbers for 3 wavelengths"}},
    {"spectrum-in-place-falling.toml", {"spectrum-in-place-falling.toml:2:", "must rise"}},
    {"spectrum-above-one.toml", {"spectrum-above-one.toml:2:15:", "in band r", "between 0 and 1"}},
    {"spectrum-per-reflectance.toml", {"spectrum-per-reflectance.toml:2:", "unknown key 'per'"}},
    {"material-missing.toml", {"material-missing.toml:6:12:", "'whit'", "Did you mean 'white'?"}},
    {"surface-no-material.toml", {"surface-no-material.toml:4:", "surface 'floor' lacks the key 'material'"}},
    {"surface-no-shape.toml", {"surface-no-shape.toml:4:", "'polygon', 'polygons', 'box', 'sphere', 'cylinder', 'cone', 'disc' or 'mesh'"}},
    {"surface-two-shapes.toml", {"surface-two-shapes.toml:4:", "both 'polygon' and 'box'"}},
    {"surface-same-name.toml", {"surface-same-name.toml:9:", "surface 'floor'", "another"}},
    {"polygon-two-vertices.toml", {"polygon-two-vertices.toml:7:11:", "surface 'floor'", "2 vertices", "at least 3"}},
    {"polygon-no-area.toml", {"polygon-no-area.toml:4:1:", "polygon-no-area.toml:7:11:", "polygon of surface 'floor'", "no area", "no light"}},
    {"polygons-second.toml", {"polygons-second.toml:9:3:", "polygon 2 of polygons of surface 'floor'"}},
    {"hole-off-plane.toml", {"hole-off-plane.toml:7:", "not planar", "holes"}},
    {"holes-without-polygon.toml", {"holes-without-polygon.toml:8:", "belongs to 'polygon'"}},
    {"box-reversed.toml", {"box-reversed.toml:7:", "y from 2 to 1"}},
    {"sphere-radius.toml", {"sphere-radius.toml:7:", "radius of sphere of surface 'floor' is -1"}},
    {"scale-zero.toml", {"scale-zero.toml:8:9:", "greater than 0"}},
    {"mesh-toml.toml", {"mesh-toml.toml:7:8:", ".obj, .ply, .stl, .dae or .fbx"}},
    {"mesh-missing.toml", {"mesh-missing.toml:7:8:", "nowhere.obj", "no such file"}},
    {"mesh-broken.toml", {"mesh-broken.toml:7:8:", "index-too-large.obj:4:"}},
    {"mesh-no-material.toml", {"mesh-no-material.toml:6:8:", "add a 'material'"}},
    {"mesh-rgb-in-spectral.toml", {"mesh-rgb-in-spectral.toml:10:8:", "RGB material", "5 spectral bands"}},
    {"camera-no-position.toml", {"camera-no-position.toml:9:", "camera 'eye' lacks the key 'position'"}},
    {"camera-no-direction.toml", {"camera-no-direction.toml:9:", "exactly one of 'direction' and 'look_at'"}},
    {"camera-looks-at-itself.toml", {"camera-looks-at-itself.toml:12:", "own position"}},
    {"camera-zero-direction.toml", {"camera-zero-direction.toml:12:", "no length"}},
    {"camera-up-parallel.toml", {"camera-up-parallel.toml:13:6:", "up of camera 'eye'", "parallel"}},
    {"camera-default-up-parallel.toml", {"camera-default-up-parallel.toml:9:", "'up'"}},
    {"camera-focus-alone.toml", {"camera-focus-alone.toml:13:18:", "needs a lens"}},
    {"camera-two-apertures.toml", {"camera-two-apertures.toml:14:12:", "second statement of the aperture"}},
    {"camera-fov.toml", {"camera-fov.toml:13:7:", "between 0 and 180"}},
    {"camera-size.toml", {"camera-size.toml:13:", "number 2 of size", "between 1 and"}},
    {"camera-size-fraction.toml", {"camera-size-fraction.toml:13:", "whole number"}},
    {"camera-same-name.toml", {"camera-same-name.toml:14:", "camera 'eye'", "another"}},
    {"camera-name-slash.toml", {"camera-name-slash.toml:10:8:", "slash"}},
    {"index-too-large.obj", {"index-too-large.obj:4:", "vertex index 4", "3 vertices"}},
    {"index-of-int.obj", {"index-of-int.obj:4:", "vertex index 2147483648", "3 vertices"}},
    {"index-zero.obj", {"index-zero.obj:4:", "vertex index 0"}},
    {"index-negative.obj", {"index-negative.obj:4:", "vertex index -4"}},
    {"index-word.obj", {"index-word.obj:4:", "'three'"}},
    {"nan-coordinate.obj", {"nan-coordinate.obj:2:", "'nan'", "finite"}},
    {"inf-coordinate.obj", {"inf-coordinate.obj:2:", "'1e999'"}},
    {"short-vertex.obj", {"short-vertex.obj:1:", "three coordinates"}},
    {"no-polygons.obj", {"no-polygons.obj", "no polygons"}},
    {"index-too-large.ply", {"index-too-large.ply"}},
    {"nan-coordinate.ply", {"nan-coordinate.ply", "finite"}},
    {"no-end-of-header.ply", {"no-end-of-header.ply", "end_header", "cut off"}},
    {"count-too-large.ply", {"count-too-large.ply:3:", "4000000000"}},
    {"no-faces.ply", {"no-faces.ply"}},
    {"garbage.ply", {"garbage.ply", "no PLY file"}},
    {"garbage.stl", {"garbage.stl"}},
    {"unknown-format.xyz", {"unknown-format.xyz", "'.xyz'", ".toml (native), .obj, .ply and .stl"}},
};
// clang-format on

std::string message_of(const std::filesystem::path& path) {
  try {
    read_scene(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

class BadScene : public testing::TestWithParam<BadFile> {};

TEST_P(BadScene, IsRefusedWithPlaceAndRemedy) {
  const std::string message = message_of(folder / GetParam().name);
  ASSERT_FALSE(message.empty()) << "the file was read without complaint";
  for (const char* part : GetParam().message) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in:\n" << message;
  }
}
INSTANTIATE_TEST_SUITE_P(Files, BadScene, testing::ValuesIn(bad_files), [](const auto& parameter) {
  std::string name = parameter.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
  return name;
});

TEST(BadScenes, AreAllInTheTable) {
  std::set<std::string> listed;
  for (const BadFile& file : bad_files) listed.insert(file.name);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".mtl" || extension == ".csv") continue;  // files that others refer to
    EXPECT_TRUE(listed.contains(entry.path().filename().string())) << entry.path();
  }
}

TEST(BadPaths, AreNamedWithWhatIsPossible) {
  EXPECT_NE(message_of("nowhere/room.toml").find("nowhere/room.toml: there is no such file"),
            std::string::npos);
  EXPECT_NE(message_of(folder).find("this is a folder"), std::string::npos);
  EXPECT_NE(message_of("/dev/null").find("not a regular file"), std::string::npos);
  EXPECT_NE(message_of(LIGHTWELL_TEST_DATA "/scene/spectra.csv")
                .find(".toml (native), .obj, .ply and .stl"),
            std::string::npos);
}

// 218 bytes that made the PLY library allocate 8 GB: it takes the name for a count.
TEST(HostileFiles, PlyNamesThatBeginWithDigitsAreRefused) {
  const TemporaryFolder temporary;
  temporary.write("bomb.ply",
                  "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                  "property float z\nelement 200000000x 0\nproperty float a\nelement face 1\n"
                  "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
                  "3 0 1 2\n");
  EXPECT_NE(message_of(temporary / "bomb.ply").find("bomb.ply:7: the name of an element"),
            std::string::npos);
}

TEST(HostileFiles, TomlKeysOfManyPartsAreRefused) {
  const TemporaryFolder temporary;
  std::string key = "a";
  for (int i = 0; i < 30000; ++i) key += ".a";
  for (const std::string& text : {key + " = 1\n", "[" + key + "]\n"}) {
    temporary.write("deep.toml", "title = \"deep\"\n" + text);
    EXPECT_NE(message_of(temporary / "deep.toml").find("deep.toml:2: the key has more than 100"),
              std::string::npos);
  }
}

// Reading a truncated file results in a scene or in an InputError.
TEST(CutOffFiles, AreRefusedOrReadButNeverCrash) {
  const TemporaryFolder temporary;
  for (const char* name : {"everything.toml", "room.obj", "room.mtl", "cube.ply", "cube.stl"}) {
    std::ifstream stream(std::filesystem::path(LIGHTWELL_TEST_DATA) / "scene" / name);
    const std::string text(std::istreambuf_iterator<char>(stream), {});
    ASSERT_FALSE(text.empty());
    const bool is_mtl = std::string(name).ends_with(".mtl");
    const auto cut =
        temporary / (std::string("lightwell_cut") +
                     (is_mtl ? ".obj" : std::filesystem::path(name).extension().string()));
    if (is_mtl)
      std::ofstream(cut)
          << "mtllib lightwell_cut.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n";
    const auto target = is_mtl ? temporary / "lightwell_cut.mtl" : cut;
    for (std::size_t length = 0; length < text.size(); length += 13) {
      std::ofstream(target, std::ios::trunc) << text.substr(0, length);
      try {
        const Scene scene = read_scene(cut);
        EXPECT_FALSE(scene.surfaces.empty());
      } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("lightwell_cut"), std::string::npos)
            << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace lightwell::bad_files_test
