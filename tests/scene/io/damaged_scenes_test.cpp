// Damaged files: a reader must return a scene or throw InputError within bounded time, and never
// crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>

#include "scene/errors.h"
#include "scene/io/read_scene.h"
#include "tests/sanitizers.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/interchange_text.h"
#include "tests/temporary_folder.h"

namespace lightwell::damaged_scenes_test {
namespace {

const std::filesystem::path folder = LIGHTWELL_TEST_DATA "/scene";

// Applies one to eight changes: a byte replaced, a range removed or doubled, a digit made large,
// the end cut off.
std::string damaged(std::string bytes, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random()) % std::max<std::size_t>(n, 1);
  };
  for (std::size_t changes = 1 + below(8); changes > 0 && !bytes.empty(); --changes) {
    const std::size_t at = below(bytes.size()),
                      length = below(std::min<std::size_t>(40, bytes.size() - at));
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 3:
        bytes.insert(at, std::string(1 + below(12), '9'));
        break;
      case 4:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      default:
        if (below(4) == 0) bytes.resize(at);
    }
  }
  return bytes;
}

void expect_answers(const TemporaryFolder& where, const std::string& name, const std::string& sound,
                    unsigned count) {
  int read = 0, refused = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    const auto path = where.write(name, damaged(sound, seed));
    const auto start = std::chrono::steady_clock::now();
    try {
      validate(read_scene(path));
      ++read;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("damaged"), std::string::npos) << error.what();
      ++refused;
    } catch (const std::exception& error) {
      ADD_FAILURE() << name << ", seed " << seed << ": " << error.what();
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    EXPECT_LT(seconds.count(), 10.0 * test::slowdown) << name << ", seed " << seed;
  }
  // Both outcomes occur, so the damage is neither too small to matter nor so large that every file
  // fails at its start.
  EXPECT_GT(read, 0) << name;
  EXPECT_GT(refused, 0) << name;
}

TEST(DamagedScenes, OfMitsubaAreReadOrRefused) {
  const TemporaryFolder where;
  expect_answers(where, "damaged.xml", content_of(folder / "mitsuba/cornell-box.xml"), 400);
}

TEST(DamagedScenes, OfRadianceAreReadOrRefused) {
  const TemporaryFolder where;
  // The file has materials, patterns, round shapes and generators.
  std::string scene;
  for (const char* part : {"mug.norm", "cornerdesk.norm", "lights", "blinds"}) {
    scene += content_of(folder / "radiance" / part);
  }
  expect_answers(where, "damaged.rad", scene, 400);
  std::filesystem::copy(folder / "radiance", where.path(),
                        std::filesystem::copy_options::recursive);
  expect_answers(where, "damaged.rif", content_of(folder / "radiance/office.rif"), 400);
}

TEST(DamagedScenes, OfGltfAreReadOrRefused) {
  const TemporaryFolder where;
  std::filesystem::copy(folder / "gltf/17_ior.bin", where / "17_ior.bin");
  expect_answers(where, "damaged.gltf", content_of(folder / "gltf/17_ior.gltf"), 400);
}

// A child process reads each file first, hence fewer files.
TEST(DamagedScenes, OfColladaAreReadOrRefused) {
  const TemporaryFolder where;
  expect_answers(where, "damaged.dae", square_dae(), 100);
}

TEST(DamagedScenes, OfFbxAreReadOrRefused) {
  const TemporaryFolder where;
  expect_answers(where, "damaged.fbx", square_fbx(), 100);
}

TEST(DamagedScenes, OfStfAreReadOrRefused) {
  const TemporaryFolder where;
  expect_answers(where, "damaged.stf",
                 "[PROJECT]\nName=House\nNrRooms=2\nRoom1=ROOM.R1\nRoom2=ROOM.R2\n"
                 "[ROOM.R1]\nName=Office\nHeight=2.5\nWorkingPlane=0.8\nNrPoints=4\nPoint1=0 0\n"
                 "Point2=4 0\nPoint3=4 3\nPoint4=0 3\nR_Ceiling=0.7\nR_Wall1=0.5\nNrLums=1\n"
                 "Lum1=LUM.A\nLum1.Pos=1 1 2.5\nLum1.Rot=0 0 90\nNrFurns=3\nFurn1=win\n"
                 "Furn1.Pos=2 3 1\nFurn1.Size=2 1 0\nFurn2=skylight\nFurn2.Pos=1 1 0\n"
                 "Furn2.Size=0.5 0.5 0\nFurn3=desk\nFurn3.Pos=1 1 0\nFurn3.Size=1.6 0.8 0.7\n"
                 "[ROOM.R2]\nHeight=2\nNrPoints=3\nPoint1=1 1\nPoint2=6 1\nPoint3=1 6\n"
                 "[LUM.A]\nBox=1 1 0\nFlux=3000\n",
                 400);
}

TEST(DamagedScenes, OfBinaryGltfAreReadOrRefused) {
  const TemporaryFolder where;
  const std::string png = content_of(folder / "two-pixels.png");
  const std::string json = square_gltf(
      R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"images":[{"uri":"data:image/png;base64,)" +
          base64(png) + R"("}],"textures":[{"source":0}],"materials":[{"emissiveFactor":[1,1,1],)" +
          R"("emissiveTexture":{"index":0}}])",
      R"(,"material":0)");
  expect_answers(where, "damaged.glb", glb(json), 400);
}

TEST(DamagedScenes, PicturesAreDecodedOrLeftOut) {
  const TemporaryFolder where;
  for (const std::string name : {"two-pixels.png", "grey.jpg"}) {
    const std::string sound = content_of(folder / name);
    int decoded = 0, refused = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
      where.write(name, damaged(sound, seed));
      const auto scene =
          where.write("scene.xml",
                      "<scene version='3.0.0'><shape type='cube'><bsdf type='diffuse'>"
                      "<texture type='bitmap' name='reflectance'><string name='filename' value='" +
                          name + "'/></texture></bsdf></shape></scene>");
      try {
        const Scene read = read_scene(scene);
        const auto is_picture = [](const std::string& loss) {
          return loss.starts_with("Pictures that cannot be read");
        };
        const auto loss = std::ranges::find_if(read.losses, is_picture);
        ++(loss == read.losses.end() ? decoded : refused);
        if (loss != read.losses.end()) {
          EXPECT_TRUE(says(*loss, name));
        }
      } catch (const std::exception& error) {
        ADD_FAILURE() << name << ", seed " << seed << ": " << error.what();
      }
    }
    EXPECT_GT(decoded, 0) << name;
    EXPECT_GT(refused, 0) << name;
  }
}

}  // namespace
}  // namespace lightwell::damaged_scenes_test
