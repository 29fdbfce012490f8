#include "viewer/document/html_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "scene/utf8.h"
#include "viewer/document/page_frame.h"
#include "viewer/export/page_data.h"

namespace lightwell {
namespace {

void add_html(const DocumentParagraph& paragraph, std::string& page) {
  page += "<p>" + paragraph.text + "</p>\n";
}

void add_html(const DocumentList& list, std::string& page) {
  page += "<ul>";
  for (const MarkedText& item : list.items) page += "<li>" + item + "</li>\n";
  page += "</ul>\n";
}

void add_html(const DocumentFacts& facts, std::string& page) {
  page += "<dl class=\"heading\">";
  for (const auto& [name, text] : facts.facts) {
    fmt::format_to(std::back_inserter(page), "<dt>{}</dt><dd>{}</dd>", name, text);
  }
  page += "</dl>\n";
}

const char* class_of(RowKind kind) {
  switch (kind) {
    case RowKind::group:
    case RowKind::total:
      return " class=\"total\"";
    case RowKind::detail:
      return " class=\"kind\"";
    case RowKind::plain:
      break;
  }
  return "";
}

// A group and its details are one <tbody>, which is not broken over pages.
void add_rows(const DocumentTable& table, std::string& page) {
  const auto out = std::back_inserter(page);
  bool is_first = true;
  for (const TableRow& row : table.rows) {
    if (row.kind != RowKind::detail) page += is_first ? "<tbody>" : "</tbody>\n<tbody>";
    is_first = false;
    fmt::format_to(out, "<tr{}>", class_of(row.kind));
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      const auto& [text, bound] = row.cells[i];
      fmt::format_to(out, "<td{}>{}", table.columns[i].is_text ? " class=\"text\"" : "", text);
      if (!bound.empty()) fmt::format_to(out, " <small>{}</small>", bound);
      page += "</td>";
    }
    page += "</tr>\n";
  }
  if (!is_first) page += "</tbody>";
}

void add_html(const DocumentTable& table, std::string& page) {
  if (!table.title.empty()) page += "<h3>" + table.title + "</h3>\n";
  page += "<table><thead><tr>";
  for (const TableColumn& column : table.columns) {
    fmt::format_to(std::back_inserter(page), "<th{}>{}</th>",
                   column.is_text ? " class=\"text\"" : "", column.head);
  }
  page += "</tr></thead>\n";
  add_rows(table, page);
  page += "</table>\n";
  for (const MarkedText& note : table.notes) add_html(DocumentParagraph{note}, page);
}

void add_html(const DocumentDrawing& drawing, std::string& page) {
  fmt::format_to(std::back_inserter(page), "<figure><figcaption>{}</figcaption>\n{}</figure>\n",
                 drawing.caption, drawing.svg);
}

void add_html(const DocumentCard& card, std::string& page) {
  fmt::format_to(std::back_inserter(page), "<div class=\"luminaire-card\">{}<div><h3>{}</h3><p>",
                 card.svg, card.title);
  for (const MarkedText& line : card.lines) page += line + "<br>";
  page += "</p></div></div>\n";
}

void add_picture(const DocumentPicture& picture, std::string& page) {
  fmt::format_to(std::back_inserter(page),
                 "<figure><img width=\"{}\" height=\"{}\" alt=\"\" "
                 "src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
                 picture.width, picture.height, base64(picture.png), picture.caption);
}

}  // namespace

MarkedText marked(std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return html_text(plain_text(line));
}

std::string html_document(const Document& document) {
  std::string page = page_begin(document.title, document.language.c_str());
  page += "<h1>" + marked(document.title) + "</h1>\n";
  add_html(document.head, page);
  if (document.picture) add_picture(*document.picture, page);
  for (const DocumentSection& section : document.sections) {
    fmt::format_to(std::back_inserter(page), "<section{}><h2>{}</h2>\n",
                   section.begins_page ? " class=\"surface\"" : "", section.title);
    for (const DocumentBlock& block : section.blocks) {
      std::visit([&page](const auto& it) { add_html(it, page); }, block);
    }
    page += "</section>\n";
  }
  return page + page_end;
}

}  // namespace lightwell
