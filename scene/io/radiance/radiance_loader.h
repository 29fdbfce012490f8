#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/radiance_primitive.h"
#include "scene/io/remarks.h"

namespace lightwell {

/// Reads the files of a RADIANCE scene and evaluates the commands in them, xform, cat and the
/// generators, itself: no line of a file is ever given to a shell. Ends with an InputError where
/// files include each other in a circle, or beyond what any scene holds.
class RadianceLoader {
 public:
  /// `folder`: of the scene, where files are looked for if they are not beside what names them; its
  /// "lib" comes last.
  RadianceLoader(std::filesystem::path folder, Remarks& remarks)
      : folder_(std::move(folder)), remarks_(remarks) {}

  /// Gives `sink` all primitives of a file, those of its commands in their places.
  void read(const std::filesystem::path& path, const RadianceSink& sink);
  /// The same for the file or, after an exclamation mark, the command that `name` is.
  void read_named(const std::string& name, const RadianceLocation& location,
                  const RadianceSink& sink);
  /// The file that something in another one names. Throws InputError if there is none.
  std::filesystem::path find(const std::string& name, const RadianceLocation& location) const;
  /// A path that stays where it is as long as the loader.
  const std::filesystem::path& keep(const std::filesystem::path& path) {
    return *paths_.insert(path).first;
  }

 private:
  using Program = std::vector<std::string>;
  void run(const std::string& command, const RadianceLocation& location, const RadianceSink& sink);
  void run_last(std::span<const Program> pipe, const RadianceLocation& location,
                const RadianceSink& sink);
  void run_xform(std::span<const Program> pipe, const RadianceLocation& location,
                 const RadianceSink& sink);
  void skip_sky(const Program& program, const RadianceLocation& location, const RadianceSink& sink);
  void account(std::uintmax_t bytes, const RadianceLocation& location);
  void account_facets(std::int64_t facets, const RadianceLocation& location);

  std::filesystem::path folder_;
  Remarks& remarks_;
  std::set<std::filesystem::path> paths_;
  std::vector<std::filesystem::path> open_;  // files that include the current one, and it
  int commands_ = 0;
  std::uintmax_t bytes_ = 0;
  std::int64_t facets_ = 0;  // of generators, also those without area
};

}  // namespace lightwell
