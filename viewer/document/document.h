#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace lightwell {

/// Text in UTF-8 with marks that mean the same in HTML and in Pango: <b>, <sub>, <small>, and the
/// entities &lt; &gt; &amp; &quot;.
using MarkedText = std::string;

/// Plain text as marked text on one line. Bytes that are not UTF-8 are taken as Latin-1; control
/// characters are left out.
MarkedText marked(std::string_view text);

/// Column of a table: words from the left, or numbers that are aligned at the decimal sign.
struct TableColumn {
  MarkedText head{};  ///< with the unit
  bool is_text = false;
};

enum class RowKind {
  plain,
  group,   ///< head of the rows of kind `detail` below it
  detail,  ///< of the group above
  total
};

/// Cell of a table; a number may have the bound of its error beside it.
struct TableCell {
  MarkedText text{};
  MarkedText bound{};
};

struct TableRow {
  std::vector<TableCell> cells{};  ///< as many as columns
  RowKind kind = RowKind::plain;
};

struct DocumentTable {
  MarkedText title{};  ///< empty: none
  std::vector<TableColumn> columns{};
  std::vector<TableRow> rows{};
  std::vector<MarkedText> notes{};  ///< below the table, a paragraph each
};

struct DocumentParagraph {
  MarkedText text{};
};

/// Sentences, an item each.
struct DocumentList {
  std::vector<MarkedText> items{};
};

struct DocumentFact {
  MarkedText name{}, text{};
};

/// Names, and what they stand for, line by line.
struct DocumentFacts {
  std::vector<DocumentFact> facts{};
};

/// A drawing that is printed at its own size: an SVG whose viewBox is in millimetres of paper, in
/// the classes of drawing_style(). It has no other text than that of the drawing.
struct DocumentDrawing {
  MarkedText caption{};
  std::string svg{};
};

/// A drawing as above, or none, with lines of text beside it.
struct DocumentCard {
  std::string svg{};
  MarkedText title{};
  std::vector<MarkedText> lines{};
};

using DocumentBlock = std::variant<DocumentParagraph, DocumentList, DocumentFacts, DocumentTable,
                                   DocumentDrawing, DocumentCard>;

struct DocumentSection {
  MarkedText title{};
  std::vector<DocumentBlock> blocks{};
  bool begins_page = true;  ///< on paper
};

/// A picture as wide as the page.
struct DocumentPicture {
  MarkedText caption{};
  int width = 0, height = 0;  ///< pixels
  std::string png{};          ///< bytes of a PNG file
};

/// Contents of a document that is written as HTML or as PDF.
struct Document {
  std::string language = "en";  ///< BCP 47
  char decimal_sign = '.';      ///< of the numbers in its tables
  std::string title{};          ///< plain text
  std::string author{};         ///< plain text; empty: not known
  std::string footer{};         ///< of every page, plain text
  DocumentFacts head{};         ///< below the title
  std::optional<DocumentPicture> picture{};
  std::vector<DocumentSection> sections{};
};

}  // namespace lightwell
