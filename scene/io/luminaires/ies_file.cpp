// IES LM-63: keyword lines, a TILT line, then numbers in free format.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/text_file.h"
#include "scene/utf8.h"

namespace lightwell {
namespace {

constexpr double metres_per_foot = 0.3048;
constexpr int most_ies_angles = 4000;

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

// The numbers after the TILT line, with their lines.
class Numbers {
 public:
  Numbers(const TextFile& file, int after) : file_(file) {
    file.for_each_line([&](int line, std::string_view text) {
      last_line_ = line;
      if (line <= after) return;
      while (true) {
        const std::size_t begin = text.find_first_not_of(" \t\r,;\x1a");
        if (begin == std::string_view::npos) return;
        const std::size_t end = std::min(text.find_first_of(" \t\r,;\x1a", begin), text.size());
        words_.push_back({line, text.substr(begin, end - begin)});
        text.remove_prefix(end);
      }
    });
  }

  double next(const std::string& what) {
    if (at_ == words_.size()) {
      file_.fail(last_line_,
                 fmt::format("the file ends where {} should be; it is cut short", what));
    }
    const auto [line, word] = words_[at_++];
    line_ = line;
    const auto number = parse_finite(word.starts_with('+') ? word.substr(1) : word);
    if (!number) {
      file_.fail(line,
                 fmt::format("'{}' is no number; {} should be here", as_utf8(excerpt(word)), what));
    }
    return *number;
  }
  int whole(const std::string& what, int low, int high) {
    const double number = next(what);
    if (!(number >= low && number <= high && number == std::floor(number))) {
      fail(fmt::format("{} is {:g}; it must be a whole number from {} to {}", what, number, low,
                       high));
    }
    return static_cast<int>(number);
  }
  std::vector<double> list(int count, const std::string& what) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) {
      values.push_back(next(fmt::format("{} {} of {}", what, i + 1, count)));
    }
    return values;
  }
  [[noreturn]] void fail(const std::string& problem) const { file_.fail(line_, problem); }

 private:
  struct Word {
    int line;
    std::string_view text;
  };
  const TextFile& file_;
  std::vector<Word> words_{};
  std::size_t at_ = 0;
  int line_ = 1, last_line_ = 1;
};

struct Header {
  int tilt_line = 0;
  std::string tilt{};
  bool is_in_milliwatts = false, is_in_watts = false;
};

Header read_header(const TextFile& file, LuminaireFile& result) {
  Header header;
  std::string catalogue;
  file.for_each_line([&](int line, std::string_view raw) {
    if (header.tilt_line > 0) return;
    std::string_view text = trimmed(raw);
    if (line == 1 && text.starts_with("\xef\xbb\xbf")) text = trimmed(text.substr(3));
    const std::string capitals = upper(text);
    if (line == 1) {
      result.format = capitals.starts_with("IES") ? fmt::format("IES ({})", as_utf8(text))
                                                  : "IES without a header, as in 1986";
    }
    if (capitals.starts_with("TILT")) {
      const std::size_t equals = text.find('=');
      if (equals == std::string_view::npos) return;
      header.tilt_line = line;
      header.tilt = trimmed(text.substr(equals + 1));
      return;
    }
    const std::size_t close = text.find(']');
    if (!text.starts_with('[') || close == std::string_view::npos) return;
    const std::string key = upper(text.substr(1, close - 1));
    const std::string value = as_utf8(trimmed(text.substr(close + 1)));
    if (key == "MANUFAC") result.maker = value;
    if (key == "LUMINAIRE") result.name = value;
    if (key == "LUMCAT") catalogue = value;
    if (key.find("UNIT") != std::string::npos) {
      const std::string unit = upper(value);
      header.is_in_milliwatts = unit.find("MW/SR") != std::string::npos;
      header.is_in_watts = !header.is_in_milliwatts && unit.find("W/SR") != std::string::npos;
    }
  });
  if (result.name.empty()) result.name = catalogue;
  if (header.tilt_line == 0) {
    file.fail(1, "there is no line that begins with TILT=, so this is no IES LM-63 file; give one");
  }
  return header;
}

void read_tilt(const Header& header, Numbers& numbers, LuminaireFile& result, double& factor) {
  const std::string tilt = upper(header.tilt);
  if (tilt.empty() || tilt == "NONE") return;
  if (tilt != "INCLUDE") {
    result.notes.push_back(
        fmt::format("Its TILT factors are in the file '{}', which is not read: it is taken to hang "
                    "as it was measured.",
                    as_utf8(header.tilt)));
    return;
  }
  numbers.whole("the lamp-to-luminaire geometry", 1, 3);
  const int pairs = numbers.whole("the number of TILT angles", 1, most_ies_angles);
  const std::vector<double> angles = numbers.list(pairs, "TILT angle");
  const std::vector<double> factors = numbers.list(pairs, "TILT factor");
  // A level luminaire has a tilt of 0.
  for (int i = 0; i < pairs; ++i) {
    if (angles[static_cast<std::size_t>(i)] == 0.0) factor *= factors[static_cast<std::size_t>(i)];
  }
  result.notes.emplace_back(
      "Its TILT factors are taken for a luminaire that hangs level, whatever way it is turned.");
}

void check_rising(const Numbers& numbers, const std::vector<double>& angles, const char* what) {
  for (std::size_t i = 1; i < angles.size(); ++i) {
    if (!(angles[i] > angles[i - 1])) {
      numbers.fail(fmt::format("{} angle {} is {:g}, after {:g}; they must rise", what, i + 1,
                               angles[i], angles[i - 1]));
    }
  }
}

// Luminous dimensions by LM-63-2002, table 1, also for files of 1995: a negative number marks a
// round opening.
void read_ies_sizes(double width, double length, double height, LuminaireFile& result) {
  const bool is_round = width < 0.0 || length < 0.0;
  result.opening = {
      .along_c0 = std::abs(length), .along_c90 = std::abs(width), .is_round = is_round};
  if (is_round && !(result.opening.along_c0 > 0.0)) {
    result.opening.along_c0 = result.opening.along_c90;
  }
  if (is_round && !(result.opening.along_c90 > 0.0)) {
    result.opening.along_c90 = result.opening.along_c0;
  }
  result.opening_height = std::abs(height);
  if (result.opening_height > 0.0) result.notes.push_back(sideways_note(result.opening_height));
}

}  // namespace

LuminaireFile read_ies(const std::filesystem::path& path) {
  const TextFile file(path);
  LuminaireFile result{.file = path};
  const Header header = read_header(file, result);
  Numbers numbers(file, header.tilt_line);
  double factor = 1.0;
  read_tilt(header, numbers, result, factor);

  const int lamps = numbers.whole("the number of lamps", 0, 1000000);
  const double lumens = numbers.next("the lumens of each lamp");
  factor *= numbers.next("the multiplier");
  const int gamma_count = numbers.whole("the number of vertical angles", 2, most_ies_angles);
  const int plane_count = numbers.whole("the number of horizontal angles", 1, most_ies_angles);
  const int type = numbers.whole("the photometric type", 1, 3);
  if (type != 1) {
    numbers.fail(
        fmt::format("the photometry is of type {}; only type C (1) is read, as indoor and "
                    "road luminaires have it",
                    type == 2 ? "B" : "A"));
  }
  const int unit = numbers.whole("the unit of its sizes (1 feet, 2 metres)", 1, 2);
  const double metres = unit == 1 ? metres_per_foot : 1.0;
  const double width = metres * numbers.next("the width of the opening");
  const double length = metres * numbers.next("the length of the opening");
  const double height = metres * numbers.next("the height of the opening");
  read_ies_sizes(width, length, height, result);
  factor *= numbers.next("the ballast factor");
  factor *= numbers.next("the ballast-lamp factor");
  result.watts = numbers.next("the input watts");
  if (!(factor > 0.0 && std::isfinite(factor))) {
    numbers.fail(fmt::format("its multiplier and factors make {:g}; they must be above 0", factor));
  }

  const std::vector<double> gammas = numbers.list(gamma_count, "vertical angle");
  if (!(gammas.front() >= 0.0 && gammas.back() <= 180.0)) {
    numbers.fail(
        fmt::format("the vertical angles go from {:g} to {:g}; they must lie within 0 and "
                    "180",
                    gammas.front(), gammas.back()));
  }
  check_rising(numbers, gammas, "vertical");
  const std::vector<double> planes = numbers.list(plane_count, "horizontal angle");
  check_rising(numbers, planes, "horizontal");
  Eigen::ArrayXXd values(plane_count, gamma_count);
  for (int p = 0; p < plane_count; ++p) {
    for (int g = 0; g < gamma_count; ++g) {
      const double value = numbers.next(
          fmt::format("the intensity at horizontal angle {:g}, vertical "
                      "angle {:g}",
                      planes[static_cast<std::size_t>(p)], gammas[static_cast<std::size_t>(g)]));
      if (const std::string fault = fault_of_intensity(value, factor); !fault.empty()) {
        numbers.fail(fault);
      }
      values(p, g) = factor * value;
    }
  }
  result.is_radiometric = header.is_in_milliwatts || header.is_in_watts;
  if (header.is_in_milliwatts) values *= 1e-3;
  if (lumens > 0.0 && !result.is_radiometric) result.lamp_lumens = lamps * lumens;
  const auto symmetry = symmetry_of_planes(planes);
  if (!symmetry) numbers.fail(no_symmetry_of_planes(planes));
  result.symmetry = symmetry_words(*symmetry);
  PlaneTable table = unfolded_planes(*symmetry, planes, values);
  result.web =
      std::make_shared<const PhotometricWeb>(std::move(table.planes), gammas, table.values);
  return result;
}

}  // namespace lightwell
