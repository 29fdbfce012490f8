#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/io/radiance/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// A call of a generator: the program's name and its arguments.
struct RadianceCall {
  const std::vector<std::string>& words;
  const RadianceLocation& location;
  Remarks& remarks;
  /// Opens a file that the call names, or throws InputError.
  std::function<TextFile(const std::string& name)> open;
  /// To be told of facets before they are computed; throws InputError if the scene has too many.
  std::function<void(std::int64_t facets)> account;

  /// Throws InputError "file:line: genbox: problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// The number that word `i` is.
  double number(std::size_t i, std::string_view what) const;
  /// The same, greater than 0.
  double positive(std::size_t i, std::string_view what) const;
  /// The same, whole, from 1 to 100 000.
  int count(std::size_t i, std::string_view what) const;
  /// Throws InputError with `usage` unless there are as many words.
  void require_words(std::size_t least, std::string_view usage) const;
};

/// Gives `sink` polygons called NAME.1, NAME.2, ... of the material that word 1 of a call names;
/// NAME is word 2.
class GeneratedPolygons {
 public:
  GeneratedPolygons(const RadianceCall& call, const RadianceSink& sink);
  /// Passes over a loop without area.
  void add(const Loop& loop);

 private:
  const RadianceSink& sink_;
  RadiancePrimitive polygon_;
  std::string name_;
  int count_ = 0;
};

/// Whether RADIANCE has a generator of this name that is evaluated here.
bool is_radiance_generator(std::string_view program);

/// Gives `sink` what the generator writes: genbox, genprism, genblinds, genrev, gensurf, genworm.
/// Throws InputError naming the place for arguments that it does not take.
void run_radiance_generator(const RadianceCall& call, const RadianceSink& sink);

void run_genbox(const RadianceCall& call, const RadianceSink& sink);
void run_genprism(const RadianceCall& call, const RadianceSink& sink);
void run_genblinds(const RadianceCall& call, const RadianceSink& sink);
void run_genrev(const RadianceCall& call, const RadianceSink& sink);
void run_gensurf(const RadianceCall& call, const RadianceSink& sink);
void run_genworm(const RadianceCall& call, const RadianceSink& sink);

}  // namespace lightwell
