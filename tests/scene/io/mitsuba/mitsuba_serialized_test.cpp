// Mitsuba's .serialized files: triangles compressed by zlib.
#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::mitsuba_serialized_test {
namespace {

using test::area_of;
using test::has_loss;
using test::mesh_of;
using test::normal_of;

constexpr std::uint32_t with_normals = 0x1, with_uv = 0x2, with_colors = 0x8, as_double = 0x2000;

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  compress(reinterpret_cast<Bytef*>(result.data()), &size,
           reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()));
  result.resize(size);
  return result;
}

template <typename Number>
std::string square_data(std::uint32_t flags, Number height) {
  std::string data = bytes_of<Number>({0, 0, height, 1, 0, height, 1, 1, height, 0, 1, height});
  if (flags & with_normals) data += bytes_of<Number>({0, 0, -1, 0, 0, -1, 0, 0, -1, 0, 0, -1});
  if (flags & with_uv) data += bytes_of<Number>({0, 0, 1, 0, 1, 1, 0, 1});
  if (flags & with_colors) data += bytes_of<Number>(std::vector<Number>(12, Number(0.5)));
  return data;
}

// A mesh of the unit square at z = `height`, whose corners run counter-clockwise seen from above.
std::string square_mesh(std::uint16_t version, std::uint32_t flags, double height,
                        std::uint64_t vertices = 4,
                        const std::vector<std::uint32_t>& triangles = {0, 1, 2, 0, 2, 3}) {
  std::string data = bytes_of<std::uint32_t>({flags});
  if (version == 4) data += std::string("tile") + '\0';
  data += bytes_of<std::uint64_t>({vertices, triangles.size() / 3});
  data += flags & as_double ? square_data<double>(flags, height)
                            : square_data<float>(flags, static_cast<float>(height));
  data += bytes_of(triangles);
  return bytes_of<std::uint16_t>({0x041c, version}) + deflated(data);
}

// A file of several meshes with its table of positions.
template <typename Position>
std::string file_of(const std::vector<std::string>& meshes) {
  std::string file;
  std::vector<Position> positions;
  for (const std::string& mesh : meshes) {
    positions.push_back(static_cast<Position>(file.size()));
    file += mesh;
  }
  return file + bytes_of(positions) +
         bytes_of<std::uint32_t>({static_cast<std::uint32_t>(meshes.size())});
}

class Serialized : public test::SceneFileTest {
 protected:
  Scene read(const std::string& bytes, const std::string& shape = "") const {
    folder.write("m.serialized", bytes);
    return read_file("scene.xml",
                     "<scene version='0.5.0'><shape type='serialized'><string name='filename' "
                     "value='m.serialized'/>" +
                         shape + "</shape></scene>");
  }
  std::string error(const std::string& bytes, const std::string& shape = "") const {
    return message_of<InputError>([&] { read(bytes, shape); });
  }
};

TEST_F(Serialized, EveryMeshOfEveryVersionIsFoundByItsNumber) {
  const std::string second = "<integer name='shapeIndex' value='1'/>";
  for (const std::uint32_t flags :
       {0u, with_normals | with_uv | with_colors, as_double, as_double | with_normals | with_uv}) {
    const std::string four = file_of<std::uint64_t>(
        {square_mesh(4, flags, 1.0), square_mesh(4, flags, 2.0), square_mesh(4, flags, 3.0)});
    const std::string three =
        file_of<std::uint32_t>({square_mesh(3, flags, 1.0), square_mesh(3, flags, 2.0)});
    for (const std::string& bytes : {four, three}) {
      EXPECT_EQ(mesh_of(read(bytes)).vertices.at(0).z(), 1.0);
      const Scene scene = read(bytes, second);
      EXPECT_EQ(mesh_of(scene).vertices.at(0).z(), 2.0);
      EXPECT_NEAR(area_of(mesh_of(scene)), 1.0, 1e-12);
      EXPECT_TRUE(scene.losses.empty());
    }
  }
}

TEST_F(Serialized, NormalsTellTheFrontOfALamp) {
  const std::string lamp = "<emitter type='area'><rgb name='radiance' value='1'/></emitter>";
  EXPECT_GT(normal_of(read(file_of<std::uint64_t>({square_mesh(4, 0, 0.0)}), lamp)).z(), 0.9);
  EXPECT_LT(normal_of(read(file_of<std::uint64_t>({square_mesh(4, with_normals, 0.0)}), lamp)).z(),
            -0.9);
}

TEST_F(Serialized, WrongFilesAreNamedAndTakeNoMemory) {
  const std::string sound = file_of<std::uint64_t>({square_mesh(4, 0, 0.0)});
  EXPECT_TRUE(says(error("no mesh at all"), "begins no mesh of version 3 or 4"));
  EXPECT_TRUE(says(error("ab"), "cut off"));
  EXPECT_TRUE(says(error(sound.substr(0, 20)), "cut off"));
  EXPECT_TRUE(says(error(sound, "<integer name='shapeIndex' value='3'/>"), "mesh 3 is asked for"));
  EXPECT_TRUE(says(error(square_mesh(4, 0, 0.0, std::uint64_t{1} << 60)), "too short for"));
  EXPECT_TRUE(says(error(square_mesh(4, 0, 0.0, 4, {0, 1, 4})), "names vertex 4"));
  EXPECT_TRUE(says(error(square_mesh(4, 0, std::nan(""))), "not finite"));
  EXPECT_TRUE(says(error(square_mesh(4, 0, 0.0, 4, {0, 1, 1})), "without area"));
}

TEST_F(Serialized, DamagedFilesAreReadOrLeftOut) {
  const std::string sound =
      file_of<std::uint64_t>({square_mesh(4, with_normals, 1.0), square_mesh(4, with_uv, 2.0)});
  int read_whole = 0, refused = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    std::mt19937 random(seed);
    std::string bytes = sound;
    for (unsigned changes = 1 + random() % 3; changes > 0; --changes) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    if (seed % 5 == 0) bytes.resize(random() % bytes.size());
    const std::string message =
        error(bytes, seed % 2 ? "<integer name='shapeIndex' value='1'/>" : "");
    ++(message.empty() ? read_whole : refused);
    EXPECT_TRUE(message.empty() || says(message, "no shapes that can be read"));
  }
  EXPECT_GT(read_whole, 0);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace lightwell::mitsuba_serialized_test
