// Commands in RADIANCE files: transformations, generators, formulas, refused commands.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>

#include "scene/io/radiance/text/radiance_expression.h"
#include "scene/round_shape.h"
#include "tests/sanitizers.h"
#include "tests/scene/scene_file_test.h"
#include "tests/scene/scene_questions.h"

namespace lightwell::radiance_commands_test {
namespace {

using test::area_of;
using test::has_note;
using test::mesh_of;
using test::normal_of;

constexpr double pi = std::numbers::pi;
const std::string grey = "void plastic grey 0 0 5 .5 .5 .5 0 0\n";

class RadianceCommands : public test::SceneFileTest {
 protected:
  RadianceCommands() {
    folder.write("square.rad", "grey polygon square 0 0 12 1 0 0 2 0 0 2 1 0 1 1 0\n");
  }
  Scene read(const std::string& content) const {
    return read_file("scene.rad", grey + content + "\n");
  }
  // First corner of the square (1,0) to (2,1) after xform with these arguments.
  Eigen::Vector3d corner(const std::string& arguments) const {
    return mesh_of(read("!xform " + arguments + " square.rad")).vertices.at(0);
  }
  std::string error(const std::string& content) const {
    return message_of<InputError>([&] { read(content); });
  }
};

void expect_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double tolerance = 1e-12) {
  EXPECT_LT((a - b).norm(), tolerance) << a.transpose() << " is not " << b.transpose();
}

// True if every edge of a mesh occurs once in either direction. Positions are rounded to 1e-9.
bool has_no_open_edge(const PolygonMesh& mesh) {
  std::map<std::array<long, 6>, int> crossed;
  for (const Facet& facet : mesh.facets) {
    for (std::size_t i = 0; i < facet.boundary.size(); ++i) {
      const Eigen::Vector3d& a = mesh.vertices[static_cast<std::size_t>(facet.boundary[i])];
      const Eigen::Vector3d& b =
          mesh.vertices[static_cast<std::size_t>(facet.boundary[(i + 1) % facet.boundary.size()])];
      std::array<long, 3> p{}, q{};
      for (int c = 0; c < 3; ++c) {
        p[static_cast<std::size_t>(c)] = std::lround(a[c] * 1e9);
        q[static_cast<std::size_t>(c)] = std::lround(b[c] * 1e9);
      }
      ++crossed[{p[0], p[1], p[2], q[0], q[1], q[2]}];
      --crossed[{q[0], q[1], q[2], p[0], p[1], p[2]}];
    }
  }
  return std::ranges::all_of(crossed, [](const auto& edge) { return edge.second == 0; });
}

// Volume, positive where the fronts face outwards: a third of the sum of p . n dA (Gauss).
double volume(const PolygonMesh& mesh) {
  double sum = 0.0;
  for (const Facet& facet : mesh.facets) {
    const Eigen::Vector3d& p = mesh.vertices[static_cast<std::size_t>(facet.boundary[0])];
    sum += p.dot(facet_normal(mesh, facet)) * facet_area(mesh, facet) / 3.0;
  }
  return sum;
}

TEST_F(RadianceCommands, TransformationsApplyFromLeftToRight) {
  expect_near(corner("-t 1 0 0 -rz 90"), {0, 2, 0});
  expect_near(corner("-rz 90 -t 1 0 0"), {1, 1, 0});
  expect_near(corner("-s 2 -t 1 0 0"), {3, 0, 0});
  expect_near(corner("-t 1 0 0 -s 2"), {4, 0, 0});
}

TEST_F(RadianceCommands, AnglesTurnRightHanded) {
  expect_near(corner("-t -1 1 0 -rx 90"), {0, 0, 1});  // y to z
  expect_near(corner("-t -1 0 1 -ry 90"), {1, 0, 0});  // z to x
  expect_near(corner("-rz 90"), {0, 1, 0});            // x to y
}

TEST_F(RadianceCommands, AMirroredPolygonKeepsItsFrontOnTheMirroredSide) {
  expect_near(normal_of(read("!xform -mx square.rad")), {0, 0, 1});
  expect_near(normal_of(read("!xform -mz square.rad")), {0, 0, -1});
  expect_near(normal_of(read("!xform -s -1 square.rad")), {0, 0, -1});
  expect_near(normal_of(read("!xform -I square.rad")), {0, 0, -1});
  EXPECT_NEAR(area_of(mesh_of(read("!xform -mx -s 3 square.rad"))), 9.0, 1e-12);
}

TEST_F(RadianceCommands, RepetitionsRepeatWhatFollowsThem) {
  expect_near(corner("-t 10 0 0 -i 3 -t 0 1 0 -i 1 -rz 90"), {-3, 11, 0});
  expect_near(corner("-i 0 -t 0 1 0"), {1, 0, 0});
}

TEST_F(RadianceCommands, ArraysCopyFromZeroTimesOn) {
  const Scene scene = read("!xform -n n -a 3 -t 0 0 1 -a 2 -t 10 0 0 square.rad");
  ASSERT_EQ(scene.surfaces.size(), 6u);
  EXPECT_EQ(scene.surfaces[0].name, "n.0.0.square");
  EXPECT_EQ(scene.surfaces[5].name, "n.2.1.square");
  expect_near(mesh_of(scene, 0).vertices[0], {1, 0, 0});
  expect_near(mesh_of(scene, 3).vertices[0], {11, 0, 1});
  expect_near(mesh_of(scene, 5).vertices[0], {11, 0, 2});
}

TEST_F(RadianceCommands, PipesAndFilesNest) {
  folder.write("inner.rad", "!xform -t 0 0 1 square.rad\n");
  const Scene scene =
      read("!cat inner.rad inner.rad\n!xform -n a \\\n  -s 2 inner.rad | xform -m grey -t 0 0 5");
  ASSERT_EQ(scene.surfaces.size(), 2u);
  EXPECT_EQ(mesh_of(scene, 0).facets.size(), 2u);  // polygons of one name are one surface
  expect_near(mesh_of(scene, 1).vertices[0], {2, 0, 7});
  EXPECT_EQ(scene.surfaces[1].name, "a.square");
}

TEST_F(RadianceCommands, ReplacedMaterialsAreThoseOfSurfaces) {
  const Scene scene = read("void plastic red 0 0 5 .5 0 0 0 0\n!xform -m red square.rad");
  EXPECT_EQ(scene.materials.at(0).name, "red");
}

TEST_F(RadianceCommands, LengthsScaleWithTheirShapes) {
  folder.write("round.rad",
               "grey sphere s 0 0 4 1 0 0 2\ngrey ring r 0 0 8 0 0 0 0 0 1 1 2\n"
               "grey cylinder c 0 0 7 0 0 0 0 0 1 1\n");
  const Scene scene = read("!xform -mx -s .5 -rx 90 round.rad");
  const auto& sphere = std::get<Sphere>(scene.surfaces.at(0).shape);
  EXPECT_DOUBLE_EQ(sphere.radius, 1.0);
  expect_near(sphere.center, {-0.5, 0, 0});
  const auto& ring = std::get<Frustum>(scene.surfaces.at(1).shape);
  // Lengths up to 2 are read, turned and scaled with a few roundings each.
  constexpr double rounding = 64 * 0x1p-53;
  EXPECT_NEAR(area(ring), pi * 3 / 4, rounding * pi * 3 / 4);
  expect_near(front_normal(ring, ring.base), {0, -1, 0});
  EXPECT_NEAR(surface_area(scene.surfaces.at(2)), 2 * pi / 4, rounding * 2 * pi / 4);
}

TEST_F(RadianceCommands, ABoxIsClosedAndFacesOutwardsOrInwards) {
  const Scene out = read("!genbox grey box 1 2 3"), in = read("!genbox grey box 1 2 3 -i");
  ASSERT_EQ(out.surfaces.size(), 1u);
  EXPECT_EQ(out.surfaces[0].name, "box");
  EXPECT_EQ(mesh_of(out).facets.size(), 6u);
  EXPECT_TRUE(has_no_open_edge(mesh_of(out)));
  EXPECT_NEAR(volume(mesh_of(out)), 6.0, 1e-12);
  EXPECT_NEAR(area_of(mesh_of(out)), 22.0, 1e-12);
  EXPECT_NEAR(volume(mesh_of(in)), -6.0, 1e-12);
  expect_near(scene_bounds(out).low, {0, 0, 0});
  expect_near(scene_bounds(out).high, {1, 2, 3});
}

TEST_F(RadianceCommands, ABevelledBoxLosesItsEdges) {
  const PolygonMesh box = mesh_of(read("!genbox grey box 4 4 4 -b 1"));
  EXPECT_EQ(box.facets.size(), 6u + 12u + 8u);
  EXPECT_TRUE(has_no_open_edge(box));
  // 64 minus 12 edges of length 2 and section 1/2, and 8 corners of 1 - 1/6.
  EXPECT_NEAR(volume(box), 64.0 - 12.0 - 8.0 * 5.0 / 6.0, 1e-12);
}

TEST_F(RadianceCommands, ARoundedBoxComesNearItsExactVolume) {
  const PolygonMesh box = mesh_of(read("!genbox grey box 4 5 6 -r 1"));
  EXPECT_TRUE(has_no_open_edge(box));
  // A core of 2 x 3 x 4 moved outwards by 1 has the volume V + A + pi (sum of sides) + 4 pi / 3
  // (Steiner). Chords of 22.5 degrees lose 2.6 % of a disk's area and 5 % of a ball's volume, which
  // reduces the last two terms.
  const double round = pi * (2 + 3 + 4) + 4 * pi / 3, exact = 24 + 52 + round;
  EXPECT_LT(volume(box), exact);
  EXPECT_GT(volume(box), exact - 0.05 * round);
  expect_near(scene_bounds({.surfaces = {{.shape = box}}}).high, {4, 5, 6});
}

TEST_F(RadianceCommands, APrismIsClosedAndFacesAsItsCornersRun) {
  const std::string square = " 4 0 0 0 2 3 2 3 0 ";  // clockwise as seen from +z
  const PolygonMesh up = mesh_of(read("!genprism grey prism" + square + "-l 0 0 5"));
  EXPECT_TRUE(has_no_open_edge(up));
  EXPECT_NEAR(volume(up), 30.0, 1e-12);
  EXPECT_NEAR(volume(mesh_of(read("!genprism grey prism" + square + "-l 1 1 -5"))), -30.0, 1e-12);
  EXPECT_EQ(mesh_of(read("!genprism grey prism" + square + "-e -c")).facets.size(), 3u);
  folder.write("corners", "0 0\n0 2 # a comment\n3 2 3 0");
  EXPECT_NEAR(volume(mesh_of(read("!genprism grey prism corners"))), 6.0, 1e-12);
}

TEST_F(RadianceCommands, BlindsAreSlatsOneAboveTheOther) {
  const Scene flat = read("!genblinds grey blind 1 4 6 3 30");
  ASSERT_EQ(flat.surfaces.size(), 1u);
  EXPECT_EQ(mesh_of(flat).facets.size(), 3u);
  EXPECT_NEAR(area_of(mesh_of(flat)), 3 * 4.0, 1e-12);
  expect_near(mesh_of(flat).vertices[0], {0, 0, 1});
  expect_near(mesh_of(flat).vertices[2], {std::sqrt(0.75), 4, 1.5});
}

TEST_F(RadianceCommands, CurvedSlatsFollowTheirArc) {
  // A depth of 1 at radius 1 turns by 60 degrees, an arc of pi / 3 in 20 chords.
  const double chord = 2 * std::sin(pi / 120);
  for (const char* way : {"-r 1", "+r 1"}) {
    const Scene curved = read(std::string("!genblinds grey blind 1 4 6 1 0 ") + way);
    EXPECT_EQ(mesh_of(curved).facets.size(), 20u);
    EXPECT_NEAR(area_of(mesh_of(curved)), 4 * 20 * chord, 1e-12);
    const Bounds bounds = scene_bounds(curved);
    const double sagitta = 1 - std::cos(pi / 6);
    EXPECT_NEAR(bounds.high.z() - 3.0, way[0] == '+' ? sagitta : 0.0, 1e-12);
    EXPECT_NEAR(bounds.low.z() - 3.0, way[0] == '+' ? 0.0 : -sagitta, 1e-12);
    EXPECT_NEAR(bounds.high.x(), 1.0, 1e-12);
  }
}

TEST_F(RadianceCommands, ASurfaceOfRevolutionIsClosedWhereItsOutlineIs) {
  // The desk's rounded edge, closed to a torus of radii 1 and 0.25.
  const PolygonMesh torus =
      mesh_of(read("!genrev grey torus '.25*sin(2*PI*t)' '1+.25*cos(2*PI*t)' 32 -s"));
  EXPECT_EQ(torus.facets.size(), 32u * 32u);
  EXPECT_TRUE(has_no_open_edge(torus));
  // 2 pi^2 R r^2, minus the loss of 32 chords in the tube's section (0.64 %), plus the gain of the
  // enlarged polygons about the axis (R^2 by 0.32 %, less 0.64 % of a disk's).
  const double exact = 2 * pi * pi * 0.25 * 0.25;
  EXPECT_NEAR(volume(torus), exact, 0.01 * exact);
  EXPECT_GT(volume(torus), 0.0);
}

TEST_F(RadianceCommands, ARevolvedOutlineFacesAsRadianceHasIt) {
  const auto side = [&](const char* z, const char* r) {
    const PolygonMesh mesh = mesh_of(read(std::string("!genrev grey g '") + z + "' '" + r + "' 1"));
    const Facet& facet = mesh.facets.at(0);  // just beyond the x axis
    return facet_normal(mesh, facet);
  };
  EXPECT_GT(side("t", "1").x(), 0.9);           // upwards: a cylinder
  EXPECT_LT(side("1-t", "1").x(), -0.9);        // downwards: a tube
  EXPECT_NEAR(side("1", "1-t").z(), 1, 1e-12);  // inwards: a ring that faces up
  EXPECT_NEAR(side("1", "t").z(), -1, 1e-12);
}

TEST_F(RadianceCommands, ACylinderOfRevolutionHasItsArea) {
  EXPECT_NEAR(area_of(mesh_of(read("!genrev grey c '3*t' 2 5"))), 2 * pi * 2 * 3, 1e-12);
}

TEST_F(RadianceCommands, AGridOfFormulasIsSplitWhereItBends) {
  const Scene flat = read("!gensurf grey g 's*2' 't*3' '0' 2 3");
  EXPECT_EQ(mesh_of(flat).facets.size(), 6u);
  EXPECT_NEAR(area_of(mesh_of(flat)), 6.0, 1e-12);
  expect_near(normal_of(flat), {0, 0, 1});  // ds x dt
  const Scene saddle = read("!gensurf grey g s t 's*t' 4 4");
  EXPECT_EQ(mesh_of(saddle).facets.size(), 32u);
  EXPECT_FALSE(has_note(saddle, "split"));
}

TEST_F(RadianceCommands, AWormIsSpheresAndConesThatTouchThem) {
  const Scene straight = read("!genworm grey w 0 0 '3*t' .5 3");
  EXPECT_EQ(straight.surfaces.size(), 4u + 3u);
  constexpr double rounding = 64 * 0x1p-53;  // formulas, contacts and areas: a few roundings each
  EXPECT_NEAR(surface_area(straight.surfaces.at(1)), 2 * pi * 0.5 * 1.0, rounding * pi);
  // A cone tangent to both spheres is perpendicular to their radii at the contacts. From radius 1
  // to 0.5 at distance 1 its slant length is sqrt(1 - 0.25), and its end radii are those of the
  // spheres times sqrt(1 - 0.25).
  const Scene thinner = read("!genworm grey w 0 0 t '1-t/2' 1");
  const double shrink = std::sqrt(0.75);
  const double area_of_thinner = pi * (1 + 0.5) * shrink * shrink;
  EXPECT_NEAR(surface_area(thinner.surfaces.at(1)), area_of_thinner, rounding * area_of_thinner);
}

TEST(RadianceFormula, BindsAsRadianceDoes) {
  const std::filesystem::path file = "f.rad";
  const auto value = [&](const std::string& text) {
    const double t = 0.25;
    return RadianceExpression(text, {"t"}, {&file, 1})({&t, 1});
  };
  EXPECT_DOUBLE_EQ(value("1+2*3-4/2"), 5.0);
  EXPECT_DOUBLE_EQ(value("2^3^2"), 512.0);
  EXPECT_DOUBLE_EQ(value("-2^2"), 4.0);
  EXPECT_DOUBLE_EQ(value("(1+.5)*t"), 0.375);
  EXPECT_DOUBLE_EQ(value(".05*sin(PI*(t-.5))"), 0.05 * std::sin(-pi / 4));
  EXPECT_DOUBLE_EQ(value("if(t-.5, 1, 2)"), 2.0);
  EXPECT_DOUBLE_EQ(value("hermite(1,2,0,0,0)+hermite(1,2,0,0,1)"), 3.0);
  EXPECT_DOUBLE_EQ(value("bezier(1,5,7,4,1)"), 4.0);
  EXPECT_DOUBLE_EQ(value("bspline(3,3,3,3,t)"), 3.0);  // the weights add up to 1
  EXPECT_DOUBLE_EQ(value("sqrt(16)+abs(-1)+max(1,2)"), 7.0);
}

TEST_F(RadianceCommands, WrongFormulasAreRefused) {
  const auto formula = [&](const std::string& text) {
    return error("!genrev grey g '" + text + "' 1 4");
  };
  EXPECT_TRUE(says(formula("t+"), "scene.rad:2: the formula 't+' cannot be read"));
  EXPECT_TRUE(says(formula("noise3(t)"), "cannot be read"));
  EXPECT_TRUE(says(formula("t=3"), "cannot be read"));
  EXPECT_TRUE(says(formula("1,2"), "gives several values"));
  EXPECT_TRUE(says(formula("1/t"), "no finite value everywhere"));
  EXPECT_TRUE(says(error("!genrev grey g t 't-.5' 4"), "negative"));
  EXPECT_TRUE(says(error("!genrev grey g t 1 4 -f x.cal"), "names the file 'x.cal'"));
}

TEST_F(RadianceCommands, FormulasUseTheDefinitionsOfTheirOptions) {
  folder.write("leg.cal", "{ a tapered leg }\nthick : .5;\ntaper(a, b, x) = a + (b - a) * x;\n");
  // A cone from radius 0.5 to 0.25 of height 2.
  const Scene scene = read(
      "!genrev grey leg 'h(t)' 'taper(thick, thick / 2, t)' n -f leg.cal "
      "-e 'h(u) = 2 * u; n = 4'");
  const double slant = std::hypot(2.0, 0.25);
  const double facets = 32 / pi * std::sin(pi / 32);  // chords are as long as the circle
  EXPECT_NEAR(area_of(mesh_of(scene)), pi * 0.75 * slant, 1e-3 * pi * slant) << facets;
  const auto [low, high] = scene_bounds(scene);
  EXPECT_NEAR(high.z() - low.z(), 2.0, 1e-12);
}

TEST_F(RadianceCommands, DefinitionsThatNeverEndAreLeftOutSoon) {
  std::string chain = "a0 = 1";
  for (int i = 1; i < 40; ++i) {  // 2^39 uses
    const std::string last = "a" + std::to_string(i - 1);
    chain += "; a" + std::to_string(i) + " = " + last + " + " + last;
  }
  for (const char* const end : {"-e 'a39 = a39'", "-e 'f(x) = f(x + 1); a39 = f(1)'",
                                "-e 'f(x) = 1; a39 = f(1, 2)'", "-e 'a39'", "-e"}) {
    const std::clock_t start = std::clock();
    const Scene scene = read("!cat square.rad\n!genrev grey g t a39 4 " + std::string(end));
    EXPECT_EQ(scene.surfaces.size(), 1u);
    EXPECT_TRUE(has_note(scene, "Commands that cannot be evaluated were left out: 'genrev"));
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 5.0 * test::slowdown);
  }
  const Scene scene = read("!cat square.rad\n!genrev grey g t a39 4 -e '" + chain + "'");
  EXPECT_TRUE(has_note(scene, "too many others"));
}

TEST_F(RadianceCommands, NothingReachesAShell) {
  const std::filesystem::path trace = folder / "trace";
  for (const std::string& command : std::vector<std::string>{
           "touch " + trace.string(), "genbox grey b 1 1 1; touch " + trace.string(),
           "genbox grey b 1 1 1 > " + trace.string(), "cat `touch " + trace.string() + "`",
           "genbox grey b 1 1 \"$(touch " + trace.string() + ")\"",
           "genbox grey b 1 1 1 | tee " + trace.string()}) {
    EXPECT_TRUE(says(error("!" + command), "scene.rad:2")) << command;
  }
  EXPECT_FALSE(std::filesystem::exists(trace));
  EXPECT_TRUE(says(error("!touch " + trace.string()), "'touch' is not evaluated here"));
  EXPECT_TRUE(says(error("!genbx grey b 1 1 1"), "Did you mean 'genbox'?"));
  EXPECT_TRUE(says(error("!cat $HOME/x"), "uses '$'"));
}

TEST_F(RadianceCommands, WrongArgumentsAreNamed) {
  const auto wrong = [&](const std::string& command, const std::string& says_this) {
    EXPECT_TRUE(says(error("!" + command), says_this)) << command;
  };
  wrong("xform -t 1 2 square.rad", "xform has 'square.rad' after '-t'");
  wrong("xform -t 1 2", "xform lacks what '-t' needs");
  wrong("xform -s 0 square.rad", "scale by 0");
  wrong("xform -f args square.rad", "option '-f', which is not read");
  wrong("xform -t 1 2 3", "xform has nothing to read");
  wrong("xform missing.rad", "names the file 'missing.rad', but there is no such file");
  wrong("cat square.rad | xform square.rad", "'square.rad' and a pipe");
  wrong("cat square.rad | genbox grey b 1 1 1", "reads nothing from a pipe");
  wrong("", "a command is missing");
  wrong("cat square.rad |", "a command is missing");
  wrong("cat 'square.rad", "within a quoted word");
  wrong("genbox grey b 1 1", "write 'genbox material name x y z'");
  wrong("genbox grey b 1 -1 1", "must be positive");
  wrong("genbox grey b 1 1 1 -r .6", "more than half of a side");
  wrong("genprism grey p 2 0 0 1 1", "has 2 corners");
  wrong("genprism grey p 3 0 0 1 1", "lacks the corner");
  wrong("genprism grey p 3 0 0 1 1 1 0 -l 1 1 0", "no height");
  wrong("genblinds grey b 2 1 1 5 0 -r .5", "cannot be curved");
  wrong("genblinds grey b 1 1 1 2.5 0", "whole number");
}

// Limits on time: without limits each scene would run for hours or exhaust the memory.
class RadianceRunaway : public RadianceCommands {
 protected:
  void expect_refused_soon(const std::string& content, const std::string& says_this) const {
    // CPU time, since other processes may load the machine.
    const std::clock_t start = std::clock();
    EXPECT_TRUE(says(error(content), says_this)) << content.substr(0, 80);
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 20.0 * test::slowdown);
  }
};

TEST_F(RadianceRunaway, ArraysAndRepetitionsAreRefused) {
  expect_refused_soon("!xform -a 1e9 -t 1 0 0 square.rad", "a whole number up to 100000");
  expect_refused_soon("!xform -a 1000 -t 1 0 0 -a 1000 -t 0 1 0 square.rad", "more than 100000");
  expect_refused_soon("!xform -i 1e12 -rz 1 square.rad", "a whole number up to 1000000");
  expect_refused_soon("!xform -i 1e6 -s 2 square.rad", "beyond the range of numbers");
  expect_refused_soon("!xform -a 9999 -rz 1 square.rad | xform -a 9999 -t 0 0 1",
                      "at most 2000000 are read");
}

TEST_F(RadianceRunaway, GeneratorsAreRefused) {
  expect_refused_soon("!gensurf grey g s t 0 1e6 1e6", "makes more than 1000000 polygons");
  std::string flat;  // a million polygons without area on each line
  for (int i = 0; i < 1000; ++i) flat += "!gensurf grey g 0 0 0 1000 1000\n";
  expect_refused_soon(flat, "generators make more than 4000000 facets");
  expect_refused_soon("!genrev grey g t 1 1e9", "give from 1 to 1000000");
  expect_refused_soon("!genblinds grey b 1 1 1 1e9 0", "a whole number from 1 to 100000");
}

TEST_F(RadianceRunaway, CirclesOfFilesAreRefused) {
  folder.write("a.rad", "!xform b.rad\n");
  folder.write("b.rad", "!cat a.rad\n");
  expect_refused_soon("!xform a.rad", "includes 'a.rad', which includes this file");
  expect_refused_soon("!xform scene.rad", "break the circle");
}

TEST_F(RadianceRunaway, FilesThatMultiplyAreRefused) {
  // Nested ten deep with ten includes each: 10^10 empty files.
  for (int level = 0; level < 10; ++level) {
    std::string text;
    for (int i = 0; i < 10; ++i) text += "!cat level" + std::to_string(level + 1) + ".rad\n";
    folder.write("level" + std::to_string(level) + ".rad", text);
  }
  folder.write("level10.rad", "# nothing\n");
  expect_refused_soon("!cat level0.rad", "without end");
  for (int level = 0; level < 60; ++level) {
    folder.write("deep" + std::to_string(level) + ".rad",
                 "!cat deep" + std::to_string(level + 1) + ".rad\n");
  }
  expect_refused_soon("!cat deep0.rad", "nest less deeply");
}

}  // namespace
}  // namespace lightwell::radiance_commands_test
