#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/radiance/text/radiance_xform.h"
#include "scene/io/remarks.h"

namespace lightwell {

/// Path of a file named at `location` in a scene of the folder `folder`: beside the file that names
/// it, in `folder` or in its subfolder "lib". Empty if there is none.
std::optional<std::filesystem::path> find_radiance_file(const std::string& name,
                                                        const RadianceLocation& location,
                                                        const std::filesystem::path& folder);

/// Reads the files of a RADIANCE scene and evaluates the commands in them (xform, cat and the
/// generators). No text of a file is ever passed to a shell. Commands that cannot be evaluated,
/// files that are missing or torn, and compiled octrees and meshes without their source are left
/// out with a remark. Throws LimitError for files that include each other in a circle and for
/// scenes beyond the limits on commands, bytes and facets.
class RadianceLoader {
 public:
  /// `folder` is the folder of the scene, for find_radiance_file().
  RadianceLoader(std::filesystem::path folder, Remarks& remarks)
      : folder_(std::move(folder)), remarks_(remarks) {}

  /// Passes all primitives of a file to `sink`, with the output of a command in the command's
  /// place. Throws InputError for a file that is missing, or torn.
  void read(const std::filesystem::path& path, const RadianceSink& sink);
  /// Passes the primitives of a file, or of a command if `name` begins with an exclamation mark.
  void read_named(const std::string& name, const RadianceLocation& location,
                  const RadianceSink& sink);
  /// Path of a file named at `location`. Throws InputError if there is none.
  std::filesystem::path find(const std::string& name, const RadianceLocation& location) const;
  /// Stores a path; the reference is valid as long as the loader.
  const std::filesystem::path& keep(const std::filesystem::path& path) {
    return *paths_.insert(path).first;
  }

 private:
  using Program = std::vector<std::string>;
  bool is_open(const std::filesystem::path& path) const;
  void read_source_of(const RadiancePrimitive& compiled, const RadianceSink& sink);
  void run(const std::string& command, const RadianceLocation& location, const RadianceSink& sink);
  void run_last(std::span<const Program> pipe, const RadianceLocation& location,
                const RadianceSink& sink);
  void run_xform(std::span<const Program> pipe, const RadianceLocation& location,
                 const RadianceSink& sink);
  void place(const RadianceXform& xform, std::span<const Program> pipe,
             const RadianceLocation& location, const RadianceSink& sink);
  void skip_sky(const Program& program, const RadianceLocation& location, const RadianceSink& sink);
  void account(std::uintmax_t bytes, const RadianceLocation& location);
  void account_facets(std::int64_t facets, const RadianceLocation& location);

  std::filesystem::path folder_;
  Remarks& remarks_;
  std::set<std::filesystem::path> paths_;
  // The current file and the files that include it, outermost first.
  std::vector<std::filesystem::path> open_;
  int commands_ = 0;
  std::uintmax_t bytes_ = 0;
  std::int64_t facets_ = 0;  // output of generators, facets without area included
};

}  // namespace lightwell
