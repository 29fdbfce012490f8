#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "mesh/build_patches.h"
#include "radiosity/solve.h"
#include "raytrace/readings/probe.h"
#include "validation/cases/case_lists.h"
#include "validation/cases/case_scenes.h"
#include "validation/cases/given_form_factors.h"
#include "validation/cases/reference_data.h"

namespace lightwell {
namespace {

// Value of one band: entries are numbers or lists of bands.
float band_of(const ReferenceValue& value, int band) {
  return value.is_array() ? value.at(static_cast<std::size_t>(band)).get<float>()
                          : value.get<float>();
}

BandArray bands_of(const ReferenceValue& list) {
  BandArray values(static_cast<Eigen::Index>(list.size()), 3);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    for (int k = 0; k < 3; ++k) values(i, k) = band_of(list.at(static_cast<std::size_t>(i)), k);
  }
  return values;
}

Eigen::ArrayXXd matrix_of(const ReferenceValue& rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::ArrayXXd F(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      F(i, j) = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j));
    }
  }
  return F;
}

KnownEnclosure sphere_of_zones(const ReferenceValue& c) {
  const ReferenceValue& zones = c.at("parameters").at("zones");
  const auto n = static_cast<Eigen::Index>(zones.size());
  KnownEnclosure e{.area = Eigen::ArrayXd(n),
                   .reflectance = BandArray(n, 3),
                   .emission = BandArray(n, 3),
                   .radiosity = bands_of(c.at("expected").at("B"))};
  for (Eigen::Index i = 0; i < n; ++i) {
    const ReferenceValue& zone = zones.at(static_cast<std::size_t>(i));
    e.area[i] = zone.at("area_fraction");
    e.reflectance.row(i) = zone.at("rho").get<float>();
    e.emission.row(i) = zone.at("E").get<float>();
  }
  e.F = e.area.transpose().replicate(n, 1);
  return e;
}

// Surface 1 sees no part of itself but with F_11; what it does not see of surface 2 is itself.
struct TwoSurfaces {
  double F11 = 0.0, F21 = 1.0;
};

KnownEnclosure two_surfaces(const TwoSurfaces& factors, const ReferenceValue& values,
                            const ReferenceValue& B) {
  KnownEnclosure e{.area = Eigen::ArrayXd(2),
                   .F = Eigen::ArrayXXd(2, 2),
                   .reflectance = bands_of(values.at("rho")),
                   .emission = bands_of(values.at("E")),
                   .radiosity = bands_of(B)};
  e.area << factors.F21, 1.0 - factors.F11;  // reciprocity: A_1 F_12 = A_2 F_21
  e.F << factors.F11, 1.0 - factors.F11, factors.F21, 1.0 - factors.F21;
  return e;
}

KnownEnclosure known_enclosure(const ReferenceValue& c) {
  const ReferenceValue &p = c.at("parameters"), &expected = c.at("expected");
  const auto pair = [](const ReferenceValue& from, const char* first, const char* second) {
    return ReferenceValue{from.at(first), from.at(second)};
  };
  if (p.contains("zones")) return sphere_of_zones(c);
  if (c.at("kind") == "box-coarse") {
    const ReferenceValue& areas = c.at("areas");
    KnownEnclosure e{.area = Eigen::ArrayXd(6),
                     .F = matrix_of(c.at("F")),
                     .reflectance = bands_of(p.at("rho")),
                     .emission = bands_of(p.at("E")),
                     .radiosity = bands_of(expected.at("B"))};
    for (Eigen::Index i = 0; i < 6; ++i) e.area[i] = areas.at(static_cast<std::size_t>(i));
    return e;
  }
  if (p.contains("rho_cap")) {
    return two_surfaces(
        {.F11 = p.at("F_cap_cap"), .F21 = p.at("F_base_cap")},
        {{"rho", pair(p, "rho_cap", "rho_base")}, {"E", pair(p, "E_cap", "E_base")}},
        pair(expected, "B_cap", "B_base"));
  }
  const double F21 = p.contains("F21") ? p.at("F21").get<double>() : 1.0;
  const bool is_coarse = expected.contains("B1_coarse");
  return two_surfaces(
      {.F21 = F21}, {{"rho", pair(p, "rho1", "rho2")}, {"E", pair(p, "E1", "E2")}},
      is_coarse ? pair(expected, "B1_coarse", "B2_coarse") : pair(expected, "B1", "B2"));
}

// A closed room of six reflectances with a block on its floor. All surfaces emit so that the
// radiosity is the same everywhere.
struct FurnaceRoom {
  std::array<float, 6> rho{}, M{};
  double B = 0.0;
};

FurnaceRoom furnace_room(const ReferenceValue& c) {
  const ReferenceValue& p = c.at("parameters");
  FurnaceRoom room{.B = c.at("expected").at("B_everywhere")};
  for (std::size_t f = 0; f < 6; ++f) {
    const bool is_mixed = p.contains("example_rho");
    room.rho[f] = is_mixed ? p.at("example_rho").at(f).get<float>() : p.at("rho").get<float>();
    room.M[f] = is_mixed ? p.at("example_E").at(f).get<float>() : p.at("E").get<float>();
  }
  return room;
}

// The value furthest from the expected one; a value that is no number goes before all others.
ComparedValue furthest(const std::string& place, const Eigen::ArrayXd& values, double expected,
                       double tolerance) {
  for (const double value : values) {
    if (!std::isfinite(value)) return {place, expected, value, tolerance};
  }
  Eigen::Index at = 0;
  (values - expected).abs().maxCoeff(&at);
  return {place, expected, values[at], tolerance};
}

ComparedValues furnace(const ReferenceValue& c, const Progress& progress) {
  const FurnaceRoom room = furnace_room(c);
  Scene scene;
  CaseBox walls{.high = {1.0, 1.2, 0.9}};
  CaseBox block{.low = {0.3, 0.4, 0.0}, .high = {0.6, 0.7, 0.5}, .inwards = false};
  for (std::size_t f = 0; f < 6; ++f) {
    walls.materials[f] = add_paint(scene, {.reflectance = room.rho[f], .exitance = room.M[f]});
    block.materials[5 - f] = walls.materials[f];
  }
  for (Material& material : scene.materials) material.one_sided = true;
  add_case_box(scene, walls);
  add_case_box(scene, block);
  SolveOptions options;
  options.mesh.max_patch_size = 0.2;
  options.form_factors.rays_per_patch = 128;
  options.solver.tolerance = 1e-7;
  options.gather.rays = 64;
  options.refine.tolerance = 0.0;
  options.error_points = 0;
  options.run.progress = progress;
  const SolvedScene solved = solve_scene(scene, options);
  const BandArray at_vertices = vertex_radiosity(solved.mesh, solved.solution);
  // Rows are floats that sum to 1 within 1e-6, and light is reflected 1 / (1 - rho) times.
  const double rho = *std::max_element(room.rho.begin(), room.rho.end());
  const double tolerance = 1e-6 * room.B / (1.0 - rho);
  ComparedValues values = {furthest(
      "patches", solved.solution.patch_radiosity.col(0).cast<double>(), room.B, tolerance)};
  // In boxes of unlike exitances the gather parts emitters that have closed forms from the light
  // that its rays find, and the sum of both is no longer without noise.
  const bool is_even = std::equal(room.rho.begin() + 1, room.rho.end(), room.rho.begin());
  if (is_even) {
    values.push_back(furthest("vertices", at_vertices.col(0).cast<double>(), room.B, tolerance));
  }
  return values;
}

// The box of a converged case: one face, or a panel in the middle of a face, emits.
Scene converged_box(const ReferenceValue& p) {
  Scene scene;
  CaseBox room{.high = reference_point(p.at("dims"))};
  const std::string lit = p.at("emitting_face");
  const bool has_panel = p.contains("panel_side");
  const double panel = has_panel ? p.at("panel_side").get<double>() : 0.0;  // m
  const auto M = p.at("exitance").get<float>();
  for (std::size_t f = 0; f < 6; ++f) {
    const bool emits = !has_panel && lit == box_face_names[f];
    room.materials[f] =
        add_paint(scene, {.reflectance = p.at("rho").at(f), .exitance = emits ? M : 0.0f});
  }
  for (int f = 0; f < 6; ++f) {
    const std::vector<Eigen::Vector3d> face = box_face(room, f);
    const auto number = static_cast<std::size_t>(f);
    if (!has_panel || lit != box_face_names[number]) {
      add_case_polygon(scene, box_face_names[number], room.materials[number], face);
      continue;
    }
    const Eigen::Vector3d middle = 0.5 * (face[0] + face[2]);
    std::vector<Eigen::Vector3d> hole;
    for (const Eigen::Vector3d& corner : face) {
      hole.push_back(middle + 0.5 * panel * (corner - middle).array().sign().matrix());
    }
    add_holed_polygon(scene, box_face_names[number], room.materials[number], face, hole);
    add_case_polygon(scene, "panel",
                     add_paint(scene, {.reflectance = p.at("rho").at(number), .exitance = M}),
                     hole);
  }
  for (Material& material : scene.materials) material.one_sided = true;
  return scene;
}

Eigen::Vector3d inward_normal(const std::string& face) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[face.at(0) - 'x'] = face.at(1) == '0' ? 1.0 : -1.0;
  return normal;
}

constexpr int probe_rays = 1 << 14;
// An edge of one of about 2400 patches is a 20th of a face: light that varies over the length of a
// face is off by the square of that, 2.5e-3, in patches. A gather of N stratified rays adds
// N^-0.75, 7e-4, twice.
constexpr double probe_error = 4e-3;

ComparedValues probed(const Scene& scene, const std::vector<Probe>& probes,
                      const std::vector<ComparedValue>& expected, const Progress& progress) {
  SolveOptions options = options_for_probes();
  options.mesh.auto_patch_count = 2400;
  options.form_factors.rays_per_patch = 1024;
  options.gather.rays = 256;
  options.run.progress = progress;
  const SolvedScene solved = solve_scene(scene, options);
  const ElementCaster caster(solved.mesh);
  const DirectLight direct_light(scene, solved.mesh);
  const BandArray E = probe_irradiance(scene, caster, direct_light, solved.solution, probes,
                                       {.rays = probe_rays, .run = {.progress = progress}});
  ComparedValues values = expected;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i].computed = static_cast<double>(E(static_cast<Eigen::Index>(i), 0));
  }
  return values;
}

ComparedValues converged(const ReferenceValue& c, const Progress& progress) {
  const Scene scene = converged_box(c.at("parameters"));
  std::vector<Probe> probes;
  ComparedValues expected;
  for (const ReferenceValue& point : c.at("expected").at("points")) {
    const std::string face = point.at("face");
    const Eigen::Vector3d place = reference_point(point.at("point"));
    const double H = point.at("H");
    probes.push_back({.position = place, .normal = inward_normal(face)});
    expected.push_back(
        {.place = fmt::format("{} ({:g}, {:g}, {:g})", face, place.x(), place.y(), place.z()),
         .expected = H,
         .tolerance = probe_error * H + point.at("H_bound").get<double>()});
  }
  return probed(scene, probes, expected, progress);
}

ComparedValues cube_in_cube(const ReferenceValue& c, const Progress& progress) {
  Scene scene;
  const ReferenceValue& p = c.at("parameters");
  for (const char* name : {"outer", "inner"}) {
    const ReferenceValue& cube = p.at(name);
    const int paint = add_paint(scene, {.reflectance = cube.at("rho"), .exitance = cube.at("E")});
    scene.materials.back().one_sided = true;
    add_case_box(scene, {.low = reference_point(cube.at("lo")),
                         .high = reference_point(cube.at("hi")),
                         .materials = {paint, paint, paint, paint, paint, paint},
                         .inwards = std::string(name) == "outer"});
  }
  std::vector<Probe> probes;
  ComparedValues expected;
  for (const ReferenceValue& point : c.at("expected").at("points_irradiance")) {
    const double H = point.at("H"), sigma = point.at("sigma");
    // All points lie on surfaces that face up.
    probes.push_back({.position = reference_point(point.at("point"))});
    expected.push_back(
        {.place = point.at("name"), .expected = H, .tolerance = probe_error * H + 3.0 * sigma});
  }
  return probed(scene, probes, expected, progress);
}

// A cube whose exitances were chosen so that every face has the radiosity of its own.
ComparedValues manufactured(const ReferenceValue& c, const Progress& progress) {
  const ReferenceValue& p = c.at("parameters");
  const int n = p.at("n");
  Scene scene;
  CaseBox cube{};
  for (std::size_t f = 0; f < 6; ++f) {
    cube.materials[f] = add_paint(scene, {.reflectance = p.at("rho").at(f)});
    scene.materials.back().one_sided = true;
  }
  add_case_box(scene, cube);
  PatchMesh mesh =
      build_patches(scene, {.max_patch_size = 1.001 / n, .elements_per_patch_edge = 1}, progress);
  for (int patch = 0; patch < mesh.patch_count(); ++patch) {
    const int face = mesh.surface[patch];
    const Eigen::Vector3d middle = element_center(mesh, mesh.first_element[patch]).position;
    const int axis = face / 2, u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
    const ReferenceValue& E = p.at("E").at(box_face_names[static_cast<std::size_t>(face)]);
    mesh.emission.row(patch) = E.at(static_cast<std::size_t>(middle[u] * n))
                                   .at(static_cast<std::size_t>(middle[v] * n))
                                   .get<float>();
  }
  const ElementCaster caster(mesh);
  const DirectLight direct_light(scene, mesh);
  const auto F =
      compute_form_factors({scene, caster, direct_light},
                           {.method = FormFactorMethod::analytic, .run = {.progress = progress}});
  const RadiositySolution solved =
      solve_radiosity(SolverMethod::automatic, mesh, *F, {.tolerance = 1e-7});
  ComparedValues values;
  for (int face = 0; face < 6; ++face) {
    const double B = c.at("expected").at("B_per_face").at(static_cast<std::size_t>(face));
    std::vector<double> of_face;
    for (int patch = 0; patch < mesh.patch_count(); ++patch) {
      if (mesh.surface[patch] != face) continue;
      of_face.push_back(static_cast<double>(solved.patch_radiosity(patch, 0)));
    }
    // Area integrals of pairs that are far apart are good to 1e-5, and the largest B is 6.
    values.push_back(furthest(
        box_face_names[static_cast<std::size_t>(face)],
        Eigen::Map<const Eigen::ArrayXd>(of_face.data(), static_cast<Eigen::Index>(of_face.size())),
        B, 6e-5));
  }
  return values;
}

std::string enclosure_reason(const std::string& kind) {
  if (kind == "furnace") {
    return "rows of form factors are floats that sum to 1 within 1e-6; light is reflected "
           "1 / (1 - rho) times";
  }
  if (kind == "box-converged") {
    return "4e-3 of the value: the square of a patch's edge over that of a face, (1/20)^2, and "
           "twice "
           "N^-0.75 of the 2^14 rays of a gather; and the bound of the stored number";
  }
  if (kind == "box-converged-mc") {
    return "4e-3 of the value, as for the converged boxes, and three standard errors of the stored "
           "number";
  }
  if (kind == "manufactured") return "1e-5 of the largest radiosity: the bound of area integrals";
  return "four roundings to floats, 6e-8 each, times 1 / (1 - rho), and the solvers' 1e-7; all "
         "eight solvers";
}

ComparedValues enclosure_of(const ReferenceValue& c, const Progress& progress) {
  const std::string kind = c.at("kind");
  if (kind == "furnace") return furnace(c, progress);
  if (kind == "box-converged") return converged(c, progress);
  if (kind == "box-converged-mc") return cube_in_cube(c, progress);
  if (kind == "manufactured") return manufactured(c, progress);
  return solve_known_enclosure(known_enclosure(c));
}

}  // namespace

std::vector<ValidationCase> enclosure_cases() {
  std::vector<ValidationCase> cases;
  for (const ReferenceValue& c : reference_cases(validation_data::enclosures_json)) {
    const std::string kind = c.at("kind");
    const bool is_probed = kind.starts_with("box-converged");
    cases.push_back(
        {.id = c.at("id"),
         .group = "enclosures",
         .title = c.at("title"),
         .unit = "W/m2",
         .source = c.at("formula"),
         .reason = enclosure_reason(kind),
         .note = is_probed ? "irradiance at points; the light of the stored numbers is "
                             "in units of the emitted exitance"
                           : "",
         .compute = [c](const Progress& progress) { return enclosure_of(c, progress); }});
  }
  return cases;
}

}  // namespace lightwell
