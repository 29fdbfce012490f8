#include "viewer/document/pdf_canvas.h"

#include <cairo-pdf.h>
#include <fmt/format.h>
#include <librsvg/rsvg.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "viewer/document/page_frame.h"

namespace lightwell {
namespace {

constexpr const char* pdf_fonts = "DejaVu Sans, sans";

template <auto release>
struct Release {
  template <typename T>
  void operator()(T* it) const {
    release(it);
  }
};
using CairoSurface = std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>>;
using SvgHandle = std::unique_ptr<RsvgHandle, Release<g_object_unref>>;

void require_cairo(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw std::runtime_error(
      fmt::format("the PDF could not be drawn: {}", cairo_status_to_string(status)));
}

cairo_status_t append_to(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

cairo_status_t take_from(void* bytes, unsigned char* data, unsigned length) {
  auto& rest = *static_cast<std::string_view*>(bytes);
  if (rest.size() < length) return CAIRO_STATUS_READ_ERROR;
  std::memcpy(data, rest.data(), length);
  rest.remove_prefix(length);
  return CAIRO_STATUS_SUCCESS;
}

[[noreturn]] void throw_svg(GError* error) {
  const std::string why = error ? error->message : "unknown error";
  g_clear_error(&error);
  throw std::runtime_error("a drawing could not be placed in the PDF: " + why);
}

SvgHandle read_svg(const std::string& svg) {
  GError* error = nullptr;
  SvgHandle handle(
      rsvg_handle_new_from_data(reinterpret_cast<const guint8*>(svg.data()), svg.size(), &error));
  if (!handle) throw_svg(error);
  const std::string style = drawing_style("'DejaVu Sans', sans-serif");
  if (!rsvg_handle_set_stylesheet(handle.get(), reinterpret_cast<const guint8*>(style.data()),
                                  style.size(), &error)) {
    throw_svg(error);
  }
  return handle;
}

PangoLayout* layout_of(const std::shared_ptr<void>& layout) {
  return static_cast<PangoLayout*>(layout.get());
}

PangoRectangle extents_of(const std::shared_ptr<void>& layout) {
  PangoRectangle logical;
  pango_layout_get_extents(layout_of(layout), nullptr, &logical);
  return logical;
}

PangoRectangle line_extents(const std::shared_ptr<void>& layout, int line) {
  PangoRectangle logical;
  pango_layout_line_get_extents(pango_layout_get_line_readonly(layout_of(layout), line), nullptr,
                                &logical);
  return logical;
}

}  // namespace

struct PdfCanvas::Parts {
  std::string bytes{};
  cairo_surface_t* surface = nullptr;
  cairo_t* cairo = nullptr;
  PangoFontMap* fonts = nullptr;
  PangoContext* text = nullptr;

  ~Parts() {
    g_object_unref(text);
    g_object_unref(fonts);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
  }
};

double SetText::width() const {
  return pango_units_to_double(extents_of(layout_).width);
}
double SetText::height() const {
  return pango_units_to_double(extents_of(layout_).height);
}
int SetText::line_count() const {
  return pango_layout_get_line_count(layout_of(layout_));
}
double SetText::line_height(int line) const {
  const double gap = line + 1 < line_count() ? spacing_ : 0.0;
  return pango_units_to_double(line_extents(layout_, line).height) + gap;
}

PdfCanvas::PdfCanvas(const std::string& title, const std::string& author,
                     const std::string& language)
    : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.surface = cairo_pdf_surface_create_for_stream(append_to, &p.bytes, page_width, page_height);
  p.cairo = cairo_create(p.surface);
  // A map of its own, since the default one belongs to its thread.
  p.fonts = pango_cairo_font_map_new();
  p.text = pango_font_map_create_context(p.fonts);
  pango_cairo_update_context(p.cairo, p.text);
  cairo_font_options_t* const options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  pango_cairo_context_set_font_options(p.text, options);
  cairo_font_options_destroy(options);
  // One unit of Pango's points is a point of the page.
  constexpr double points_per_inch = 72.0;
  pango_cairo_context_set_resolution(p.text, points_per_inch);
  pango_context_set_language(p.text, pango_language_from_string(language.c_str()));
  pango_context_set_round_glyph_positions(p.text, FALSE);
  cairo_pdf_surface_set_metadata(p.surface, CAIRO_PDF_METADATA_TITLE, title.c_str());
  if (!author.empty()) {
    cairo_pdf_surface_set_metadata(p.surface, CAIRO_PDF_METADATA_AUTHOR, author.c_str());
  }
  cairo_pdf_surface_set_metadata(p.surface, CAIRO_PDF_METADATA_CREATOR, "Lightwell");
  // Cairo would write the time of the run: the same input gives the same bytes.
  cairo_pdf_surface_set_metadata(p.surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
}

PdfCanvas::~PdfCanvas() = default;

SetText PdfCanvas::set(const MarkedText& text, const TextStyle& style, double width) const {
  SetText result;
  PangoLayout* const layout = pango_layout_new(parts_->text);
  result.layout_ = std::shared_ptr<void>(layout, g_object_unref);
  result.grey_ = style.grey;
  // DejaVu's lines are 1.16 letters high; text is easier to read at 1.3.
  constexpr double gap_of_lines = 0.14;
  result.spacing_ = gap_of_lines * style.size;
  pango_layout_set_spacing(layout, pango_units_from_double(result.spacing_));
  PangoFontDescription* const font = pango_font_description_from_string(pdf_fonts);
  pango_font_description_set_absolute_size(font, style.size * PANGO_SCALE);
  if (style.is_bold) pango_font_description_set_weight(font, PANGO_WEIGHT_BOLD);
  pango_layout_set_font_description(layout, font);
  pango_font_description_free(font);
  pango_layout_set_wrap(layout, width > 0.0 ? PANGO_WRAP_WORD_CHAR : PANGO_WRAP_WORD);
  pango_layout_set_width(layout, pango_units_from_double(width));
  if (style.is_right) pango_layout_set_alignment(layout, PANGO_ALIGN_RIGHT);
  if (style.most_lines > 0) {
    pango_layout_set_height(layout, -style.most_lines);
    pango_layout_set_ellipsize(layout, PANGO_ELLIPSIZE_END);
  }
  pango_layout_set_markup(layout, text.c_str(), static_cast<int>(text.size()));
  return result;
}

void PdfCanvas::draw(const SetText& text, double x, double y) {
  cairo_t* const cairo = parts_->cairo;
  cairo_set_source_rgb(cairo, text.grey_, text.grey_, text.grey_);
  cairo_move_to(cairo, x, y);
  pango_cairo_show_layout(cairo, layout_of(text.layout_));
}

void PdfCanvas::draw_line(const SetText& text, int line, double x, double y) {
  cairo_t* const cairo = parts_->cairo;
  cairo_set_source_rgb(cairo, text.grey_, text.grey_, text.grey_);
  const PangoRectangle logical = line_extents(text.layout_, line);
  cairo_move_to(cairo, x, y - pango_units_to_double(logical.y));
  pango_cairo_show_layout_line(cairo,
                               pango_layout_get_line_readonly(layout_of(text.layout_), line));
}

void PdfCanvas::draw_rule(double x, double y, double width, double thickness, double grey) {
  cairo_t* const cairo = parts_->cairo;
  cairo_set_source_rgb(cairo, grey, grey, grey);
  cairo_rectangle(cairo, x, y, width, thickness);
  cairo_fill(cairo);
}

PdfCanvas::Size PdfCanvas::size_of_svg(const std::string& svg) {
  const SvgHandle handle = read_svg(svg);
  gboolean has_width = FALSE, has_height = FALSE, has_box = FALSE;
  RsvgLength width, height;
  RsvgRectangle box;
  rsvg_handle_get_intrinsic_dimensions(handle.get(), &has_width, &width, &has_height, &height,
                                       &has_box, &box);
  if (!has_box) throw std::runtime_error("a drawing for the PDF has no viewBox");
  return {box.width * points_per_mm, box.height * points_per_mm};
}

void PdfCanvas::draw_svg(const std::string& svg, double x, double y, const Size& size) {
  const SvgHandle handle = read_svg(svg);
  const RsvgRectangle place{x, y, size.width, size.height};
  GError* error = nullptr;
  if (!rsvg_handle_render_document(handle.get(), parts_->cairo, &place, &error)) throw_svg(error);
}

void PdfCanvas::draw_png(const std::string& png, double x, double y, const Size& size) {
  std::string_view rest = png;
  const CairoSurface picture(cairo_image_surface_create_from_png_stream(take_from, &rest));
  require_cairo(cairo_surface_status(picture.get()));
  cairo_t* const cairo = parts_->cairo;
  cairo_save(cairo);
  cairo_translate(cairo, x, y);
  cairo_scale(cairo, size.width / cairo_image_surface_get_width(picture.get()),
              size.height / cairo_image_surface_get_height(picture.get()));
  cairo_set_source_surface(cairo, picture.get(), 0.0, 0.0);
  cairo_paint(cairo);
  cairo_restore(cairo);
}

void PdfCanvas::add_bookmark(const std::string& title, int page, double y) {
  cairo_pdf_surface_add_outline(parts_->surface, CAIRO_PDF_OUTLINE_ROOT, title.c_str(),
                                fmt::format("page={} pos=[0 {:.1f}]", page, y).c_str(),
                                static_cast<cairo_pdf_outline_flags_t>(0));
}

void PdfCanvas::end_page() {
  cairo_show_page(parts_->cairo);
}

std::string PdfCanvas::finish() {
  require_cairo(cairo_status(parts_->cairo));
  cairo_surface_finish(parts_->surface);
  require_cairo(cairo_surface_status(parts_->surface));
  return std::move(parts_->bytes);
}

}  // namespace lightwell
