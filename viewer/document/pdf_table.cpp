#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "viewer/document/pdf_pages.h"

namespace lightwell {
namespace {

constexpr double letters = 8.5, small_letters = 7.0;                        // points
constexpr double between_columns = 12.0, above_row = 2.2, below_row = 2.2;  // points
constexpr double bound_gap = 3.0, indent = 8.0;                             // points
constexpr int most_lines = 12;

/// Widths of the parts of a column, points.
struct ColumnWidths {
  double lead = 0.0;   ///< of numbers up to the decimal sign
  double tail = 0.0;   ///< of the decimal sign and what follows
  double bound = 0.0;  ///< of the bound beside it, with its gap
  double word = 0.0;   ///< of entries of a column of numbers that are no numbers
  double head = 0.0;   ///< of the head
  double width = 0.0;  ///< of the column
};

struct TableLayout {
  const DocumentTable& table;
  char decimal_sign = '.';
  double scale = 1.0;  ///< of letters, below 1 where numbers would not fit
  std::vector<ColumnWidths> columns{};
};

/// A number before its decimal sign, and from there on.
struct NumberParts {
  MarkedText lead{}, tail{};
};

bool is_number(const MarkedText& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text.front())) != 0 ||
                           text.front() == '-' || text.front() == '+');
}

NumberParts parts_of(const MarkedText& text, char decimal_sign) {
  std::size_t end = text.find(decimal_sign);
  // Text after the digits of a number without decimals is a unit.
  if (end == MarkedText::npos) end = text.find_first_not_of("0123456789+-e");
  return end == MarkedText::npos ? NumberParts{text, {}}
                                 : NumberParts{text.substr(0, end), text.substr(end)};
}

TextStyle cell_style(const TableLayout& layout, RowKind kind) {
  return {.size = letters * layout.scale,
          .is_bold = kind == RowKind::total || kind == RowKind::group,
          .most_lines = most_lines};
}

TextStyle bound_style(const TableLayout& layout) {
  constexpr double grey = 0.35;
  return {.size = small_letters * layout.scale, .grey = grey};
}

TextStyle head_style(const TableLayout& layout, bool is_text) {
  return {.size = letters * layout.scale, .is_bold = true, .is_right = !is_text};
}

constexpr double unlimited = 1e5;                   // points
constexpr double most_head = 26.0 * points_per_mm;  // of a line of a head over numbers

double natural_width(const PdfCanvas& canvas, const MarkedText& text, TextStyle style) {
  style.is_right = false;
  return canvas.set(text, style, unlimited).width();
}

// The head of a column. A long one is broken before its unit rather than within it.
SetText set_head(const TableLayout& layout, const PdfCanvas& canvas, const TableColumn& column,
                 double width) {
  const TextStyle style = head_style(layout, column.is_text);
  MarkedText head = column.head;
  const std::size_t unit = head.rfind(", ");
  if (unit != MarkedText::npos && natural_width(canvas, head, style) > width) {
    head[unit + 1] = '\n';
  }
  return canvas.set(head, style, width);
}

void measure_cell(const TableLayout& layout, const PdfCanvas& canvas, const TableCell& cell,
                  RowKind kind, ColumnWidths& widths) {
  TextStyle style = cell_style(layout, kind);
  const auto width_of = [&](const MarkedText& text) {
    return text.empty() ? 0.0 : natural_width(canvas, text, style);
  };
  if (is_number(cell.text)) {
    const auto [lead, tail] = parts_of(cell.text, layout.decimal_sign);
    widths.lead = std::max(widths.lead, width_of(lead));
    widths.tail = std::max(widths.tail, width_of(tail));
  } else {
    widths.word = std::max(widths.word, width_of(cell.text));
  }
  if (cell.bound.empty()) return;
  style = bound_style(layout);
  widths.bound = std::max(widths.bound, bound_gap + width_of(cell.bound));
}

// Natural widths of all columns.
void measure_columns(TableLayout& layout, const PdfCanvas& canvas) {
  const DocumentTable& table = layout.table;
  layout.columns.assign(table.columns.size(), {});
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    ColumnWidths& widths = layout.columns[i];
    const TableColumn& column = table.columns[i];
    const TextStyle style = head_style(layout, true);
    widths.head =
        std::max(canvas.set(column.head, style, 0.0).width(),
                 std::min(natural_width(canvas, column.head, style), layout.scale * most_head));
    if (column.is_text) {
      for (const TableRow& row : table.rows) {
        const double natural =
            canvas.set(row.cells[i].text, cell_style(layout, row.kind), unlimited).width();
        widths.word = std::max(widths.word, natural + (row.kind == RowKind::detail ? indent : 0.0));
      }
    } else {
      for (const TableRow& row : table.rows) {
        measure_cell(layout, canvas, row.cells[i], row.kind, widths);
      }
    }
    widths.width = std::max({widths.lead + widths.tail + widths.bound, widths.word, widths.head});
  }
}

// Columns of words share `width`. None gets less than an even share unless its words need less;
// the first column takes what remains.
void share_among_words(TableLayout& layout, double width) {
  std::vector<ColumnWidths*> columns;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    if (layout.table.columns[i].is_text) columns.push_back(&layout.columns[i]);
  }
  if (columns.empty()) return;
  ColumnWidths* const first = columns.front();
  std::ranges::stable_sort(columns, {}, &ColumnWidths::width);
  double left = width, open = static_cast<double>(columns.size());
  for (ColumnWidths* const column : columns) {
    column->width = std::min(column->width, left / open);
    left -= column->width;
    open -= 1.0;
  }
  first->width += left;
}

// Columns of numbers get their natural widths. Where those leave too little for the words, all
// letters of the table are smaller.
void share_width(TableLayout& layout, const PdfCanvas& canvas) {
  constexpr double least_text = 28.0 * points_per_mm;
  const auto sum_of_numbers = [&] {
    double sum = 0.0;
    for (std::size_t i = 0; i < layout.columns.size(); ++i) {
      if (!layout.table.columns[i].is_text) sum += layout.columns[i].width;
    }
    return sum;
  };
  const auto texts = static_cast<double>(
      std::ranges::count_if(layout.table.columns, [](const TableColumn& c) { return c.is_text; }));
  const double gaps = between_columns * (static_cast<double>(layout.table.columns.size()) - 1.0);
  const double most_numbers = PdfPages::width - gaps - least_text * texts;
  measure_columns(layout, canvas);
  if (sum_of_numbers() > most_numbers) {
    // A little less, since letters of another size are not exactly in proportion.
    constexpr double a_little_less = 0.97;
    layout.scale = a_little_less * most_numbers / sum_of_numbers();
    measure_columns(layout, canvas);
  }
  share_among_words(layout, PdfPages::width - gaps - sum_of_numbers());
}

double indent_of(const TableRow& row, std::size_t column) {
  return row.kind == RowKind::detail && column == 0 ? indent : 0.0;
}

double row_height(const TableLayout& layout, const PdfCanvas& canvas, const TableRow& row) {
  double height = 0.0;
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const double width =
        layout.table.columns[i].is_text ? layout.columns[i].width - indent_of(row, i) : unlimited;
    const SetText text = canvas.set(row.cells[i].text, cell_style(layout, row.kind), width);
    height = std::max(height, text.height());
  }
  return above_row + height + below_row;
}

// A number stands with its decimal sign in a line with those of the column; the column's numbers
// and bounds stand at its right end.
void draw_number(const TableLayout& layout, PdfCanvas& canvas, const TableCell& cell, RowKind kind,
                 const ColumnWidths& widths, double x, double y) {
  const TextStyle style = cell_style(layout, kind);
  const double right = x + widths.width;
  if (!is_number(cell.text)) {
    if (cell.text.empty()) return;
    const SetText word = canvas.set(cell.text, style, unlimited);
    canvas.draw(word, right - word.width(), y);
    return;
  }
  const auto [lead, tail] = parts_of(cell.text, layout.decimal_sign);
  const double sign_at = right - widths.bound - widths.tail;
  const SetText before = canvas.set(lead, style, unlimited);
  canvas.draw(before, sign_at - before.width(), y);
  if (!tail.empty()) canvas.draw(canvas.set(tail, style, unlimited), sign_at, y);
  if (cell.bound.empty()) return;
  const SetText bound = canvas.set(cell.bound, bound_style(layout), unlimited);
  constexpr double to_the_base_line = (letters - small_letters) * 0.93;
  canvas.draw(bound, right - widths.bound + bound_gap, y + to_the_base_line * layout.scale);
}

void draw_row(const TableLayout& layout, PdfPages& pages, const TableRow& row, double height) {
  double x = PdfPages::left;
  const double y = pages.y() + above_row;
  for (std::size_t i = 0; i < row.cells.size(); ++i) {
    const ColumnWidths& widths = layout.columns[i];
    if (layout.table.columns[i].is_text) {
      const double in = indent_of(row, i);
      pages.canvas().draw(
          pages.canvas().set(row.cells[i].text, cell_style(layout, row.kind), widths.width - in),
          x + in, y);
    } else {
      draw_number(layout, pages.canvas(), row.cells[i], row.kind, widths, x, y);
    }
    x += widths.width + between_columns;
  }
  pages.skip(height);
  constexpr double thin = 0.4, light = 0.82;
  pages.canvas().draw_rule(PdfPages::left, pages.y(), PdfPages::width, thin, light);
}

std::vector<SetText> set_heads(const TableLayout& layout, const PdfCanvas& canvas) {
  std::vector<SetText> heads;
  for (std::size_t i = 0; i < layout.columns.size(); ++i) {
    heads.push_back(set_head(layout, canvas, layout.table.columns[i], layout.columns[i].width));
  }
  return heads;
}

double head_height(const std::vector<SetText>& heads) {
  double height = 0.0;
  for (const SetText& head : heads) height = std::max(height, head.height());
  return height + below_row;
}

// Heads stand on the line below them.
void draw_head(const TableLayout& layout, const std::vector<SetText>& heads, PdfPages& pages) {
  const double height = head_height(heads);
  double x = PdfPages::left;
  for (std::size_t i = 0; i < heads.size(); ++i) {
    pages.canvas().draw(heads[i], x, pages.y() + height - below_row - heads[i].height());
    x += layout.columns[i].width + between_columns;
  }
  pages.skip(height);
  constexpr double thick = 0.8, dark = 0.3;
  pages.canvas().draw_rule(PdfPages::left, pages.y(), PdfPages::width, thick, dark);
}

}  // namespace

void draw_table(const DocumentTable& table, char decimal_sign, PdfPages& pages) {
  TableLayout layout{.table = table, .decimal_sign = decimal_sign};
  share_width(layout, pages.canvas());
  const std::vector<SetText> heads = set_heads(layout, pages.canvas());
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const TableRow& row = table.rows[r];
    const double height = row_height(layout, pages.canvas(), row);
    // The head of a group stays with the first row of the group.
    const bool has_next = row.kind == RowKind::group && r + 1 < table.rows.size();
    const double together =
        height + (has_next ? row_height(layout, pages.canvas(), table.rows[r + 1]) : 0.0);
    if (r == 0) {
      pages.need(head_height(heads) + together);
      draw_head(layout, heads, pages);
    } else if (together > pages.room()) {
      pages.begin_page();
      draw_head(layout, heads, pages);
    }
    draw_row(layout, pages, row, height);
  }
}

}  // namespace lightwell
