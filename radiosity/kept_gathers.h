#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "radiosity/gather/final_gather.h"
#include "radiosity/pilot_gathers.h"

namespace lightwell {

/// Indirect light gathered so far at the vertices of a pilot gather, to which later gathers add.
/// Empty before the first.
struct KeptGather {
  std::vector<int> rays{};    ///< per vertex; 0: nothing was gathered there
  BandArray indirect{};       ///< W/m^2, vertices x columns
  Eigen::ArrayXf variance{};  ///< of `indirect`, (W/m^2)^2
  std::uint64_t count = 0;    ///< number of gathers
};

/// The gathers that reconstruct() has made so far.
struct KeptGathers {
  std::vector<int> number{};      ///< PilotGather::number of their vertices
  KeptGather of_pilot{}, last{};  ///< the second pilot gather, and the final one
};

/// Brings kept gathers over to the vertices of another pilot gather, by their numbers.
void carry_over(const std::vector<int>& number, KeptGathers& kept);

/// A gather of indirect light at the vertices of a pilot gather.
struct VertexGatherTask {
  const LitScene& lit;
  const PilotGather& pilot;
  GatherOptions options{};
  const SceneParts& parts;
  std::vector<int> rays{};  // in each part
  int one_in = 1;           // the gather casts one in so many of the rays
  int cast_of(int all) const { return all > 0 ? std::max(1, all / one_in) : 0; }
};

/// Casts the rays that `kept` lacks, with random numbers of their own, and adds what they find.
/// Joins each vertex's gather with the prediction of the pilot gather and, on refined elements,
/// with its neighbours (see combine_with_predictions() and even_out_noise()). `radiosity` is what
/// rays read, W/m^2, vertices x columns. The variance is that of half the difference between the
/// two halves of the rays (see GatheredIrradiance), less what joining takes away. Throws
/// Interrupted when progress says stop.
GatheredIrradiance gather_once(const VertexGatherTask& task, const BandArray& radiosity,
                               KeptGather& kept);

}  // namespace lightwell
