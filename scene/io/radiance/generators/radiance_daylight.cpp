#include "scene/io/radiance/generators/radiance_daylight.h"

#include "scene/io/radiance/generators/radiance_sky_call.h"

namespace lightwell {

bool is_radiance_sky(std::string_view program) {
  return program == "gensky" || program == "gendaylit";
}

void pass_radiance_sky(const std::vector<std::string>& words, const RadianceLocation& location,
                       Remarks& remarks, const RadianceSink& sink) {
  SkyCall call(words, location);
  if (words.front() == "gensky") return pass_gensky(call, sink);
  pass_gendaylit(call, remarks, sink);
}

}  // namespace lightwell
