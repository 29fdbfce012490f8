#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scene/io/polygon.h"
#include "scene/io/radiance/text/radiance_primitive.h"
#include "scene/io/remarks.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// A call of a generator: the program's name and its arguments.
struct RadianceCall {
  const std::vector<std::string>& words;
  const RadianceLocation& location;
  Remarks& remarks;
  /// Opens a file named in the call, or throws InputError.
  std::function<TextFile(const std::string& name)> open;
  /// Must be called with the number of facets before they are computed; throws InputError if the
  /// scene has too many.
  std::function<void(std::int64_t facets)> account;

  /// Throws InputError "file:line: genbox: problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// Word `i` as a number.
  double number(std::size_t i, std::string_view what) const;
  /// Word `i` as a number greater than 0.
  double positive(std::size_t i, std::string_view what) const;
  /// Word `i` as a whole number from 1 to 100 000.
  int count(std::size_t i, std::string_view what) const;
  /// Throws InputError with `usage` if the call has fewer than `least` words.
  void require_words(std::size_t least, std::string_view usage) const;
};

/// Passes polygons named NAME.1, NAME.2, ... to `sink`. Word 1 of the call is their material, word
/// 2 is NAME.
class GeneratedPolygons {
 public:
  GeneratedPolygons(const RadianceCall& call, const RadianceSink& sink);
  /// Adds a polygon; a loop without area is skipped.
  void add(const Loop& loop);

 private:
  const RadianceSink& sink_;
  RadiancePrimitive polygon_;
  std::string name_;
  int count_ = 0;
};

/// True if `program` is a generator of RADIANCE that this reader evaluates.
bool is_radiance_generator(std::string_view program);

/// Passes the output of a generator to `sink`: genbox, genprism, genblinds, genrev, gensurf,
/// genworm. Throws InputError naming the place for invalid arguments.
void run_radiance_generator(const RadianceCall& call, const RadianceSink& sink);

void run_genbox(const RadianceCall& call, const RadianceSink& sink);
void run_genprism(const RadianceCall& call, const RadianceSink& sink);
void run_genblinds(const RadianceCall& call, const RadianceSink& sink);
void run_genrev(const RadianceCall& call, const RadianceSink& sink);
void run_gensurf(const RadianceCall& call, const RadianceSink& sink);
void run_genworm(const RadianceCall& call, const RadianceSink& sink);

}  // namespace lightwell
