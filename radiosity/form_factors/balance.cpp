#include "radiosity/form_factors/balance.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lightwell {
namespace {

// One step of one column. Returns the largest relative error before the step.
double improve(Eigen::Ref<Eigen::ArrayXd> d, const Eigen::ArrayXd& sum,
               const Eigen::ArrayXd& target) {
  double worst = 0.0;
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    if (!(sum[i] > 0.0)) continue;
    const double wanted = std::max(target[i], 0.0);
    if (wanted > 0.0) worst = std::max(worst, std::abs(d[i] * sum[i] / wanted - 1.0));
    d[i] = std::sqrt(d[i] * wanted / sum[i]);
  }
  return worst;
}

}  // namespace

Eigen::ArrayXXd symmetric_scaling(
    const std::function<Eigen::ArrayXXd(const Eigen::ArrayXXd&)>& product,
    const Eigen::ArrayXXd& open, const Eigen::ArrayXXd& target, JournalPhase phase,
    double tolerance, int max_iterations) {
  Eigen::ArrayXXd d = Eigen::ArrayXXd::Ones(open.rows(), open.cols());
  std::vector<char> is_done(static_cast<std::size_t>(open.cols()), 0);
  int iteration = 0;
  phase.recall_state(iteration, d, is_done);
  while (iteration < max_iterations) {
    const Eigen::ArrayXXd sum = open + product(d);
    bool all_done = true;
    for (Eigen::Index k = 0; k < open.cols(); ++k) {
      if (is_done[static_cast<std::size_t>(k)] != 0) continue;
      const double error = improve(d.col(k), sum.col(k), target.col(k));
      is_done[static_cast<std::size_t>(k)] = error < tolerance ? 1 : 0;
      all_done = all_done && error < tolerance;
    }
    iteration = all_done ? max_iterations : iteration + 1;
    if (phase.is_state_due()) phase.keep_state(iteration, d, is_done);
  }
  if (phase.has_state()) phase.keep_state(iteration, d, is_done);
  return d;
}

}  // namespace lightwell
