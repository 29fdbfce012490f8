#include "radiosity/balance.h"

#include <cmath>

#include "scene/parallel.h"

namespace lightwell {

Eigen::ArrayXd symmetric_scaling(const SparseRows& S, const Eigen::ArrayXd& open,
                                 const Eigen::ArrayXd& target, double tolerance,
                                 int max_iterations) {
  const int n = S.rows();
  Eigen::ArrayXd d = Eigen::ArrayXd::Ones(n);
  Eigen::ArrayXd sum(n);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    parallel_for(n, 256, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        double s = open[i];
        for (std::int64_t e = S.first[i]; e < S.first[i + 1]; ++e) s += S.value[e] * d[S.column[e]];
        sum[i] = s;
      }
    });
    double worst = 0.0;
    for (int i = 0; i < n; ++i) {
      if (!(sum[i] > 0.0)) continue;
      const double wanted = std::max(target[i], 0.0);
      if (wanted > 0.0) worst = std::max(worst, std::abs(d[i] * sum[i] / wanted - 1.0));
      d[i] = std::sqrt(d[i] * wanted / sum[i]);
    }
    if (worst < tolerance) break;
  }
  return d;
}

}  // namespace lightwell
