// Geometry of glTF that is packed, or stored in part: Draco, meshopt, sparse accessors.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

#include "scene/io/gltf/gltf_uri.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::gltf_compressed_test {
namespace {

using test::area_of;
using test::has_loss;
using test::mesh_of;

const std::string one_node = R"(,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";

class GltfPacked : public test::SceneFileTest {
 protected:
  static std::string text_of(const std::string& name) {
    std::ifstream file(LIGHTWELL_TEST_DATA "/scene/gltf/" + name);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  Scene read(const std::string& text) const { return read_file("it.gltf", text); }
  // The message of a file that is refused, or what is left out of the scene.
  std::string refusal(const std::string& text) const {
    std::string losses;
    const std::string message = message_of<InputError>([&] {
      for (const std::string& loss : read(text).losses) losses += loss + "\n";
    });
    return message + losses;
  }
  void expect_refusal(const std::string& text, const char* part) const {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  }
  static std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  }
};

// The files hold a grid of 4 x 4 cells over [0, 2] x [0, 1] at z = 0.5, with the normal (0.6, 0,
// 0.8) and texture coordinates over [0, 1]^2.
void expect_grid(const Scene& scene, double step, double turn) {
  const PolygonMesh& mesh = mesh_of(scene);
  EXPECT_EQ(mesh.facets.size(), 32u);
  // An edge of 2 and one of 1, each to a step.
  EXPECT_NEAR(area_of(mesh), 2.0, 3.0 * step);
  for (const Facet& facet : mesh.facets) {
    EXPECT_GT(facet_normal(mesh, facet).z(), 0.99);
    ASSERT_GE(facet.uv_map, 0);
    ASSERT_GE(facet.normal_map, 0);
    for (const int vertex : facet.boundary) {
      const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(vertex)];
      EXPECT_NEAR(p.z(), 0.5, step);
      const Eigen::Vector2d uv = mesh.uv_maps[static_cast<std::size_t>(facet.uv_map)].at(p);
      EXPECT_NEAR(uv.x(), 0.5 * p.x(), 2.0 * step);
      EXPECT_NEAR(std::abs(uv.y() - 0.5), std::abs(p.y() - 0.5), 2.0 * step);
      const Eigen::Vector3d n = mesh.normal_maps[static_cast<std::size_t>(facet.normal_map)].at(p);
      EXPECT_LT((n.normalized() - Eigen::Vector3d(0.6, 0.0, 0.8)).norm(), turn);
    }
  }
}

// 14 bits over the greatest extent, 2; normals of 14 bits are finer than that.
TEST_F(GltfPacked, DracoIsUnpacked) {
  for (const char* name : {"draco_edgebreaker.gltf", "draco_sequential.gltf"}) {
    SCOPED_TRACE(name);
    const Scene scene = read(text_of(name));
    EXPECT_TRUE(scene.losses.empty());
    expect_grid(scene, 2.0 / (1 << 14), 2e-3);
  }
}

// Positions are floats; coordinates have 15 bits, normals 8: half a step of 1/127 in two of three
// coordinates.
TEST_F(GltfPacked, MeshoptIsUnpackedWithItsFilters) {
  const Scene scene = read(text_of("meshopt.gltf"));
  EXPECT_TRUE(has_loss(scene, "without texture coordinates"));  // of the mesh by a sequence
  EXPECT_EQ(scene.losses.size(), 1u);
  expect_grid(scene, 1.0 / (1 << 14), 1.0 / 127);
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_NEAR(area_of(mesh_of(scene, 1)), 2.0, 1e-6);  // floats
}

TEST_F(GltfPacked, DamagedBytesEndInASentence) {
  const auto damage_all = [&](const std::string& text) {
    const auto begin = text.find("data:application"), end = text.find('"', begin);
    const std::string bytes = decode_data_uri(text.substr(begin, end - begin)).value();
    int refused = 0;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ (i % 2 ? 0xff : 0x11));
      std::string copy = text;
      copy.replace(begin, end - begin, "data:application/octet-stream;base64," + base64(damaged));
      refused += refusal(copy).empty() ? 0 : 1;  // nothing else is thrown
    }
    return refused;
  };
  for (const char* name : {"draco_edgebreaker.gltf", "draco_sequential.gltf"}) {
    EXPECT_GT(damage_all(text_of(name)), 10) << name;  // the head alone has as many bytes
  }
  std::string meshopt = text_of("meshopt.gltf");
  damage_all(meshopt);
  expect_refusal(replaced(text_of("draco_sequential.gltf"), "base64,RFJB", "base64,RFJC"),
                 "no triangle mesh of KHR_draco_mesh_compression");
}

TEST_F(GltfPacked, CountsAreBoundedBeforeAnythingIsUnpacked) {
  const std::string text = text_of("meshopt.gltf");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string copy = text;
    for (auto at = copy.find(from); at != std::string::npos; at = copy.find(from, at + to.size())) {
      copy.replace(at, from.size(), to);
    }
    return refusal(copy);
  };
  const auto expect = [&](const std::string& from, const std::string& to, const char* part) {
    const std::string message = changed(from, to);
    EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
  };
  expect("\"count\": 25,\n     \"mode\"", "\"count\": 9007199254740991,\n     \"mode\"",
         "more than can come of 102 bytes");
  expect("\"byteStride\": 12,\n     \"count\"", "\"byteStride\": 13,\n     \"count\"",
         "does not know");
  expect("\"mode\": \"ATTRIBUTES\"", "\"mode\": \"BOXES\"", "'BOXES', which is none");
  expect("\"mode\": \"TRIANGLES\"", "\"mode\": \"INDICES\"", "more than can come of 89 bytes");
  expect("\"mode\": \"INDICES\"", "\"mode\": \"TRIANGLES\"", "is damaged");
  expect("OCTAHEDRAL", "QUATERNION", "'QUATERNION', which elements of 4 bytes do not know");
  // The number of triangles of a Draco mesh stands in its twelfth byte and the following ones.
  const std::string draco = text_of("draco_sequential.gltf");
  const auto begin = draco.find("data:application"), end = draco.find('"', begin);
  std::string bytes = decode_data_uri(draco.substr(begin, end - begin)).value();
  ASSERT_EQ(bytes[11], 32);
  bytes.replace(11, 1, "\xff\xff\xff\x7f");  // 2^28 - 1
  std::string huge = draco;
  huge.replace(begin, end - begin, "data:application/octet-stream;base64," + base64(bytes));
  huge = replaced(huge, "\"byteLength\": 798,", "\"byteLength\": 801,");
  huge.replace(huge.rfind("\"byteLength\": 798"), 17, "\"byteLength\": 801");
  EXPECT_THROW(read(huge), LimitError);
}

// A square whose last two corners are moved by a sparse accessor: by 2 upwards.
TEST_F(GltfPacked, SparseAccessorsReplaceElements) {
  std::string text = square_gltf(one_node);
  const std::string more = bytes_of<std::uint16_t>({2, 3}) + bytes_of<float>({1, 3, 0, 0, 3, 0});
  text = replaced(text, R"(}],"bufferViews":[)",
                  R"(},{"byteLength":28,"uri":"data:application/octet-stream;base64,)" +
                      base64(more) + R"("}],"bufferViews":[)");
  text = replaced(text, R"(}],"accessors")",
                  R"(},{"buffer":1,"byteLength":4},{"buffer":1,"byteOffset":4,"byteLength":24}],)"
                  R"("accessors")");
  const std::string sparse =
      R"(,"sparse":{"count":2,"indices":{"bufferView":2,"componentType":5123},)"
      R"("values":{"bufferView":3}})";
  const std::string moved =
      replaced(text, R"("count":4,"type":"VEC3")", R"("count":4,"type":"VEC3")" + sparse);
  EXPECT_NEAR(area_of(mesh_of(read(moved))), 3.0, 1e-12);
  // Without other bytes the rest lies at 0: a triangle of the corners 0, 2 and 3 is left.
  const std::string bare = replaced(moved, R"({"bufferView":0,)", "{");
  EXPECT_NEAR(area_of(mesh_of(read(bare))), 1.5, 1e-12);
  expect_refusal(replaced(bare, R"("count":4,)", R"("count":9007199254740991,)"), "at most 100000");
  expect_refusal(replaced(moved, R"("count":2,)", R"("count":3,)"), "do not fit");
  expect_refusal(replaced(moved, R"("count":4,)", R"("count":3,)"), "index 1 is 3");
  expect_refusal(
      replaced(moved, R"("componentType":5123},"values")", R"("componentType":7},"values")"),
      "componentType that does not exist");
  expect_refusal(replaced(moved, R"("values":{"bufferView":3})", R"("values":{})"), "bufferView");
}

}  // namespace
}  // namespace lightwell::gltf_compressed_test
