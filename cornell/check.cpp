// Compares what lightwell computed for a Cornell box with the references in cornell/reference.
// cornell/README.md defines every figure.
//   lightwell_cornell_check diffuse|mirror-block|spheres|spectral CORNELL_FOLDER SOLUTION.vtp
//   PICTURE.exr
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cornell/picture_mask.h"
#include "cornell/sightlines.h"
#include "mesh/cleaning/planar_regions.h"
#include "radiosity/solution/solution_file.h"
#include "raytrace/pictures/image.h"
#include "raytrace/readings/probe.h"
#include "scene/errors.h"
#include "scene/io/read_scene.h"

namespace lightwell {
namespace {
namespace fs = std::filesystem;

constexpr double light_radiance = 17.0;                     // W/(m^2 sr), the brightest band
constexpr double light_width = 0.130, light_depth = 0.105;  // metres
constexpr double light_band_sum = 17.0 + 11.8 + 4.0;  // W/(m^2 sr); the spectrum has the same sum
constexpr double seen_light = 0.2 * light_radiance;   // above this a pixel shows the light itself
constexpr int cell_size = 8;                          // pixels

/// Prints figures beside their bounds, and remembers whether one was missed.
class Verdict {
 public:
  void figure(const std::string& name, double percent, double bound_percent) {
    const bool holds = percent <= bound_percent;  // a NaN does not
    all_hold_ = all_hold_ && holds;
    fmt::print("{}  {:<66} {:9.4f} %  (at most {:g} %)\n", holds ? "PASS" : "FAIL", name, percent,
               bound_percent);
  }
  void remark(const std::string& name, double percent) {
    fmt::print("      {:<66} {:9.4f} %\n", name, percent);
  }
  bool all_hold() const { return all_hold_; }

 private:
  bool all_hold_ = true;
};

struct Subject {
  fs::path folder;
  Scene scene;
  SolvedScene solved;
  Image picture;
};

// Columns E_r, E_g, E_b of the reference values.
BandArray read_reference_irradiance(const fs::path& csv) {
  std::ifstream in(csv);
  std::string line;
  if (!std::getline(in, line)) {
    throw InputError(csv.string() + ": the reference irradiance cannot be read");
  }
  std::vector<std::string> header;
  std::stringstream names(line);
  for (std::string name; std::getline(names, name, ',');) header.push_back(name);
  const auto first = std::find(header.begin(), header.end(), "E_r") - header.begin();
  std::vector<std::array<float, 3>> rows;
  while (std::getline(in, line)) {
    std::stringstream fields(line);
    std::string field;
    auto& row = rows.emplace_back();
    for (int i = 0; std::getline(fields, field, ','); ++i) {
      if (i >= first && i < first + 3) row[i - first] = std::stof(field);
    }
  }
  BandArray E(static_cast<Eigen::Index>(rows.size()), 3);
  for (Eigen::Index i = 0; i < E.rows(); ++i) E.row(i) << rows[i][0], rows[i][1], rows[i][2];
  return E;
}

void check_energy(const Subject& subject, Verdict& verdict) {
  const EnergyBalance& energy = subject.solved.solution.energy;
  const double exact = std::numbers::pi * light_band_sum * light_width * light_depth;
  verdict.figure(
      "energy: |emitted - absorbed - escaped| / emitted",
      100.0 * std::abs(energy.emitted - energy.absorbed - energy.escaped) / energy.emitted, 0.01);
  verdict.figure("energy: |emitted - pi L A of the light| / (pi L A)",
                 100.0 * std::abs(energy.emitted - exact) / exact, 0.001);
}

// The errors of probes, in lux of the bands' mean, against the bounds that the solution states.
void check_bounds(const Subject& subject, const Eigen::ArrayXd& bound, const BandArray& E,
                  const BandArray& R, Verdict& verdict) {
  if (bound.size() == 0) return;  // refinement was off
  const double lux = luminous(subject.scene.bands, constant_spectrum(subject.scene.bands, 1.0f));
  const Eigen::ArrayXd off = lux * (E - R).cast<double>().rowwise().mean().abs();
  verdict.figure(
      "bounds of irradiance at probes: missed by",
      100.0 * static_cast<double>((off > bound).count()) / static_cast<double>(off.size()), 5.0);
  verdict.figure("bounds of irradiance at probes: their RMS, of the RMS error",
                 100.0 * std::sqrt(bound.square().mean() / off.square().mean()), 500.0);
}

void check_probes(const Subject& subject, Verdict& verdict) {
  const fs::path csv = subject.folder / "reference" / "irradiance.csv";
  const BandArray R = read_reference_irradiance(csv);
  const std::vector<Probe> probes = read_probes(csv, subject.scene.metres_per_unit);
  const ElementCaster caster(subject.solved.mesh);
  const BandArray E = interpolate_irradiance(caster, subject.solved.solution, probes);
  if (E.rows() != R.rows()) throw InputError(csv.string() + ": a probe has no reference value");

  const Eigen::ArrayXXd difference = (E - R).cast<double>().abs();
  std::vector<double> relative;
  for (Eigen::Index i = 0; i < R.rows(); ++i) {
    for (Eigen::Index k = 0; k < R.cols(); ++k) relative.push_back(difference(i, k) / R(i, k));
  }
  std::sort(relative.begin(), relative.end());
  const std::string of = fmt::format("irradiance at {} probes: ", R.rows());
  const double rmse = std::sqrt(difference.square().mean()) / R.cast<double>().mean();
  verdict.figure(of + "relative RMSE", 100.0 * rmse, 1.5);
  if (const double estimate = subject.solved.solution.error_estimate; estimate > 0.0) {
    verdict.figure(of + "the same, of its estimate", 100.0 * rmse / estimate, 100.0);
  }
  verdict.figure(of + "95th percentile of |E - R| / R",
                 100.0 * relative[static_cast<std::size_t>(0.95 * relative.size())], 4.0);
  verdict.remark(of + "largest |E - R| / R", 100.0 * relative.back());
  check_bounds(subject, interpolation_bound(caster, subject.solved.solution, probes), E, R,
               verdict);
}

// sqrt(mean (P - A)(P - B)) / mean (A + B) / 2 over what is not masked. With A = B an ordinary
// relative RMSE; with two independent noisy references their noise cancels.
double relative_rmse(const Image& P, const Image& A, const Image& B, const PictureMask& mask) {
  if (P.width != A.width || P.height != A.height || A.radiance.rows() != B.radiance.rows()) {
    throw InputError(fmt::format("the picture is {} x {}, the reference {} x {}", P.width, P.height,
                                 A.width, A.height));
  }
  double square = 0.0, mean = 0.0;
  for (Eigen::Index i = 0; i < P.radiance.rows(); ++i) {
    if (mask.out[i]) continue;
    const Eigen::Array<double, 1, Eigen::Dynamic> p = P.radiance.row(i).cast<double>(),
                                                  a = A.radiance.row(i).cast<double>(),
                                                  b = B.radiance.row(i).cast<double>();
    square += ((p - a) * (p - b)).sum();
    mean += 0.5 * (a + b).sum();
  }
  const double count = 3.0 * static_cast<double>(P.radiance.rows()) * (1.0 - mask.share());
  return std::sqrt(std::max(0.0, square / count)) / (mean / count);
}

void check_diffuse_picture(const Subject& subject, Verdict& verdict) {
  const Image reference = read_exr(subject.folder / "reference" / "diffuse-gather.exr");
  const ElementCaster caster(subject.solved.mesh);
  const Sightlines sightlines(subject.scene, caster);
  PictureMask light = brighter_than(reference, seen_light);
  PictureMask mask = grown(light, 3);
  mask |= grown(silhouettes(sightlines, subject.scene.cameras.front()), 3);
  verdict.figure(fmt::format("picture: relative RMSE, 3 pixels off light and edges ({:.0f} % kept)",
                             100.0 * (1.0 - mask.share())),
                 100.0 * relative_rmse(subject.picture, reference, reference, mask), 1.5);
  verdict.remark("picture: relative RMSE of everything but the light",
                 100.0 * relative_rmse(subject.picture, reference, reference, light));
}

// The share of a place in a pixel from which on it decides whether the pixel is left out.
constexpr double least_weight = 0.02;

PictureMask cells_that_show_the_light(const Sightlines& sightlines, const Camera& camera) {
  const Scene& scene = sightlines.scene();
  return cells(places(sightlines, camera, least_weight,
                      [&scene](const TracedPoint& place) {
                        const Surface& surface = scene.surfaces[place.surface];
                        return scene.materials[surface.material].is_emitter();
                      }),
               cell_size);
}

// The floor under the glass sphere: where the cone of lines from the middle of the light past the
// sphere ends, widened by half. In it lie the focus of the light and the sphere's shadow.
PictureMask cells_that_show_the_focus(const Sightlines& sightlines, const Camera& camera) {
  const Scene& scene = sightlines.scene();
  const Eigen::Vector3d light(0.278, 0.5488, 0.2795), sphere(0.160, 0.100, 0.150);
  constexpr double sphere_radius = 0.100;
  const double stretch = light.y() / (light.y() - sphere.y());
  const Eigen::Vector3d middle = light + stretch * (sphere - light);
  const double radius = 1.5 * stretch * sphere_radius;
  return cells(places(sightlines, camera, least_weight,
                      [&](const TracedPoint& place) {
                        return scene.surfaces[place.surface].name == "floor" &&
                               (place.position - middle).norm() < radius;
                      }),
               cell_size);
}

// |mean P / mean (A + B) / 2 - 1| over what `within` holds and `mask` leaves in.
double difference_of_means(const Image& P, const Image& A, const Image& B,
                           const PictureMask& within, const PictureMask& mask) {
  double p = 0.0, r = 0.0;
  for (Eigen::Index i = 0; i < P.radiance.rows(); ++i) {
    if (!within.out[i] || mask.out[i]) continue;
    p += P.radiance.row(i).cast<double>().sum();
    r += 0.5 * (A.radiance.row(i) + B.radiance.row(i)).cast<double>().sum();
  }
  return std::abs(p / r - 1.0);
}

void check_specular_picture(const std::string& name, const Subject& subject, Verdict& verdict) {
  const Image A = read_exr(subject.folder / "reference" / (name + "-A.exr")),
              B = read_exr(subject.folder / "reference" / (name + "-B.exr"));
  const ElementCaster caster(subject.solved.mesh);
  const Sightlines sightlines(subject.scene, caster);
  const Camera& camera = subject.scene.cameras.front();
  const Image P = cell_means(subject.picture, cell_size);
  const PictureMask light = cells_that_show_the_light(sightlines, camera);
  const auto kept = [](const PictureMask& mask) {
    return fmt::format("({:.0f} % kept)", 100.0 * (1.0 - mask.share()));
  };
  verdict.figure("picture: relative RMSE of 8 x 8 means, off the light " + kept(light),
                 100.0 * relative_rmse(P, A, B, light), 1.5);
  if (name != "spheres") return;
  const PictureMask focus = cells_that_show_the_focus(sightlines, camera);
  PictureMask elsewhere = light;
  for (std::size_t i = 0; i < focus.out.size(); ++i) {
    if (!focus.out[i]) elsewhere.out[i] = 1;
  }
  verdict.figure("picture: the same of the focus alone " + kept(elsewhere),
                 100.0 * relative_rmse(P, A, B, elsewhere), 3.0);
  verdict.figure("picture: difference of the means over the focus",
                 100.0 * difference_of_means(P, A, B, focus, light), 1.0);
}

int check(const std::string& name, const fs::path& folder, const fs::path& solution,
          const fs::path& picture) {
  const std::string file = name == "diffuse" ? "cornell.toml" : "cornell-" + name + ".toml";
  Subject subject{folder, merge_planar_regions(read_scene(folder / file)), read_solution(solution),
                  read_exr(picture)};
  check_matches(subject.scene, subject.solved.solution);
  Verdict verdict;
  check_energy(subject, verdict);
  if (name == "diffuse") {
    check_probes(subject, verdict);
    check_diffuse_picture(subject, verdict);
  } else if (name != "spectral") {
    check_specular_picture(name, subject, verdict);
  }
  return verdict.all_hold() ? 0 : 1;
}

}  // namespace
}  // namespace lightwell

int main(int argc, char** argv) {
  try {
    if (argc != 5)
      throw lightwell::InputError(
          "four arguments are needed: NAME CORNELL_FOLDER SOLUTION.vtp PICTURE.exr");
    return lightwell::check(argv[1], argv[2], argv[3], argv[4]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 3;
  }
}
