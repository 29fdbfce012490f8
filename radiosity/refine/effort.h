#pragma once

#include <cstdint>

namespace lightwell {

/// Rays of each patch's row of form factors for a target error relative to the mean irradiance:
/// `most`, or as many fewer as the target is above half a percent, 64 at least; for no target (0)
/// `most`. A gather reads very many patches, so that what their noise leaves of error is a small
/// share of it. It has to be: no error estimate sees it.
int form_factor_rays(double target, int most);

/// Patches that light is exchanged between for such a target, where a scene decides their size:
/// `most`, or as many fewer as the target is above one percent, 600 at least. What is read
/// where gathered rays end is light at vertices, gathered itself, so that patches may be coarse.
int patch_count_for(double target, int most);

/// Rays of a gather that leave the share `target` of noise, where `rays` of them left `found`: a
/// power of two, or five to seven eighths of one. Stratified rays' error in a room falls with about
/// the power 2/3 of their number.
int rays_for_noise(int rays, double found, double target);

/// Places that an error estimate looks at, for a solution that gathers at `vertices`: those `asked`
/// for, or twice, four or eight times as many where that is a 32nd of the vertices at most. An
/// estimate from more of them is surer by the square root.
int estimate_points(int asked, std::int64_t vertices);

/// Rays of each of `places`, beside a solution of `rays` a vertex: twice as many, or four times
/// where that is an eighth of the solution's work at most; 256 at least. Else the estimate would be
/// mostly the noise of what it compares with.
int estimate_rays(int rays, std::int64_t vertices, int points);

}  // namespace lightwell
