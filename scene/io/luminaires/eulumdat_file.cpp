// EULUMDAT: one value a line, in a fixed order (Stockmar 1990).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/text_file.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr int most_eulumdat_angles = 4000;

// The lines of a file in order, numbered from 1.
class Lines {
 public:
  explicit Lines(const TextFile& file) : file_(file) {
    file.for_each_line([&](int line, std::string_view text) {
      if (line == 1 && text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
      lines_.push_back(trimmed(text));
    });
    while (!lines_.empty() && (lines_.back().empty() || lines_.back() == "\x1a")) lines_.pop_back();
  }

  std::string_view text(const char* what) {
    if (at_ == lines_.size()) {
      file_.fail(static_cast<int>(at_),
                 fmt::format("the file ends where {} should be; it is cut short", what));
    }
    return lines_[at_++];
  }
  // Some programs write decimal commas, which are accepted.
  std::optional<double> number_or_text(const char* what) {
    std::string word(text(what));
    std::ranges::replace(word, ',', '.');
    return parse_finite(word);
  }
  double number(const char* what) {
    const auto found = number_or_text(what);
    if (!found) {
      fail(fmt::format("there is no number where {} should be", what));
    }
    return *found;
  }
  int whole(const char* what, int low, int high) {
    const double found = number(what);
    if (!(found >= low && found <= high && found == std::floor(found))) {
      fail(fmt::format("{} is {:g}; it must be a whole number from {} to {}", what, found, low,
                       high));
    }
    return static_cast<int>(found);
  }
  void skip(int count, const char* what) {
    for (int i = 0; i < count; ++i) text(what);
  }
  [[noreturn]] void fail(const std::string& problem) const {
    file_.fail(static_cast<int>(at_), problem);
  }

 private:
  const TextFile& file_;
  std::vector<std::string_view> lines_{};
  std::size_t at_ = 0;
};

struct LampSet {
  double lumens = 0.0, watts = 0.0;
  bool is_absolute = false;
};

LampSet read_lamp_set(Lines& lines) {
  LampSet set;
  // A negative number of lamps marks absolute photometry: the flux is the luminaire's.
  set.is_absolute = lines.number("the number of lamps") < 0.0;
  lines.text("the type of lamps");
  set.lumens = lines.number("the flux of the lamps");
  if (!(set.lumens > 0.0)) {
    lines.fail(fmt::format("the flux of the lamps is {:g} lm; it must be above 0", set.lumens));
  }
  lines.skip(2, "the colour of the lamps");  // words and classes, such as '1A/>90'
  set.watts = lines.number_or_text("the watts of the lamps").value_or(0.0);
  return set;
}

// First index and number of the stored planes, numbered from 0 as in EULUMDAT.
std::pair<int, int> stored_planes(PlaneSymmetry symmetry, int count) {
  using enum PlaneSymmetry;
  switch (symmetry) {
    case all_around:
      return {0, 1};
    case about_c0:
      return {0, count / 2 + 1};
    case about_c90:
      return {3 * count / 4, count / 2 + 1};
    case quarters:
      return {0, count / 4 + 1};
    default:
      return {0, count};
  }
}

void read_eulumdat_sizes(Lines& lines, LuminaireFile& result) {
  constexpr double mm = 0.001;
  // Sizes that are no numbers, or not above 0, are of no body; light does not need them.
  const auto size = [&] {
    return mm * lines.number_or_text("the size of the luminaire").value_or(0.0);
  };
  const double body_length = size(), body_width = size(), body_height = size();
  result.body = {.along_c0 = body_width > 0.0 ? body_width : body_length,
                 .along_c90 = body_length,
                 .height = body_height,
                 .is_round = !(body_width > 0.0)};
  const double length = mm * lines.number("the length of the luminous area");
  const double width = mm * lines.number("the width of the luminous area");
  if (!(length >= 0.0 && width >= 0.0)) lines.fail("the luminous area must not be below 0");
  result.opening = {.along_c0 = width > 0.0 ? width : length,
                    .along_c90 = length,
                    .is_round = !(width > 0.0) && length > 0.0};
  double height = 0.0;
  for (int i = 0; i < 4; ++i) {
    height = std::max(height, mm * lines.number("a height of the luminous area"));
  }
  result.opening_height = height;
  if (height > 0.0) result.notes.push_back(sideways_note(height));
}

}  // namespace

LuminaireFile read_eulumdat(const std::filesystem::path& path, int lamp_set) {
  using enum PlaneSymmetry;
  const TextFile file(path);
  Lines lines(file);
  LuminaireFile result{.file = path, .format = "EULUMDAT"};
  result.maker = as_utf8(lines.text("the maker"));
  lines.number("the type");
  const auto symmetry = static_cast<PlaneSymmetry>(
      lines.whole("the symmetry", static_cast<int>(none), static_cast<int>(quarters)));
  result.symmetry = symmetry_words(symmetry);
  const int plane_count = lines.whole("the number of C planes", 1, most_eulumdat_angles);
  const int divisor = symmetry == quarters || symmetry == about_c90 ? 4
                      : symmetry == about_c0                        ? 2
                                                                    : 1;
  if (plane_count % divisor != 0) {
    lines.fail(fmt::format("there are {} C planes, and its symmetry needs a multiple of {}",
                           plane_count, divisor));
  }
  lines.number_or_text("the angle between C planes");
  const int gamma_count = lines.whole("the number of angles gamma", 2, most_eulumdat_angles);
  lines.number_or_text("the angle between gammas");
  lines.text("the report's number");
  result.name = as_utf8(lines.text("the luminaire's name"));
  lines.skip(3, "the luminaire's number, file and date");
  read_eulumdat_sizes(lines, result);
  lines.number("the downward flux fraction");
  lines.number("the light output ratio");
  double factor = lines.number("the conversion factor");
  if (!(factor > 0.0)) {
    if (factor < 0.0) lines.fail("the conversion factor must not be below 0");
    factor = 1.0;
    result.notes.emplace_back("Its conversion factor is 0; 1 is meant.");
  }
  lines.number_or_text("the tilt of the luminaire");
  constexpr int most_sets = 20;
  const int set_count = lines.whole("the number of lamp sets", 1, most_sets);
  if (lamp_set < 1 || lamp_set > set_count) {
    lines.fail(
        fmt::format("there are {} sets of lamps, and set {} is asked for", set_count, lamp_set));
  }
  LampSet lamps;
  for (int i = 1; i <= set_count; ++i) {
    const LampSet set = read_lamp_set(lines);
    if (i == lamp_set) lamps = set;
  }
  if (set_count > 1) {
    result.notes.push_back(
        fmt::format("It has {} sets of lamps to choose from; this is set {}, of {:g} lm.",
                    set_count, lamp_set, lamps.lumens));
  }
  constexpr int direct_ratios = 10;
  lines.skip(direct_ratios, "a direct ratio");

  std::vector<double> angles, gammas;
  for (int i = 0; i < plane_count; ++i) angles.push_back(lines.number("an angle C"));
  for (int i = 0; i < gamma_count; ++i) {
    gammas.push_back(lines.number("an angle gamma"));
    const bool rises = i == 0 || gammas.back() > gammas[static_cast<std::size_t>(i) - 1];
    if (!rises || !(gammas.back() >= 0.0 && gammas.back() <= 180.0)) {
      lines.fail(
          fmt::format("an angle gamma is {:g}; they must rise within 0 and 180", gammas.back()));
    }
  }
  const auto [first, stored_count] = stored_planes(symmetry, plane_count);
  const double candela = factor * lamps.lumens / 1000.0;  // the table is per 1000 lm
  std::vector<double> stored;
  Eigen::ArrayXXd values(stored_count, gamma_count);
  for (int p = 0; p < stored_count; ++p) {
    stored.push_back(angles[static_cast<std::size_t>((first + p) % plane_count)]);
    for (int g = 0; g < gamma_count; ++g) {
      const double value = lines.number("an intensity");
      if (const std::string fault = fault_of_intensity(value, candela); !fault.empty()) {
        lines.fail(fault);
      }
      values(p, g) = candela * value;
    }
  }
  result.watts = lamps.watts;
  if (!lamps.is_absolute) result.lamp_lumens = lamps.lumens;
  PlaneTable table = unfolded_planes(symmetry, stored, values);
  if (table.planes.front() != 0.0) lines.fail("there is no plane C0; there must be one");
  result.web =
      std::make_shared<const PhotometricWeb>(std::move(table.planes), gammas, table.values);
  return result;
}

}  // namespace lightwell
