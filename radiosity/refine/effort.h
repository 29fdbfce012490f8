#pragma once

#include <cstdint>

namespace lightwell {

/// Form-factor rays of each patch for `target`, an error relative to the mean irradiance: 128 * 1 %
/// / target, rounded up to a power of two, at least 64 and at most `most`; `most` if the target is
/// 0. A gather averages very many patches, so the noise of their form factors is a small part of
/// its error. The noise must be small, because no error estimate sees it.
int form_factor_rays(double target, int most);

/// Number of patches for such a target, if the scene decides their size: 800 * 2 % / target, at
/// least 600 and at most `most`; `most` if the target is 0. Patches may be coarse, because the rays
/// of a gather read light at vertices, which was gathered itself.
int patch_count_for(double target, int most);

/// The noise of a gather in a room falls with about this power of the number of its rays, which are
/// stratified.
inline constexpr double noise_order = 2.0 / 3.0;
/// Most rays of a gather that an accuracy asks for.
inline constexpr int most_gather_rays = 1 << 15;

/// Rays of a gather that leave the noise `target`, if `rays` of them left `found`; both relative to
/// the mean irradiance (see noise_order). 128 to most_gather_rays, a power of two or five to seven
/// eighths of one, which stratify well.
int rays_for_noise(int rays, double found, double target);

/// Sample points of an error estimate for a solution with so many `vertices`: `asked`, or two, four
/// or eight times as many if that is at most a 32nd of the vertices. The standard error of the
/// estimate falls with the square root of the number.
int estimate_points(int asked, std::int64_t vertices);

/// Rays of each of the sample points of an error estimate, for a solution with `rays` at each of
/// `vertices`: twice as many, or four times if that is at most an eighth of the solution's work; at
/// least 256. With fewer, most of the estimate would be the noise of its own gathers.
int estimate_rays(int rays, std::int64_t vertices, int points);

}  // namespace lightwell
