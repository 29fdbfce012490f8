// Sizes of IES TM-33, in metres: emission areas on the faces of a luminaire, and its dimensions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/io/luminaires/tm33_file.h"

namespace lightwell {
namespace {

// Larger sizes are millimetres: no luminaire on a goniophotometer is longer.
constexpr double largest_luminaire = 20.0;  // m

// Rectangle on a face, in metres from its middle.
struct Tm33Extent {
  double low_length = std::numeric_limits<double>::infinity(), high_length = -low_length;
  double low_width = low_length, high_width = -low_length;
  int areas = 0;
  bool is_round = false;

  bool is_off_middle() const {
    constexpr double rounding = 1e-6;  // m
    return std::abs(low_length + high_length) > rounding ||
           std::abs(low_width + high_width) > rounding;
  }
};

double size_of(const XmlFile& file, const pugi::xml_node& parent, const char* name) {
  const double size = tm33_number(file, parent, name).value_or(0.0);
  if (!(size >= 0.0)) {
    file.fail(parent, fmt::format("{} is {:g} m; it must not be below 0", name, size));
  }
  return size;
}

void add_areas(const XmlFile& file, const pugi::xml_node& face, const char* name,
               Tm33Extent& extent) {
  for (const pugi::xml_node area : face.children(name)) {
    const double length = size_of(file, area, "Length"), width = size_of(file, area, "Width");
    const double along = tm33_number(file, area, "LengthOffset").value_or(0.0);
    const double across = tm33_number(file, area, "WidthOffset").value_or(0.0);
    extent.low_length = std::min(extent.low_length, along - length / 2.0);
    extent.high_length = std::max(extent.high_length, along + length / 2.0);
    extent.low_width = std::min(extent.low_width, across - width / 2.0);
    extent.high_width = std::max(extent.high_width, across + width / 2.0);
    const std::string circular = tm33_word(area.child_value("Circular"));
    ++extent.areas;
    extent.is_round = extent.areas == 1 && (circular == "true" || circular == "1");
  }
}

void set_opening(const Tm33Extent& extent, LuminaireFile& luminaire) {
  const double length = extent.high_length - extent.low_length;
  const double width = extent.high_width - extent.low_width;
  if (!(std::max(length, width) <= largest_luminaire)) {
    luminaire.notes.push_back(
        fmt::format("Its emission areas of {:g} x {:g} m are larger than any luminaire, as if in "
                    "millimetres, and left out.",
                    length, width));
    return;
  }
  luminaire.opening = {.along_c0 = width, .along_c90 = length, .is_round = extent.is_round};
  if (extent.areas > 1) {
    luminaire.notes.push_back(fmt::format(
        "Its {} emission areas are one opening here, the rectangle around them.", extent.areas));
  }
  if (extent.is_off_middle()) {
    luminaire.notes.emplace_back(
        "Its emission areas lie off the middle of the luminaire; here they lie about the position "
        "of the lamp.");
  }
}

void read_body(const XmlFile& file, const pugi::xml_node& element, LuminaireFile& luminaire) {
  const pugi::xml_node sizes = element.child("Dimensions");
  const LampBody body = {.along_c0 = size_of(file, sizes, "Width"),
                         .along_c90 = size_of(file, sizes, "Length"),
                         .height = size_of(file, sizes, "Height"),
                         .is_round = tm33_word(element.child_value("Shape")) == "align_z"};
  if (std::max({body.along_c0, body.along_c90, body.height}) <= largest_luminaire) {
    luminaire.body = body;
    return;
  }
  luminaire.notes.push_back(
      fmt::format("Its dimensions of {:g} x {:g} x {:g} m are larger than any luminaire, as if in "
                  "millimetres, and left out.",
                  body.along_c90, body.along_c0, body.height));
}

}  // namespace

void read_tm33_sizes(const XmlFile& file, const pugi::xml_node& root, LuminaireFile& luminaire) {
  if (const pugi::xml_node element = root.child("Luminaire")) read_body(file, element, luminaire);
  Tm33Extent below, above;
  double height = 0.0;
  for (const pugi::xml_node emitter : root.children("Emitter")) {
    const pugi::xml_node areas = emitter.child("EmissionAreas");
    add_areas(file, areas.child("BottomFace"), "BottomArea", below);
    add_areas(file, areas.child("TopFace"), "TopArea", above);
    for (const char* side : {"C0", "C90", "C180", "C270"}) {
      const pugi::xml_node face = areas.child(fmt::format("{}Face", side).c_str());
      for (const pugi::xml_node area : face.children(fmt::format("{}Area", side).c_str())) {
        height = std::max(height, size_of(file, area, "Height"));
      }
    }
  }
  if (below.areas + above.areas > 0) set_opening(below.areas > 0 ? below : above, luminaire);
  if (below.areas > 0 && above.areas > 0) {
    luminaire.notes.emplace_back(
        "It has emission areas above and below; here all light leaves from those below.");
  }
  if (!(height > 0.0 && height <= largest_luminaire)) return;
  luminaire.opening_height = height;
  luminaire.notes.push_back(sideways_note(height));
}

}  // namespace lightwell
