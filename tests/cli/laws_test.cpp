// Furnace test and independence of the number of threads, through the built program.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "radiosity/solution/solution_file.h"
#include "tests/cli/program.h"

namespace lightwell::laws_test {
namespace {
using Words = std::vector<std::string>;

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// A closed room whose every wall emits M and reflects rho: B = E = M / (1 - rho) everywhere.
TEST(Furnace, IrradianceIsEmissionOverOneMinusReflectance) {
  TemporaryFolder folder;
  folder.write("furnace.toml", R"(
unit = "cm"
[materials.wall]
reflectance = [0.0, 0.5, 0.8]
exitance = [1, 2, 3]
[[surfaces]]
name = "room"
material = "wall"
box = { min = [0, 0, 0], max = [300, 400, 250], inward = true }
)");
  folder.write("points.csv",
               "x,y,z,nx,ny,nz\n150,200,0,0,0,1\n1,1,0,0,0,1\n0,399,249,1,0,0\n60,90,250,0,0,-1\n");
  ASSERT_EQ(
      run_lightwell(folder / "", {"solve", "furnace.toml", "-o", "S.vtp", "--max-patch-size", "50"})
          .code,
      0);
  for (const Words& how : {Words{"S.vtp", "--interpolate"}, Words{"S.vtp"}, Words{}}) {
    const Ended ended =
        run_lightwell(folder / "", Words{"probe", "furnace.toml"} + how +
                                       Words{"--points", "points.csv", "-o", "E.csv"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    std::ifstream in(folder / "E.csv");
    std::string line;
    std::getline(in, line);
    int probes = 0;
    while (std::getline(in, line)) {
      std::stringstream fields(line);
      std::vector<double> values;
      for (std::string field; std::getline(fields, field, ',');) values.push_back(std::stod(field));
      ASSERT_GE(values.size(), 10u);
      // Every ray sees the same radiance, so the estimate has no variance. The error is rounding to
      // float and the solver's tolerance of 1e-5 over 1 - rho.
      const double exact[] = {1.0, 2.0 / 0.5, 3.0 / 0.2};
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(values[6 + k] / exact[k], 1.0, 1e-4) << line;
      ++probes;
    }
    EXPECT_EQ(probes, 4);
  }
}

// The walls between two rooms of an STF file lie in one plane, with doors that reach the floor.
// Each room has the light that it has alone. A ceiling beside a lamp that faces down has reflected
// light alone, to which the wall of 7.5 m2 among 59 m2 gives a tenth.
TEST(Rooms, ThatShareAWallHaveTheLightThatEachHasAlone) {
  TemporaryFolder folder;
  const auto house = [](int rooms) {
    return "[PROJECT]\nNrRooms=" + std::to_string(rooms) +
           "\nRoom1=R1\nRoom2=R2\n"
           "[R1]\nHeight=2.5\nNrPoints=4\nPoint1=0 0\nPoint2=4 0\nPoint3=4 3\nPoint4=0 3\n"
           "NrLums=1\nLum1=L\nLum1.Pos=2 1.5 2.5\nNrFurns=1\nFurn1=door\nFurn1.Pos=4 1 0\n"
           "Furn1.Size=0.9 2.1 0\n"
           "[R2]\nHeight=3\nNrPoints=4\nPoint1=4 0\nPoint2=8 0\nPoint3=8 3\nPoint4=4 3\n"
           "NrFurns=1\nFurn1=door\nFurn1.Pos=4 2.2 0\nFurn1.Size=0.9 2.1 0\n"
           "[L]\nBox=1 1 0\nFlux=3000\n";
  };
  folder.write("points.csv", "x,y,z,nx,ny,nz\n3.5,1,2.49,0,0,-1\n1,1,2.49,0,0,-1\n");
  std::vector<std::vector<double>> lux;
  for (const int rooms : {1, 2}) {
    folder.write("house.stf", house(rooms));
    ASSERT_EQ(
        run_lightwell(folder / "", {"solve", "house.stf", "-o", "S.vtp", "--accuracy", "1%"}).code,
        0);
    ASSERT_EQ(run_lightwell(folder / "", {"probe", "house.stf", "S.vtp", "--points", "points.csv",
                                          "-o", "E.csv"})
                  .code,
              0);
    std::ifstream in(folder / "E.csv");
    std::string line;
    std::getline(in, line);
    lux.emplace_back();
    while (std::getline(in, line)) {
      std::stringstream fields(line);
      std::string field;
      constexpr int lux_column = 10;  // behind x,y,z,nx,ny,nz,E_r,E_g,E_b
      for (int column = 0; column < lux_column; ++column) std::getline(fields, field, ',');
      lux.back().push_back(std::stod(field));
    }
    ASSERT_EQ(lux.back().size(), 2u);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(lux[0][i], 10.0);
    // Two standard errors of the difference of two results with 1 % each.
    EXPECT_NEAR(lux[1][i] / lux[0][i], 1.0, 2.0 * std::sqrt(2.0) * 0.01);
  }
}

TEST(Threads, OneAndTwoGiveTheSameBits) {
  TemporaryFolder folder;
  folder.write("room.toml", small_room());
  for (const char* threads : {"1", "2"}) {
    const std::string results = std::string("threads-") + threads;
    ASSERT_EQ(run_lightwell(folder / "", Words{"run", "room.toml", "-o", results,
                                               "--max-patch-size", "0.4", "--threads", threads})
                  .code,
              0);
  }
  const SolvedScene a = read_solution(folder / "threads-1/solution.vtp"),
                    b = read_solution(folder / "threads-2/solution.vtp");
  ASSERT_EQ(a.mesh.vertex_count(), b.mesh.vertex_count());
  for (int v = 0; v < a.mesh.vertex_count(); ++v) {
    ASSERT_EQ(a.mesh.position(v), b.mesh.position(v));
  }
  EXPECT_TRUE((a.solution.patch_radiosity == b.solution.patch_radiosity).all());
  EXPECT_TRUE((a.solution.direct_irradiance == b.solution.direct_irradiance).all());
  EXPECT_TRUE((a.solution.indirect_irradiance == b.solution.indirect_irradiance).all());
  EXPECT_EQ(a.solution.residual, b.solution.residual);
  EXPECT_EQ(a.solution.error_estimate, b.solution.error_estimate);
  EXPECT_EQ(a.solution.energy.absorbed, b.solution.energy.absorbed);
  for (const char* picture : {"door.exr", "door.png"}) {
    const std::string bytes = bytes_of(folder / ("threads-1/" + std::string(picture)));
    EXPECT_FALSE(bytes.empty());
    EXPECT_TRUE(bytes == bytes_of(folder / ("threads-2/" + std::string(picture)))) << picture;
  }
}

// All ways to choose among 50 lamps give the energy of all; the report says how many a point asks.
TEST(ManyLights, AreChosenAsAskedFor) {
  TemporaryFolder folder;
  std::string scene = R"(
[materials.wall]
reflectance = 0.5
[[surfaces]]
name = "room"
material = "wall"
box = { min = [0, 0, 0], max = [20, 10, 3], inward = true }
)";
  constexpr int lamps = 50;
  for (int k = 0; k < lamps; ++k) {
    scene += "[[lamps]]\nlumens = 100\nposition = [" + std::to_string(1 + 2 * (k % 10)) + ", " +
             std::to_string(1 + 2 * (k / 10)) + ", 2.9]\n";
  }
  folder.write("hall.toml", scene);
  const auto solved = [&](const std::string& method) {
    const Ended ended =
        run_lightwell(folder / "", Words{"solve", "hall.toml", "-o", "S.vtp", "--json", "--refine",
                                         "off", "--max-patch-size", "2", "--gather-rays", "64",
                                         "--many-lights", method});
    EXPECT_EQ(ended.code, 0) << ended.err;
    return nlohmann::json::parse(ended.out);
  };
  const nlohmann::json all = solved("all");
  EXPECT_EQ(all["lights"]["count"], lamps);
  EXPECT_EQ(all["lights"]["asked"], lamps);
  for (const std::string method : {"lightcuts", "sorted", "importance"}) {
    const nlohmann::json some = solved(method);
    EXPECT_EQ(some["lights"]["count"], lamps);
    EXPECT_LE(some["lights"]["asked"].get<double>(), lamps);
    EXPECT_GE(some["lights"]["asked_most"].get<double>(), some["lights"]["asked"].get<double>());
    // Patches get the light of lamps by rays, whatever points ask; sums of floats may be in another
    // order.
    EXPECT_NEAR(some["energy"]["absorbed"].get<double>() / all["energy"]["absorbed"].get<double>(),
                1.0, 1e-5);
  }
  EXPECT_EQ(
      run_lightwell(folder / "", {"solve", "hall.toml", "-o", "S.vtp", "--many-lights", "few"})
          .code,
      2);
}

}  // namespace
}  // namespace lightwell::laws_test
