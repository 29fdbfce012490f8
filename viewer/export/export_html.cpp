#include <stdexcept>
#include <string>
#include <string_view>

#include "viewer/export/export.h"
#include "viewer/export/page_data.h"
#include "viewer/export/web_files.h"
#include "viewer/export/write_whole.h"

namespace lightwell {
namespace {

/// JSON as the content of a script element. A script element ends at the first "</script", even
/// inside a JSON string, and names may contain "</script" or "<!--": every "<" is escaped.
std::string script_json(const nlohmann::ordered_json& json) {
  std::string result;
  for (const char c : json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

std::string title_of(const BakedModel& model) {
  if (!model.title.empty()) return model.title;
  return std::filesystem::path(model.provenance.scene_file).filename().string();
}

/// A copy of page.html in which pieces replace the marks "{{name}}", in the order of the file.
class Page {
 public:
  void put(std::string_view name, std::string_view piece) {
    const std::string mark = "{{" + std::string(name) + "}}";
    const std::size_t at = rest_.find(mark);
    if (at == std::string_view::npos) throw std::logic_error("page.html lacks " + mark);
    text_ += rest_.substr(0, at);
    text_ += piece;
    rest_.remove_prefix(at + mark.size());
  }
  std::string finish() {
    text_ += rest_;
    return std::move(text_);
  }

 private:
  std::string text_;
  std::string_view rest_ = web::page_html;
};

/// The page's own scripts; each may use those before it.
std::string program() {
  std::string text;
  for (const std::string_view script :
       {web::texts_js,    web::spheres_js, web::model_js,  web::white_js, web::sunlight_js,
        web::picture_js,  web::sky_js,     web::probe_js,  web::walk_js,  web::lights_js,
        web::cues_js,     web::isolux_js,  web::legend_js, web::plan_js,  web::measure_js,
        web::gestures_js, web::stick_js,   web::panels_js, web::year_js,  web::page_js}) {
    text += script;
    text += '\n';
  }
  return text;
}

}  // namespace

void write_walkthrough(const std::filesystem::path& path, const BakedModel& model,
                       const std::optional<LuxRange>& range, const WhitePoint& white) {
  const PageData data = page_data(model, range.value_or(lux_range(model.illuminance)), white);
  Page page;
  page.put("title", html_text(title_of(model)));
  page.put("style", web::page_css);
  page.put("about", script_json(data.about));
  page.put("data", base64(data.bytes));
  page.put("licenses", web::licenses_txt);
  page.put("library", web::library_js);
  page.put("program", program());
  write_whole(path, {page.finish()});
}

}  // namespace lightwell
