#pragma once

namespace lightwell {

/// Light from all around, or from the sun: sources so far away that every point of the scene sees
/// them in the same directions. What a sky is made of is to be said here; none has anything yet.
struct Sky {};

}  // namespace lightwell
