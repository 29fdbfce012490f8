#pragma once

#include <string>

#include "viewer/document/document.h"

namespace lightwell {

/// Throws InputError, which says what to install, in a build without cairo, Pango and librsvg.
void require_pdf();

/// The document as a PDF file of A4 pages: a cover, then the sections, with numbers of pages. The
/// same document gives the same bytes with the same fonts and libraries. Text is set in DejaVu
/// Sans; where that is missing, in the system's sans serif. Throws as require_pdf() does, and
/// std::runtime_error if a drawing cannot be placed.
std::string pdf_document(const Document& document);

}  // namespace lightwell
