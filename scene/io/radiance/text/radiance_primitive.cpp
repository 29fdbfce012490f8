#include "scene/io/radiance/text/radiance_primitive.h"

#include <fmt/format.h>

#include <map>

#include "scene/errors.h"
#include "scene/io/text_file.h"

namespace lightwell {
namespace {

using Kind = RadianceKind;

const std::map<std::string_view, Kind>& kinds() {
  static const std::map<std::string_view, Kind> table = [] {
    std::map<std::string_view, Kind> result;
    const auto add = [&](Kind kind, std::initializer_list<const char*> types) {
      for (const char* type : types) result.emplace(type, kind);
    };
    add(Kind::surface, {"source", "sphere", "bubble", "polygon", "cone", "cup", "cylinder", "tube",
                        "ring", "instance", "mesh"});
    add(Kind::material, {"light",      "illum",    "glow",     "spotlight", "mirror",    "prism1",
                         "prism2",     "mist",     "plastic",  "metal",     "plastic2",  "metal2",
                         "trans",      "trans2",   "ashik2",   "glass",     "plasfunc",  "metfunc",
                         "dielectric", "BRTDfunc", "plasdata", "interface", "transfunc", "metdata",
                         "transdata",  "WGMDfunc", "BSDF",     "aBSDF",     "antimatter"});
    add(Kind::texture, {"texfunc", "texdata"});
    add(Kind::pattern,
        {"brightfunc", "brightdata", "brighttext", "colorfunc", "colordata", "colorpict",
         "colortext", "specfunc", "specdata", "specpict", "specfile", "spectrum"});
    add(Kind::mixture, {"mixfunc", "mixdata", "mixpict", "mixtext"});
    add(Kind::alias, {"alias"});
    return result;
  }();
  return table;
}

}  // namespace

std::string RadianceLocation::sentence(std::string_view problem) const {
  if (line == 0) return fmt::format("{}: {}", file->string(), problem);
  return fmt::format("{}:{}: {}", file->string(), line, problem);
}

void RadianceLocation::fail(std::string_view problem) const {
  throw InputError(sentence(problem));
}

void RadianceLocation::fail_limit(std::string_view problem) const {
  throw LimitError(sentence(problem));
}

RadianceKind radiance_kind(std::string_view type) {
  const auto found = kinds().find(type);
  return found == kinds().end() ? Kind::unknown : found->second;
}

void RadiancePrimitive::fail(std::string_view problem) const {
  location.fail(fmt::format("{} '{}' {}", type, excerpt(name), problem));
}

void RadiancePrimitive::require_reals(std::size_t count) const {
  if (reals.size() == count) return;
  fail(fmt::format("has {} real argument{}; it needs {}", reals.size(),
                   reals.size() == 1 ? "" : "s", count));
}

}  // namespace lightwell
