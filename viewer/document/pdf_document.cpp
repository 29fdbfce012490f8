#include "viewer/document/pdf_document.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "scene/utf8.h"
#include "viewer/document/pdf_canvas.h"
#include "viewer/document/pdf_pages.h"

namespace lightwell {
namespace {

constexpr double text_size = 9.0, title_size = 22.0, section_size = 14.0, part_size = 10.5;
constexpr double caption_size = 8.5;
constexpr double grey_text = 0.3;
constexpr double paragraph_gap = 6.0, part_gap = 10.0;  // points

void draw_block(const DocumentParagraph& paragraph, const Document& /*of*/, PdfPages& pages) {
  pages.flow(pages.canvas().set(paragraph.text, {.size = text_size}, PdfPages::width),
             PdfPages::left);
  pages.skip(paragraph_gap);
}

void draw_block(const DocumentList& list, const Document& /*of*/, PdfPages& pages) {
  constexpr double indent = 12.0, gap = 3.0;
  for (const MarkedText& item : list.items) {
    const SetText text = pages.canvas().set(item, {.size = text_size}, PdfPages::width - indent);
    pages.need(text.line_height(0));
    pages.canvas().draw(pages.canvas().set("•", {.size = text_size}, indent), PdfPages::left,
                        pages.y());
    pages.flow(text, PdfPages::left + indent);
    pages.skip(gap);
  }
  pages.skip(paragraph_gap);
}

void draw_block(const DocumentFacts& facts, const Document& /*of*/, PdfPages& pages) {
  constexpr double name_width = 42.0 * points_per_mm, between = 8.0, gap = 2.5;
  for (const auto& [name, text] : facts.facts) {
    const SetText label = pages.canvas().set(
        name, {.size = text_size, .grey = grey_text, .most_lines = 3}, name_width);
    const SetText lines =
        pages.canvas().set(text, {.size = text_size}, PdfPages::width - name_width - between);
    pages.need(label.height());
    const double label_end = pages.y() + label.height();
    const int page = pages.page();
    pages.canvas().draw(label, PdfPages::left, pages.y());
    pages.flow(lines, PdfPages::left + name_width + between);
    if (pages.page() == page) pages.skip(std::max(0.0, label_end - pages.y()));
    pages.skip(gap);
  }
  pages.skip(paragraph_gap);
}

void draw_part_title(const MarkedText& title, double together, PdfPages& pages) {
  const SetText text = pages.canvas().set(
      title, {.size = part_size, .is_bold = true, .most_lines = 6}, PdfPages::width);
  if (!pages.is_fresh()) pages.skip(part_gap);
  pages.need(text.height() + together);
  pages.flow(text, PdfPages::left);
  constexpr double gap = 3.0;
  pages.skip(gap);
}

void draw_block(const DocumentTable& table, const Document& of, PdfPages& pages) {
  constexpr double few_rows = 25.0 * points_per_mm;
  if (!table.title.empty()) draw_part_title(table.title, few_rows, pages);
  draw_table(table, of.decimal_sign, pages);
  pages.skip(paragraph_gap);
  for (const MarkedText& note : table.notes) draw_block(DocumentParagraph{note}, of, pages);
}

// Drawings stay true to their scale unless one is larger than the page.
PdfCanvas::Size fitted(PdfCanvas::Size size, double width, double height) {
  const double smaller = std::min({1.0, width / size.width, height / size.height});
  return {smaller * size.width, smaller * size.height};
}

void draw_block(const DocumentDrawing& drawing, const Document& /*of*/, PdfPages& pages) {
  const SetText caption =
      pages.canvas().set(drawing.caption, {.size = caption_size, .most_lines = 6}, PdfPages::width);
  constexpr double gap = 5.0;
  const PdfCanvas::Size size = fitted(PdfCanvas::size_of_svg(drawing.svg), PdfPages::width,
                                      PdfPages::bottom - PdfPages::top - caption.height() - gap);
  pages.need(caption.height() + gap + size.height);
  pages.flow(caption, PdfPages::left);
  pages.skip(gap);
  pages.canvas().draw_svg(drawing.svg, PdfPages::left, pages.y(), size);
  pages.skip(size.height + part_gap);
}

void draw_block(const DocumentCard& card, const Document& /*of*/, PdfPages& pages) {
  constexpr double gap = 14.0;
  PdfCanvas::Size size;
  if (!card.svg.empty()) size = PdfCanvas::size_of_svg(card.svg);
  const double x = PdfPages::left + (card.svg.empty() ? 0.0 : size.width + gap);
  const double width = PdfPages::left + PdfPages::width - x;
  std::vector<SetText> lines = {
      pages.canvas().set(card.title, {.size = part_size, .is_bold = true, .most_lines = 4}, width)};
  for (const MarkedText& line : card.lines) {
    lines.push_back(pages.canvas().set(line, {.size = text_size, .most_lines = 6}, width));
  }
  double height = 0.0;
  for (const SetText& line : lines) height += line.height();
  const double taller = std::max(height, size.height);
  pages.need(taller);
  if (!card.svg.empty()) pages.canvas().draw_svg(card.svg, PdfPages::left, pages.y(), size);
  double y = pages.y() + 0.5 * (taller - height);
  for (const SetText& line : lines) {
    pages.canvas().draw(line, x, y);
    y += line.height();
  }
  pages.skip(taller + part_gap);
}

void draw_cover(const Document& document, PdfPages& pages) {
  constexpr double above = 18.0 * points_per_mm, gap = 10.0, thick = 2.0, dark = 0.1;
  pages.skip(above);
  pages.flow(pages.canvas().set(marked(document.title), {.size = title_size, .is_bold = true},
                                PdfPages::width),
             PdfPages::left);
  pages.skip(gap);
  pages.canvas().draw_rule(PdfPages::left, pages.y(), PdfPages::width, thick, dark);
  pages.skip(2.0 * gap);
  draw_block(document.head, document, pages);
  if (!document.picture) return;
  pages.skip(gap);
  const DocumentPicture& picture = *document.picture;
  const SetText caption = pages.canvas().set(
      picture.caption, {.size = caption_size, .grey = grey_text, .most_lines = 3}, PdfPages::width);
  const double aspect = static_cast<double>(picture.height) / picture.width;
  PdfCanvas::Size size{PdfPages::width, PdfPages::width * aspect};
  constexpr double least = 60.0 * points_per_mm;
  pages.need(std::min(size.height, least) + gap + caption.height());
  size = fitted(size, PdfPages::width, pages.room() - gap - caption.height());
  pages.canvas().draw_png(picture.png, PdfPages::left, pages.y(), size);
  pages.skip(size.height + 0.5 * gap);
  pages.flow(caption, PdfPages::left);
}

// A title as plain text, without its marks.
std::string without_marks(const MarkedText& text) {
  std::string plain;
  bool is_mark = false;
  for (const char c : text) {
    if (c == '<') is_mark = true;
    if (!is_mark) plain += c;
    if (c == '>') is_mark = false;
  }
  for (const auto& [entity, letter] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}}) {
    for (std::size_t at = 0; (at = plain.find(entity, at)) != std::string::npos; ++at) {
      plain.replace(at, std::string(entity).size(), letter);
    }
  }
  return plain;
}

void draw_section(const DocumentSection& section, const Document& document, PdfPages& pages) {
  constexpr double few_lines = 40.0 * points_per_mm, gap = 22.0;
  if (section.begins_page || pages.room() < few_lines) {
    pages.begin_page();
    pages.name_section(section.title);
  } else {
    pages.skip(gap);
  }
  pages.canvas().add_bookmark(without_marks(section.title), pages.page(), pages.y());
  const SetText title = pages.canvas().set(
      section.title, {.size = section_size, .is_bold = true, .most_lines = 6}, PdfPages::width);
  pages.flow(title, PdfPages::left);
  constexpr double above_line = 3.0, below_line = 8.0, thick = 1.2, dark = 0.1;
  pages.skip(above_line);
  pages.canvas().draw_rule(PdfPages::left, pages.y(), PdfPages::width, thick, dark);
  pages.skip(below_line);
  for (const DocumentBlock& block : section.blocks) {
    std::visit([&](const auto& it) { draw_block(it, document, pages); }, block);
  }
}

/// Bytes of a file, and the number of its pages.
struct DrawnPdf {
  std::string bytes{};
  int pages = 0;
};

DrawnPdf draw_pdf(const Document& document, int page_count) {
  PdfCanvas canvas(plain_text(document.title), plain_text(document.author), document.language);
  PdfPages pages(canvas, marked(document.footer), page_count);
  draw_cover(document, pages);
  for (const DocumentSection& section : document.sections) draw_section(section, document, pages);
  pages.end();
  return {canvas.finish(), pages.page()};
}

}  // namespace

void require_pdf() {}

std::string pdf_document(const Document& document) {
  // Drawn twice, since the footer has the number of all pages.
  const int page_count = draw_pdf(document, 0).pages;
  return draw_pdf(document, page_count).bytes;
}

}  // namespace lightwell
