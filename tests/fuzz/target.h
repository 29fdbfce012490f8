#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace lightwell::fuzz {

/// Changes bytes at random, to at most `longest` of them: libFuzzer's own mutations.
using ByteMutator = std::function<std::string(std::string bytes, std::size_t longest)>;

/// A reader and the form of its files.
struct Target {
  std::string_view name{};
  /// Reads `bytes` as a file of the target. Returns, or throws InputError; anything else is a
  /// finding.
  void (*read)(std::string_view bytes) = nullptr;
  /// Changes the contents of a file and repairs the checksums that guard them, since random changes
  /// alone would end at the checksum. Null: `mutate_bytes` changes the file itself.
  std::string (*mutate)(const std::string& file, const ByteMutator& mutate_bytes,
                        std::uint64_t seed) = nullptr;
  std::string_view sources{};  ///< folder whose string literals are words of the format, or none
};

std::span<const Target> targets();

// The readers.
/// Reads a scene from a file called `name`, and walks over all of the scene as its hash does.
Scene read_scene_file(const std::string& name, std::string_view bytes);
void read_epw_year(std::string_view bytes);
void read_honeybee_parts(std::string_view bytes);
void read_stf_design(std::string_view bytes);
void read_wea_year(std::string_view bytes);
void read_toml_scene(std::string_view bytes);
void read_obj_and_mtl(std::string_view bytes);
void read_serialized(std::string_view bytes);
void read_ies_luminaire(std::string_view bytes);
void read_ldt_luminaire(std::string_view bytes);
void read_tm33_luminaire(std::string_view bytes);
void read_png_or_jpeg(std::string_view bytes);
void read_exr_picture(std::string_view bytes);
void read_hdr_picture(std::string_view bytes);
void read_spectrum(std::string_view bytes);
void read_points(std::string_view bytes);
void read_cue_list(std::string_view bytes);
void read_road_file(std::string_view bytes);
void read_road_surface(std::string_view bytes);
void read_sport_table(std::string_view bytes);
void read_rating_table(std::string_view bytes);
void read_room_table(std::string_view bytes);
void read_colours(std::string_view bytes);
void read_solved(std::string_view bytes);
void read_checkpoint(std::string_view bytes);

// The changes of files with checksums.
std::string mutate_png(const std::string& file, const ByteMutator& mutate_bytes,
                       std::uint64_t seed);
std::string mutate_serialized(const std::string& file, const ByteMutator& mutate_bytes,
                              std::uint64_t seed);
std::string mutate_solution(const std::string& file, const ByteMutator& mutate_bytes,
                            std::uint64_t seed);
std::string mutate_journal(const std::string& file, const ByteMutator& mutate_bytes,
                           std::uint64_t seed);

}  // namespace lightwell::fuzz
