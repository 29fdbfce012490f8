#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "raytrace/readings/probe.h"
#include "scene/errors.h"
#include "tests/temporary_folder.h"

namespace lightwell::probe_file_test {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class ReadProbes : public ::testing::Test {
 protected:
  std::vector<Probe> read(const std::string& text, double metres_per_unit = 1.0) const {
    return read_probes(folder_.write("p.csv", text), metres_per_unit);
  }
  std::string refusal(const std::string& text) const {
    return message_of<InputError>([&] { read(text); });
  }
  TemporaryFolder folder_;
};

TEST_F(ReadProbes, ColumnsInAnyOrderCommentsAndOtherColumns) {
  const auto probes = read(
      "# two points\r\n"
      "name, nz ,ny,nx,z,y,x\r\n"
      "\r\n"
      "desk,1,0,0,3,2,1\r\n"
      "# between\n"
      "wall, 0, -2.5e0, 0, +6, 5, -4.5\n");
  ASSERT_EQ(probes.size(), 2u);
  EXPECT_EQ(probes[0].position, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(probes[0].normal, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(probes[1].position, Eigen::Vector3d(-4.5, 5, 6));
  EXPECT_EQ(probes[1].normal, Eigen::Vector3d(0, -1, 0));
}

TEST_F(ReadProbes, PositionsBecomeMetresAndNormalsUnitLength) {
  const auto probes = read("x,y,z,nx,ny,nz\n1000,2000,500,3,0,4\n", 1e-3);
  EXPECT_LT((probes[0].position - Eigen::Vector3d(1, 2, 0.5)).norm(), 1e-15);
  EXPECT_LT((probes[0].normal - Eigen::Vector3d(0.6, 0, 0.8)).norm(), 1e-15);
}

// RADIANCE's rtrace reads such points.
TEST_F(ReadProbes, SixNumbersALineNeedNoNames) {
  for (const char* text :
       {"1 2 -3e-1 0 0\t1\n\n  4 5 6 0 1 0 \r\n", "1,2,-0.3,0,0,1\n4, 5, 6, 0, 1, 0"}) {
    const auto probes = read(text);
    ASSERT_EQ(probes.size(), 2u) << text;
    EXPECT_EQ(probes[0].position, Eigen::Vector3d(1, 2, -0.3));
    EXPECT_EQ(probes[1].normal, Eigen::Vector3d(0, 1, 0));
  }
  EXPECT_TRUE(says(refusal("1 2 3\n"), "p.csv:1: has 3 values"));
  EXPECT_TRUE(says(refusal("1 2 3 0 0 1\n1 2 3 0 0 up\n"), "p.csv:2: nz is 'up'"));
}

TEST_F(ReadProbes, ErrorsNameFileLineAndValue) {
  const std::string header = "x,y,z,nx,ny,nz\n";
  EXPECT_TRUE(says(refusal("x,y,z,nx,ny\n"), "p.csv:1: no column is named 'nz'"));
  EXPECT_TRUE(says(refusal("x,y,z,nx,ny,nz,x\n"), "p.csv:1: two columns are named 'x'"));
  EXPECT_TRUE(says(refusal(header + "0,0,0,0,0,1\n0,0,zero,0,0,1\n"), "p.csv:3: z is 'zero'"));
  EXPECT_TRUE(says(refusal(header + "0,0,0,0,0\n"), "p.csv:2: has 5 values"));
  EXPECT_TRUE(says(refusal(header + "0,nan,0,0,0,1\n"), "p.csv:2: y is 'nan'"));
  EXPECT_TRUE(says(refusal(header + "0,0,0,inf,0,1\n"), "p.csv:2: nx is 'inf'"));
  EXPECT_TRUE(says(refusal(header + "1e999,0,0,0,0,1\n"), "p.csv:2: x is '1e999'"));
  EXPECT_TRUE(says(refusal(header + "1.5m,0,0,0,0,1\n"), "p.csv:2: x is '1.5m'"));
  EXPECT_TRUE(says(refusal(header + ",0,0,0,0,1\n"), "p.csv:2: x is ''"));
  EXPECT_TRUE(says(refusal(header + "0,0,0,0,0,0\n"), "p.csv:2: the normal"));
  EXPECT_TRUE(says(refusal(header), "p.csv: has no probes"));
  EXPECT_TRUE(says(refusal("# nothing\n"), "p.csv: is empty"));
}

TEST_F(ReadProbes, MissingFileIsNamed) {
  EXPECT_TRUE(
      says(message_of<InputError>([&] { read_probes(folder_ / "no.csv", 1.0); }), "no.csv"));
}

TEST(WriteProbes, WritesFileUnitsBandsAndLux) {
  const TemporaryFolder folder;
  const std::vector<Probe> probes = {{.position = {0.278, 0.0, 0.1}, .normal = {0, 1, 0}}};
  BandArray E(1, 3);
  E << 0.5f, 0.25f, 2.0f;
  write_probes(folder / "e.csv", probes, E, rgb_bands(), 1e-3);
  // lux = 683 (0.2126729 0.5 + 0.7151522 0.25 + 0.0721750 2), sums in float.
  const std::string text = text_of(folder / "e.csv");
  EXPECT_TRUE(says(text, "x,y,z,nx,ny,nz,E_r,E_g,E_b,lux\n278,0,100,0,1,0,0.5,0.25,2,293.3"));
  EXPECT_EQ(folder.file_count(), 1);
}

TEST(WriteProbes, NineDigitsKeepEveryFloat) {
  const TemporaryFolder folder;
  const std::vector<Probe> probes(200);
  BandArray E(200, 3);
  for (Eigen::Index i = 0; i < E.size(); ++i) {
    E.data()[i] = std::nextafter(0.1f * static_cast<float>(i + 1), 1e9f);
  }
  write_probes(folder / "e.csv", probes, E, rgb_bands(), 1.0);
  std::ifstream stream(folder / "e.csv");
  std::string line, cell;
  std::getline(stream, line);
  for (int i = 0; i < 200; ++i) {
    std::getline(stream, line);
    std::istringstream cells(line);
    for (int c = 0; c < 6; ++c) std::getline(cells, cell, ',');
    for (int k = 0; k < 3; ++k) {
      std::getline(cells, cell, ',');
      EXPECT_EQ(std::stof(cell), E(i, k));
    }
  }
}

TEST(WriteProbes, FailureNamesTheFile) {
  const TemporaryFolder folder;
  const std::vector<Probe> probes(1);
  const auto path = folder / "no" / "e.csv";
  EXPECT_TRUE(says(message_of<std::runtime_error>([&] {
                     write_probes(path, probes, BandArray::Zero(1, 3), rgb_bands(), 1.0);
                   }),
                   path.string()));
}

}  // namespace
}  // namespace lightwell::probe_file_test
