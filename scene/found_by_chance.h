#pragma once

#include <span>

#include "scene/bands.h"

namespace lightwell {

/// Sum of the light that some of `count` samples found by chance, where no sample is aimed: a
/// single bright one would show as a dot. The mean of the bands of each is limited to four times
/// the mean of the other samples plus `besides`, so the edge of a highlight, which one sample in
/// four finds, stays; and so does the light of a sample without others. `found` holds the light of
/// the samples that found any, at least one.
Spectrum limited_sum(std::span<const Spectrum> found, int count, float besides);

}  // namespace lightwell
