#include "scene/scene.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>

#include "scene/errors.h"

namespace lightwell::scene_test {
namespace {

// A valid scene: a square with a square hole, a sphere and three materials.
Scene sound_scene() {
  Scene scene;
  const Spectrum half = constant_spectrum(scene.bands, 0.5f), zero = half * 0.0f;
  scene.materials = {
      {.name = "wall", .reflectance = half, .specular = 0.4f * half, .emission = zero},
      {.name = "lamp", .reflectance = zero, .specular = zero, .emission = half},
      {.name = "glass",
       .reflectance = zero,
       .specular = zero,
       .dielectric = Dielectric{.tint = half},
       .emission = zero}};
  PolygonMesh plate{
      .vertices =
          {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}},
      .facets = {{.boundary = {0, 1, 2, 3}, .holes = {{4, 5, 6, 7}}}}};
  PolygonMesh triangle{.vertices = {{0, 0, 3}, {0, 1, 3}, {1, 0, 3}}, .facets = {{{0, 1, 2}}}};
  scene.surfaces = {{.name = "plate", .material = 0, .shape = plate},
                    {.name = "ball", .material = 2, .shape = Sphere{{1, 2, 3}, 0.5}},
                    {.name = "panel", .material = 1, .shape = triangle}};
  return scene;
}

PolygonMesh& plate(Scene& scene) {
  return std::get<PolygonMesh>(scene.surfaces[0].shape);
}
Sphere& ball(Scene& scene) {
  return std::get<Sphere>(scene.surfaces[1].shape);
}

TEST(Facet, AreaLeavesHolesOut) {
  Scene scene = sound_scene();
  EXPECT_DOUBLE_EQ(facet_area(plate(scene), plate(scene).facets[0]), 15.0);
  EXPECT_TRUE(
      facet_normal(plate(scene), plate(scene).facets[0]).isApprox(Eigen::Vector3d::UnitZ()));
}

TEST(Facet, AreaAndNormalHoldFarFromTheOrigin) {
  Scene scene = sound_scene();
  for (auto& v : plate(scene).vertices) v += Eigen::Vector3d(1e8, -1e8, 1e8);
  EXPECT_DOUBLE_EQ(facet_area(plate(scene), plate(scene).facets[0]), 15.0);
}

TEST(Facet, AConcavePolygonHasItsShoelaceArea) {
  const PolygonMesh arrow{.vertices = {{0, 0, 0}, {0, 4, 2}, {0, 0, 4}, {0, 1, 2}},
                          .facets = {{{0, 1, 2, 3}}}};
  EXPECT_DOUBLE_EQ(facet_area(arrow, arrow.facets[0]), 6.0);  // 8 less the notch of 2
  EXPECT_TRUE(facet_normal(arrow, arrow.facets[0]).isApprox(Eigen::Vector3d::UnitX()));
}

TEST(SceneFacets, CountThroughAllSurfacesInOrder) {
  const auto facets = scene_facets(sound_scene());
  ASSERT_EQ(facets.size(), 3u);
  EXPECT_EQ(facets[1].surface, 1);
  EXPECT_EQ(facets[2].surface, 2);
  EXPECT_EQ(facets[2].facet, 0);
}

TEST(SceneBounds, HoldPolygonsAndSpheres) {
  Scene scene = sound_scene();
  const Bounds bounds = scene_bounds(scene);
  EXPECT_EQ(bounds.low, Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(bounds.high, Eigen::Vector3d(4, 4, 3.5));
  scene.surfaces.clear();
  EXPECT_THROW(scene_bounds(scene), std::invalid_argument);
}

using Change = std::function<void(Scene&)>;

TEST(SceneHash, ChangesWithEverythingThatDecidesTheLight) {
  const std::vector<std::pair<const char*, Change>> changes = {
      {"vertex", [](Scene& s) { plate(s).vertices[5].y() += 1e-12; }},
      {"boundary",
       [](Scene& s) { std::swap(plate(s).facets[0].boundary[1], plate(s).facets[0].boundary[3]); }},
      {"hole", [](Scene& s) { plate(s).facets[0].holes.clear(); }},
      {"facet",
       [](Scene& s) {
         plate(s).facets.push_back({{0, 1, 2}});
       }},
      {"center", [](Scene& s) { ball(s).center.x() = 1.0000001; }},
      {"radius", [](Scene& s) { ball(s).radius = 0.51; }},
      {"material index", [](Scene& s) { s.surfaces[0].material = 1; }},
      {"surface order", [](Scene& s) { std::swap(s.surfaces[0], s.surfaces[1]); }},
      {"reflectance", [](Scene& s) { s.materials[0].reflectance[1] = 0.500001f; }},
      {"specular", [](Scene& s) { s.materials[0].specular[2] = 0.0f; }},
      {"emission", [](Scene& s) { s.materials[1].emission[0] = 1.0f; }},
      {"index", [](Scene& s) { s.materials[2].dielectric->index_of_refraction = 1.4f; }},
      {"tint", [](Scene& s) { s.materials[2].dielectric->tint[0] = 0.4f; }},
      {"roughness", [](Scene& s) { s.materials[0].specular_roughness = 0.1f; }},
      {"roughness of glass", [](Scene& s) { s.materials[2].dielectric->roughness = 0.1f; }},
      {"absorption",
       [](Scene& s) { s.materials[2].dielectric->absorption = Spectrum::Constant(3, 0.1f); }},
      {"thin", [](Scene& s) { s.materials[2].dielectric->thin = true; }},
      {"transmissivity",
       [](Scene& s) { s.materials[2].dielectric->transmissivity = Spectrum::Ones(3); }},
      {"no glass", [](Scene& s) { s.materials[2].dielectric.reset(); }},
      {"one side", [](Scene& s) { s.materials[0].one_sided = true; }},
      {"both emit", [](Scene& s) { s.materials[1].emits_both_sides = true; }},
      {"efficacy", [](Scene& s) { s.bands.lumens_per_watt = 179; }},
      {"bands", [](Scene& s) { s.bands = spectral_bands(400, 700, 3); }},
  };
  const std::uint64_t before = scene_hash(sound_scene());
  for (const auto& [what, change] : changes) {
    Scene scene = sound_scene();
    change(scene);
    EXPECT_NE(scene_hash(scene), before) << what;
  }
}

TEST(SceneHash, DoesNotChangeWithNamesNotesAndCameras) {
  Scene scene = sound_scene();
  scene.title = "another";
  scene.file = "elsewhere.toml";
  scene.notes = {"a note"};
  scene.cameras.push_back({.name = "eye"});
  for (auto& material : scene.materials) material.name += "2";
  for (auto& surface : scene.surfaces) surface.name += "2";
  plate(scene).vertices[0].x() = -0.0;
  EXPECT_EQ(scene_hash(scene), scene_hash(sound_scene()));
}

TEST(Validate, AcceptsASoundScene) {
  EXPECT_NO_THROW(validate(sound_scene()));
}

struct Flaw {
  const char* name;
  Change change;
  std::vector<const char*> message;
};

TEST(Validate, RefusesFiniteNumbersThatFloatsCannotCompute) {
  const auto refused = [](const std::function<void(Scene&)>& change) {
    Scene scene = sound_scene();
    change(scene);
    EXPECT_THROW(validate(scene), InputError);
  };
  refused([](Scene& scene) { scene.materials[1].emission[0] = 3e38f; });
  for (const float light : {3e38f, 1e-30f, 1e-40f}) {
    refused([&](Scene& scene) {
      scene.materials[1].emission.setZero();
      scene.materials[1].emission[2] = light;
    });
  }
  refused([](Scene& scene) {
    for (Eigen::Vector3d& p : plate(scene).vertices) p *= 1e-30;
    scene.surfaces.resize(1);
  });
  const auto of_camera = [&](const std::function<void(Camera&)>& change) {
    refused([&](Scene& scene) {
      scene.cameras = {{.name = "eye"}};
      EXPECT_NO_THROW(validate(scene));
      change(scene.cameras[0]);
    });
  };
  of_camera([](Camera& camera) { camera.lens_radius = 1e300; });
  of_camera([](Camera& camera) { camera.focus_distance = 1e-300; });
  of_camera([](Camera& camera) { camera.position.x() = 1e300; });
  of_camera([](Camera& camera) { camera.fov_degrees = 180.0; });
  of_camera([](Camera& camera) { camera.shutter_close = std::numeric_limits<double>::infinity(); });
  // A dark band beside bright ones does no harm.
  Scene scene = sound_scene();
  scene.materials[1].emission[0] = 1e-40f;
  EXPECT_NO_THROW(validate(scene));
}

TEST(Validate, NamesWhatIsWrongAndWhere) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr float nanf = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Flaw> flaws = {
      {"bands", [](Scene& s) { s.bands.names.clear(); }, {"0 bands", "between 1 and"}},
      {"rho > 1",
       [](Scene& s) { s.materials[0].reflectance[1] = 1.5f; },
       {"'wall'", "reflectance is 1.5", "band g"}},
      {"rho nan", [](Scene& s) { s.materials[0].reflectance[0] = nanf; }, {"'wall'", "nan"}},
      {"rho size",
       [](Scene& s) { s.materials[0].reflectance.conservativeResize(2); },
       {"'wall'", "2 bands", "has 3"}},
      {"specular",
       [](Scene& s) { s.materials[0].specular[2] = -0.1f; },
       {"'wall'", "specular", "-0.1"}},
      {"sum",
       [](Scene& s) { s.materials[0].specular[2] = 0.6f; },
       {"'wall'", "more light would leave", "band b"}},
      {"index",
       [](Scene& s) { s.materials[2].dielectric->index_of_refraction = 0.0f; },
       {"'glass'", "index of refraction 0"}},
      {"index nan",
       [](Scene& s) { s.materials[2].dielectric->index_of_refraction = nanf; },
       {"'glass'", "index of refraction nan", "glass: 1.5"}},
      {"index huge",
       [](Scene& s) { s.materials[2].dielectric->index_of_refraction = 1e30f; },
       {"'glass'", "index of refraction 1e+30"}},
      {"roughness",
       [](Scene& s) { s.materials[0].specular_roughness = 1.1f; },
       {"'wall'", "roughness is 1.1", "between 0"}},
      {"roughness of glass",
       [](Scene& s) { s.materials[2].dielectric->roughness = nanf; },
       {"'glass'", "roughness is nan"}},
      {"absorption",
       [](Scene& s) { s.materials[2].dielectric->absorption = Spectrum::Constant(3, -1.0f); },
       {"'glass'", "absorption is -1 per metre", "band r"}},
      {"absorption without end",
       [](Scene& s) { s.materials[2].dielectric->absorption = Spectrum::Constant(3, 1.0f / 0.0f); },
       {"'glass'", "absorption is inf"}},
      {"absorption size",
       [](Scene& s) { s.materials[2].dielectric->absorption = Spectrum::Ones(2); },
       {"'glass'", "absorption has 2 bands", "has 3"}},
      {"thin absorption",
       [](Scene& s) {
         s.materials[2].dielectric->absorption = Spectrum::Ones(3);
         s.materials[2].dielectric->thin = true;
       },
       {"'glass'", "thin pane", "tint"}},
      {"transmissivity of a body",
       [](Scene& s) { s.materials[2].dielectric->transmissivity = Spectrum::Ones(3); },
       {"'glass'", "transmissivity", "thin pane", "absorption"}},
      {"transmissivity beyond 1",
       [](Scene& s) {
         s.materials[2].dielectric->transmissivity = Spectrum::Constant(3, 1.5f);
         s.materials[2].dielectric->thin = true;
       },
       {"'glass'", "transmissivity is 1.5", "band r"}},
      {"tint",
       [](Scene& s) { s.materials[2].dielectric->tint[0] = 2.0f; },
       {"'glass'", "tint is 2"}},
      {"both",
       [](Scene& s) { s.materials[2].reflectance[0] = 0.5f; },
       {"'glass'", "dielectric", "remove one"}},
      {"emission", [](Scene& s) { s.materials[1].emission[0] = -1.0f; }, {"'lamp'", "emission"}},
      {"emission inf",
       [](Scene& s) { s.materials[1].emission[0] = 1.0f / 0.0f; },
       {"'lamp'", "emission", "finite"}},
      {"material", [](Scene& s) { s.surfaces[2].material = 3; }, {"'panel'", "material"}},
      {"coordinate",
       [](Scene& s) { plate(s).vertices[2].z() = nan; },
       {"'plate'", "vertex 2", "finite"}},
      {"far",
       [](Scene& s) { plate(s).vertices[2].z() = 1e12; },
       {"'plate'", "vertex 2", "1e+12", "unit"}},
      {"index",
       [](Scene& s) { plate(s).facets[0].boundary[0] = 8; },
       {"'plate'", "index 8", "0..7"}},
      {"hole index",
       [](Scene& s) { plate(s).facets[0].holes[0][0] = -1; },
       {"'plate'", "index -1"}},
      {"two", [](Scene& s) { plate(s).facets[0].boundary.resize(2); }, {"'plate'", "2 vertices"}},
      {"area",
       [](Scene& s) {
         plate(s).facets[0] = {{0, 1, 0}};
       },
       {"'plate'", "area is zero"}},
      {"radius", [](Scene& s) { ball(s).radius = 0.0; }, {"'ball'", "radius"}},
      {"center", [](Scene& s) { ball(s).center.y() = nan; }, {"'ball'", "finite"}},
  };
  for (const Flaw& flaw : flaws) {
    Scene scene = sound_scene();
    scene.file = "room.toml";
    flaw.change(scene);
    try {
      validate(scene);
      ADD_FAILURE() << flaw.name << " was accepted";
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with("room.toml: ")) << message;
      for (const char* part : flaw.message) {
        EXPECT_NE(message.find(part), std::string::npos) << flaw.name << ": " << message;
      }
    }
  }
}

}  // namespace
}  // namespace lightwell::scene_test
