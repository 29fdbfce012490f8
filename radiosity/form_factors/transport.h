#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "mesh/patches/patch_mesh.h"
#include "radiosity/form_factors/form_factors.h"

namespace lightwell {

/// Method of exchange between patches.
enum class Transport {
  rows_in_memory,  ///< form factors computed once, stored, and used by a solver
  rows_on_disk,    ///< as rows_in_memory, but rows beyond the budget go into a file
  shooting         ///< progressive refinement: rows computed when a patch shoots, not stored
};

/// Inputs of choose_transport, in bytes.
struct TransportFigures {
  int patches = 0;
  std::int64_t rows = 0;      ///< upper bound of all form factors: see most_row_bytes
  std::int64_t work = 0;      ///< beside rows during assembly and solve
  std::int64_t shooting = 0;  ///< instead of both, with shooting
  std::int64_t resident = 0;  ///< resident memory of the process
  std::int64_t limit = 0;     ///< memory budget
  std::int64_t disk = 0;      ///< free space for rows: see room_on_disk
};

struct TransportChoice {
  Transport transport = Transport::rows_in_memory;
  /// One sentence: the choice, its reason, and the budget that would change it.
  std::string reason{};
};

/// Most bytes of rows on disk. With more, each of about 20 passes over the rows would take over
/// half a minute at 200 MB/s, and shooting needs no rows.
inline constexpr std::int64_t most_rows_on_disk = std::int64_t{8} << 30;

/// Form factors are stored where they fit, because stored rows estimate every exchange from both
/// ends:
///   - in memory if they fit into the budget;
///   - on disk if they are at most half of the free space, at most most_rows_on_disk, and a slice
///     of rows fits into memory;
///   - otherwise patches shoot;
///   - if even shooting does not fit: rows in memory, for which MemoryBudget reports the required
///     amount.
TransportChoice choose_transport(const TransportFigures& figures);

/// Upper bound of the bytes of the rows of `patches` patches. With rays: the patches that a row's
/// rays meet, and as many on average whose rays meet the patch. With the analytic and hemicube
/// methods: all patches.
std::int64_t most_row_bytes(int patches, const FormFactorOptions& options);

/// Bytes needed beside rows: numbers per patch during assembly and solve, and counters per thread.
std::int64_t bytes_beside_rows(const PatchMesh& mesh, std::int64_t emitters,
                               const FormFactorOptions& options);

/// Bytes of progressive refinement beside the mesh, with at most `most_rays` rays per shot.
std::int64_t bytes_to_shoot(const PatchMesh& mesh, int most_rays);

/// Bytes of the light on vertices and elements during the gather, without refinement. Rows are
/// released by then.
std::int64_t bytes_to_gather(const PatchMesh& mesh);

/// Most elements of refinement where `bytes` are left for them and light has `columns` columns
/// (bands of each channel). An element takes memory in the solution and in the search for splits.
/// Rounded down to sixteenths of a power of two, so that the resident memory of a process hardly
/// ever affects the result.
std::int64_t elements_in(std::int64_t bytes, std::int64_t columns);

/// Free bytes in a folder; 0 if unknown, or if the folder is itself kept in memory.
std::int64_t room_on_disk(const std::filesystem::path& folder);

}  // namespace lightwell
