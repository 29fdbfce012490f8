#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/io/luminaires/luminaire_file.h"
#include "scene/io/xml_file.h"

namespace lightwell {

/// True for the root elements of TM-33-18 (IESTM33, IESTM33-18) and TM-33-23 (IESTM33-22).
bool is_tm33_root(std::string_view name);

/// `text` in lower case and without blanks: "Symm _ Bi _90" of one copy of the schema is the
/// "Symm_Bi_90" of another.
std::string tm33_word(std::string_view text);

/// Number in a child element; empty if there is no such child. Throws InputError if the child is no
/// finite number.
std::optional<double> tm33_number(const XmlFile& file, const pugi::xml_node& parent,
                                  const char* child);

/// Intensities of an emitter, candela or W/sr: a row for each plane C, a column for each gamma.
struct Tm33Table {
  std::vector<double> planes{};  ///< degrees, of the whole circle, rising from 0
  std::vector<double> gammas{};  ///< degrees, rising within 0 and 180
  Eigen::ArrayXXd values{};
  PlaneSymmetry symmetry = PlaneSymmetry::none;
};

/// Reads the element LuminousIntensity or RadiantIntensity; `factor` multiplies its values. Throws
/// InputError unless each pair of angles has one value from 0 to 1e18.
Tm33Table read_tm33_table(const XmlFile& file, const pugi::xml_node& intensity, double factor);

/// Sum of at least one table on the angles of all. A table is linear between its angles and 0
/// beyond them; where one ends before others do, the sum falls within 1e-6 degrees. Throws
/// LimitError naming `path` above 1 000 000 sums.
Tm33Table sum_of_tm33_tables(const std::filesystem::path& path,
                             const std::vector<Tm33Table>& tables);

/// Reads opening, height and body from emission areas and dimensions, with notes on what is left
/// out.
void read_tm33_sizes(const XmlFile& file, const pugi::xml_node& root, LuminaireFile& luminaire);

}  // namespace lightwell
