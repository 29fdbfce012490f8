// Every solver on matrices with known solutions.
#include "radiosity/solvers/solve_radiosity.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/sampling.h"
#include "tests/radiosity/given_form_factors.h"
#include "tests/radiosity/named_methods.h"

namespace lightwell::solve_radiosity_test {
namespace {

using test::GivenFormFactors;
using test::patches;

// Bounces decay slowly at high reflectance; the slow methods follow every bounce.
constexpr int many_sweeps = 20000;

class Solver : public testing::TestWithParam<NamedSolverMethod> {
 protected:
  static RadiositySolution solve(const PatchMesh& mesh, const FormFactors& F,
                                 const SolverOptions& options) {
    return solve_radiosity(GetParam().method, mesh, F, options);
  }
  static RadiositySolution solve(const PatchMesh& mesh, const FormFactors& F,
                                 double tolerance = 1e-7) {
    const auto s = solve(mesh, F, {.tolerance = tolerance, .max_sweeps = many_sweeps});
    EXPECT_EQ(s.outcome, Outcome::converged) << s.residual;
    EXPECT_EQ(s.solver, GetParam().method == SolverMethod::automatic ? "cg" : GetParam().name);
    return s;
  }
};

// The inside of a sphere in n equal patches: F_ij = A_j / A_sphere = 1/n exactly, so that the
// solution is uniform.
TEST_P(Solver, RadiosityInASphereIsEmissionOverOneMinusRho) {
  for (const float rho : {0.0f, 0.5f, 0.8f, 0.95f, 0.99f}) {
    constexpr int n = 64;
    const PatchMesh mesh =
        patches(Eigen::ArrayXd::Ones(n), Eigen::ArrayXf::Constant(n, rho), Eigen::ArrayXf::Ones(n));
    const auto s = solve(mesh, GivenFormFactors(Eigen::ArrayXXd::Constant(n, n, 1.0 / n)), 1e-6);
    const double B = 1.0 / (1.0 - static_cast<double>(rho));
    // The bound at which the solver ended, plus the rounding of B to float.
    const double bound = (1e-6 + 6e-8) * B;
    EXPECT_LT((s.patch_radiosity.cast<double>() - B).abs().maxCoeff(), bound) << rho;
  }
}

float band(const nlohmann::json& value, int k) {
  return value.is_array() ? value[k].get<float>() : value.get<float>();
}

TEST_P(Solver, SolvesTheSixPatchBoxesExactly) {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/enclosures.json");
  int tested = 0;
  for (const auto& c : nlohmann::json::parse(file)) {
    if (c["kind"] != "box-coarse") continue;
    const auto& p = c["parameters"];
    const double a = p["dims"][0], b = p["dims"][1], h = p["dims"][2];
    Eigen::ArrayXd area(6);
    area << b * h, b * h, a * h, a * h, a * b, a * b;
    Eigen::ArrayXXd F(6, 6);
    PatchMesh mesh = patches(area, Eigen::ArrayXf::Zero(6), Eigen::ArrayXf::Zero(6));
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 3; ++k) {
        mesh.reflectance(i, k) = band(p["rho"][i], k);
        mesh.emission(i, k) = band(p["E"][i], k);
      }
      for (int j = 0; j < 6; ++j) F(i, j) = c["F"][i][j];
    }
    const auto s = solve(mesh, GivenFormFactors(F));
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 3; ++k) {
        const float B = band(c["expected"]["B"][i], k);
        // Form factors, reflectances and radiosities are stored in float: a few units of 1.2e-7
        // relative.
        EXPECT_NEAR(s.patch_radiosity(i, k), B, 2e-6 * std::max(B, 0.1f)) << c["id"];
      }
    }
    ++tested;
  }
  EXPECT_GE(tested, 3);
}

struct Enclosure {
  std::string id{};
  Eigen::ArrayXd area{};
  Eigen::ArrayXXd F{};
  Eigen::ArrayXf rho{}, M{};
  Eigen::ArrayXd B{};
};

// Zones of a sphere, or two uniformly lit surfaces: one patch each is exact.
std::vector<Enclosure> exact_enclosures() {
  std::ifstream file(LIGHTWELL_TEST_DATA "/analytic/enclosures.json");
  std::vector<Enclosure> cases;
  for (const auto& c : nlohmann::json::parse(file)) {
    const auto& p = c["parameters"];
    const auto& expected = c["expected"];
    Enclosure e{.id = c["id"]};
    if (c["kind"] == "sphere" && p.contains("zones")) {
      const auto n = static_cast<Eigen::Index>(p["zones"].size());
      e.area.resize(n);
      e.rho.resize(n);
      e.M.resize(n);
      e.B.resize(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto& zone = p["zones"][i];
        e.area[i] = zone["area_fraction"];
        e.rho[i] = zone["rho"];
        e.M[i] = zone["E"];
        e.B[i] = expected["B"][i];
      }
      e.F = e.area.transpose().replicate(n, 1);
    } else if (c["kind"] == "concentric" && expected.contains("B1")) {
      const double F21 = p["F21"];
      e.area.resize(2);
      e.area << F21, 1.0;
      e.F.resize(2, 2);
      e.F << 0.0, 1.0, F21, 1.0 - F21;
    } else if (c["kind"] == "parallel-plates") {
      e.area = Eigen::ArrayXd::Ones(2);
      e.F.resize(2, 2);
      e.F << 0.0, 1.0, 1.0, 0.0;
    } else {
      continue;
    }
    if (e.B.size() == 0) {
      e.rho.resize(2);
      e.rho << p["rho1"].get<float>(), p["rho2"].get<float>();
      e.M.resize(2);
      e.M << p["E1"].get<float>(), p["E2"].get<float>();
      e.B.resize(2);
      e.B << expected["B1"].get<double>(), expected["B2"].get<double>();
    }
    cases.push_back(e);
  }
  return cases;
}

TEST_P(Solver, SolvesSpheresAndPlatesExactly) {
  const auto cases = exact_enclosures();
  ASSERT_GE(cases.size(), 7u);
  for (const Enclosure& e : cases) {
    const auto s = solve(patches(e.area, e.rho, e.M), GivenFormFactors(e.F));
    // Reflectances and form factors are floats, and light is reflected up to 1 / (1 - 0.95) times.
    constexpr double bound = 20 * 1.2e-7;
    for (Eigen::Index i = 0; i < e.B.size(); ++i) {
      EXPECT_NEAR(s.patch_radiosity(i, 0), e.B[i], bound * e.B.maxCoeff()) << e.id << " " << i;
    }
  }
}

// A reciprocal enclosure of n patches with losses: random exchange areas, scaled to rows below 1.
struct RandomRoom {
  explicit RandomRoom(int n, int bands) {
    const auto u = [](int i, int j, int what) {
      return random_uniform(random_key(static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(j),
                                       static_cast<std::uint64_t>(what)));
    };
    Eigen::ArrayXXd S(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = i; j < n; ++j) S(i, j) = S(j, i) = u(i, j, 0) < 0.5 ? 0.0 : u(i, j, 1);
    }
    const Eigen::ArrayXd area = 1.05 * S.rowwise().sum();
    F = S.colwise() / area;
    mesh = patches(area, Eigen::ArrayXf::Zero(n), Eigen::ArrayXf::Zero(n), bands);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < bands; ++k) {
        mesh.reflectance(i, k) = static_cast<float>(u(i, k, 2) < 0.1 ? 0.0 : 0.95 * u(i, k, 3));
        mesh.emission(i, k) = static_cast<float>(u(i, k, 4) < 0.2 ? u(i, k, 5) : 0.0);
      }
    }
  }
  Eigen::ArrayXXd F{};
  PatchMesh mesh{};
};

TEST_P(Solver, BandsDoNotTouchEachOther) {
  constexpr int n = 37;
  for (const int bands : {1, 2, 4, 5, 9}) {
    const RandomRoom room(n, bands);
    const auto s = solve(room.mesh, GivenFormFactors(room.F));
    for (int k = 0; k < bands; ++k) {
      const Eigen::MatrixXd A =
          Eigen::MatrixXd::Identity(n, n) - (room.F.cast<float>().cast<double>().colwise() *
                                             room.mesh.reflectance.col(k).cast<double>())
                                                .matrix();
      const Eigen::ArrayXd B =
          A.partialPivLu().solve(room.mesh.emission.col(k).cast<double>().matrix()).array();
      // The tolerance, plus rounding to float.
      EXPECT_LT((s.patch_radiosity.col(k).cast<double>() - B).abs().maxCoeff(),
                (1e-7 + 6e-8) * room.mesh.emission.maxCoeff() * 4.0)
          << bands << " bands, band " << k;
    }
  }
}

TEST_P(Solver, ObserverSeesEverySweepAndItsRadiosities) {
  constexpr int n = 40;
  const RandomRoom room(n, 3);
  const GivenFormFactors F(room.F);
  std::vector<StepRecord> seen;
  BandArray last;
  const auto s = solve(room.mesh, F, {.tolerance = 1e-6, .observer = [&](const SolverSweep& sweep) {
                                        seen.push_back(sweep.record);
                                        EXPECT_EQ(sweep.number, static_cast<int>(seen.size()));
                                        last = sweep.radiosity;
                                        const BandArray residual =
                                            room.mesh.emission +
                                            room.mesh.reflectance * gather(F, last) - last;
                                        // Both B and its residual are rounded to float here.
                                        EXPECT_NEAR(residual.abs().maxCoeff() / last.maxCoeff(),
                                                    sweep.record.residual, 4e-7);
                                      }});
  ASSERT_EQ(seen.size(), s.history.size());
  ASSERT_GE(seen.size(), 2u);
  EXPECT_TRUE((last == s.patch_radiosity).all());
  // These methods reduce the largest residual in every sweep. Krylov methods reduce another norm,
  // so for all methods only the last residual is below the first.
  const bool is_contraction = GetParam().method == SolverMethod::jacobi ||
                              GetParam().method == SolverMethod::gauss_seidel ||
                              GetParam().method == SolverMethod::southwell;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_EQ(seen[i].residual, s.history[i].residual);
    if (i == 0) continue;
    EXPECT_GE(seen[i].seconds, seen[i - 1].seconds);
    if (is_contraction) {
      EXPECT_LT(seen[i].residual, seen[i - 1].residual);
    }
  }
  EXPECT_LT(seen.back().residual, 1e-2 * seen.front().residual);
}

TEST_P(Solver, FuseIsReported) {
  const RandomRoom room(16, 3);
  const auto s = solve(room.mesh, GivenFormFactors(room.F), {.tolerance = 1e-12, .max_sweeps = 2});
  EXPECT_EQ(s.outcome, Outcome::max_sweeps_reached);
  EXPECT_EQ(s.history.size(), 2u);
  EXPECT_GT(s.residual, 1e-12);
}

// Rows are floats, so a residual of 1e-16 is out of reach. Iterations below rounding must not lead
// away from the solution.
TEST_P(Solver, StaysWhereRoundingEndsIt) {
  const RandomRoom room(60, 3);
  const GivenFormFactors F(room.F);
  const auto found = solve(room.mesh, F, {.tolerance = 1e-6});
  const auto beyond = solve(room.mesh, F, {.tolerance = 1e-18, .max_sweeps = 400});
  EXPECT_LT((beyond.patch_radiosity - found.patch_radiosity).abs().maxCoeff(),
            2e-6 * found.patch_radiosity.maxCoeff());
}

TEST_P(Solver, GoesOnFromWhatItIsGiven) {
  const RandomRoom room(50, 3);
  const GivenFormFactors F(room.F);
  SolverOptions options{.tolerance = 1e-6};
  const auto from_dark = solve(room.mesh, F, options);
  options.start = from_dark.patch_radiosity;
  const auto again = solve(room.mesh, F, options);
  EXPECT_LE(again.history.size(), 2u);

  PatchMesh brighter = room.mesh;
  brighter.reflectance = 0.2f + 0.8f * brighter.reflectance;
  const auto resumed = solve(brighter, F, options);
  options.start = BandArray::Zero(50, 3);
  const auto afresh = solve(brighter, F, options);
  EXPECT_EQ(resumed.outcome, Outcome::converged);
  // Each solution is within the tolerance of the true one.
  EXPECT_LT((resumed.patch_radiosity - afresh.patch_radiosity).abs().maxCoeff(),
            2.2e-6 * afresh.patch_radiosity.maxCoeff());
}

// Rooms a (lit) and b (dark), each the inside of a sphere, and a patch that sees nothing. All
// surfaces of b have reflectance 1.
struct TwoRooms {
  static constexpr int n = 12;
  TwoRooms() : F(Eigen::ArrayXXd::Zero(2 * n + 1, 2 * n + 1)) {
    F.block(0, 0, n, n) = F.block(n, n, n, n) = 1.0 / n;
    Eigen::ArrayXf rho = Eigen::ArrayXf::Constant(2 * n + 1, 1.0f), M(2 * n + 1);
    rho.head(n) = 0.5f;
    M.setZero();
    M[3] = static_cast<float>(n);
    M[2 * n] = 7.0f;
    mesh = patches(Eigen::ArrayXd::Ones(2 * n + 1), rho, M);
    mesh.reflectance(2 * n, 0) = 0.5f;
    mesh.reflectance(2 * n, 1) = 0.0f;
  }
  Eigen::ArrayXXd F;
  PatchMesh mesh{};
};

TEST_P(Solver, ADarkRoomStaysDarkWhateverItReflects) {
  constexpr int n = TwoRooms::n;
  TwoRooms rooms;
  rooms.mesh.reflectance(2 * n, 2) = 0.3f;
  for (const bool has_start : {false, true}) {
    SolverOptions options{.tolerance = 1e-6};
    if (has_start) options.start = BandArray::Constant(2 * n + 1, 3, 2.5f);
    const auto s = solve(rooms.mesh, GivenFormFactors(rooms.F), options);
    EXPECT_EQ(s.outcome, Outcome::converged);
    EXPECT_EQ(s.patch_radiosity.block(n, 0, n, 3).abs().maxCoeff(), 0.0f);
    // The mean of M is 1, and half of the light is reflected each time.
    EXPECT_NEAR(s.patch_radiosity(0, 0), 1.0, 1e-5);
    EXPECT_NEAR(s.patch_radiosity(3, 1), n + 1.0, 1e-5 * n);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(s.patch_radiosity(2 * n, k), 7.0, 1e-5);
  }
}

TEST_P(Solver, SaysWhereLightNeverEnds) {
  TwoRooms rooms;
  rooms.mesh.emission(TwoRooms::n, 2) = 1.0f;  // emission in the room of reflectance 1, in one band
  rooms.mesh.reflectance.row(2 * TwoRooms::n) = 0.5f;
  SolverOptions options{.name_of = [](int i) { return "the wall of patch " + std::to_string(i); }};
  try {
    solve(rooms.mesh, GivenFormFactors(rooms.F), options);
    FAIL() << "expected InputError";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("light never ends around the wall of patch 12"), std::string::npos) << what;
    EXPECT_NE(what.find("band 3"), std::string::npos) << what;
    EXPECT_NE(what.find("reflectance below 1"), std::string::npos) << what;
  }
  // One black patch in the room absorbs the light.
  rooms.mesh.reflectance.row(TwoRooms::n + 5) = 0.0f;
  const auto s = solve(rooms.mesh, GivenFormFactors(rooms.F));
  // The black patch absorbs the emitted power, 1: E = 1 everywhere in the room.
  EXPECT_NEAR(s.patch_radiosity(TwoRooms::n + 1, 2), 1.0, 1e-4);
}

TEST_P(Solver, WithoutAnEmitterAllIsDark) {
  RandomRoom room(20, 3);
  room.mesh.emission.setZero();
  const auto s = solve(room.mesh, GivenFormFactors(room.F));
  EXPECT_EQ(s.patch_radiosity.abs().maxCoeff(), 0.0f);
  EXPECT_EQ(s.residual, 0.0);
}

TEST_P(Solver, WhereNothingSeesAnythingRadiosityIsEmission) {
  const RandomRoom room(9, 3);
  const auto s = solve(room.mesh, GivenFormFactors(Eigen::ArrayXXd::Zero(9, 9)));
  EXPECT_TRUE((s.patch_radiosity == room.mesh.emission).all());
}

TEST_P(Solver, StopsWhenAskedTo) {
  const RandomRoom room(8, 3);
  EXPECT_THROW(solve(room.mesh, GivenFormFactors(room.F),
                     {.run = {.progress = [](auto, double) { return false; }}}),
               Interrupted);
}

TEST_P(Solver, RejectsWhatMakesNoSense) {
  const RandomRoom room(8, 3);
  const GivenFormFactors F(room.F);
  PatchMesh flat = room.mesh;
  flat.area[3] = 0.0;
  EXPECT_THROW(solve(flat, F, SolverOptions{}), std::invalid_argument);
  EXPECT_THROW(solve(room.mesh, F, {.tolerance = 0.0}), std::invalid_argument);
  EXPECT_THROW(solve(room.mesh, F, {.relaxation = 2.0}), std::invalid_argument);
  EXPECT_THROW(solve(room.mesh, F, {.start = BandArray::Zero(7, 3)}), std::invalid_argument);
  BandArray nan = BandArray::Zero(8, 3);
  nan(2, 2) = std::nanf("");
  EXPECT_THROW(solve(room.mesh, F, {.start = nan}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Methods, Solver, testing::ValuesIn(solver_methods), test::name_of_solver);

TEST(Solvers, UnknownNamesAreToldTheKnownOnes) {
  for (const auto& [name, method] : solver_methods) EXPECT_EQ(solver_method(name), method);
  try {
    solver_method("cholesky");
    FAIL() << "expected invalid_argument";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("cholesky"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("bicgstab"), std::string::npos);
  }
}

// Rooms of reflectance 1 that see each other through narrow gaps, and one that absorbs: one mode
// per room hardly decays, and Gauss-Seidel corrects only one mode.
TEST(Solvers, AutomaticCopesWithBrightCavities) {
  constexpr int rooms = 6, each = 8, n = rooms * each;
  Eigen::ArrayXXd F = Eigen::ArrayXXd::Zero(n, n);
  constexpr double gap = 1.0 / 1024.0;  // rows sum to 1 in floats, too
  for (int r = 0; r < rooms; ++r) {
    F.block(r * each, r * each, each, each) = 1.0 / each;
    if (r == 0) continue;
    const int a = (r - 1) * each, b = r * each;  // one patch of each room sees one of the next
    F(a, b) = F(b, a) = gap;
    F(a, a) -= gap;
    F(b, b) -= gap;
  }
  Eigen::ArrayXf rho = Eigen::ArrayXf::Ones(n), M = Eigen::ArrayXf::Zero(n);
  rho.head(each) = 0.5f;
  M[1] = 1.0f;
  const PatchMesh mesh = patches(Eigen::ArrayXd::Ones(n), rho, M);
  const SolverOptions options{.tolerance = 1e-11};
  const auto plain =
      solve_radiosity(SolverMethod::gauss_seidel, mesh, GivenFormFactors(F), options);
  EXPECT_EQ(plain.outcome, Outcome::max_sweeps_reached);
  const auto s = solve_radiosity(SolverMethod::automatic, mesh, GivenFormFactors(F), options);
  EXPECT_EQ(s.outcome, Outcome::converged);
  EXPECT_LT(s.history.size(), 100u);
  // Nothing is absorbed in the bright rooms, so as much light enters as leaves, and all rooms are
  // as bright as the patch at the first gap. A residual is multiplied by the number of bounces
  // before light leaves a room, each / gap = 8192, once more in each of 5 rooms.
  constexpr double bound = 1e-11 * rooms * rooms * each / gap + 1.2e-7;
  for (int i = each; i < n; ++i) {
    EXPECT_NEAR(s.patch_radiosity(i, 0) / s.patch_radiosity(0, 0), 1.0, bound) << i;
  }
}

// Light through a mirror in one direction only is unphysical, but a valid matrix.
TEST(Solvers, ThoseThatNeedReciprocityLookForIt) {
  const RandomRoom room(30, 3);
  Eigen::ArrayXXd one_way = Eigen::ArrayXXd::Zero(30, 30);
  one_way(3, 7) = one_way(4, 8) = 0.04;
  const GivenFormFactors F(room.F, one_way);
  const SolverOptions options{.tolerance = 1e-6};
  for (const SolverMethod method : {SolverMethod::conjugate_gradients, SolverMethod::southwell}) {
    try {
      solve_radiosity(method, room.mesh, F, options);
      FAIL() << "expected InputError";
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(solver_name(method)), std::string::npos) << what;
      EXPECT_NE(what.find("use 'bicgstab' or 'gmres'"), std::string::npos) << what;
    }
  }
  const auto reference = solve_radiosity(SolverMethod::jacobi, room.mesh, F, options);
  for (const SolverMethod method :
       {SolverMethod::automatic, SolverMethod::bicgstab, SolverMethod::gmres}) {
    const auto s = solve_radiosity(method, room.mesh, F, options);
    EXPECT_NE(s.solver, "cg");
    EXPECT_LT((s.patch_radiosity - reference.patch_radiosity).abs().maxCoeff(),
              2.2e-6 * reference.patch_radiosity.maxCoeff());
  }
  // The same exchange in both directions is accepted.
  Eigen::ArrayXXd both_ways = one_way;
  both_ways(7, 3) = one_way(3, 7) * room.mesh.area[3] / room.mesh.area[7];
  both_ways(8, 4) = one_way(4, 8) * room.mesh.area[4] / room.mesh.area[8];
  EXPECT_EQ(solve_radiosity(SolverMethod::conjugate_gradients, room.mesh,
                            GivenFormFactors(room.F, both_ways), options)
                .outcome,
            Outcome::converged);
}

TEST(Solvers, RestartedGmresAndGivenRelaxationGetThereToo) {
  const RandomRoom room(60, 3);
  const GivenFormFactors F(room.F);
  const SolverOptions options{.tolerance = 1e-6};
  const auto reference = solve_radiosity(SolverMethod::automatic, room.mesh, F, options);
  for (SolverOptions other : {SolverOptions{.tolerance = 1e-6, .gmres_restart = 2},
                              SolverOptions{.tolerance = 1e-6, .relaxation = 1.2},
                              SolverOptions{.tolerance = 1e-6, .relaxation = 0.8}}) {
    const auto method = other.relaxation > 0.0 ? SolverMethod::sor : SolverMethod::gmres;
    const auto s = solve_radiosity(method, room.mesh, F, other);
    EXPECT_EQ(s.outcome, Outcome::converged);
    EXPECT_LT((s.patch_radiosity - reference.patch_radiosity).abs().maxCoeff(),
              2.2e-6 * reference.patch_radiosity.maxCoeff());
  }
}

}  // namespace
}  // namespace lightwell::solve_radiosity_test
