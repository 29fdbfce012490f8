#pragma once

#include "mesh/patches/patch_mesh.h"
#include "radiosity/direct_light/direct_light.h"
#include "radiosity/direct_light/lit_scene.h"
#include "radiosity/gather/final_gather.h"
#include "radiosity/solution/solution.h"

namespace lightwell {

/// Patch radiosities, W/m^2, patches x columns of every channel at full scale.
BandArray unscaled_radiosity(const RadiositySolution& solution);

/// The mean of the patches around each vertex, weighted by the area of their elements there:
/// vertices x columns of `of_patches`.
BandArray to_vertices(const PatchMesh& mesh, const BandArray& of_patches);

/// Shares of patches from shares of vertices, the adjoint of to_vertices():
///
///     sum_v shares_v to_vertices(B)_v = sum_p result_p B_p    for every B.
///
/// `shares` are vertices x columns, the result is patches x columns.
BandArray shares_of_patches(const PatchMesh& mesh, const BandArray& shares);

/// Shares of patches in the light that gather_indirect() finds: the irradiance of each point by
/// radiosity 1 of one band of one patch alone, patches x (points x bands), the bands of a point
/// side by side. Throws as gather_shares() does.
BandArray gather_patch_shares(const LitScene& lit, const GatherPoints& points,
                              const GatherOptions& options);

/// The radiosity that the first gather reads, W/m^2, vertices x columns: that of patches, smoothed
/// to vertices, without the emission that `direct_light` owns.
BandArray patch_to_vertex(const PatchMesh& mesh, const DirectLight& direct_light,
                          const BandArray& patch_radiosity);

/// Scales the radiosity that gathers read (W/m^2, vertices x columns) to the power that the
/// patches' equations balanced. Interpolation between vertices that are far apart cuts peaks off,
/// and their power would be lost at each reflection.
///
/// - One factor per band serves a neighbourhood of patches that lie near each other and face alike:
///   of 200 to 400 in a scene of 20 000 patches, of twice as many in one of half as many, and of
///   all in a scene of 2800. A factor for each patch would be worse: in corners and beside
///   objects that stand on a patch, the error of the patch's own value exceeds the power that the
///   factor restores, and large patches err more than small ones.
/// - A patch whose power is off by a notable share of the scene's light (see notable_share), such
///   as the place that a spotlight falls on, has a factor of its own. Its light would otherwise be
///   spread over the surfaces around.
///
/// Each channel has factors of its own: sunlight that falls between vertices says nothing of a lamp
/// beside it, whose light would be wrong when the sun is dimmed.
void keep_power(const PatchMesh& mesh, const DirectLight& direct_light,
                const BandArray& patch_radiosity, BandArray& radiosity);

/// Evens out pools of lamps' light that are narrower than elements. A lamp at a distance d from a
/// surface lights a pool of a width of about 2 d, with an irradiance I / d^2 in its middle: without
/// bound where a vertex lies there, and lost where none does.
///
/// A pool is a patch whose power, as `direct` and `others` make it, is off from that of
/// `patch_radiosity` by a notable share of all power (see notable_share) and by more than a
/// quarter: elements that resolve a pool err by some percent. An error within the noise of the
/// lamps' rays is none. The vertices of pools get the mean irradiance that the patches' equations
/// balanced, with `others` in it. Nothing changes in scenes without lamps, on sheets, which take
/// light from two sides, on patches that shine, and in bands without reflection.
///
/// `patch_radiosity` (W/m^2, patches x columns) is at full scale, by `free_rays` rays of lamps (see
/// cast_free_light); `direct` and `others`, W/m^2, are vertices x columns.
void spread_pools(const LitScene& lit, const BandArray& patch_radiosity, const BandArray& others,
                  int free_rays, BandArray& direct);

}  // namespace lightwell
