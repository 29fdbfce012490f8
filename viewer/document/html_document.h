#pragma once

#include <string>

#include "viewer/document/document.h"

namespace lightwell {

/// The document as one HTML page without external files, for screens and for A4 paper.
std::string html_document(const Document& document);

}  // namespace lightwell
