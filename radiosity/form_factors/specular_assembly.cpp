#include "radiosity/form_factors/specular_assembly.h"

#include <cstring>

#include "radiosity/form_factors/balance.h"
#include "radiosity/rows/symmetric_rows.h"

namespace lightwell {
namespace {

using RecordValues = Eigen::Map<const Eigen::Array<float, 1, Eigen::Dynamic>>;

// Values per band of a record.
RecordValues values_of(const std::byte* record, int bands) {
  return {reinterpret_cast<const float*>(record + sizeof(int)), bands};
}

// n_i^2 A_i of each patch, in which exchange by way of clear bodies is symmetric.
Eigen::ArrayXd etendue(const PatchMesh& mesh, const AssemblyOptions& options) {
  if (options.squared_index.size() == 0) return mesh.area;
  return options.squared_index * mesh.area;
}

// S_ij, j >= i, per band: the mean of both ends weighted by inverse variance.
RecordStore joined_records(const PatchMesh& mesh, RowEstimates& rows,
                           const AssemblyOptions& options) {
  const int bands = rows.bands();
  const Eigen::ArrayXd& squared_index = options.squared_index;
  const auto inverse_variance = [&](int i) {
    return squared_index.size() == 0 ? rows.inverse_variance(i)
                                     : rows.inverse_variance(i) / squared_index[i];
  };
  // The weight of F_ij: that of S_ij times n_i^2 A_i.
  const auto weight = [&](int i) {
    return static_cast<float>(rows.inverse_variance(i) * mesh.area[i]);
  };
  RecordStore S(options.budget, rows.patch_count(), rows.specular_shares().record_bytes(),
                RecordStore::Count::above_diagonal);
  fold_symmetric(
      rows.specular_shares(),
      [&](int i, RecordSpan row, RecordSpan column) {
        std::vector<std::byte> records;
        std::size_t count = 0;
        for_each_pair(i, row, column, [&](int j, const std::byte* own, const std::byte* other) {
          Spectrum sum = Spectrum::Zero(bands);
          if (own) sum += values_of(own, bands).transpose() * weight(i);
          if (other) sum += values_of(other, bands).transpose() * weight(j);
          sum /= static_cast<float>(inverse_variance(i) + inverse_variance(j));
          records.resize(++count * S.record_bytes());
          std::byte* const to = records.data() + records.size() - S.record_bytes();
          std::memcpy(to, &j, sizeof j);
          std::memcpy(to + sizeof j, sum.data(), S.record_bytes() - sizeof j);
        });
        S.append(i, records.data(), count);
      },
      [](int) {});
  S.close();
  return S;
}

// S x, per band.
Eigen::ArrayXXd product(const RecordStore& S, const Eigen::ArrayXXd& x) {
  const int bands = static_cast<int>(x.cols());
  using RowMajor = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor from = x;
  RowMajor own = RowMajor::Zero(x.rows(), x.cols()), below = own;
  read_symmetric(
      S,
      [&](int i, RecordSpan row) {
        for (std::size_t k = 0; k < row.size(); ++k) {
          own.row(i) += values_of(row[k], bands).cast<double>() * from.row(row.patch(k));
        }
      },
      [&](int i, std::size_t k, RecordSpan row) {
        below.row(row.patch(k)) += values_of(row[k], bands).cast<double>() * from.row(i);
      });
  return own + below;
}

// Light of rows behind mirrors and glass, per band.
struct RowLight {
  Eigen::ArrayXXd left;  // 1 - s_j: what a patch does not mirror of what arrives there
  Eigen::ArrayXXd
      own;  // sum of the row's own estimates, times `left` of the patches that they reach
  Eigen::ArrayXXd
      ratio;  // light that enters mirrors by the row's form factors, over that of its rays
  Eigen::ArrayXXd unfound;  // light that enters, though no ray of the row did
};

RowLight row_light(RowEstimates& rows, const AssemblyOptions& options,
                   const Eigen::ArrayXXd& entering) {
  const int n = rows.patch_count(), bands = rows.bands();
  RowLight light{.left = Eigen::ArrayXXd::Ones(n, bands),
                 .own = Eigen::ArrayXXd::Zero(n, bands),
                 .ratio = Eigen::ArrayXXd::Ones(n, bands),
                 .unfound = Eigen::ArrayXXd::Zero(n, bands)};
  const bool is_mixed = entering.size() > 0 && options.enforce_closure;
  if (is_mixed) light.left -= options.mirrored.cast<double>();
  for (int i = 0; i < n; ++i) {
    if (!is_mixed) {
      light.own.row(i) = rows.specular_sum(i);
      continue;
    }
    const RecordSpan row = rows.specular_shares().row(i);
    for (std::size_t k = 0; k < row.size(); ++k) {
      light.own.row(i) += values_of(row[k], bands).cast<double>() * light.left.row(row.patch(k));
    }
    const Eigen::Array<double, 1, Eigen::Dynamic> entered = rows.specular(i) + entering.row(i);
    const Eigen::Array<double, 1, Eigen::Dynamic> found =
        light.own.row(i) +
        (rows.specular_escaped(i) + rows.absorbed(i) + rows.cut(i)).cast<double>();
    light.ratio.row(i) = (found > 0.0).select(entered / found, 1.0);
    light.unfound.row(i) = (found > 0.0).select(0.0 * entered, entered);
  }
  return light;
}

Eigen::ArrayXXd balance(const Eigen::ArrayXd& etendue, const RowLight& light, const RecordStore& S,
                        const PhaseOf& phase_of) {
  Eigen::ArrayXXd target = light.left * light.ratio * light.own;
  target.colwise() *= etendue;
  const auto scaled = [&](const Eigen::ArrayXXd& x) -> Eigen::ArrayXXd {
    return light.left * product(S, light.left * x);
  };
  // Bounds on the scaling: few rays of a row may have missed what others sent to the row, and
  // targets may contradict each other. Factors would then grow without bound.
  constexpr double most_stretch = 2.0, largest_factor = 4.0;
  constexpr int most_iterations = 50;
  const Eigen::ArrayXXd has = scaled(Eigen::ArrayXXd::Ones(target.rows(), target.cols()));
  target = target.max(has / most_stretch).min(has * most_stretch);
  constexpr double tolerance = 1e-8;
  return symmetric_scaling(scaled, Eigen::ArrayXXd::Zero(target.rows(), target.cols()), target,
                           phase_of("balance of mirrors and glass"), tolerance, most_iterations)
      .max(1.0 / largest_factor)
      .min(largest_factor);
}

}  // namespace

void assemble_specular(const PatchMesh& mesh, RowEstimates& rows, const AssemblyOptions& options,
                       const Eigen::ArrayXXd& entering, StoredFormFactors& result) {
  const RowLight light = row_light(rows, options, entering);
  const Eigen::ArrayXd G = etendue(mesh, options);
  RecordStore S = joined_records(mesh, rows, options);
  Eigen::ArrayXXd d = Eigen::ArrayXXd::Ones(rows.patch_count(), rows.bands());
  if (options.enforce_closure) d = balance(G, light, S, options.phase_of);
  Eigen::ArrayXXd kept = Eigen::ArrayXXd::Zero(rows.patch_count(), rows.bands());
  unfold_symmetric(S, [&](int i, RecordSpan below, RecordSpan upper) {
    std::vector<int> patches;
    std::vector<float> values;
    for (const RecordSpan part : {below, upper}) {
      for (std::size_t k = 0; k < part.size(); ++k) {
        const int j = part.patch(k);
        const RecordValues S_ij = values_of(part[k], rows.bands());
        patches.push_back(j);
        for (int band = 0; band < rows.bands(); ++band) {
          values.push_back(static_cast<float>(S_ij[band] * (d(i, band) * d(j, band)) / G[i]));
        }
      }
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto band = static_cast<Eigen::Index>(k) % rows.bands();
      const int j = patches[k / static_cast<std::size_t>(rows.bands())];
      kept(i, band) += light.left(j, band) * static_cast<double>(values[k]);
    }
    result.append_specular(i, patches, values);
  });
  for (int i = 0; i < rows.patch_count(); ++i) {
    if (!rows.is_measured(i)) continue;
    // The change by balancing is offset against the row's losses, so that rows keep their light.
    using Row = Eigen::Array<double, 1, Eigen::Dynamic>;
    const auto as_row = [](const auto& spectrum) {
      return spectrum.template cast<double>().eval();
    };
    const Row ratio = light.ratio.row(i);
    const Row change = options.enforce_closure ? Row(ratio * light.own.row(i) - kept.row(i))
                                               : Row(Row::Zero(rows.bands()));
    const Row absorbed =
        ratio * as_row(rows.absorbed(i) + rows.cut(i)) + change + light.unfound.row(i);
    result.absorbed_share.row(i) = absorbed.max(0.0).cast<float>();
    result.escaped_share.row(i) = (as_row(result.escaped_share.row(i)) +
                                   ratio * as_row(rows.specular_escaped(i)) + absorbed.min(0.0))
                                      .max(0.0)
                                      .cast<float>();
  }
}

}  // namespace lightwell
