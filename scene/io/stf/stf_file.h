#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/remarks.h"
#include "scene/io/text_file.h"

namespace lightwell {

/// A section of an STF file: the lines `Key=Value` below `[NAME]`. Keys in any case. Every key that
/// is asked for counts as read.
class StfSection {
 public:
  /// Keeps references. `line` is that of the heading; 0: a section that the file does not have.
  StfSection(const TextFile& file, Remarks& remarks, std::string name, int line)
      : file_(&file), remarks_(&remarks), name_(std::move(name)), line_(line) {}

  /// Adds a line; of equal keys the first counts, with a remark.
  void add(std::string_view key, std::string_view value, int line);

  const std::string& name() const { return name_; }
  bool has(std::string_view key) const;
  /// The value of a key; empty if there is none, or nothing behind the equal sign.
  std::string text(std::string_view key);
  /// The number of a key; empty if there is none. A comma counts as a decimal point, with a remark.
  /// Throws InputError for a value that is no finite number.
  std::optional<double> number(std::string_view key);
  /// The numbers of a key, at least `least`. Throws InputError for a key that is missing.
  std::vector<double> numbers(std::string_view key, std::size_t least);
  /// The first three numbers of a key, of which the last may be missing (0); `usual` without the
  /// key.
  Eigen::Vector3d vector_or(std::string_view key, const Eigen::Vector3d& usual);
  /// The number of a key that must be there and positive.
  double positive(std::string_view key);
  /// The whole number, >= 0, of a key; 0 without the key.
  std::size_t count(std::string_view key);
  /// How many keys PREFIX1, PREFIX2 ... the section has in a row, up to what the key `count` says.
  /// A remark names the section where `count` says more, or is no whole number, which counts as 0.
  std::size_t counted(std::string_view prefix, std::string_view count);
  /// A remark for every key that was not read, but for those of `known`, in lower case.
  void remark_unread(const std::set<std::string_view>& known) const;

  /// Throws InputError "file:line: KEY of [NAME] problem".
  [[noreturn]] void fail(std::string_view key, std::string_view problem) const;
  /// Throws InputError "file:line: [NAME] problem".
  [[noreturn]] void fail(std::string_view problem) const;
  /// Throws LimitError in place of InputError.
  [[noreturn]] void fail_limit(std::string_view problem) const;

 private:
  struct Entry {
    std::string key{};  // as the file has it
    std::string value{};
    int line = 0;
    bool is_read = false;
  };
  double parsed(std::string_view key, std::string_view word) const;

  const TextFile* file_;
  Remarks* remarks_;
  std::string name_;
  int line_;
  std::map<std::string, Entry, std::less<>> entries_{};  // by the key in lower case
};

/// An STF file as sections by name, in any case.
class StfFile {
 public:
  /// Throws InputError for a file that is no text of 8-bit characters, or has no [PROJECT].
  /// Remarks name lines that are neither heading nor `Key=Value`, repeated sections, and text that
  /// is not UTF-8, which is taken as Latin-1.
  StfFile(const TextFile& file, Remarks& remarks);

  /// Null if there is no such section. Blanks in names do not count.
  StfSection* find(std::string_view name);
  /// A section without keys, in place of one that the file does not have.
  StfSection absent(const std::string& name) const { return {*file_, *remarks_, name, 0}; }
  /// Remarks on sections that find() was never asked for.
  void remark_unread() const;

 private:
  struct Known {
    StfSection section;
    bool is_read = false;
  };
  std::map<std::string, Known, std::less<>> sections_{};  // by the name in lower case
  const TextFile* file_;
  Remarks* remarks_;
};

}  // namespace lightwell
