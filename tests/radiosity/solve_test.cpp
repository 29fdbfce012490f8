#include "radiosity/solve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/errors.h"
#include "scene/parallel.h"
#include "scene/specular.h"
#include "tests/radiosity/test_scenes.h"
#include "tests/temporary_folder.h"

namespace lightwell::solve_test {
namespace {

class Furnace : public testing::TestWithParam<std::tuple<float, bool>> {};

// In a closed room whose surfaces all emit M and reflect rho, B = M / (1 - rho) everywhere, with or
// without a block inside.
TEST_P(Furnace, RadiosityIsEmissionOverOneMinusRho) {
  const auto [rho, with_block] = GetParam();
  const Scene scene = test::furnace(rho, 2.0f, with_block);
  SolveOptions options;
  options.mesh.max_patch_size = 0.2;
  options.form_factors.rays_per_patch = 128;
  options.gather.rays = 64;
  const SolvedScene solved = solve_scene(scene, options);
  const double B = 2.0 / (1.0 - static_cast<double>(rho));
  const BandArray vertex_B = vertex_radiosity(solved.mesh, solved.solution);
  const double patch_error =
      (solved.solution.patch_radiosity.cast<double>() / B - 1.0).abs().maxCoeff();
  const double vertex_error = (vertex_B.cast<double>() / B - 1.0).abs().maxCoeff();
  std::printf("furnace rho %.2f: worst relative error %.1e (patches), %.1e (vertices)\n", rho,
              patch_error, vertex_error);
  EXPECT_LT(patch_error, 1e-4);
  EXPECT_LT(vertex_error, 1e-4);
}
INSTANTIATE_TEST_SUITE_P(Rooms, Furnace,
                         testing::Combine(testing::Values(0.0f, 0.3f, 0.5f, 0.8f, 0.95f, 0.99f),
                                          testing::Bool()));

// A floor that mirrors a part of the light and scatters the rest, and absorbs none: a half mirror,
// and white paint under a rough coat. Closed forms say how much of the light meets the floor and
// rays where its mirrored part goes, and the sums agree, so that patches have the residual of the
// solver, 1e-5, twice at most, since the walls return a half.
TEST(FurnaceWithGloss, WhiteFloorsAreInvisible) {
  for (const bool has_coat : {false, true}) {
    Scene scene = test::furnace(0.5f, 1.0f, false);
    Material white = test::diffuse(scene.bands, 0.5f);
    white.specular = constant_spectrum(scene.bands, has_coat ? 1.0f : 0.5f);
    if (has_coat) {
      white.coat = Coat{};
      white.specular_roughness = 0.3f;
      white.reflectance = 1.0f - mean_specular(white);
    }
    scene.surfaces[4].material = test::add_material(scene, white);
    SolveOptions options;
    options.mesh.max_patch_size = 0.25;
    options.form_factors.rays_per_patch = 256;
    options.gather.rays = 64;
    const SolvedScene solved = solve_scene(scene, options);
    double worst = 0.0;
    for (int p = 0; p < solved.mesh.patch_count(); ++p) {
      const double share = solved.mesh.surface[p] == 4 ? double{white.reflectance[0]} : 1.0;
      const double B = static_cast<double>(solved.solution.patch_radiosity(p, 0));
      worst = std::max(worst, std::abs(B / (2.0 * share) - 1.0));
    }
    EXPECT_LT(worst, 2e-5) << (has_coat ? "coat" : "half mirror");
    EXPECT_NEAR(solved.solution.energy.absorbed / solved.solution.energy.emitted, 1.0, 1e-4);
  }
}

Scene lit_room() {
  Scene scene;
  const int white = test::add_material(scene, test::diffuse(scene.bands, 0.7f));
  Material lamp_material = test::diffuse(scene.bands, 0.1f, 20.0f);
  lamp_material.one_sided = false;  // no black back that would count as escaped
  const int lamp = test::add_material(scene, lamp_material);
  test::add_box(scene, {0, 0, 0}, {2, 3, 2.5}, {white, white, white, white, white, white}, true);
  test::add_polygon(scene, "lamp", lamp,
                    {{0.8, 1.2, 2.4}, {0.8, 1.8, 2.4}, {1.2, 1.8, 2.4}, {1.2, 1.2, 2.4}});
  test::add_box(scene, {0.4, 0.5, 0.0}, {0.9, 1.1, 0.8}, {white, white, white, white, white, white},
                false);
  return scene;
}

SolveOptions quick() {
  SolveOptions options;
  options.mesh.max_patch_size = 0.3;
  options.form_factors.rays_per_patch = 128;
  options.gather.rays = 64;
  options.error_points = 64;
  return options;
}

TEST(SolveScene, EmittedIsAbsorbedPlusEscaped) {
  for (const bool open : {false, true}) {
    Scene scene = lit_room();
    if (open) scene.surfaces.erase(scene.surfaces.begin());
    const EnergyBalance e = solve_scene(scene, quick()).solution.energy;
    std::printf("%s room: emitted %.6f absorbed %.6f escaped %.6f unshot %.1e\n",
                open ? "open" : "closed", e.emitted, e.absorbed, e.escaped, e.unshot);
    EXPECT_NEAR((e.absorbed + e.escaped) / e.emitted, 1.0, 1e-4);
    EXPECT_NEAR(e.emitted, 3 * 20.0 * 0.4 * 0.6, 1e-5 * e.emitted);  // three bands of M A
    if (open) {
      EXPECT_GT(e.escaped, 0.05 * e.emitted);
    } else {
      EXPECT_EQ(e.escaped, 0.0);
    }
  }
}

// A second room and a second block in the same place as the first ones: no ray meets them, but rays
// of their own meet others. Rows that no scaling closes lose what they lack, and say so.
TEST(SolveScene, SurfacesInTheSamePlaceMakeNoLight) {
  Scene scene = lit_room();
  const int grey = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  const std::size_t count = scene.surfaces.size();
  for (std::size_t s = 0; s < count; ++s) {
    if (scene.surfaces[s].name == "lamp") continue;
    Surface copy = scene.surfaces[s];
    copy.material = grey;
    scene.surfaces.push_back(copy);
  }
  const SolvedScene solved = solve_scene(scene, quick());
  const EnergyBalance& e = solved.solution.energy;
  std::printf("doubled room: absorbed %.5f %%, escaped %.5f %%\n", 100 * e.absorbed / e.emitted,
              100 * e.escaped / e.emitted);
  EXPECT_NEAR((e.absorbed + e.escaped + e.unshot) / e.emitted, 1.0, 1e-4);
  if (e.escaped > 1e-4 * e.emitted) {
    const auto says_it = [](const std::string& note) {
      return note.find("of the emitted power is lost") != std::string::npos;
    };
    EXPECT_TRUE(std::ranges::any_of(solved.mesh.notes, says_it));
  }
}

// Elements absorb nearly all that is emitted. Patches balance the power by construction, but
// interpolation between the vertices of elements cuts peaks of light off. That loss is corrected
// before reflected light is gathered, so that power is lost only once.
TEST(SolveScene, ElementsAbsorbWhatIsEmitted) {
  SolveOptions options = quick();
  options.refine.tolerance = 0.02;
  options.gather.rays = 256;
  const SolvedScene solved = solve_scene(lit_room(), options);
  const PatchMesh& mesh = solved.mesh;
  const BandArray direct = element_mean(mesh, solved.solution.direct_irradiance);
  const BandArray all = element_mean(mesh, solved.solution.irradiance());
  double absorbed = 0.0, from_lamp = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) {
    const auto rho = mesh.reflectance.row(mesh.patch[e]);
    absorbed += mesh.element_area[e] * ((1.0f - rho) * all.row(e)).sum();
    from_lamp += mesh.element_area[e] * direct.row(e).sum();
  }
  const double emitted = solved.solution.energy.emitted;
  const double lost = 1.0 - absorbed / emitted, lost_directly = 1.0 - from_lamp / emitted;
  std::printf("elements absorb %.3f %% less than is emitted, receive %.3f %% less of it directly\n",
              100.0 * lost, 100.0 * lost_directly);
  EXPECT_GT(lost_directly, 0.0);
  // Reflected light is smoother than direct light, and loses no more by interpolation. (A loss at
  // each reflection anew would come to 3.6 times as much.)
  EXPECT_LT(lost, 2.0 * lost_directly);
}

// B = M / (1 - rho) is ten times the largest float.
TEST(SolveScene, LightThatIsNoFiniteNumberIsRefused) {
  const Scene scene = test::furnace(0.9f, 3e38f, false);
  EXPECT_NE(message_of<InputError>([&] { solve_scene(scene, quick()); }), "");
}

TEST(SolveScene, MirrorsAndGlassKeepTheEnergyBalance) {
  Scene scene = lit_room();
  scene.surfaces[1].material = test::add_material(scene, test::mirror(scene.bands, 0.9f));
  Material glass = test::diffuse(scene.bands, 0.0f);
  glass.dielectric =
      Dielectric{.index_of_refraction = 1.5f, .tint = constant_spectrum(scene.bands, 1.0f)};
  const int g = test::add_material(scene, glass);
  scene.surfaces.push_back({.name = "ball", .material = g, .shape = Sphere{{1.4, 2.2, 0.6}, 0.3}});
  const EnergyBalance e = solve_scene(scene, quick()).solution.energy;
  std::printf("mirror and glass: emitted %.5f absorbed %.5f escaped %.1e\n", e.emitted, e.absorbed,
              e.escaped);
  EXPECT_NEAR((e.absorbed + e.escaped) / e.emitted, 1.0, 1e-4);
}

// A row of form factors whose mirrored light leaves the scene still counts the escaped light.
TEST(SolveScene, LightMirroredOutOfTheSceneEscapes) {
  Scene scene;
  Material glossy = test::diffuse(scene.bands, 0.3f);
  glossy.specular = constant_spectrum(scene.bands, 0.5f);
  Material lamp = test::diffuse(scene.bands, 0.0f, 20.0f);
  const int floor = test::add_material(scene, glossy), panel = test::add_material(scene, lamp);
  test::add_polygon(scene, "floor", floor, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  // The lamp stands to the side: no ray from it meets the lamp or the floor after a reflection at
  // the floor.
  test::add_polygon(scene, "lamp", panel,
                    {{4.2, 1, 0.1}, {4.2, 1, 0.6}, {4.2, 3, 0.6}, {4.2, 3, 0.1}});
  std::swap(scene.surfaces[0], scene.surfaces[1]);
  const EnergyBalance e = solve_scene(scene, quick()).solution.energy;
  std::printf("glossy floor: emitted %.5f absorbed %.5f escaped %.5f\n", e.emitted, e.absorbed,
              e.escaped);
  EXPECT_NEAR((e.absorbed + e.escaped) / e.emitted, 1.0, 1e-4);
}

bool same_bits(const BandArray& a, const BandArray& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), sizeof(float) * static_cast<std::size_t>(a.size())) == 0;
}

TEST(SolveScene, BitsDoNotDependOnTheNumberOfThreads) {
  const auto with_threads = [](int n) {
    const ThreadLimit limit(n);
    return solve_scene(lit_room(), quick());
  };
  const SolvedScene one = with_threads(1), two = with_threads(2), five = with_threads(5);
  for (const SolvedScene* other : {&two, &five}) {
    EXPECT_TRUE(same_bits(one.solution.patch_radiosity, other->solution.patch_radiosity));
    EXPECT_TRUE(same_bits(one.solution.direct_irradiance, other->solution.direct_irradiance));
    EXPECT_TRUE(same_bits(one.solution.indirect_irradiance, other->solution.indirect_irradiance));
    EXPECT_EQ(one.solution.error_estimate, other->solution.error_estimate);
    EXPECT_EQ(one.mesh.corners, other->mesh.corners);
  }
}

// Two rooms that share floor and ceiling polygons, separated by a wall without thickness, with a
// lamp in the first.
TEST(SolveScene, NoLightLeaksThroughAWallWithoutThickness) {
  for (const double patch : {0.15, 0.35, 1.0}) {
    Scene scene;
    Material white = test::diffuse(scene.bands, 0.7f);
    white.one_sided = false;
    const int w = test::add_material(scene, white);
    const int lamp = test::add_material(scene, test::diffuse(scene.bands, 0.0f, 20.0f));
    test::add_box(scene, {0, 0, 0}, {4, 2, 2}, {w, w, w, w, w, w}, true);
    test::add_polygon(scene, "partition", w, {{1.9, 0, 0}, {1.9, 2, 0}, {1.9, 2, 2}, {1.9, 0, 2}});
    test::add_polygon(scene, "lamp", lamp,
                      {{0.8, 0.8, 1.9}, {0.8, 1.2, 1.9}, {1.2, 1.2, 1.9}, {1.2, 0.8, 1.9}});
    SolveOptions options = quick();
    options.mesh.max_patch_size = patch;
    const SolvedScene solved = solve_scene(scene, options);
    const BandArray E = element_mean(solved.mesh, solved.solution.irradiance());
    float dark = 0.0f, lit = 0.0f;
    for (int e = 0; e < solved.mesh.element_count(); ++e) {
      const PatchPoint at = element_center(solved.mesh, e);
      const bool in_dark_room =
          at.position.x() > 1.9 || (at.position.x() > 1.899 && at.normal.x() > 0.5);
      (in_dark_room ? dark : lit) = std::max(in_dark_room ? dark : lit, E.row(e).maxCoeff());
    }
    EXPECT_EQ(dark, 0.0f) << "patch size " << patch;
    EXPECT_GT(lit, 0.1f);  // the other room is lit
  }
}

// Half of the ball's light stays inside the ball, whose inner side reflects a part of that light
// and sees nothing else.
TEST(SolveScene, ABallThatEmitsBothWaysLosesNothing) {
  Scene scene;
  Material lamp = test::diffuse(scene.bands, 0.4f, 10.0f);
  lamp.one_sided = false;
  lamp.emits_both_sides = true;
  const int wall = test::add_material(scene, test::diffuse(scene.bands, 0.5f));
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, {wall, wall, wall, wall, wall, wall}, true);
  scene.surfaces.push_back({.name = "ball",
                            .material = test::add_material(scene, lamp),
                            .shape = Sphere{.center = {1, 1, 1}, .radius = 0.2}});
  const SolvedScene solved = solve_scene(scene, quick());
  const EnergyBalance& energy = solved.solution.energy;
  const double power = 2.0 * 3.0 * 10.0 * 4.0 * M_PI * 0.2 * 0.2;
  // Elements have the sphere's area. Rounding of floats adds up over some thousand patches.
  EXPECT_NEAR(energy.emitted, power, 1e-5 * power);
  EXPECT_NEAR(energy.absorbed, power, 1e-5 * power);
  EXPECT_NEAR(energy.escaped, 0.0, 1e-5 * power);
  // Inside, B = M + rho B everywhere.
  for (int p = 0; p < solved.mesh.patch_count(); ++p) {
    if (solved.mesh.is_back[p] == 0) continue;
    EXPECT_NEAR(solved.solution.patch_radiosity(p, 0), 10.0 / (1.0 - 0.4), 1e-4);
  }
}

// A unit of length that differs by a power of two changes exponents alone, so every ray and every
// split is the same, unless some code compares a length with a number.
TEST(SolveScene, BitsDoNotDependOnTheUnitOfLength) {
  const auto solved_in_units = [](double scale) {
    Scene scene = lit_room();
    for (Surface& s : scene.surfaces) {
      for (auto& v : std::get<PolygonMesh>(s.shape).vertices) v *= scale;
    }
    SolveOptions options = quick();
    options.mesh.max_patch_size *= scale;
    return solve_scene(scene, options);
  };
  const SolvedScene metres = solved_in_units(1.0);
  for (const double scale : {0x1p-10, 0x1p10}) {
    const SolvedScene other = solved_in_units(scale);
    EXPECT_EQ(metres.mesh.corners, other.mesh.corners) << "scale " << scale;
    EXPECT_TRUE(same_bits(metres.solution.patch_radiosity, other.solution.patch_radiosity));
    EXPECT_TRUE(same_bits(metres.solution.direct_irradiance, other.solution.direct_irradiance));
    EXPECT_TRUE(same_bits(metres.solution.indirect_irradiance, other.solution.indirect_irradiance));
    EXPECT_EQ(metres.solution.error_estimate, other.solution.error_estimate);
  }
}

int material_of_face(Scene& scene, const nlohmann::json& p, const std::string& emitting, int face) {
  static const std::array<std::string, 6> names = {"x0", "x1", "y0", "y1", "z0", "z1"};
  return test::add_material(scene, test::diffuse(scene.bands, p["rho"][face].get<float>(),
                                                 names[face] == emitting ? 1.0f : 0.0f));
}

TEST(SolveScene, ConvergedBoxesWithinDiscretisation) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/enclosures.json");
  int tested = 0;
  for (const auto& c : nlohmann::json::parse(file)) {
    if (c["kind"] != "box-converged") continue;
    const auto& p = c["parameters"];
    const std::string emission = p["emission"].is_string() ? p["emission"].get<std::string>() : "";
    if (emission.rfind("face ", 0) != 0 || emission.substr(7) != " emits E=1") continue;
    Scene scene;
    std::array<int, 6> faces;
    for (int f = 0; f < 6; ++f) faces[f] = material_of_face(scene, p, emission.substr(5, 2), f);
    test::add_box(
        scene, {0, 0, 0},
        {p["dims"][0].get<double>(), p["dims"][1].get<double>(), p["dims"][2].get<double>()}, faces,
        true);
    SolveOptions options;
    options.mesh.auto_patch_count = 600;
    options.gather.rays = 1024;
    options.refine = {.tolerance = 0.001, .max_elements = 1000000};
    const SolvedScene solved = solve_scene(scene, options);
    const ElementCaster caster(solved.mesh);
    double worst = 0.0;
    for (const auto& at : c["expected"]["points"]) {
      const auto point_of = [](const nlohmann::json& j) {
        return Eigen::Vector3d(j[0].get<double>(), j[1].get<double>(), j[2].get<double>());
      };
      const Eigen::Vector3d point = point_of(at["point"]);
      const std::string face = at["face"];
      const int axis = face[0] - 'x';
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      normal[axis] = face[1] == '0' ? 1.0 : -1.0;
      const Ray ray{.origin = point + 1e-3 * normal, .direction = -normal};
      ElementHit hit;
      caster.closest_hits({&ray, 1}, {&hit, 1});
      ASSERT_GE(hit.element, 0);
      const double E = interpolate(solved.mesh, solved.solution.irradiance(), hit)[0];
      const double H = at["H"];
      if (H > 0.0) worst = std::max(worst, std::abs(E / H - 1.0));
    }
    std::printf("%s: worst relative error of irradiance %.2e (estimate %.2e)\n",
                c["id"].get<std::string>().c_str(), worst, solved.solution.error_estimate);
    // 10 x 10 patches a face, then 1024 gathered rays a vertex. The noise of 1024 stratified rays
    // of a smooth function is about 2e-3; four standard deviations are 8e-3.
    EXPECT_LT(worst, 8e-3) << c["id"];
    ++tested;
  }
  EXPECT_GE(tested, 1);
}

TEST(SolveScene, SaysWhatToDoWhenNothingEmits) {
  Scene scene;
  const int white = test::add_material(scene, test::diffuse(scene.bands, 0.7f));
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, {white, white, white, white, white, white}, true);
  try {
    solve_scene(scene);
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("nothing emits light"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("radiance"), std::string::npos);
  }
}

}  // namespace
}  // namespace lightwell::solve_test
