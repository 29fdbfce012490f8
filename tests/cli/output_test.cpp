// Files, standard output and JSON, as scripts read them.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "raytrace/pictures/image.h"
#include "tests/cli/program.h"

namespace lightwell::output_test {
namespace {
using Words = std::vector<std::string>;

class Output : public CommandTest {
 protected:
  void SetUp() override { folder.write("room.toml", small_room()); }
};

void expect_solution_keys(const nlohmann::json& json) {
  for (const char* key :
       {"patches", "elements", "cleaned", "notes", "seconds", "peak_memory_mb", "energy",
        "error_estimate", "residual", "outcome", "version", "threads", "files"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  const auto& energy = json["energy"];
  EXPECT_NEAR(energy["emitted"].get<double>(), 12.0 + 10.0 + 8.0, 30.0 * 1e-5);  // float areas
  EXPECT_NEAR(energy["absorbed"].get<double>() + energy["escaped"].get<double>() +
                  energy["unshot"].get<double>(),
              30.0, 30.0 * 1e-4);
  EXPECT_EQ(json["outcome"], "converged");
  EXPECT_GT(json["seconds"]["total"].get<double>(), 0.0);
}

TEST_F(Output, SolvePrintsOneJsonObject) {
  const auto json = run_json(Words{"solve", "room.toml", "-o", "S.vtp"} + quick());
  expect_solution_keys(json);
  EXPECT_EQ(json["files"], nlohmann::json::array({"S.vtp"}));
  EXPECT_TRUE(std::filesystem::exists(folder / "S.vtp"));
}

TEST_F(Output, SolveTellsHowItRefined) {
  const Words asked{"solve", "room.toml",      "-o", "S.vtp", "--refine",
                    "2 %",   "--max-elements", "900"};
  const auto json = run_json(asked + quick());
  const auto& refinement = json["refinement"];
  EXPECT_NE(refinement["outcome"], "off");
  EXPECT_DOUBLE_EQ(refinement["tolerance"].get<double>(), 0.02);  // the 2 % of --refine
  EXPECT_EQ(refinement["elements"], json["elements"]);
  EXPECT_LE(refinement["elements"].get<int>(), 900);
  EXPECT_TRUE(says(json["options"], "--refine 2% --max-elements 900 "));
  EXPECT_TRUE(says(json["refined"], "elements became"));
  const auto off =
      run_json(Words{"solve", "room.toml", "-o", "S.vtp", "--refine", "off"} + quick());
  EXPECT_EQ(off["refinement"]["outcome"], "off");
  EXPECT_FALSE(off.contains("refined"));
}

TEST_F(Output, FewerElementsThanThereAreIsAnError) {
  const Ended ended =
      run(Words{"solve", "room.toml", "-o", "S.vtp", "--max-elements", "1"} + quick());
  EXPECT_EQ(ended.code, 3);
  EXPECT_TRUE(says(ended.err, "error: at most 1 elements are allowed")) << ended.err;
  EXPECT_TRUE(says(ended.err, "larger patch size"));
  EXPECT_FALSE(std::filesystem::exists(folder / "S.vtp"));
}

TEST_F(Output, RunLeavesSolutionPicturesAndReport) {
  const Ended ended = run(Words{"run", "room.toml", "-o", "made/results"} + quick());
  ASSERT_EQ(ended.code, 0) << ended.err;
  for (const char* name : {"solution.vtp", "door.exr", "door.png", "report.json"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "made/results" / name)) << name;
  }
  std::ifstream in(folder / "made/results/report.json");
  expect_solution_keys(nlohmann::json::parse(in));
  EXPECT_EQ(read_exr(folder / "made/results/door.exr").width, 48);
  EXPECT_TRUE(says(ended.out, "30 W emitted"));
}

TEST_F(Output, SolveSaysFromWhereItLooked) {
  folder.write("desk.csv", "x,y,z,nx,ny,nz\n2,1.5,0.75,0,0,1\n");
  const Words solve{"solve", "room.toml", "-o", "S.vtp", "--accuracy", "20%"};
  for (const char* name : {"door", "desk.csv"}) {
    const auto json = run_json(solve + Words{"--look-from", name});
    EXPECT_EQ(json["looked_from"], nlohmann::json::array({name}));
    EXPECT_TRUE(says(json["options"].get<std::string>(), std::string(" --look-from ") + name));
    EXPECT_LE(json["error_estimate"].get<double>(), 0.2);
  }
  // The solution's file keeps the names, and whoever reads it is told them.
  const auto render =
      run_json({"render", "room.toml", "S.vtp", "-o", "door.png", "--size", "16x12"});
  EXPECT_EQ(render["looked_from"], nlohmann::json::array({"desk.csv"}));
  EXPECT_FALSE(run_json(solve).contains("looked_from"));
  EXPECT_FALSE(run_json(solve + Words{"--look-from", "everywhere"}).contains("looked_from"));
}

TEST_F(Output, RunWithAnAccuracyLooksFromItsCameras) {
  const auto json = run_json({"run", "room.toml", "--accuracy", "20%", "--size", "16x12"});
  EXPECT_EQ(json["looked_from"], nlohmann::json::array({"door"}));
}

TEST_F(Output, RunWithoutAFolderTakesTheScenesName) {
  ASSERT_EQ(run(Words{"run", "room.toml", "--quiet"} + quick()).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "room-output/door.png"));
}

TEST_F(Output, QuietSaysNothing) {
  const Ended ended = run(Words{"solve", "room.toml", "-o", "S.vtp", "--quiet"} + quick());
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.out + ended.err, "");
}

TEST_F(Output, RenderTakesSizeAndSeveralFiles) {
  ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "S.vtp"} + quick()).code, 0);
  const auto json = run_json({"render", "room.toml", "S.vtp", "--size", "20x10", "--pass",
                              "interpolate", "-o", "a.exr", "-o", "a.png"});
  EXPECT_EQ(json["files"], nlohmann::json::array({"a.exr", "a.png"}));
  const Image image = read_exr(folder / "a.exr");
  EXPECT_EQ(image.width, 20);
  EXPECT_EQ(image.height, 10);

  const auto difference = run_json({"compare", "a.exr", "a.exr", "-o", "d.png"});
  EXPECT_EQ(difference["rmse"].get<double>(), 0.0);
  EXPECT_TRUE(std::filesystem::exists(folder / "d.png"));
}

TEST_F(Output, ProbeWritesIrradianceAndLux) {
  ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "S.vtp"} + quick()).code, 0);
  folder.write("points.csv", "x,y,z,nx,ny,nz\n2,1.5,0,0,0,1\n1.5,1,0,0,0,1\n");
  for (const Words& how :
       {Words{}, Words{"--interpolate"}, Words{"--rays", "64"}, Words{"--accuracy", "5%"}}) {
    const auto json = run_json(
        Words{"probe", "room.toml", "S.vtp", "--points", "points.csv", "-o", "E.csv"} + how);
    EXPECT_EQ(json["points"], 2);
    std::ifstream in(folder / "E.csv");
    std::string header, first;
    std::getline(in, header);
    std::getline(in, first);
    EXPECT_EQ(header, "x,y,z,nx,ny,nz,E_r,E_g,E_b,lux,lux_within");
    EXPECT_EQ(first.rfind("2,1.5,0,0,0,1,", 0), 0u) << first;
  }
}

TEST_F(Output, ProbeSolvesWhatItHasNoSolutionOf) {
  folder.write("points.csv", "x,y,z,nx,ny,nz\n2,1.5,0,0,0,1\n1.5,1,0,0,0,1\n");
  const auto json = run_json({"probe", "room.toml", "--points", "points.csv", "-o", "E.csv"});
  EXPECT_EQ(json["points"], 2);
  EXPECT_NEAR(json["energy"]["emitted"].get<double>(), 30.0, 1e-4);
  EXPECT_FALSE(json.contains("error_estimate"));  // the solve made no estimate
  EXPECT_EQ(json["files"], nlohmann::json::array({"E.csv"}));
}

TEST_F(Output, InfoTellsPowerInWattsAndLumens) {
  const auto json = run_json({"info", "room.toml"});
  ASSERT_EQ(json["emitters"].size(), 1u);
  // Three bands of floats near 10 round by 5e-7 each, and their products with the area as well.
  EXPECT_NEAR(json["emitters"][0]["watts_radiated"].get<double>(), 30.0, 1e-5);
  // Rec. 709 luminance of (12, 10, 8) W at 683 lm/W.
  const double lumens = 683.0 * (0.2126 * 12 + 0.7152 * 10 + 0.0722 * 8);
  EXPECT_NEAR(json["emitters"][0]["lumens"].get<double>(), lumens, 1e-3 * lumens);
  EXPECT_EQ(json["bounds"][1][0], 4.0);
}

TEST_F(Output, InfoCallsNothingLuxWhereTheFileNamesNoUnit) {
  folder.write("box.xml", R"(<scene version="3.0.0"><shape type="cube" id="lamp">
      <transform name="to_world"><scale value="0.5"/></transform>
      <emitter type="area"><rgb name="radiance" value="1, 2, 3"/></emitter></shape></scene>)");
  const auto json = run_json({"info", "box.xml"});
  EXPECT_EQ(json["light"], "relative");
  ASSERT_EQ(json["emitters"].size(), 1u);
  const auto& lamp = json["emitters"][0];
  EXPECT_FALSE(lamp.contains("lumens") || lamp.contains("watts_radiated"));
  EXPECT_NEAR(lamp["area"].get<double>(), 6.0, 1e-12);
  EXPECT_NEAR(lamp["power"].get<double>(), 6.0 * 6.0 * 3.14159265, 1e-4);  // float exitance
  EXPECT_EQ(json["quality"]["triangles"], 12);
  EXPECT_EQ(json["quality"]["open_edges"], 0);
  EXPECT_EQ(json["notes"].size(), 2u);  // no units, no BSDF
}

TEST_F(Output, NothingSaysWattsWhereTheFileNamesNoUnit) {
  folder.write("box.xml", R"(<scene version="3.0.0"><shape type="cube">
      <emitter type="area"/></shape><sensor type="perspective"><transform name="to_world">
      <lookat origin="0,0,5" target="0,0,0"/></transform><film type="hdrfilm">
      <integer name="width" value="8"/><integer name="height" value="8"/></film></sensor></scene>)");
  folder.write("room.toml", small_room());
  for (const auto& [scene, light, unit] :
       {std::array{"box.xml", "relative", "relative radiance per band"},
        std::array{"room.toml", "watts", "W/(m^2 sr) per band"}}) {
    const auto solved = run_json(Words{"solve", scene, "-o", "S.vtp"} + quick());
    EXPECT_EQ(solved["light"], light);
    EXPECT_EQ(solved["notes"], run_json({"info", scene})["notes"]);
    EXPECT_EQ(run_json({"info", "S.vtp"})["light"], light);
    run_json({"render", scene, "S.vtp", "--size", "8x8", "-o", "P.exr", "-o", "P.png"});
    for (const char* picture : {"P.exr", "P.png"}) {
      EXPECT_NE(content_of(folder / picture).find(unit), std::string::npos)
          << picture << " of " << scene;
    }
  }
}

TEST_F(Output, InfoTellsHowASolutionWasMade) {
  ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "S.vtp"} + quick()).code, 0);
  const auto json = run_json({"info", "S.vtp"});
  EXPECT_TRUE(says(json["options"], "--max-patch-size 1 "));
  EXPECT_TRUE(says(json["options"], "--rays 64 "));
  EXPECT_EQ(json["scene"], "room.toml");
  EXPECT_FALSE(json["version"].get<std::string>().empty());
}

TEST_F(Output, HelpAndVersionEverywhere) {
  for (const Words& command :
       {Words{}, Words{"run"}, Words{"solve"}, Words{"mesh"}, Words{"relight"}, Words{"render"},
        Words{"probe"}, Words{"view"}, Words{"compare"}, Words{"info"}, Words{"validate"}}) {
    const Ended help = run(command + Words{"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_EQ(help.err, "");
    const std::string example = command.empty() ? "lightwell" : "Example: lightwell " + command[0];
    EXPECT_TRUE(says(help.out, example));
    // Help fits the lines of a maximised terminal.
    EXPECT_LE(std::count(help.out.begin(), help.out.end(), '\n'), 48) << help.out;
    EXPECT_TRUE(says(run(command + Words{"--version"}).out, "lightwell "));
  }
}

// Every line after the first is "NAME VERSION", and --json has the same names and versions.
TEST_F(Output, VersionNamesTheLibraries) {
  const Ended ended = run({"--version"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.err, "");
  std::istringstream lines(ended.out);
  std::string program, version;
  ASSERT_TRUE(lines >> program >> version);
  EXPECT_EQ(program, "lightwell");
  EXPECT_EQ(ended.out.find('\n'), program.size() + 1 + version.size());
  auto libraries = nlohmann::json::object();
  for (std::string name, number; lines >> name >> number;) {
    EXPECT_TRUE(std::isdigit(static_cast<unsigned char>(number[0]))) << name << " " << number;
    libraries[name] = number;
  }
  for (const char* name : {"Embree", "oneTBB", "Eigen", "OpenEXR", "fmt"}) {
    EXPECT_TRUE(libraries.contains(name)) << name;
  }
  EXPECT_NE(libraries.contains("CGAL"), libraries.contains("CDT")) << "one library triangulates";
#ifdef LIGHTWELL_VIEWER
  EXPECT_TRUE(libraries.contains("VTK"));
#endif
  EXPECT_EQ(static_cast<std::size_t>(std::count(ended.out.begin(), ended.out.end(), '\n')),
            libraries.size() + 1);
  for (const Words& words : {Words{"--version", "--json"}, Words{"--json", "--version"},
                             Words{"--json", "solve", "--version"}}) {
    const Ended as_json = run(words);
    EXPECT_EQ(as_json.code, 0) << as_json.err;
    const auto json = nlohmann::json::parse(as_json.out);
    EXPECT_EQ(json["version"], version);
    EXPECT_EQ(json["libraries"], libraries);
  }
}

TEST_F(Output, NoArgumentsShowRecipes) {
  const Ended ended = run({});
  EXPECT_EQ(ended.code, 0);
  EXPECT_TRUE(says(ended.out, "lightwell run"));
}

TEST_F(Output, SaysWhichSolverFoundIt) {
  double absorbed = 0.0;
  for (const std::string solver : {"auto", "jacobi", "southwell", "gmres"}) {
    const auto json =
        run_json(Words{"solve", "room.toml", "-o", "S.vtp", "--solver", solver} + quick());
    EXPECT_EQ(json["solver"], solver == "auto" ? "cg" : solver);
    EXPECT_EQ(json["outcome"], "converged");
    EXPECT_GT(json["sweeps"], 1);
    EXPECT_NE(json["options"].get<std::string>().find("--solver " + solver), std::string::npos);
    const double now = json["energy"]["absorbed"];
    // The error of each radiosity, and so of each irradiance, is at most 1e-5 of the largest, the
    // lamp's 12 W/m^2. The room's 59 m^2 absorb 0.3, 0.5 and 0.7 of irradiance in the three bands,
    // the panel's 2 m^2 all of it. The absorbed power of two solvers, 30 W each, differs by at most
    // the sum of both errors.
    constexpr double apart = 2.0 * 1e-5 * 12.0 * (59.0 * 1.5 + 2.0 * 3.0) / 30.0;
    if (absorbed > 0.0) {
      EXPECT_NEAR(now / absorbed, 1.0, apart) << solver;
    }
    absorbed = now;
  }
}

TEST_F(Output, StoppedBeforeTheToleranceIsCodeFourAndStillWritten) {
  const Ended ended =
      run(Words{"solve", "room.toml", "-o", "S.vtp", "--max-sweeps", "1"} + quick());
  EXPECT_EQ(ended.code, 4);
  EXPECT_TRUE(says(ended.err, "warning"));
  EXPECT_TRUE(std::filesystem::exists(folder / "S.vtp"));
}

// RLIMIT_FSIZE of the child stands for a full disk: no file may grow beyond the limit. Messages are
// shorter than the limit, results are longer.
TEST_F(Output, AFailedWriteNamesTheCauseAndTheOldFileStays) {
  ASSERT_EQ(run(Words{"solve", "room.toml", "-o", "S.vtp"} + quick()).code, 0);
  std::string points = "x,y,z,nx,ny,nz\n";
  for (int i = 0; i < 99; ++i) points += "2,1.5,0.5,0,0,1\n";
  folder.write("points.csv", points);
  const Words writers[] = {
      Words{"solve", "room.toml"} + quick() + Words{"-o", "old.vtp"},
      {"mesh", "room.toml", "-o", "old.vtp"},
      {"render", "room.toml", "S.vtp", "-o", "old.png"},
      {"render", "room.toml", "S.vtp", "-o", "old.exr"},
      {"probe", "room.toml", "S.vtp", "--points", "points.csv", "-o", "old.csv"},
      {"export", "S.vtp", "-o", "old.glb"},
#ifdef LIGHTWELL_PDF
      {"report", "room.toml", "S.vtp", "--surface", "panel", "--rays", "64", "-o", "old.pdf"},
#endif
      {"form-factors", "room.toml", "--max-patch-size", "1", "-o", "old.mtx"}};
  for (const Words& words : writers) {
    folder.write(words.back(), "old");
    const int files = folder.file_count();
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{1000, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    Running running(folder / "", words);
    ::setrlimit(RLIMIT_FSIZE, &before);
    const Ended ended = running.wait();
    EXPECT_EQ(ended.code, 1) << words[0] << ": " << ended.err;
    EXPECT_TRUE(says(ended.err, words.back()));
    EXPECT_TRUE(says(ended.err, ": File too large"));
    EXPECT_EQ(content_of(folder / words.back()), "old");
    EXPECT_EQ(folder.file_count(), files);
  }
}

// The code of `words`, given to a shell that redirects standard output or standard error.
int code_in_shell(const std::filesystem::path& folder, const std::string& words) {
  const int status =
      std::system(("cd '" + folder.string() + "' && " LIGHTWELL_PROGRAM " " + words).c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST_F(Output, AFullStandardOutputIsAnErrorAndAFullLogIsNone) {
  ASSERT_TRUE(std::filesystem::exists("/dev/full"));
  for (const std::string words : {"", "--help", "--version", "solve --help", "info room.toml"}) {
    EXPECT_EQ(code_in_shell(folder.path(), words + " >/dev/full 2>err"), 1) << words;
    EXPECT_TRUE(says(content_of(folder / "err"), "No space left on device")) << words;
  }
  EXPECT_EQ(code_in_shell(folder.path(), "mesh room.toml -o M.vtp >out 2>/dev/full"), 0);
  EXPECT_EQ(code_in_shell(folder.path(), "solve nothing.toml -o S.vtp 2>/dev/full"), 3);
  EXPECT_EQ(code_in_shell(folder.path(), "solve 2>/dev/full"), 2);
}

}  // namespace
}  // namespace lightwell::output_test
