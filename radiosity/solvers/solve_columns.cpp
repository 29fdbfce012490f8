#include "radiosity/solvers/solve_columns.h"

#include <algorithm>
#include <stdexcept>

#include "mesh/patches/translucency.h"
#include "radiosity/solvers/patches_alone.h"

namespace lightwell {
namespace {

// Patches whose reflectances repeat for every column of a block.
PatchMesh repeated(const PatchMesh& mesh, Eigen::Index columns) {
  PatchMesh patches = patches_alone(mesh);
  patches.reflectance = mesh.reflectance.replicate(1, columns);
  if (mesh.transmittance.size() > 0) {
    patches.transmittance = mesh.transmittance.replicate(1, columns);
  }
  patches.emission = BandArray::Zero(mesh.patch_count(), columns * mesh.reflectance.cols());
  return patches;
}

}  // namespace

BandArray solve_columns(const PatchMesh& mesh, const FormFactors& form_factors,
                        const BandArray& arriving, double tolerance, const Progress& progress) {
  const Eigen::Index bands = mesh.reflectance.cols(), count = arriving.cols() / bands;
  const Eigen::Index most = std::max<Eigen::Index>(1, max_bands / bands);
  BandArray B = BandArray::Zero(arriving.rows(), arriving.cols());
  PatchMesh patches;
  for (Eigen::Index first = 0; first < count; first += most) {
    const double done = static_cast<double>(first) / static_cast<double>(count);
    report(progress, "solve", done);
    const Eigen::Index n = std::min(most, count - first);
    if (patches.reflectance.cols() != n * bands) patches = repeated(mesh, n);
    SolverOptions options{.tolerance = tolerance};
    options.run.progress = [&](std::string_view phase, double) {
      return !progress || progress(phase, done);
    };
    options.arriving = arriving.middleCols(first * bands, n * bands);
    // Solvers compare errors with the brightest patch of all columns, so all are made as bright at
    // their first reflection.
    Eigen::Array<float, 1, Eigen::Dynamic> brightest =
        scattered_by_patches(patches, options.arriving).colwise().maxCoeff();
    brightest = (brightest > 0.0f).select(brightest, 1.0f);
    options.arriving.rowwise() /= brightest;
    RadiositySolution solved =
        solve_radiosity(SolverMethod::automatic, patches, form_factors, options);
    if (solved.outcome != Outcome::converged) {
      throw std::runtime_error(
          "The equations of many columns of light did not converge; please report the scene.");
    }
    solved.patch_radiosity.rowwise() *= brightest;
    B.middleCols(first * bands, n * bands) = solved.patch_radiosity;
  }
  return B;
}

BandArray solve_importance(const PatchMesh& mesh, const FormFactors& form_factors,
                           BandArray received, double tolerance, const Progress& progress) {
  const Eigen::ArrayXf area = mesh.area.cast<float>();
  received.colwise() /= area;  // what receivers send
  BandArray importance = solve_columns(mesh, form_factors, received, tolerance, progress);
  importance.colwise() *= area;
  return importance;
}

}  // namespace lightwell
