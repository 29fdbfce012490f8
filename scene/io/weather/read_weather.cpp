#include <fmt/format.h>

#include "scene/errors.h"
#include "scene/io/text_file.h"
#include "scene/io/weather/weather_file.h"

namespace lightwell {

Weather read_weather(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".epw") return read_epw(path);
  if (extension == ".wea") return read_wea(path);
  throw InputError(fmt::format(
      "{}: weather is read from .epw (EnergyPlus) and .wea (RADIANCE) files", path.string()));
}

}  // namespace lightwell
