#include "daylight/year_basis.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "radiosity/gather/vertex_points.h"
#include "scene/errors.h"
#include "scene/parallel.h"
#include "scene/sampling.h"

namespace lightwell {
namespace {

// Owners of random keys.
constexpr std::uint64_t of_sample_vertices = 0x7ea5, of_range_finder = 0x7ea6;

// Least light of a vertex that errors are relative to, as a share of the median of all.
constexpr double least_of_median = 0.25;

// Vertices, drawn by the areas around them: `samples`, then as many `checks`, which are none of the
// samples unless the mesh has hardly any others.
std::vector<int> sample_vertices(const PatchMesh& mesh, int samples, int checks) {
  std::vector<double> sum;
  double area = 0.0;
  for (int e = 0; e < mesh.element_count(); ++e) sum.push_back(area += mesh.element_area[e]);
  std::vector<int> vertices;
  std::vector<char> is_sample(static_cast<std::size_t>(mesh.vertex_count()), 0);
  const int count = samples + checks;
  const int most_draws = 64 * count;  // the last ones may be of samples
  for (int i = 0; static_cast<int>(vertices.size()) < count; ++i) {
    const auto random = [&](std::uint64_t number) {
      return random_uniform(random_key(of_sample_vertices, static_cast<std::uint64_t>(i), number));
    };
    const double at = random(0) * area;
    const auto e = static_cast<int>(std::min<std::ptrdiff_t>(
        std::ranges::upper_bound(sum, at) - sum.begin(), mesh.element_count() - 1));
    const int corners = mesh.corner_count(e);
    const int c = std::min(static_cast<int>(random(1) * corners), corners - 1);
    const int vertex = mesh.corners[static_cast<std::size_t>(e)][static_cast<std::size_t>(c)];
    const bool is_check = static_cast<int>(vertices.size()) >= samples;
    char& known = is_sample[static_cast<std::size_t>(vertex)];
    if (is_check && known != 0 && i < most_draws) continue;
    if (!is_check) known = 1;
    vertices.push_back(vertex);
  }
  return vertices;
}

// The vertices as points that have the random numbers of their own.
class VertexList {
 public:
  VertexList(const ElementCaster& caster, std::vector<int> vertices)
      : points_(vertex_points(caster)), vertices_(std::move(vertices)) {}

  int size() const { return static_cast<int>(vertices_.size()); }
  int vertex(int i) const { return vertices_[static_cast<std::size_t>(i)]; }
  GatherPoint point(int i) const {
    GatherPoint point = points_[vertex(i)];
    point.key = static_cast<std::uint64_t>(vertex(i));
    return point;
  }
  GatherPoints points() const {
    return {size(), [this](int i) { return point(i); }};
  }

 private:
  GatherPoints points_;
  std::vector<int> vertices_;
};

// The dome as vertices see it.
struct DomeOfVertices {
  SkyPatches sky;
  DomeEffort effort;
};

// The light of vertices straight from dome and ground, whose luminances are cd/m^2, columns of
// the sky x sources: vertices x (sources x bands), lx.
BandArray dome_at(const DaylightModel& model, const DomeOfVertices& dome,
                  const VertexList& vertices, const BandArray& luminance) {
  const Eigen::Index bands = model.scene().bands.count();
  BandArray E(vertices.size(), luminance.cols() * bands);
  constexpr int grain = 4;
  parallel_for(vertices.size(), grain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const DomeView view =
          model.view_of(dome.sky, vertices.point(i), dome.effort, vertices.vertex(i));
      const Eigen::MatrixXf light = view.coefficient.matrix().transpose() * luminance.matrix();
      E.row(i) =
          Eigen::Map<const Eigen::Array<float, 1, Eigen::Dynamic>>(light.data(), light.size());
    }
  });
  return E;
}

// A year's light of sample vertices, a row for each vertex and band and a column for each hour,
// and what arrives at all patches.
struct SampledYear {
  Eigen::MatrixXd samples{};
  BandArray arriving{};  // E0, patches x (hours x bands)
};

SampledYear light_of_year(const DaylightModel& model, const DomeOfVertices& seen,
                          const VertexList& samples, std::span<const SkyHour> hours,
                          double ground_reflectance) {
  const Eigen::Index bands = model.scene().bands.count(),
                     count = static_cast<Eigen::Index>(hours.size());
  // A ray of each point of a patch: noise of fewer differs from hour to hour, which no short sum
  // can follow.
  const int sun_rays = model.options().points_of_patch;
  SampledYear year{.samples = Eigen::MatrixXd(samples.size() * bands, count),
                   .arriving = model.hourly_arriving(hours, ground_reflectance, sun_rays)};
  const BandArray dome =
      dome_at(model, seen, samples, hour_luminances(seen.sky, hours, ground_reflectance));
  const BandArray E = reflected_by_importance(
      model.importance(samples.points(), model.options().gather_rays), year.arriving, bands);
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    for (Eigen::Index b = 0; b < bands; ++b) {
      for (Eigen::Index h = 0; h < count; ++h) {
        year.samples(i * bands + b, h) =
            double{E(i, h * bands + b)} + double{dome(i, h * bands + b)};
      }
    }
  }
  return year;
}

double median_brightness(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Divides each row of light by its own brightness and each column by that of the hour, and returns
// the hours' brightness; 1 for hours without light. Errors are thus relative. Throws InputError
// where there is no light.
Eigen::ArrayXd make_relative(Eigen::MatrixXd& light) {
  const auto divide_rows = [&](const Eigen::ArrayXd& brightness) {
    std::vector<double> lit;
    for (const double x : brightness) {
      if (x > 0.0) lit.push_back(x);
    }
    if (lit.empty()) {
      throw InputError(
          "no daylight reaches any surface in any hour, so that a page would be black: the scene "
          "has no opening, or its windows are opaque");
    }
    light.array().colwise() /= brightness.max(least_of_median * median_brightness(std::move(lit)));
  };
  divide_rows(light.rowwise().mean().array());
  const auto root_mean_squares = [&] {
    return Eigen::ArrayXd(light.array().square().colwise().mean().sqrt().transpose());
  };
  Eigen::ArrayXd of_hours = root_mean_squares();
  of_hours = (of_hours > 0.0).select(of_hours, 1.0);
  light.array().rowwise() /= of_hours.transpose();
  divide_rows(light.array().square().rowwise().mean().sqrt());
  return of_hours;
}

// Orthonormal right singular vectors of the largest singular values, columns x `count`, in
// descending order; 0 where there are no more. A range of a few more random directions is found,
// which two passes turn towards the largest singular vectors (Halko, Martinsson & Tropp 2011,
// algorithm 4.4).
Eigen::MatrixXd leading_vectors(const Eigen::MatrixXd& light, int count) {
  constexpr int more = 12, passes = 2;
  const Eigen::Index columns = light.cols(),
                     width = std::min<Eigen::Index>({count + more, columns, light.rows()});
  Eigen::MatrixXd range(columns, width);
  for (Eigen::Index i = 0; i < columns; ++i) {
    for (Eigen::Index k = 0; k < width; ++k) {
      const auto random = [&](std::uint64_t number) {
        return random_uniform(random_key(of_range_finder, static_cast<std::uint64_t>(i),
                                         static_cast<std::uint64_t>(k), number));
      };
      // Normal numbers after Box & Muller.
      range(i, k) =
          std::sqrt(-2.0 * std::log1p(-random(0))) * std::cos(2.0 * std::numbers::pi * random(1));
    }
  }
  const auto orthonormal = [&](const Eigen::MatrixXd& vectors) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(vectors);
    return Eigen::MatrixXd(qr.householderQ() * Eigen::MatrixXd::Identity(columns, width));
  };
  for (int pass = 0; pass <= passes; ++pass) {
    const Eigen::MatrixXd image = light * orthonormal(range);
    range = light.transpose() * image;
  }
  range = orthonormal(range);
  const Eigen::MatrixXd image = light * range;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> squares(image.transpose() * image);
  const Eigen::Index kept = std::min<Eigen::Index>(count, width);
  Eigen::MatrixXd vectors = Eigen::MatrixXd::Zero(columns, count);
  vectors.leftCols(kept) = range * squares.eigenvectors().rightCols(kept).rowwise().reverse();
  return vectors;
}

// Relative root mean square of what the first `terms` vectors leave out of rows of light.
double left_out(const Eigen::MatrixXd& light, const Eigen::MatrixXd& vectors, int terms) {
  const Eigen::MatrixXd coefficients = light * vectors.leftCols(terms);
  const double all = light.squaredNorm();
  return all > 0.0 ? std::sqrt(std::max(0.0, 1.0 - coefficients.squaredNorm() / all)) : 0.0;
}

// `values` of rows x (hours x bands) times the hours' factors: rows x (terms x bands).
BandArray in_terms(const BandArray& values, const Eigen::MatrixXf& factors, Eigen::Index bands) {
  BandArray sums(values.rows(), factors.cols() * bands);
  constexpr int grain = 16;
  parallel_for(static_cast<int>(values.rows()), grain, [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      // Bands x hours: as the columns of a row.
      const Eigen::Map<const Eigen::MatrixXf> row(values.row(r).data(), bands, factors.rows());
      Eigen::Map<Eigen::MatrixXf>(sums.row(r).data(), bands, factors.cols()) = row * factors;
    }
  });
  return sums;
}

// The most terms, a multiple of 4.
int most_terms(const PatchMesh& mesh, Eigen::Index bands, const YearBasisOptions& options) {
  constexpr double bytes = 2.0;
  constexpr Eigen::Index of_page = 3;  // pages have red, green and blue, or grey
  const double of_term =
      bytes * static_cast<double>(std::min(bands, of_page)) * mesh.vertex_count();
  const int afforded = static_cast<int>(std::min(options.most_bytes / of_term, 1e4));
  return std::max(4, std::min(options.most, afforded) / 4 * 4);
}

}  // namespace

void check_year_basis(const PatchMesh& mesh, int bands, std::span<const SkyHour> hours,
                      const YearBasisOptions& options) {
  if (mesh.vertex_count() > options.most_vertices) {
    throw InputError(fmt::format(
        "the surfaces have {} vertices, and a page of a year takes {} at most; give a larger "
        "'--max-patch-size'",
        mesh.vertex_count(), options.most_vertices));
  }
  const double bytes =
      double{sizeof(float)} * bands * mesh.patch_count() * static_cast<double>(hours.size());
  if (bytes > options.most_memory) {
    throw InputError(fmt::format(
        "the light of {} patches in {} hours takes {:.1f} GB, and a page of a year takes {:.1f} GB "
        "at most; give a larger '--max-patch-size'",
        mesh.patch_count(), hours.size(), 1e-9 * bytes, 1e-9 * options.most_memory));
  }
  if (hours.empty()) {
    throw InputError("the weather has no hour with daylight, so that a page would be black");
  }
}

YearBasis find_year_basis(const DaylightModel& model, std::span<const SkyHour> hours,
                          double ground_reflectance, const YearBasisOptions& options) {
  const PatchMesh& mesh = model.mesh();
  check_year_basis(mesh, model.scene().bands.count(), hours, options);
  const DomeOfVertices seen{
      .sky = SkyPatches(options.sky_subdivision, model.sky().up(), model.sky().north()),
      .effort = options.view};
  const Eigen::Index bands = model.scene().bands.count();
  const VertexList samples(model.caster(), sample_vertices(mesh, options.samples, options.checks));
  SampledYear year = light_of_year(model, seen, samples, hours, ground_reflectance);
  const Eigen::ArrayXd brightness = make_relative(year.samples);
  const Eigen::MatrixXd vectors = leading_vectors(year.samples.topRows(options.samples * bands),
                                                  most_terms(mesh, bands, options));
  const Eigen::MatrixXd checks = year.samples.bottomRows(options.checks * bands);
  YearBasis basis;
  int terms = 0;
  do {
    terms = std::min(terms + 4, static_cast<int>(vectors.cols()));
    basis.error = left_out(checks, vectors, terms);
  } while (basis.error > options.error && terms < vectors.cols());

  basis.weight = (vectors.leftCols(terms).array().colwise() * brightness).cast<float>();
  const Eigen::MatrixXf factors =
      (vectors.leftCols(terms).array().colwise() / brightness).cast<float>().matrix();
  // Terms may be below 0, which no light is; light is linear.
  const BandArray E0 = in_terms(year.arriving, factors, bands);
  year = {};
  const BandArray B = model.radiosity(E0.max(0.0f)) - model.radiosity((-E0).max(0.0f));
  const BandArray luminance =
      (hour_luminances(seen.sky, hours, ground_reflectance).matrix() * factors).array();
  basis.light.resize(mesh.vertex_count(), terms * bands);
  constexpr int block = 4096;
  for (int first = 0; first < mesh.vertex_count(); first += block) {
    report(model.options().progress, "vertices", static_cast<double>(first) / mesh.vertex_count());
    std::vector<int> numbers;
    for (int v = first; v < std::min(first + block, mesh.vertex_count()); ++v) numbers.push_back(v);
    const VertexList vertices(model.caster(), std::move(numbers));
    basis.light.middleRows(first, vertices.size()) =
        model.gather(B, vertices.points(), options.rays) +
        dome_at(model, seen, vertices, luminance);
  }
  return basis;
}

BandArray light_of_hour(const YearBasis& basis, int hour, int bands) {
  BandArray light = BandArray::Zero(basis.light.rows(), bands);
  for (int k = 0; k < basis.term_count(); ++k) {
    light += basis.weight(hour, k) * basis.light.middleCols(k * bands, bands);
  }
  return light;
}

}  // namespace lightwell
