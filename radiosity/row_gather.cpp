#include "radiosity/row_gather.h"

#include <algorithm>
#include <array>

#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int packet = 4;  // lanes that are computed together

// Left to itself a processor waits for each row's start to come from memory; asked for it so much
// earlier it does a pass in half the time (solver_bench).
constexpr int bytes_ahead = 4096;

void fetch_ahead(const FormFactor* at) {
  __builtin_prefetch(reinterpret_cast<const char*>(at) + bytes_ahead);
}

// Terms are added by turns to a few sums, for one addition need not wait for the other then.
template <int Lanes, int Sums>
void gather_straight(std::span<const FormFactor> row, const double* B, double* E) {
  using Values = Eigen::Array<double, Lanes, 1>;
  using Map = Eigen::Map<const Values, Lanes == 1 ? Eigen::Unaligned : Eigen::Aligned16>;
  constexpr std::size_t line = 64 / sizeof(FormFactor);
  std::array<Values, Sums> sum;
  sum.fill(Values::Zero());
  const auto add = [&](std::size_t k, std::size_t turn) {
    sum[turn] += static_cast<double>(row[k].value) *
                 Map(B + static_cast<std::ptrdiff_t>(Lanes) * row[k].patch);
  };
  std::size_t k = 0;
  for (; k + line <= row.size(); k += line) {
    fetch_ahead(&row[k]);
    for (std::size_t t = 0; t < line; ++t) add(k + t, t % Sums);
  }
  for (; k < row.size(); ++k) add(k, k % Sums);
  for (int s = 1; s < Sums; ++s) sum[0] += sum[s];
  Eigen::Map<Values>{E} = sum[0];
}

void gather_straight(std::span<const FormFactor> row, const double* B, int lanes, double* E) {
  using Map = Eigen::Map<const Eigen::Array<double, packet, 1>>;
  std::fill_n(E, lanes, 0.0);
  for (const auto [j, F] : row) {
    const double* const B_j = B + static_cast<std::ptrdiff_t>(lanes) * j;
    for (int lane = 0; lane < lanes; lane += packet) {
      Eigen::Map<Eigen::Array<double, packet, 1>>{E + lane} +=
          static_cast<double>(F) * Map(B_j + lane);
    }
  }
}

}  // namespace

RowGather::RowGather(const FormFactors& form_factors, int bands, std::function<void()> pause)
    : form_factors_(form_factors),
      pause_(std::move(pause)),
      bands_(bands),
      lanes_(bands == 1 ? 1 : (bands + packet - 1) / packet * packet) {
  for (int i = 0; i < form_factors.patch_count() && !has_specular_; ++i) {
    has_specular_ = !form_factors.specular_row(i).patch.empty();
  }
}

void RowGather::row(int i, const LightVector& B, double* E) const {
  const std::span<const FormFactor> straight = form_factors_.row(i);
  switch (lanes()) {
    case 1:
      gather_straight<1, packet>(straight, B.data(), E);
      break;
    case packet:
      gather_straight<packet, 2>(straight, B.data(), E);
      break;
    default:
      gather_straight(straight, B.data(), lanes(), E);
  }
  if (!has_specular_) return;
  const SpecularRow specular = form_factors_.specular_row(i);
  for (std::size_t s = 0; s < specular.patch.size(); ++s) {
    const float* const F = specular.value.data() + s * static_cast<std::size_t>(bands_);
    const double* const B_j = B.data() + static_cast<std::ptrdiff_t>(lanes()) * specular.patch[s];
    for (int k = 0; k < bands_; ++k) E[k] += static_cast<double>(F[k]) * B_j[k];
  }
}

LightVector RowGather::all(const LightVector& B) const {
  LightVector E(B.rows(), B.cols());
  const auto patch_count = static_cast<int>(B.rows());
  constexpr int rows_between_pauses = 4096, grain = 64;
  for (int first = 0; first < patch_count; first += rows_between_pauses) {
    const int count = std::min(rows_between_pauses, patch_count - first);
    parallel_for(count, grain, [&](int begin, int end) {
      for (int i = first + begin; i < first + end; ++i) row(i, B, E.row(i).data());
    });
    pause();
  }
  return E;
}

LightVector RowGather::with_lanes(const BandArray& values) const {
  LightVector padded = LightVector::Zero(values.rows(), lanes_);
  padded.leftCols(bands_) = values.cast<double>();
  return padded;
}

BandArray RowGather::without_lanes(const LightVector& values) const {
  return values.leftCols(bands_).cast<float>();
}

}  // namespace lightwell
