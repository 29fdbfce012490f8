#include "radiosity/solvers/row_gather.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "scene/parallel.h"

namespace lightwell {
namespace {

constexpr int packet = 4;  // lanes computed together

// Prefetch distance. Without prefetch the processor waits for each row's start to come from memory;
// with it a pass takes half the time (solver_bench).
constexpr int bytes_ahead = 4096;

void fetch_ahead(const FormFactor* at) {
  __builtin_prefetch(reinterpret_cast<const char*>(at) + bytes_ahead);
}

// GCC vector type: one register on processors with AVX, otherwise two.
using Packet [[gnu::vector_size(packet * sizeof(double))]] = double;

template <class Values>
[[gnu::always_inline]] inline void load(const double* from, Values& values) {
  std::memcpy(&values, from, sizeof values);
}

// Terms are added to several sums in turn, so that one addition need not wait for the previous one.
template <class Values, int Sums>
[[gnu::always_inline]] inline void gather_straight(std::span<const FormFactor> row, const double* B,
                                                   double* E) {
  constexpr auto lanes = static_cast<std::ptrdiff_t>(sizeof(Values) / sizeof(double));
  constexpr std::size_t line = 64 / sizeof(FormFactor);
  std::array<Values, Sums> sum{};
  std::size_t k = 0;
  for (; k + line <= row.size(); k += line) {
    fetch_ahead(&row[k]);
    for (std::size_t t = 0; t < line; ++t) {
      Values values;
      load(B + lanes * row[k + t].patch, values);
      sum[t % Sums] += static_cast<double>(row[k + t].value) * values;
    }
  }
  for (; k < row.size(); ++k) {
    Values values;
    load(B + lanes * row[k].patch, values);
    sum[k % Sums] += static_cast<double>(row[k].value) * values;
  }
  for (int s = 1; s < Sums; ++s) sum[0] += sum[s];
  std::memcpy(E, sum.data(), sizeof(Values));
}

// `Packets` packets of lanes, one register each, from `lane` on.
template <int Packets>
[[gnu::always_inline]] inline void gather_packets(std::span<const FormFactor> row, const double* B,
                                                  int lanes, int lane, double* E) {
  std::array<Packet, Packets> sum{};
  for (const auto [j, F] : row) {
    const double* const B_j = B + static_cast<std::ptrdiff_t>(lanes) * j + lane;
    for (int p = 0; p < Packets; ++p) {
      Packet values;
      load(B_j + p * packet, values);
      sum[static_cast<std::size_t>(p)] += static_cast<double>(F) * values;
    }
  }
  std::memcpy(E + lane, sum.data(), sizeof sum);
}

[[gnu::always_inline]] inline void gather_lanes(std::span<const FormFactor> row, const double* B,
                                                int lanes, double* E) {
  if (lanes == packet) {
    gather_straight<Packet, 2>(row, B, E);
    return;
  }
  constexpr int together = 8;  // of 16 registers
  int lane = 0;
  for (; lane + together * packet <= lanes; lane += together * packet) {
    gather_packets<together>(row, B, lanes, lane, E);
  }
  for (; lane < lanes; lane += packet) gather_packets<1>(row, B, lanes, lane, E);
}

using GatherLanes = void (*)(std::span<const FormFactor>, const double*, int, double*);

void gather_lanes_anywhere(std::span<const FormFactor> row, const double* B, int lanes, double* E) {
  gather_lanes(row, B, lanes, E);
}

#if defined(__x86_64__)
// No fused multiply-add: all machines compute the same bits.
[[gnu::target("avx2")]] void gather_lanes_avx2(std::span<const FormFactor> row, const double* B,
                                               int lanes, double* E) {
  gather_lanes(row, B, lanes, E);
}

GatherLanes best_gather_lanes() {
  return __builtin_cpu_supports("avx2") ? gather_lanes_avx2 : gather_lanes_anywhere;
}
#else
GatherLanes best_gather_lanes() {
  return gather_lanes_anywhere;
}
#endif

}  // namespace

RowGather::RowGather(const FormFactors& form_factors, int bands, std::function<void()> pause)
    : form_factors_(form_factors),
      pause_(std::move(pause)),
      bands_(bands),
      lanes_(bands == 1 ? 1 : (bands + packet - 1) / packet * packet),
      gather_lanes_(best_gather_lanes()) {
  for (int i = 0; i < form_factors.patch_count() && !has_specular_; ++i) {
    has_specular_ = !form_factors.specular_row(i).patch.empty();
  }
}

void RowGather::row(int i, const LightVector& B, double* E) const {
  const std::span<const FormFactor> straight = form_factors_.row(i);
  if (lanes() == 1) {
    gather_straight<double, packet>(straight, B.data(), E);
  } else {
    gather_lanes_(straight, B.data(), lanes(), E);
  }
  if (!has_specular_) return;
  const SpecularRow specular = form_factors_.specular_row(i);
  for (std::size_t s = 0; s < specular.patch.size(); ++s) {
    const auto in_row = static_cast<int>(specular.value.cols());
    const float* const F = specular.value.data() + s * static_cast<std::size_t>(in_row);
    const double* const B_j = B.data() + static_cast<std::ptrdiff_t>(lanes()) * specular.patch[s];
    for (int first = 0; first < bands_; first += in_row) {
      for (int k = 0; k < in_row; ++k) E[first + k] += static_cast<double>(F[k]) * B_j[first + k];
    }
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
