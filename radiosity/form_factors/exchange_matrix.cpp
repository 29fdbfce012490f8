#include "radiosity/form_factors/exchange_matrix.h"

namespace lightwell {

ExchangeMatrix::ExchangeMatrix(std::shared_ptr<MemoryBudget> budget, int patches)
    : upper_(std::move(budget), patches, sizeof(Exchange), RecordStore::Count::above_diagonal) {}

PerKind ExchangeMatrix::product(const PerKind& x) const {
  PerKind own = PerKind::Zero(x.rows(), 2), below = own;
  read_symmetric(
      upper_,
      [&](int i, RecordSpan row) {
        std::array<double, 2> sum = {0.0, 0.0};
        for (const Exchange e : row.as<Exchange>()) {
          sum[e.kind()] += static_cast<double>(e.value()) * x(e.patch(), e.kind());
        }
        own.row(i) << sum[0], sum[1];
      },
      [&](int i, std::size_t k, RecordSpan row) {
        const Exchange e = row.as<Exchange>()[k];
        below(e.patch(), e.kind()) += static_cast<double>(e.value()) * x(i, e.kind());
      });
  return own + below;
}

}  // namespace lightwell
