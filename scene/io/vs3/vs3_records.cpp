#include "scene/io/vs3/vs3_records.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

namespace lightwell {
namespace {

using Words = std::vector<std::string_view>;

// Blanks and commas separate words; a word that begins with / or ! begins a comment.
Words split(std::string_view text) {
  constexpr std::string_view separators = " ,\t\r\f\v";
  Words words;
  while (true) {
    const std::size_t first = text.find_first_not_of(separators);
    if (first == std::string_view::npos || text[first] == '/' || text[first] == '!') return words;
    text.remove_prefix(first);
    const std::size_t length = std::min(text.find_first_of(separators), text.size());
    words.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
}

char capital(char c) {
  return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}

class Vs3Parser {
 public:
  explicit Vs3Parser(const TextFile& file) : file_(file) {}

  Vs3Content parse() {
    file_.for_each_line([&](int line, std::string_view text) {
      line_ = line;
      const Words words = split(text);
      if (is_over_ || words.empty()) return;
      if (words[0][0] == '*') {
        is_over_ = true;
      } else if (numbers_wanted_ > 0) {
        read_numbers(words);
      } else {
        read_record(words, text);
      }
    });
    if (numbers_wanted_ > 0) fail("the last surface ends before all its numbers are given");
    if (content_.surfaces.empty()) {
      fail("the file ends without a surface; S records with vertex numbers are needed");
    }
    resolve_vertices();
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { file_.fail(line_, what); }

  void read_record(const Words& words, std::string_view text) {
    switch (const char key = capital(words[0][0])) {
      case 'T':
        content_.title = trimmed(trimmed(text).substr(words[0].size()));
        break;
      case 'C':
        read_control({words.begin() + 1, words.end()});
        break;
      case 'F':
        read_format(words);
        break;
      case 'G':
        fail(
            "a G record describes a two-dimensional geometry; only three-dimensional ones (F 3) "
            "can be read");
      case 'V':
        require_format();
        read_vertex(words);
        break;
      case 'S':
      case 'M':
      case 'N':
      case 'O':
        require_format();
        read_surface(static_cast<Vs3Record::Kind>(key), words);
        break;
      case 'X':
        content_.has_transformation = true;
        break;
      case 'E':
        is_over_ = true;
        break;
      default:
        fail(fmt::format("'{}' begins no record; there are T, C, F, V, S, N, O and E", words[0]));
    }
  }

  void read_format(const Words& words) {
    const std::string_view format = words.size() > 1 ? words[1] : std::string_view();
    if (format == "3") {
      is_shape_format_ = false;
    } else if (format == "3a" || format == "3A") {
      is_shape_format_ = true;
    } else {
      fail(
          fmt::format("the geometry's format is '{}'; only the three-dimensional formats 3 and "
                      "3a can be read",
                      format));
    }
    has_format_ = true;
  }

  void require_format() const {
    if (!has_format_) fail("an F record must come before vertices and surfaces; write 'F 3'");
  }

  // Control words and numbers such as "encl=1 eps = 1e-4", separated by blanks or equal signs.
  void read_control(const Words& words) {
    std::string joined;
    for (const std::string_view word : words) joined.append(word).append(" ");
    for (char& c : joined) c = c == '=' ? ' ' : c;
    const Words parts = split(joined);
    for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
      if (parts[i] == "encl") content_.encl = whole(parts[i + 1], "encl") != 0;
      if (parts[i] == "emit") content_.emit = whole(parts[i + 1], "emit") != 0;
    }
  }

  double number(std::string_view word, const char* what) const {
    const auto value = parse_finite(word);
    if (!value) fail(fmt::format("the {} is '{}', which is not a finite number", what, word));
    return *value;
  }

  int whole(std::string_view word, const char* what) const {
    const double value = number(word, what);
    constexpr double most = 1e9;
    if (!(std::abs(value) <= most) || value != std::floor(value)) {
      fail(fmt::format("the {} is '{}'; a whole number is needed", what, word));
    }
    return static_cast<int>(value);
  }

  void expect_number(std::string_view word, std::size_t next, const char* what) const {
    if (whole(word, what) != static_cast<int>(next)) {
      fail(fmt::format("the {} is {}, where {} is next; number them from 1 without gaps", what,
                       word, next));
    }
  }

  void read_vertex(const Words& words) {
    if (is_shape_format_) fail("format 3a has no vertices; write F 3 for vertices and surfaces");
    if (words.size() < 5) fail("a vertex needs its number and three coordinates: V n x y z");
    expect_number(words[1], vertices_.size() + 1, "vertex number");
    vertices_.emplace_back(number(words[2], "x coordinate"), number(words[3], "y coordinate"),
                           number(words[4], "z coordinate"));
  }

  void read_surface(Vs3Record::Kind kind, const Words& words) {
    const bool is_obstruction = kind == Vs3Record::Kind::obstruction;
    // Words for a shape's letter or vertex numbers.
    const std::size_t places = is_shape_format_ ? 1 : 4;
    const std::size_t least = 2 + places + (is_obstruction ? 0 : 3);
    if (words.size() < least) {
      fail(fmt::format("a surface of {} words is too short; write '{} {}{}'", words.size(),
                       words[0], is_shape_format_ ? "n shape" : "n v1 v2 v3 v4",
                       is_obstruction ? "" : " base cmb emit name"));
    }
    if (is_obstruction) {
      has_obstructions_ = true;
    } else if (has_obstructions_) {
      fail("obstructions (O) must come after all other surfaces");
    }
    expect_number(words[1], content_.surfaces.size() + 1, "surface number");
    Vs3Record record{.kind = kind, .line = line_};
    if (!is_obstruction) {
      record.base = whole(words[2 + places], "base surface");
      record.combine = whole(words[3 + places], "surface to combine with");
      record.emittance = number(words[4 + places], "emittance");
      if (!(record.emittance >= 0.0 && record.emittance <= 1.0)) {
        fail(fmt::format("the emittance is {}; it must lie in 0 to 1", words[4 + places]));
      }
      if (words.size() > least) record.name = words[least];
    }
    if (record.name.empty()) record.name = fmt::format("surface {}", words[1]);
    content_.surfaces.push_back(std::move(record));
    if (is_shape_format_) {
      begin_shape(words[2]);
    } else {
      std::array<int, 4> corners;
      for (std::size_t i = 0; i < 4; ++i) corners[i] = whole(words[2 + i], "vertex");
      corners_.push_back(corners);
    }
  }

  // Resolved at the end, because vertices may follow the surfaces that use them.
  void resolve_vertices() {
    for (std::size_t s = 0; s < corners_.size(); ++s) {
      Vs3Record& record = content_.surfaces[s];
      line_ = record.line;
      const std::size_t count = corners_[s][3] == 0 ? 3 : 4;
      for (std::size_t i = 0; i < count; ++i) {
        const int v = corners_[s][i];
        if (v < 1 || v > static_cast<int>(vertices_.size())) {
          fail(fmt::format("surface {} names vertex {}; there are vertices 1 to {}", s + 1, v,
                           vertices_.size()));
        }
        record.loop.push_back(vertices_[static_cast<std::size_t>(v - 1)]);
      }
    }
  }

  void begin_shape(std::string_view shape) {
    constexpr std::size_t plane_numbers = 5;  // origin, azimuth, tilt
    shape_ = capital(shape[0]);
    numbers_.clear();
    if (shape_ == 'R') {
      numbers_wanted_ = plane_numbers + 2;
    } else if (shape_ == 'T') {
      numbers_wanted_ = plane_numbers + 6;
    } else if (shape_ == 'Q') {
      numbers_wanted_ = plane_numbers + 8;
    } else {
      fail(
          fmt::format("the shape is '{}'; there are R (rectangle), T (triangle) and Q "
                      "(quadrilateral)",
                      shape));
    }
  }

  void read_numbers(const Words& words) {
    for (const std::string_view word : words) {
      numbers_.push_back(number(word, "shape's number"));
      if (numbers_.size() < numbers_wanted_) continue;
      numbers_wanted_ = 0;
      return finish_shape();
    }
  }

  // The azimuth of a plane is that of its normal, clockwise from +y (north). Tilt 0 faces up, 90 is
  // vertical. In the plane u points to the right as seen from the front, v upwards.
  void finish_shape() {
    const double radians = std::numbers::pi / 180.0;
    const double azimuth = numbers_[3] * radians, tilt = numbers_[4] * radians;
    const Eigen::Vector3d origin(numbers_[0], numbers_[1], numbers_[2]);
    const Eigen::Vector3d u(-std::cos(azimuth), std::sin(azimuth), 0.0);
    const Eigen::Vector3d v(-std::cos(tilt) * std::sin(azimuth),
                            -std::cos(tilt) * std::cos(azimuth), std::sin(tilt));
    std::vector<double> flat(numbers_.begin() + 5, numbers_.end());
    if (shape_ == 'R') {
      const double width = flat[0], height = flat[1];
      flat = {0.0, height, 0.0, 0.0, width, 0.0, width, height};
    }
    Loop& loop = content_.surfaces.back().loop;
    for (std::size_t i = 0; i < flat.size(); i += 2) {
      loop.emplace_back(origin + flat[i] * u + flat[i + 1] * v);
    }
  }

  const TextFile& file_;
  Vs3Content content_;
  int line_ = 1;
  bool is_over_ = false, has_format_ = false, is_shape_format_ = false, has_obstructions_ = false;
  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<int, 4>> corners_;  // by surface; fourth number 0: a triangle
  char shape_ = 'R';
  std::size_t numbers_wanted_ = 0;  // number count of the surface being read
  std::vector<double> numbers_;
};

}  // namespace

Vs3Content read_vs3_records(const TextFile& file) {
  return Vs3Parser(file).parse();
}

}  // namespace lightwell
