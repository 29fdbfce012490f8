#include "scene/errors.h"
#include "viewer/document/pdf_document.h"

namespace lightwell {

void require_pdf() {
  throw InputError(
      "this lightwell was built without PDF; write .html, or install cairo, Pango and librsvg "
      "(Debian: libcairo2-dev, libpango1.0-dev, librsvg2-dev) and build it with "
      "-DLIGHTWELL_PDF=ON");
}

std::string pdf_document(const Document& /*document*/) {
  require_pdf();
  return {};
}

}  // namespace lightwell
