#include "scene/io/radiance/files/radiance_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "scene/io/nearest_name.h"
#include "scene/io/radiance/files/radiance_compiled.h"
#include "scene/io/radiance/generators/radiance_daylight.h"
#include "scene/io/radiance/generators/radiance_generators.h"
#include "scene/io/radiance/text/radiance_command.h"
#include "scene/io/radiance/text/radiance_text.h"
#include "scene/io/radiance/text/radiance_xform.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

constexpr std::size_t most_nested_includes = 32;  // files
constexpr int most_commands = 200'000;            // files that include each other multiply quickly
constexpr std::uintmax_t most_bytes = 1 << 30;    // total, repeated files counted each time
constexpr std::int64_t most_generated = 4'000'000;

const std::vector<std::string> known_programs = {"xform",     "cat",      "genbox",  "genprism",
                                                 "genblinds", "genrev",   "gensurf", "genworm",
                                                 "gensky",    "gendaylit"};

bool makes_a_sky(std::string_view program) {
  constexpr std::array<std::string_view, 3> programs = {"genssky", "gensdaymtx",
                                                        "gencumulativesky"};
  return std::ranges::find(programs, program) != programs.end();
}

}  // namespace

std::optional<std::filesystem::path> find_radiance_file(const std::string& name,
                                                        const RadianceLocation& location,
                                                        const std::filesystem::path& folder) {
  for (const auto& from : {location.file->parent_path(), folder, folder / "lib"}) {
    auto path = (from / name).lexically_normal();
    if (is_file(path)) return path;
  }
  return std::nullopt;
}

std::filesystem::path RadianceLoader::find(const std::string& name,
                                           const RadianceLocation& location) const {
  if (auto path = find_radiance_file(name, location, folder_)) return *path;
  location.fail(fmt::format(
      "names the file '{}', but there is no such file beside it, in the scene's folder or in its "
      "folder 'lib'",
      name));
}

void RadianceLoader::read(const std::filesystem::path& path, const RadianceSink& sink) {
  const TextFile file(path);
  const std::filesystem::path& kept = keep(path);
  RadianceText text(file.text(), kept);
  open_.push_back(std::filesystem::weakly_canonical(path));
  const struct Closing {
    std::vector<std::filesystem::path>& open;
    ~Closing() { open.pop_back(); }
  } closing{open_};
  while (true) {
    const RadianceText::Item item = text.next();
    if (const auto* primitive = std::get_if<RadiancePrimitive>(&item)) {
      const bool is_compiled = primitive->type == "instance" || primitive->type == "mesh";
      is_compiled ? read_source_of(*primitive, sink) : sink(*primitive);
    } else if (const auto* command = std::get_if<RadianceCommand>(&item)) {
      remarks_.attempt("Commands that cannot be evaluated were left out",
                       excerpt(trimmed(command->text)),
                       [&] { run(command->text, command->location, sink); });
    } else {
      break;
    }
  }
}

void RadianceLoader::read_named(const std::string& name, const RadianceLocation& location,
                                const RadianceSink& sink) {
  if (name.starts_with('!')) return run(name.substr(1), location, sink);
  std::filesystem::path path;
  if (!remarks_.attempt("Files are missing, with all that they hold", name,
                        [&] { path = find(name, location); })) {
    return;
  }
  if (is_open(path)) {
    location.fail_limit(
        fmt::format("includes '{}', which includes this file; break the circle", name));
  }
  if (open_.size() >= most_nested_includes) {
    location.fail_limit(
        fmt::format("includes '{}' within {} files; nest less deeply", name, most_nested_includes));
  }
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  account(error ? 0 : bytes, location);
  remarks_.attempt("Files cannot be read to their end, and the rest was left out", name,
                   [&] { read(path, sink); });
}

bool RadianceLoader::is_open(const std::filesystem::path& path) const {
  return std::ranges::find(open_, std::filesystem::weakly_canonical(path)) != open_.end();
}

// An instance is an octree compiled from scene files, a mesh is compiled from an OBJ file. What was
// compiled cannot be read, but its source may stand beside it.
void RadianceLoader::read_source_of(const RadiancePrimitive& compiled, const RadianceSink& sink) {
  const bool is_octree = compiled.type == "instance";
  const std::string name = compiled.strings.empty() ? compiled.name : compiled.strings.front();
  const std::string source =
      std::filesystem::path(name).replace_extension(is_octree ? ".rad" : ".obj").string();
  const auto path = find_radiance_file(source, compiled.location, folder_);
  if (!path || is_open(*path)) {
    return remarks_.add(
        is_octree ? "Compiled octrees cannot be read and were left out (put '!xform FILE' for the "
                    "file that each was made from in its place)"
                  : "Compiled meshes cannot be read and were left out (the OBJ file that each was "
                    "made from is read if it stands beside it)",
        name);
  }
  remarks_.add(is_octree ? "Compiled octrees were read from the scene files beside them"
                         : "Compiled meshes were read from the OBJ files beside them",
               name);
  std::span<const std::string> options(compiled.strings);
  if (!options.empty()) options = options.subspan(1);
  RadianceXform xform = parse_radiance_xform(options, compiled.location);
  if (is_octree && compiled.modifier != radiance_void) xform.modifier = compiled.modifier;
  const RadianceSink placing = [&](const RadiancePrimitive& primitive) {
    apply_xform(xform, primitive, sink);
  };
  if (is_octree) return read_named(source, compiled.location, placing);
  account(std::filesystem::file_size(*path), compiled.location);
  remarks_.attempt("Meshes that cannot be read were left out", source,
                   [&] { pass_mesh_source(compiled, *path, placing); });
}

// Limits the reading time of files without primitives that are included over and over.
void RadianceLoader::account(std::uintmax_t bytes, const RadianceLocation& location) {
  if (++commands_ > most_commands) {
    location.fail_limit(
        fmt::format("is command {} of the scene; files seem to include each other without "
                    "end",
                    commands_));
  }
  bytes_ += bytes;
  if (bytes_ > most_bytes) {
    location.fail_limit(
        fmt::format("the scene's files, as often as they are included, hold more than {} "
                    "bytes; include less",
                    most_bytes));
  }
}

void RadianceLoader::account_facets(std::int64_t facets, const RadianceLocation& location) {
  facets_ += facets;
  if (facets_ > most_generated) {
    location.fail_limit(fmt::format(
        "generators make more than {} facets; use fewer segments or copies", most_generated));
  }
}

void RadianceLoader::run(const std::string& command, const RadianceLocation& location,
                         const RadianceSink& sink) {
  account(0, location);
  const auto pipe = split_radiance_pipe(command, location);
  constexpr std::size_t longest = 64;
  if (pipe.size() > longest) {
    location.fail(fmt::format("pipes {} programs; at most {} are run", pipe.size(), longest));
  }
  run_last(pipe, location, sink);
}

// Runs the last program of a pipe; the programs before it produce its input.
void RadianceLoader::run_last(std::span<const Program> pipe, const RadianceLocation& location,
                              const RadianceSink& sink) {
  const Program& program = pipe.back();
  const std::string& name = program.front();
  if (name == "xform") return run_xform(pipe, location, sink);
  if (pipe.size() > 1) {
    location.fail(fmt::format("'{}' reads nothing from a pipe here; only xform does", name));
  }
  if (name == "cat") {
    for (std::size_t i = 1; i < program.size(); ++i) read_named(program[i], location, sink);
  } else if (is_radiance_generator(name)) {
    const auto open = [&](const std::string& file) {
      const std::filesystem::path path = find(file, location);
      require_readable(path);
      account(std::filesystem::file_size(path), location);
      return TextFile(keep(path));
    };
    const auto account = [&](std::int64_t facets) { account_facets(facets, location); };
    run_radiance_generator({program, location, remarks_, open, account}, sink);
  } else if (is_radiance_sky(name)) {
    pass_radiance_sky(program, location, remarks_, sink);
  } else if (makes_a_sky(name)) {
    skip_sky(program, location, sink);
  } else {
    location.fail(fmt::format(
        "the command '{}' is not evaluated here, and commands are never given to a shell; run it "
        "yourself and name a file with what it writes.{}",
        excerpt(name), did_you_mean(name, known_programs)));
  }
}

void RadianceLoader::run_xform(std::span<const Program> pipe, const RadianceLocation& location,
                               const RadianceSink& sink) {
  const RadianceXform xform = parse_radiance_xform(std::span(pipe.back()).subspan(1), location);
  if (!copies_turn(xform)) return place(xform, pipe, location, sink);
  // Patterns of an array that look up directions are other ones in each copy.
  for (const RadianceXform::Copy& copy : xform.copies) {
    RadianceXform one = xform;
    one.copies = {copy};
    place(one, pipe, location, sink);
  }
}

void RadianceLoader::place(const RadianceXform& xform, std::span<const Program> pipe,
                           const RadianceLocation& location, const RadianceSink& sink) {
  const RadianceSink placing = [&](const RadiancePrimitive& primitive) {
    apply_xform(xform, primitive, sink);
  };
  if (pipe.size() > 1) {
    if (!xform.files.empty()) {
      location.fail(fmt::format("xform reads the file '{}' and a pipe; give it one of them",
                                xform.files.front()));
    }
    return run_last(pipe.first(pipe.size() - 1), location, placing);
  }
  if (xform.files.empty())
    location.fail("xform has nothing to read: name a file after its options");
  for (const std::string& file : xform.files) read_named(file, location, placing);
}

// Passes on the pattern of a sky's generator, so that primitives modified by the pattern can be
// read.
void RadianceLoader::skip_sky(const Program& program, const RadianceLocation& location,
                              const RadianceSink& sink) {
  remarks_.add("Skies of other programs than gensky and gendaylit were left out", program.front());
  sink({.modifier = std::string(radiance_void),
        .type = "brightfunc",
        .name = "skyfunc",
        .strings = {"skybright", "skybright.cal"},
        .location = location});
}

}  // namespace lightwell
