#pragma once

#include <cstddef>
#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "scene/io/text_file.h"
#include "scene/spectrum_samples.h"

namespace lightwell {

/// An XML file, whole in memory, whose elements know their lines. Entities and document types are
/// not expanded, and elements may be nested to any depth.
class XmlFile {
 public:
  /// `kind` names files of the format in messages: "TM-27 files". Throws InputError naming file and
  /// line if the file is missing, unreadable or no well-formed XML; LimitError if the file is
  /// larger than 32 MiB, because a parsed file takes up to 18 times its size in memory (empty
  /// elements).
  XmlFile(const std::filesystem::path& path, std::string_view kind);

  const pugi::xml_document& document() const { return document_; }
  /// Line of the beginning of an element, from 1.
  int line_of(const pugi::xml_node& element) const { return line_at(element.offset_debug()); }
  /// Throws InputError "file:line: problem".
  [[noreturn]] void fail(const pugi::xml_node& element, std::string_view problem) const;
  /// Value of `text`, which belongs to `element`, as a finite number. `what` names the value in the
  /// message of the InputError.
  double number(const pugi::xml_node& element, std::string_view what, std::string_view text) const;

 private:
  int line_at(std::ptrdiff_t offset) const;

  TextFile file_;
  pugi::xml_document document_{};
};

/// `text` without white space and ends of lines at either end.
std::string_view without_xml_space(std::string_view text);

/// Adds a wavelength, nm, and a value, both of `element`, to a spectrum. Throws InputError unless
/// the wavelength is above the last one.
void append_sample(const XmlFile& file, const pugi::xml_node& element, double nm, double value,
                   SpectrumSamples& samples);

/// Name of the first element of an XML file, from the first 64 KiB; empty if there is none, or no
/// such file.
std::string xml_root_name(const std::filesystem::path& path);

}  // namespace lightwell
